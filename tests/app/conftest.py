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
        state = ProcessState(Settings(**settings))
        monkeypatch.setattr(process_state, "_started", state)
        return state

    return start
