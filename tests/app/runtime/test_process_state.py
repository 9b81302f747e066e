"""The state of a server process."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from app.runtime.process_state import ProcessState, process_state
from app.runtime.settings import Settings
from engine.jobs.manager import Jobs


def test_settings_reach_the_jobs_of_the_process(start_state: Callable[..., ProcessState]) -> None:
    state = start_state(cache_bytes=1000, most_orbits=2000, threads=3)
    assert process_state() is state
    stats = state.jobs.stats()
    assert (stats.cache_limit, stats.orbits_limit, stats.threads) == (1000, 2000, 3)


class LateJobs(Jobs):
    """Jobs whose first frames wait for given times, one for each look at the load."""

    def __init__(self, *waits: float) -> None:
        super().__init__()
        self.waits, self.spared = list(waits), list[bool]()

    def take_first_frame_wait(self) -> float:
        return self.waits.pop(0)

    def spare_first_frames(self, spared: bool) -> None:
        self.spared.append(spared)


def test_one_thread_is_kept_for_first_frames_as_soon_as_one_is_late_by_waits_and_delays_of_the_loop() -> None:
    state, jobs = ProcessState(Settings(longest_delay=0.5)), LateJobs(0.1, 0.4, 0.1)
    state.jobs = jobs
    for delay in (0.0, 0.3, 0.0):
        state.load.delay = delay
        state.adapt_to_load()
    assert state.overload.delay == pytest.approx(0.7)
    assert jobs.spared == [False, True, True]
    assert not state.overload.is_overloaded()
