"""Faults in the middle of a job, or in those who listen to it: the others and the pool go on."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

from app.job_clients.error_messages import sentence
from engine import CASES, EscapeMap, Jobs, MapSpec, OrbitRequest, Plane, compute_map

MAP = MapSpec(CASES["I"], Plane.X_PX, 0.3, (48, 48), t_max=100.0)
OTHER = MapSpec(CASES["I"], Plane.X_PX, 0.31, (48, 48), t_max=100.0)


class Inbox:
    """Collects what a request delivers."""

    def __init__(self) -> None:
        self.results: list[Any] = []
        self.errors: list[Exception] = []
        self.done = threading.Event()

    def result(self, result: Any) -> None:
        self.results.append(result)
        if getattr(result, "complete", True):
            self.done.set()

    def error(self, error: Exception) -> None:
        self.errors.append(error)
        self.done.set()


class FaultyPool(ThreadPoolExecutor):
    """A pool in which the first few calls end as they should, and then one fails."""

    def __init__(self, error: BaseException, good_calls: int) -> None:
        super().__init__(2)
        self._error, self._left = error, good_calls
        self.failed = False

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> Any:
        self._left -= 1
        if self._left < 0 and not self.failed:
            self.failed = True
            return super().submit(self._fail)
        return super().submit(function, *arguments, **named)

    def _fail(self) -> None:
        raise self._error


def wait_until_idle(jobs: Jobs) -> None:
    end = time.monotonic() + 30.0
    while jobs.in_flight and time.monotonic() < end:
        time.sleep(0.01)
    assert jobs.in_flight == 0


@pytest.mark.parametrize(
    "error", [RuntimeError("kernel"), MemoryError(), OSError(28, "No space left on device"), ZeroDivisionError()]
)
@pytest.mark.parametrize("good_calls", [0, 1])
def test_a_kernel_that_fails_ends_its_job_and_no_other(error: Exception, good_calls: int) -> None:
    with FaultyPool(error, good_calls) as pool:
        jobs, first, second, third = Jobs(pool), Inbox(), Inbox(), Inbox()
        jobs.request_map(MAP, first.result, first.error)
        assert first.done.wait(60)
        assert pool.failed
        assert first.errors == [error]
        wait_until_idle(jobs)
        jobs.request_map(OTHER, second.result, second.error)
        jobs.request_map(MAP, third.result, third.error)
        for inbox in (second, third):
            assert inbox.done.wait(60)
            assert not inbox.errors
        np.testing.assert_array_equal(third.results[-1].escape_time, compute_map(MAP).escape_time)
        wait_until_idle(jobs)


def test_people_are_not_told_what_is_for_the_log() -> None:
    said = sentence(RuntimeError("/home/somebody/secret.py: line 3"))
    assert "secret" not in said
    assert said.endswith(".")


def test_an_error_reaches_all_who_wait_though_one_of_them_fails(caplog: pytest.LogCaptureFixture) -> None:
    with FaultyPool(RuntimeError("kernel"), 0) as pool:
        jobs, inbox = Jobs(pool), Inbox()

        def fall_over(_: object) -> None:
            raise LookupError("a page that is gone")

        gate = threading.Event()
        pool.submit = _held(pool.submit, gate)  # type: ignore[method-assign]
        jobs.request_map(MAP, fall_over, fall_over)
        jobs.request_map(MAP, inbox.result, inbox.error)
        gate.set()
        assert inbox.done.wait(60)
        assert [type(error) for error in inbox.errors] == [RuntimeError]
    assert "a listener failed" in caplog.text


def test_a_listener_that_fails_at_every_frame_hears_the_last_one_all_the_same() -> None:
    heard: list[EscapeMap] = []
    done = threading.Event()

    def fall_over(frame: EscapeMap) -> None:
        heard.append(frame)
        if frame.complete:
            done.set()
        raise LookupError("a page that is gone")

    Jobs().request_map(MAP, fall_over, lambda error: None)
    assert done.wait(60)
    assert heard[-1].complete


def test_an_orbit_that_fails_is_answered_with_its_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*arguments: Any, **named: Any) -> None:
        raise MemoryError

    monkeypatch.setattr("engine.jobs.requests.integrate_orbit", fail)
    jobs, inbox = Jobs(), Inbox()
    jobs.request(OrbitRequest(CASES["I"], (0.1, 0.0, 0.0, 0.5), 50.0), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert [type(error) for error in inbox.errors] == [MemoryError]
    wait_until_idle(jobs)


def _held(submit: Callable[..., Any], gate: threading.Event) -> Callable[..., Any]:
    """A pool's `submit` that waits until everybody has come."""

    def submit_later(*arguments: Any, **named: Any) -> Any:
        gate.wait(30)
        return submit(*arguments, **named)

    return submit_later
