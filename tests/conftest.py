"""What every test may rely on: random inputs that are the same in every run."""

from __future__ import annotations

from hypothesis import settings

settings.register_profile("same-every-run", derandomize=True, deadline=None, max_examples=60, database=None)
settings.load_profile("same-every-run")
