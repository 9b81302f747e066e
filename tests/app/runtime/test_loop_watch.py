"""Delays of the event loop are reported with their cause."""

from __future__ import annotations

import logging
import sys
import threading
import time
from collections.abc import Callable
from types import FrameType
from typing import Any

import pytest

from app.runtime.load_monitor import TICK_SECONDS, LoadMonitor
from app.runtime.loop_watch import SLOW_SECONDS, WAITING, LoopWatch, find_cause
from app.runtime.metrics import ServerMetrics
from app.state.history import History
from tests.app.clock import Clock


def counted(metrics: ServerMetrics) -> dict[str, float]:
    return {
        sample.labels["cause"]: sample.value
        for family in metrics.registry.collect()
        for sample in family.samples
        if sample.name == "escape_explorer_event_loop_delay_seconds_count"
    }


def frame_inside(call: Callable[[Callable[[], Any]], Any]) -> FrameType:
    """A frame below whatever `call` calls its argument from."""
    frames: list[FrameType] = []
    call(lambda: frames.append(sys._getframe()))
    return frames[0]


class _Entry:
    """A state that calls back from a module of the app."""

    def __init__(self, callback: Callable[[], Any]) -> None:
        self.callback = callback

    def __le__(self, other: object) -> bool:
        self.callback()
        return True

    __ge__ = __le__


def test_the_cause_is_the_outermost_function_of_the_app() -> None:
    frame = frame_inside(lambda callback: History().move_to(_Entry(callback)))  # type: ignore[arg-type]
    assert find_cause(frame) == "state/history: History.move_to"


def test_a_stack_that_waits_has_no_cause() -> None:
    thread = threading.Thread(target=(event := threading.Event()).wait)
    thread.start()
    frame = sys._current_frames()[thread.ident or 0]
    assert find_cause(frame) == WAITING
    event.set()
    thread.join()


@pytest.mark.parametrize("late", [SLOW_SECONDS, 3.0])
def test_a_slow_turn_is_logged_and_counted(
    late: float, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    clock, metrics = Clock(), ServerMetrics()
    monkeypatch.setattr("app.runtime.load_monitor.time", clock)
    watch = LoopWatch(LoadMonitor(), metrics.loop_delays)
    watch.tick()
    with caplog.at_level(logging.INFO, "bokeh"):
        clock.now += TICK_SECONDS + late
        watch.tick()
        clock.now += TICK_SECONDS
        watch.tick()
    assert counted(metrics) == {WAITING: 1.0}
    [message] = [record.message for record in caplog.records]
    assert message.startswith(f"event loop {1000 * late:.0f} ms late, ")
    assert message.endswith(f" ms of its own; cause: {WAITING}")


def test_the_thread_names_the_function_that_delays_the_tick() -> None:
    metrics, stopping = ServerMetrics(), threading.Event()
    load = LoadMonitor()
    watch = LoopWatch(load, metrics.loop_delays)
    watcher = threading.Thread(target=watch.watch, args=[stopping])
    watch.tick()
    watcher.start()
    end = time.monotonic() + 20.0

    def wait_for_samples() -> None:
        # A sample is taken as soon as the tick is overdue.
        while len(watch._samples) < 3 and time.monotonic() < end:
            pass

    History().move_to(_Entry(wait_for_samples))  # type: ignore[arg-type]
    while load.overdue_seconds() < SLOW_SECONDS:
        pass
    watch.tick()
    stopping.set()
    watcher.join()
    assert "state/history: History.move_to" in counted(metrics)
