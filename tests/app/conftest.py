"""Provide the state of a server process."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest

from app.runtime.process_state import ProcessState, start_process_state
from app.runtime.settings import Settings


@pytest.fixture
def start_state() -> Iterator[Callable[..., ProcessState]]:
    """Yield a function that starts the state of this process with settings. After the test, start a state without settings."""
    yield lambda **settings: start_process_state(Settings(**settings))
    start_process_state(Settings())
