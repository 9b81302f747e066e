"""The manager shares, caches, resumes and cancels jobs, and releases their memory."""

from __future__ import annotations

import gc
import threading
from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from types import SimpleNamespace
from typing import Any
from weakref import ref

import numpy as np
import pytest

from engine import (
    CASES,
    EscapeMap,
    MapSpec,
    Plane,
    Potential,
    compute_map,
    compute_regularity,
    find_divergent_start,
)
from engine.foundations.execution import Execution
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from engine.jobs.map_priority import CROWDED_REST_SECONDS
from engine.maps.map_jobs import map_job
from tests.app.clock import Clock
from tests.engine.jobs.inbox import Inbox, wait_until_idle
from tests.waiting import SECONDS, wait_until

QUICK = MapSpec(CASES["I"], Plane.X_PX, 0.3, (64, 64), t_max=200.0)
SEARCH = Job(find_divergent_start, (CASES["I"], Plane.X_PX, 0.2, -0.2, 0.1, 500.0))
LONG = MapSpec(CASES["III"], Plane.X_PX, 0.26, (128, 128), t_max=1e6)


def compute_cached_map(jobs: Jobs) -> EscapeMap:
    """Compute the map of `QUICK`, so that it is in the cache."""
    inbox = Inbox()
    jobs.request(map_job(QUICK), inbox.result, inbox.error)
    assert inbox.done.wait(SECONDS)
    wait_until_idle(jobs)
    result = inbox.results[-1]
    assert isinstance(result, EscapeMap)
    return result


def test_complete_map_is_cached() -> None:
    jobs, second = Jobs(), Inbox()
    first = compute_cached_map(jobs)
    jobs.request(map_job(QUICK), second.result, second.error)
    assert second.results == [first]
    assert jobs.in_flight == 0


def test_shared_job_continues_until_its_last_subscription_is_cancelled() -> None:
    jobs, first, second = Jobs(), Inbox(), Inbox()
    one = jobs.request(map_job(LONG), first.result, first.error)
    two = jobs.request(map_job(LONG), second.result, second.error)
    assert jobs.in_flight == 1
    assert first.first.wait(SECONDS)
    one.cancel()
    assert jobs.in_flight == 1
    count = len(second.results)
    wait_until(lambda: len(second.results) > count)
    two.cancel()
    wait_until_idle(jobs)


def test_cancelled_map_is_resumed() -> None:
    jobs, first, second = Jobs(), Inbox(), Inbox()
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.4, (64, 64), t_max=1e3)
    subscription = jobs.request(map_job(spec), first.result, first.error)
    assert first.first.wait(SECONDS)
    subscription.cancel()
    wait_until(lambda: jobs.cache.get(map_job(spec)) is not None)
    assert jobs.cache.get(map_job(spec)).complete is False
    jobs.request(map_job(spec), second.result, second.error)
    assert second.done.wait(SECONDS)
    np.testing.assert_array_equal(second.results[-1].crossings, compute_map(spec).crossings)


def test_longer_t_max_resumes_the_cached_map() -> None:
    jobs, second = Jobs(), Inbox()
    compute_cached_map(jobs)
    longer = replace(QUICK, t_max=2e3)
    job = map_job(longer)

    jobs.request(job, second.result, second.error)
    assert second.done.wait(SECONDS)
    np.testing.assert_array_equal(second.results[-1].fate, compute_map(longer).fate)


def test_an_interrupted_result_does_not_replace_a_complete_one() -> None:
    jobs, inbox, begun, goes_on = Jobs(), Inbox(), threading.Event(), threading.Event()
    complete = compute_map(QUICK)

    def interrupted(_spec: MapSpec) -> EscapeMap:
        begun.set()
        assert goes_on.wait(SECONDS)
        return replace(complete, complete=False)

    job = Job(interrupted, (QUICK,), queue=Queue.LONG_CALL)
    jobs.request(job, inbox.result, inbox.error)
    assert begun.wait(SECONDS)
    jobs.cache.put(job, complete)
    goes_on.set()
    wait_until_idle(jobs)
    assert jobs.cache.get(job) is complete


def test_failing_callback_does_not_affect_other_subscriptions() -> None:
    jobs, inbox = Jobs(), Inbox()

    def fail(_result: object) -> None:
        raise RuntimeError("closed")

    jobs.request(map_job(QUICK), fail, fail)
    jobs.request(map_job(QUICK), inbox.result, inbox.error)
    assert inbox.done.wait(SECONDS)
    assert inbox.results[-1].complete


def test_stop_ends_all_jobs_without_callbacks() -> None:
    inbox, jobs = Inbox(), Jobs()
    jobs.request(map_job(LONG), inbox.result, inbox.error)
    assert inbox.first.wait(SECONDS)
    jobs.stop()
    delivered = len(inbox.results)
    wait_until_idle(jobs)
    assert (len(inbox.results), inbox.errors) == (delivered, [])


def test_making_a_job_computes_nothing() -> None:
    potential = Potential("new", ((2, 0, 0.5), (0, 2, 0.5), (1, 2, -1.3579)))
    assert Job(compute_regularity, (map_job(MapSpec(potential, Plane.X_PX, 0.1)),)).orbits_held == 224 * 224
    assert set(vars(potential)) == {field.name for field in fields(Potential)}


def test_jobs_of_jobs_are_computed_once() -> None:
    calls = []

    def first() -> int:
        calls.append("first")
        return 2

    def second(number: int, *, power: int) -> int:
        return number**power

    jobs, inbox = Jobs(), Inbox()
    for power in (3, 4):
        jobs.request(Job(second, (Job(first, ()),), (("power", power),)), inbox.result, inbox.error)
        wait_until_idle(jobs)
    assert inbox.results == [8, 16]
    assert calls == ["first"]


def compile_kernels(begun: threading.Event, end: threading.Event) -> None:
    """Stand in for a compilation that lasts until `end` is set."""
    begun.set()
    end.wait(SECONDS)


def test_orbits_do_not_wait_for_a_compilation() -> None:
    jobs, inbox, begun, end = Jobs(threads=1), Inbox(), threading.Event(), threading.Event()
    jobs.request(Job(compile_kernels, (begun, end), queue=Queue.COMPILATION), Inbox().result, Inbox().error)
    assert begun.wait(SECONDS)
    jobs.request(SEARCH, inbox.result, inbox.error)
    assert inbox.done.wait(SECONDS)
    end.set()


def wait_for(begun: threading.Event, end: threading.Event) -> str:
    """Stand in for a call that lasts until `end` is set."""
    begun.set()
    end.wait(SECONDS)
    return "waited"


@pytest.mark.parametrize("queue", [Queue.LIMITED, Queue.COMPILATION])
def test_all_pages_of_an_account_share_a_turn(queue: Queue) -> None:
    jobs, begun, end, order = Jobs(threads=2), threading.Event(), threading.Event(), list[str]()
    jobs.request(Job(wait_for, (begun, end), queue=queue), Inbox().result, Inbox().error)
    assert begun.wait(SECONDS)
    inboxes = list[Inbox]()
    for account, client in (("crowd", 1), ("crowd", 2), ("crowd", 3), ("other", 4)):
        inboxes.append(Inbox())
        job = Job(order.append, (f"{account} {client}",), queue=queue)
        jobs.request(job, inboxes[-1].result, inboxes[-1].error, client=client, account=account)
        wait_until(lambda: jobs.stats().calls_waiting == len(inboxes))
    end.set()
    assert all(inbox.done.wait(SECONDS) for inbox in inboxes)
    assert order == ["crowd 1", "other 4", "crowd 2", "crowd 3"]


@pytest.fixture
def paused() -> Iterator[Jobs]:
    """Yield a manager whose background is paused, and stop it. A job left by a failed test would keep the process from ending."""
    jobs = Jobs(threads=2)
    jobs.pause_background(True)
    yield jobs
    jobs.stop()


def test_first_frames_are_computed_while_background_is_paused(paused: Jobs) -> None:
    jobs, inbox = paused, Inbox()
    jobs.request(map_job(replace(LONG, t_max=1e3)), inbox.result, inbox.error)
    assert inbox.first.wait(SECONDS)
    wait_until(lambda: jobs.stats().calls_waiting > 0)
    assert not inbox.done.is_set()
    jobs.pause_background(False)
    assert inbox.done.wait(SECONDS)


def test_a_limited_call_begins_while_background_is_paused(paused: Jobs) -> None:
    inbox = Inbox()
    paused.request(Job(divmod, (7, 2), queue=Queue.LIMITED), inbox.result, inbox.error)
    assert inbox.done.wait(SECONDS)


def test_cancelled_map_ends_while_background_is_paused(paused: Jobs) -> None:
    jobs, inbox = paused, Inbox()
    subscription = jobs.request(map_job(replace(LONG, t_max=1e3)), inbox.result, inbox.error)
    assert inbox.first.wait(SECONDS)
    subscription.cancel()
    wait_until_idle(jobs)
    assert jobs.stats().calls_waiting == 0


def show_two_frames(clock: Clock, shown: threading.Event, *, execution: Execution, on_frame: Callable[[Any], None]) -> str:
    """Show two frames, as a map does. The second needs 2 s of a processor."""
    on_frame(SimpleNamespace(complete=False, horizon=1.0))
    assert execution.executor is not None
    second = execution.executor.submit(clock.compute, 2)
    shown.set()
    second.result()
    return "map"


def test_all_but_the_first_frame_is_put_off_while_the_process_is_crowded() -> None:
    clock, shown, inbox = Clock(), threading.Event(), Inbox()
    jobs = Jobs(threads=1, clock=clock)
    jobs.prefer_first_frames(True)
    jobs.request(Job(show_two_frames, (clock, shown), queue=Queue.FIRST_FRAME), inbox.result, inbox.error)
    assert shown.wait(SECONDS)
    assert (jobs.stats().calls_waiting, jobs.stats().processor_time) == (1, 0.0)
    clock.now += CROWDED_REST_SECONDS
    jobs.prefer_first_frames(True)
    assert inbox.done.wait(SECONDS)
    wait_until(lambda: jobs.stats().processor_time == 2.0)


def test_spare_calls_wait_for_all_others() -> None:
    order: list[str] = []

    def append(name: str, *, execution: Execution) -> str:
        assert execution.executor is not None
        execution.executor.submit(order.append, name).result()
        return name

    jobs, inbox = Jobs(threads=1), Inbox()
    jobs.pause_background(True)
    for name, queue in (("spare", Queue.SPARE), ("background", Queue.BACKGROUND)):
        jobs.request(Job(append, (name,), queue=queue), inbox.result, inbox.error)
    wait_until(lambda: jobs.stats().calls_waiting == 2)
    jobs.pause_background(False)
    wait_until(lambda: len(order) == 2)
    assert order == ["background", "spare"]


def test_finished_job_leaves_no_reference_cycles() -> None:
    jobs, inbox = Jobs(cache_bytes=0), Inbox()
    gc.collect()
    gc.disable()
    try:
        jobs.request(map_job(replace(LONG, t_max=1e3)), inbox.result, inbox.error)
        assert inbox.done.wait(SECONDS)
        wait_until_idle(jobs)
        frames = [ref(frame) for frame in inbox.results]
        inbox.results.clear()
        wait_until(lambda: all(frame() is None for frame in frames))
    finally:
        gc.enable()
