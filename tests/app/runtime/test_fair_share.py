"""A visitor gets a share of the event loop's time, which all pages of the visitor use."""

from __future__ import annotations

import asyncio

import pytest

from app.runtime.fair_share import BURST_SECONDS, SHARE, FairShare, PageTime
from tests.app.clock import Clock
from tests.app.other_loop import run_on_new_loop


def test_a_drag_with_thirty_messages_per_second_never_waits() -> None:
    clock = Clock()
    share = FairShare(clock.monotonic)
    for _ in range(30 * 600):
        share.charge(0.01)
        clock.now += 1.0 / 30.0
        assert share.wait_seconds() == 0.0


def test_a_greedy_visitor_gets_a_share_after_the_burst() -> None:
    clock, taken = Clock(), 0.0
    share, begin = FairShare(clock.monotonic), clock.now
    while clock.now < begin + 100.0:
        clock.now += share.wait_seconds() + 0.02
        share.charge(0.02)
        taken += 0.02
    assert taken == pytest.approx(BURST_SECONDS + SHARE * 100.0, rel=0.01)


def test_the_longest_wait_is_limited() -> None:
    share = FairShare(Clock().monotonic)
    share.charge(1000.0)
    assert share.wait_seconds() == BURST_SECONDS / SHARE


def test_only_the_steps_of_a_coroutine_count() -> None:
    clock = Clock()
    share = FairShare(clock.monotonic)
    page_time = PageTime(share, clock.monotonic, clock.monotonic)

    async def work(begun: asyncio.Event, other: asyncio.Event) -> str:
        clock.now += BURST_SECONDS
        begun.set()
        await other.wait()
        clock.now += 1.0
        return "done"

    async def scenario() -> None:
        begun, other = asyncio.Event(), asyncio.Event()
        task = asyncio.ensure_future(page_time.charge_for(work(begun, other)))
        await begun.wait()
        clock.now += 1.0
        other.set()
        assert await task == "done"
        # The page has used one second in all, and may use its share of two seconds.
        assert share.wait_seconds() == 0.0
        share.charge(2.0 * SHARE - 1.0)
        assert share.wait_seconds() == 0.0
        share.charge(0.1)
        assert share.wait_seconds() == pytest.approx(0.1 / SHARE)

    run_on_new_loop(scenario)


def test_pages_of_a_visitor_use_one_share_and_are_idle_one_by_one() -> None:
    clock = Clock()
    share = FairShare(clock.monotonic)
    busy, idle = (PageTime(share, clock.monotonic) for _ in range(2))
    clock.now += 10.0
    busy.charge(BURST_SECONDS + 1.0)
    assert share.wait_seconds() == 1.0 / SHARE
    assert (busy.idle_seconds(), idle.idle_seconds()) == (0.0, 10.0)


def test_a_counted_coroutine_can_fail_and_be_cancelled() -> None:
    seen = []

    async def fail() -> None:
        raise OSError("no")

    async def wait(begun: asyncio.Event) -> None:
        try:
            begun.set()
            await asyncio.Event().wait()
        except asyncio.CancelledError:
            seen.append("cancelled")
            raise

    async def scenario() -> None:
        with pytest.raises(OSError, match="no"):
            await PageTime(FairShare()).charge_for(fail())
        begun = asyncio.Event()
        task = asyncio.ensure_future(PageTime(FairShare()).charge_for(wait(begun)))
        await begun.wait()
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    run_on_new_loop(scenario)
    assert seen == ["cancelled"]
