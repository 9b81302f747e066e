"""Add a Hypothesis profile for long runs with 14 000 inputs instead of 500: ``--hypothesis-profile=thorough``."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.browser.served_app import RunningApp, running_app
from tests.fuzz.attacked_server import SETTINGS

settings.register_profile(
    "thorough", max_examples=400, deadline=None, database=None, derandomize=False, suppress_health_check=list(HealthCheck)
)


@pytest.fixture
def served(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[RunningApp, Path]]:
    """Yield a server with small limits, and its log."""
    for name, value in SETTINGS.items():
        monkeypatch.setenv(f"ESCAPE_EXPLORER_{name}", value)
    log = tmp_path / "log"
    with running_app(log, "--unused-session-lifetime", "5000", "--check-unused-sessions", "500") as app:
        yield app, log
