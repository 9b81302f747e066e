"""Hypothesis profile for long runs, 14 000 inputs instead of 500: ``pytest tests/fuzz --hypothesis-profile=thorough``."""

from __future__ import annotations

from hypothesis import HealthCheck, settings

settings.register_profile(
    "thorough", max_examples=400, deadline=None, database=None, derandomize=False, suppress_health_check=list(HealthCheck)
)
