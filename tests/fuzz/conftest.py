"""Bad input in bulk: ``pytest tests/fuzz --hypothesis-profile=thorough`` tries some 14 000 requests instead of some 2 200."""

from __future__ import annotations

from hypothesis import HealthCheck, settings

settings.register_profile(
    "thorough", max_examples=400, deadline=None, database=None, derandomize=False, suppress_health_check=list(HealthCheck)
)
