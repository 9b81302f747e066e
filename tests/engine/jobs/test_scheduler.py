"""The fair scheduler has priorities, serves clients in turn, and leaves a thread free during long calls."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor, wait
from typing import Any

import pytest

from engine.jobs.scheduler import FairScheduler, Priority, QueueExecutor
from tests.waiting import SECONDS


def background() -> Priority:
    return Priority.BACKGROUND


class Recorder:
    """A scheduler whose threads are blocked until `run`, so that the order of the queued calls can be recorded."""

    def __init__(self, threads: int = 1) -> None:
        self.scheduler = FairScheduler(ThreadPoolExecutor(threads))
        self.released = threading.Event()
        self.order: list[str] = []
        blocker = self.executor("blocker")
        for _ in range(threads):
            blocker.submit(self.released.wait, SECONDS)

    def executor(self, *client: str, priority: Callable[[], Priority] = background) -> QueueExecutor:
        return self.scheduler.executor(client, priority)

    def submit(self, executor: QueueExecutor, *names: str) -> list[Future[None]]:
        return [executor.submit(self.order.append, name) for name in names]

    def run(self, *futures: Future[None]) -> list[str]:
        self.released.set()
        assert not wait(futures, SECONDS).not_done
        return self.order


def first_frame() -> Priority:
    return Priority.FIRST_FRAME


def long_call() -> Priority:
    return Priority.LONG_CALL


def test_clients_are_served_round_robin() -> None:
    recorder = Recorder()
    first = recorder.submit(recorder.executor("a"), "a1", "a2", "a3")
    second = recorder.submit(recorder.executor("b"), "b1", "b2")
    assert recorder.run(*first, *second) == ["a1", "b1", "a2", "b2", "a3"]


def test_the_clients_of_a_group_share_its_turns() -> None:
    recorder = Recorder()
    crowd = [recorder.executor("crowd", client) for client in "ab"]
    calls = [*recorder.submit(crowd[0], "a1", "a2"), *recorder.submit(crowd[1], "b1", "b2")]
    calls += recorder.submit(recorder.executor("alone", "c"), "c1", "c2")
    assert recorder.run(*calls) == ["a1", "c1", "b1", "c2", "a2", "b2"]


def test_priority_of_queued_calls_may_change() -> None:
    recorder, shown = Recorder(), threading.Event()
    executor = recorder.executor("b", priority=lambda: Priority.BACKGROUND if shown.is_set() else Priority.FIRST_FRAME)
    calls = [executor.submit(lambda: (recorder.order.append("b1"), shown.set())), *recorder.submit(executor, "b2")]
    calls += recorder.submit(recorder.executor("a", priority=first_frame), "a1", "a2")
    recorder.run(*calls)
    assert recorder.order == ["b1", "a1", "a2", "b2"]


def test_long_calls_leave_one_thread_free() -> None:
    recorder, release = Recorder(threads=2), threading.Event()
    long_calls = [recorder.executor(name, priority=long_call).submit(release.wait, SECONDS) for name in "abc"]
    short = recorder.submit(recorder.executor("d"), "d1")
    assert recorder.run(*short) == ["d1"]
    assert not any(call.done() for call in long_calls)
    release.set()
    assert not wait(long_calls, SECONDS).not_done


def test_a_client_with_one_call_at_a_time_leaves_the_other_threads_to_others() -> None:
    scheduler, release = FairScheduler(ThreadPoolExecutor(2), one_call_per_client=True), threading.Event()
    hostile = [scheduler.executor(("a",), background).submit(release.wait, SECONDS) for _ in range(2)]
    assert scheduler.executor(("b",), background).submit(divmod, 7, 2).result(SECONDS) == (3, 1)
    assert scheduler.pending_calls == 1
    release.set()
    assert not wait(hostile, SECONDS).not_done


def test_a_client_that_has_not_asked_for_a_while_is_served_before_those_in_turn() -> None:
    recorder = Recorder()
    quiet, crowd = recorder.executor("quiet"), [recorder.executor(name) for name in "ab"]
    calls = recorder.submit(quiet, "q1")
    calls += [crowd[0].submit(recorder.submit, quiet, "q2"), *recorder.submit(crowd[1], "b1", "b2", "b3")]
    calls += recorder.submit(crowd[0], "a2", "a3")
    recorder.run(*calls)
    assert recorder.order == ["q1", "b1", "q2", "a2", "b2", "a3", "b3"]


def test_exception_is_stored_in_the_future_and_the_pool_continues() -> None:
    recorder = Recorder()

    def fail() -> None:
        raise RuntimeError("broken")

    failing, later = recorder.executor("a").submit(fail), recorder.submit(recorder.executor("a"), "a1")
    assert recorder.run(*later) == ["a1"]
    with pytest.raises(RuntimeError, match="broken"):
        failing.result(SECONDS)


def test_pending_futures_of_one_executor_can_be_cancelled() -> None:
    recorder = Recorder()
    executor = recorder.executor("a")
    cancelled, others = recorder.submit(executor, "a1", "a2"), recorder.submit(recorder.executor("a"), "a3")
    executor.cancel_futures()
    assert not wait(cancelled, SECONDS).not_done
    assert all(future.cancelled() for future in cancelled)
    assert recorder.run(*others) == ["a3"]


def unsettled() -> Priority:
    return Priority.UNSETTLED


def test_calls_run_in_the_order_of_their_priorities() -> None:
    recorder = Recorder()
    others = recorder.submit(recorder.executor("b", priority=unsettled), "b1")
    background = recorder.submit(recorder.executor("c"), "c1")
    orbits = recorder.submit(recorder.executor("d", priority=long_call), "d1")
    frames = recorder.submit(recorder.executor("e", priority=first_frame), "e1", "e2")
    calls = (*others, *background, *orbits, *frames)
    assert recorder.run(*calls) == ["e1", "e2", "d1", "c1", "b1"]


def test_paused_background_calls_wait_and_others_run() -> None:
    recorder = Recorder(threads=2)
    recorder.scheduler.pause_background(True)
    background = recorder.submit(recorder.executor("a"), "a1", "a2")
    others = [
        *recorder.submit(recorder.executor("b", priority=first_frame), "b1"),
        *recorder.submit(recorder.executor("c", priority=long_call), "c1"),
    ]
    recorder.released.set()
    assert not wait(others, SECONDS).not_done
    assert sorted(recorder.order) == ["b1", "c1"]
    assert recorder.scheduler.pending_calls == len(background)
    recorder.scheduler.pause_background(False)
    assert not wait(background, SECONDS).not_done


def test_one_thread_is_kept_for_first_frames() -> None:
    recorder, ended = Recorder(threads=2), threading.Event()
    recorder.scheduler.prefer_first_frames(True)
    first = recorder.executor("b", priority=long_call).submit(ended.wait, SECONDS)
    others = recorder.submit(recorder.executor("a"), "a1")
    assert recorder.run(*recorder.submit(recorder.executor("c", priority=first_frame), "c1")) == ["c1"]
    recorder.scheduler.prefer_first_frames(False)
    assert not wait(others, SECONDS).not_done
    assert not first.done()
    ended.set()


def test_unsettled_calls_wait_while_first_frames_are_preferred() -> None:
    recorder, settled = Recorder(), threading.Event()
    recorder.scheduler.prefer_first_frames(True)
    executor = recorder.executor("a", priority=lambda: Priority.BACKGROUND if settled.is_set() else Priority.UNSETTLED)
    unsettled = recorder.submit(executor, "a1")
    assert recorder.run(*recorder.submit(recorder.executor("b"), "b1")) == ["b1"]
    assert recorder.scheduler.pending_calls == len(unsettled)
    settled.set()
    recorder.scheduler.prefer_first_frames(True)
    assert recorder.run(*unsettled) == ["b1", "a1"]


def test_a_single_thread_runs_all_calls_in_turn() -> None:
    recorder = Recorder()
    recorder.scheduler.prefer_first_frames(True)
    calls = [*recorder.submit(recorder.executor("a"), "a1"), *recorder.submit(recorder.executor("b", priority=first_frame), "b1")]
    assert recorder.run(*calls) == ["b1", "a1"]


def test_the_pool_has_no_more_tasks_than_threads() -> None:
    class CountingPool(ThreadPoolExecutor):
        submitted = 0

        def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
            self.submitted += 1
            return super().submit(fn, *args, **kwargs)

    pool = CountingPool(2)
    scheduler, released = FairScheduler(pool), threading.Event()
    executor = scheduler.executor(("a",), lambda: Priority.BACKGROUND)
    calls = [executor.submit(released.wait, SECONDS) for _ in range(100)]
    assert pool.submitted == 2
    released.set()
    assert not wait(calls, SECONDS).not_done
