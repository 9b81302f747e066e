"""The state of a server process, for the tests of what uses it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from app.runtime import process_state
from app.runtime.process_state import ProcessState
from app.runtime.settings import Settings


@pytest.fixture
def start_state(monkeypatch: pytest.MonkeyPatch) -> Callable[..., ProcessState]:
    """Starts the state of this process with some settings, as if there were none before; until the end of the test."""

    def start(**settings: Any) -> ProcessState:
        monkeypatch.setattr(process_state, "_started", None)
        return process_state.start_process_state(Settings(**settings))

    return start
