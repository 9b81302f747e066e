"""Large jobs wait for the release of others by a semaphore of orbits, until they are cancelled."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError, ThreadPoolExecutor

import pytest

from engine.foundations.execution import Execution
from engine.jobs.orbit_semaphore import SMALL_JOB, OrbitSemaphore
from tests.waiting import SECONDS

LARGE = 4 * SMALL_JOB


def test_large_job_waits_for_the_release_of_another() -> None:
    semaphore, released = OrbitSemaphore(LARGE), threading.Event()

    def second() -> bool:
        with semaphore.acquire(LARGE, Execution()):
            return released.is_set()

    with ThreadPoolExecutor(1) as threads:
        with semaphore.acquire(LARGE, Execution()):
            waiting = threads.submit(second)
            assert not waiting.done()
            released.set()
        assert waiting.result(SECONDS)
    assert semaphore.held == 0


def test_job_above_the_limit_runs_alone() -> None:
    semaphore = OrbitSemaphore(LARGE)
    with semaphore.acquire(3 * LARGE, Execution()):
        assert semaphore.held == 3 * LARGE


def test_cancel_ends_the_wait() -> None:
    semaphore, cancel = OrbitSemaphore(LARGE), threading.Event()
    cancel.set()
    with semaphore.acquire(LARGE, Execution()), pytest.raises(CancelledError), semaphore.acquire(LARGE, Execution(cancel=cancel)):
        pass
    assert semaphore.held == 0
