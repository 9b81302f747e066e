"""Settings and capacity of a server process reach its jobs."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import Callable

from app.runtime.capacity import Capacity, ProcessorTimes
from app.runtime.process_state import ProcessState, process_state
from app.runtime.settings import Settings
from engine.jobs.manager import Jobs
from tests.app.clock import Clock
from tests.app.other_loop import run_on_new_loop


def test_settings_reach_the_jobs_of_the_process(start_state: Callable[..., ProcessState]) -> None:
    state = start_state(cache_bytes=1000, most_orbits=2000, threads=3)
    assert process_state() is state
    stats = state.jobs.stats()
    assert (stats.cache_limit, stats.orbits_limit, stats.threads) == (1000, 2000, 3)


class PreferenceJobs(Jobs):
    """Jobs that record whether first frames have priority."""

    def __init__(self) -> None:
        super().__init__()
        self.preferences = list[bool]()

    def prefer_first_frames(self, preferred: bool) -> None:
        self.preferences.append(preferred)


def test_work_is_postponed_while_pages_may_take_more_processor_time_than_there_is() -> None:
    clock, loop = Clock(), iter((0.0, 0.9, 0.9))
    state = ProcessState(Settings())
    state.jobs = jobs = PreferenceJobs()
    state.capacity = Capacity(0.02, 1, lambda: ProcessorTimes(clock.now, 0.0, 0.0, next(loop)), clock.monotonic, usable_cores=2)
    for seconds in (0.0, 1.0, 1.0):
        clock.now += seconds
        state.adapt_to_load()
    assert jobs.preferences == [False, True, False]
    assert not state.is_crowded()


class Iterations:
    """Counts the iterations of the running event loop."""

    def __init__(self) -> None:
        self.count = 0
        self._count_next()

    def _count_next(self) -> None:
        self.count += 1
        asyncio.get_running_loop().call_soon(self._count_next)


def test_pages_that_wait_at_once_have_their_turns_in_different_iterations_of_the_loop() -> None:
    async def scenario() -> None:
        state, iterations, pages = ProcessState(Settings()), Iterations(), 5

        async def take_turn() -> int:
            await state.next_turn("a visitor")
            return iterations.count

        assert len({*await asyncio.gather(*(take_turn() for _ in range(pages)))}) == pages

    run_on_new_loop(scenario)


def test_a_message_that_came_during_the_last_turn_of_a_page_is_read_before_its_next_turn() -> None:
    async def scenario() -> None:
        state, (own_end, other_end) = ProcessState(Settings()), socket.socketpair()
        with other_end:
            reader, writer = await asyncio.open_connection(sock=own_end)
            message = asyncio.create_task(reader.read(1))
            await state.next_turn("a visitor")
            other_end.send(b"m")
            await state.next_turn("a visitor")
            assert message.done()
            writer.close()
            await writer.wait_closed()

    run_on_new_loop(scenario)
