"""Delays of the event loop are reported with their cause."""

from __future__ import annotations

import logging
import sys
import threading
from collections.abc import Callable
from typing import Any

import pytest

from app.runtime.loop_watch import SLOW_SECONDS, TICK_SECONDS, WAITING, LoadMonitor, LoopWatch, find_cause
from app.runtime.metrics import ServerMetrics
from app.session.context import History
from tests.app.clock import Clock


def counted(metrics: ServerMetrics) -> dict[str, float]:
    return {
        sample.labels["cause"]: sample.value
        for family in metrics.registry.collect()
        for sample in family.samples
        if sample.name == "escape_explorer_event_loop_delay_seconds_count"
    }


class _Entry:
    """A state whose callback runs in a module of the app."""

    def __init__(self, callback: Callable[[], Any]) -> None:
        self.callback = callback

    def __le__(self, other: object) -> bool:
        self.callback()
        return True

    __ge__ = __le__


def test_a_stack_that_waits_for_an_event_is_reported_as_waiting() -> None:
    thread = threading.Thread(target=(event := threading.Event()).wait)
    thread.start()
    frame = sys._current_frames()[thread.ident or 0]
    assert find_cause(frame) == WAITING
    event.set()
    thread.join()


@pytest.mark.parametrize("late", [SLOW_SECONDS, 3.0])
def test_a_slow_turn_is_logged_and_counted(late: float, caplog: pytest.LogCaptureFixture) -> None:
    clock, metrics = Clock(), ServerMetrics()
    watch = LoopWatch(LoadMonitor(clock.monotonic), metrics.loop_delays)
    watch.tick()
    with caplog.at_level(logging.INFO, "bokeh"):
        clock.now += TICK_SECONDS + late
        watch.tick()
        clock.now += TICK_SECONDS
        watch.tick()
    assert counted(metrics) == {WAITING: 1.0}
    [message] = [record.message for record in caplog.records]
    assert message.startswith(f"event loop {1000 * late:.0f} ms late, ")
    assert message.endswith(f" ms of its own, with 0 ms of garbage collection; cause: {WAITING}")


def test_garbage_collections_on_the_thread_of_the_loop_are_measured(caplog: pytest.LogCaptureFixture) -> None:
    clock, metrics = Clock(), ServerMetrics()
    watch = LoopWatch(LoadMonitor(clock.monotonic), metrics.loop_delays, clock.thread_time)
    elsewhere = threading.Thread(target=watch.on_collection, args=["start", {}])
    watch.tick()
    with caplog.at_level(logging.INFO, "bokeh"):
        watch.on_collection("start", {})
        clock.compute(1)
        elsewhere.start()
        elsewhere.join()
        watch.on_collection("stop", {})
        clock.compute(1)
        watch.tick()
    assert " 2000 ms of its own, with 1000 ms of garbage collection" in caplog.records[0].message


def test_the_thread_names_the_function_that_delays_the_tick() -> None:
    metrics, stopping = ServerMetrics(), threading.Event()
    load = LoadMonitor()
    watch = LoopWatch(load, metrics.loop_delays)
    watcher = threading.Thread(target=watch.sample_stacks, args=[stopping])
    watch.tick()
    watcher.start()

    def delay() -> None:
        while load.overdue_seconds() < 10.0 * SLOW_SECONDS:
            pass

    History().move_to(_Entry(delay))  # type: ignore[arg-type]
    watch.tick()
    stopping.set()
    watcher.join()
    assert "session/context: History.move_to" in counted(metrics)
