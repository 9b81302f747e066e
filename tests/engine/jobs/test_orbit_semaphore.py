"""OrbitSemaphore for large jobs: bounded, waited for, and given back."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError, ThreadPoolExecutor

import pytest

from engine.jobs.orbit_semaphore import SMALL, OrbitSemaphore

LARGE = 4 * SMALL


def test_small_jobs_never_wait() -> None:
    room, nobody_cancels = OrbitSemaphore(LARGE), threading.Event()
    with room.hold(LARGE, nobody_cancels), room.hold(SMALL, nobody_cancels):
        assert room.taken == LARGE


def test_a_large_job_waits_until_there_is_room() -> None:
    room, go_on = OrbitSemaphore(LARGE), threading.Event()

    def second() -> bool:
        with room.hold(LARGE, threading.Event()):
            return go_on.is_set()

    with ThreadPoolExecutor(1) as threads:
        with room.hold(LARGE, threading.Event()):
            waiting = threads.submit(second)
            assert not waiting.done()
            go_on.set()
        assert waiting.result(10)
    assert room.taken == 0


def test_one_larger_than_the_room_has_it_to_itself() -> None:
    room = OrbitSemaphore(LARGE)
    with room.hold(3 * LARGE, threading.Event()):
        assert room.taken == 3 * LARGE


def test_who_gives_up_stops_waiting() -> None:
    room, cancel = OrbitSemaphore(LARGE), threading.Event()
    cancel.set()
    with room.hold(LARGE, threading.Event()), pytest.raises(CancelledError), room.hold(LARGE, cancel):
        pass
    assert room.taken == 0
