"""Visitors take turns on the event loop."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable
from contextlib import suppress

from app.runtime.visitor_turns import VisitorTurns
from tests.app.other_loop import run_on_new_loop
from tests.waiting import SECONDS


class Visits:
    """Turns that are recorded. They last until `end` is called, and each lasts for at least one iteration of the loop."""

    def __init__(self) -> None:
        self.turns, self.order = VisitorTurns(), list[str]()
        self.released = asyncio.Event()

    async def begin(self, *visits: str) -> list[asyncio.Task[None]]:
        """Begin to wait for turns, in this order. The first letter of a visit is the visitor."""
        tasks = [asyncio.create_task(self._visit(visit)) for visit in visits]
        await asyncio.sleep(0)
        return tasks

    async def _visit(self, visit: str) -> None:
        async with self.turns.turn(visit[0]):
            self.order.append(visit)
            await self.released.wait()
            await asyncio.sleep(0)

    async def end(self, tasks: list[asyncio.Task[None]]) -> list[str]:
        """Let all turns end, and return the visits in the order of their turns."""
        self.released.set()
        async with asyncio.timeout(SECONDS):
            await asyncio.gather(*tasks)
        return self.order


def run(scenario: Callable[[Visits], Awaitable[None]]) -> None:
    async def begin() -> None:
        await scenario(Visits())

    run_on_new_loop(begin)


def test_one_page_has_the_turn_and_the_others_follow_visitor_by_visitor() -> None:
    async def scenario(visits: Visits) -> None:
        tasks = await visits.begin("a1", "a2", "a3", "b1", "b2", "c1")
        assert visits.order == ["a1"]
        assert await visits.end(tasks) == ["a1", "b1", "c1", "a2", "b2", "a3"]

    run(scenario)


def test_a_turn_is_free_again_after_its_end() -> None:
    async def scenario(visits: Visits) -> None:
        assert await visits.end(await visits.begin("a1")) == ["a1"]
        assert await visits.end(await visits.begin("a2")) == ["a1", "a2"]

    run(scenario)


def test_turns_are_wanted_by_others_while_another_visitor_has_the_turn_or_waits() -> None:
    async def scenario(visits: Visits) -> None:
        wanted = [visits.turns.are_wanted_by_others("a")]
        first = await visits.begin("a1", "a2")
        wanted.append(visits.turns.are_wanted_by_others("a"))
        last = await visits.begin("b1")
        wanted += [visits.turns.are_wanted_by_others(visitor) for visitor in "ab"]
        await visits.end([*first, *last])
        wanted.append(visits.turns.are_wanted_by_others("a"))
        assert wanted == [False, False, True, True, False]

    run(scenario)


def test_a_task_that_is_cancelled_while_it_waits_gets_no_turn() -> None:
    async def scenario(visits: Visits) -> None:
        first, cancelled, last = await visits.begin("a1", "b1", "c1")
        cancelled.cancel()
        assert await visits.end([first, last]) == ["a1", "c1"]

    run(scenario)


def test_a_task_that_is_cancelled_as_it_gets_the_turn_passes_it_on() -> None:
    async def scenario(visits: Visits) -> None:
        async with visits.turns.turn("a"):
            cancelled, last = await visits.begin("b1", "c1")
        # The turn is given to the first task now, before the task runs again.
        cancelled.cancel()
        assert await visits.end([last]) == ["c1"]
        with suppress(asyncio.CancelledError):
            await cancelled

    run(scenario)
