"""The state of a server process."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from app.runtime.process_state import ProcessState, process_state
from app.runtime.settings import Settings


def test_settings_reach_the_jobs_of_the_process(start_state: Callable[..., ProcessState]) -> None:
    state = start_state(cache_bytes=1000, most_orbits=2000, threads=3)
    assert process_state() is state
    stats = state.jobs.stats()
    assert (stats.cache_limit, stats.orbits_limit, stats.threads) == (1000, 2000, 3)


def test_delays_of_the_loop_count_and_pause_the_background() -> None:
    state = ProcessState(Settings(longest_delay=0.5))
    assert not state.is_overloaded()
    state.load.delay = 0.7
    state.adapt_to_load()
    assert state.overload.delay == pytest.approx(0.7)


def test_one_thread_is_kept_for_first_frames_as_soon_as_one_is_late(monkeypatch: pytest.MonkeyPatch) -> None:
    state, kept, wait = ProcessState(Settings(longest_delay=0.5)), list[bool](), [0.1, 0.6, 0.1]
    monkeypatch.setattr(state.jobs, "take_first_frame_wait", lambda: wait.pop(0))
    monkeypatch.setattr(state.jobs, "spare_first_frames", kept.append)
    for _ in range(3):
        state.adapt_to_load()
    assert kept == [False, True, True]
    assert not state.overload.is_overloaded()
