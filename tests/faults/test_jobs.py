"""Failing jobs and callbacks do not affect other jobs or the pool."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest

from app.job_clients.error_messages import error_sentence
from engine import CASES, MapSpec, Plane, compute_map
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from engine.maps.map_jobs import map_job
from tests.engine.jobs.inbox import Inbox, wait_until_idle
from tests.waiting import SECONDS

MAP = MapSpec(CASES["I"], Plane.X_PX, 0.3, (48, 48), t_max=100.0)
OTHER = MapSpec(CASES["I"], Plane.X_PX, 0.31, (48, 48), t_max=100.0)


class FaultyPool(ThreadPoolExecutor):
    """A thread pool in which one call fails, after a number of successful calls."""

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


@pytest.mark.parametrize(("error", "good_calls"), [(RuntimeError("kernel"), 0), (MemoryError(), 1)])
def test_failing_kernel_ends_only_its_job(error: Exception, good_calls: int) -> None:
    with FaultyPool(error, good_calls) as pool:
        jobs, first, second, third = Jobs(pool), Inbox(), Inbox(), Inbox()
        jobs.request(map_job(MAP), first.result, first.error)
        assert first.done.wait(SECONDS)
        assert pool.failed
        assert first.errors == [error]
        wait_until_idle(jobs)
        jobs.request(map_job(OTHER), second.result, second.error)
        jobs.request(map_job(MAP), third.result, third.error)
        for inbox in (second, third):
            assert inbox.done.wait(SECONDS)
            assert not inbox.errors
        np.testing.assert_array_equal(third.results[-1].escape_time, compute_map(MAP).escape_time)
        wait_until_idle(jobs)


def test_internal_errors_are_not_shown_on_the_page() -> None:
    text = error_sentence(RuntimeError("/home/somebody/secret.py: line 3"))
    assert "secret" not in text
    assert text.endswith(".")


def test_error_reaches_all_subscribers_although_one_callback_fails(caplog: pytest.LogCaptureFixture) -> None:
    with FaultyPool(RuntimeError("kernel"), 0) as pool:
        jobs, inbox = Jobs(pool), Inbox()

        def fail(_: object) -> None:
            raise LookupError("closed page")

        released = threading.Event()
        pool.submit = _delayed(pool.submit, released)  # type: ignore[method-assign]
        jobs.request(map_job(MAP), fail, fail)
        jobs.request(map_job(MAP), inbox.result, inbox.error)
        released.set()
        assert inbox.done.wait(SECONDS)
        assert [type(error) for error in inbox.errors] == [RuntimeError]
    assert "a callback of a job failed" in caplog.text


@pytest.mark.parametrize("queue", Queue)
def test_failing_function_delivers_its_error(queue: Queue) -> None:
    def fail() -> None:
        raise MemoryError

    jobs, inbox = Jobs(), Inbox()
    jobs.request(Job(fail, (), queue=queue), inbox.result, inbox.error)
    assert inbox.done.wait(SECONDS)
    assert [type(error) for error in inbox.errors] == [MemoryError]
    wait_until_idle(jobs)


def _delayed(submit: Callable[..., Any], released: threading.Event) -> Callable[..., Any]:
    """Return a `submit` method that waits for an event first."""

    def submit_later(*arguments: Any, **named: Any) -> Any:
        released.wait(SECONDS)
        return submit(*arguments, **named)

    return submit_later
