"""Job manager: sharing, caching, resuming and cancelling jobs, and releasing their memory."""

from __future__ import annotations

import gc
import threading
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from weakref import ref

import numpy as np
import pytest

from engine import (
    CASES,
    EscapeMap,
    MapSpec,
    Plane,
    compute_map,
    compute_regularity,
    compute_separation,
    find_divergent_start,
    integrate_orbit,
)
from engine.jobs.context import JobContext
from engine.service import (
    Answer,
    DivergentStartRequest,
    Jobs,
    OrbitRequest,
    RegularityRequest,
    SeparationRequest,
    UnresolvedMapSpec,
    WarmupRequest,
)
from tests.engine.jobs.inbox import Inbox, wait_until, wait_until_idle

QUICK = MapSpec(CASES["I"], Plane.X_PX, 0.3, (64, 64), t_max=200.0)
REQUEST = DivergentStartRequest(CASES["I"], Plane.X_PX, 0.2, -0.2, 0.1, 500.0)
LONG = MapSpec(CASES["III"], Plane.X_PX, 0.26, (128, 128), t_max=1e6)


def compute_cached_map(jobs: Jobs) -> EscapeMap:
    """Compute the map of `QUICK`, so that it is in the cache."""
    inbox = Inbox()
    jobs.request_map(QUICK, inbox.result, inbox.error)
    assert inbox.done.wait(30)
    wait_until_idle(jobs)
    result = inbox.results[-1]
    assert isinstance(result, EscapeMap)
    return result


def test_last_frame_is_the_map() -> None:
    inbox, jobs = Inbox(), Jobs()
    jobs.request_map(QUICK, inbox.result, inbox.error)
    assert inbox.done.wait(30)
    expected = compute_map(QUICK)
    np.testing.assert_array_equal(inbox.results[-1].fate, expected.fate)
    np.testing.assert_array_equal(inbox.results[-1].escape_time, expected.escape_time)


def test_regularity_uses_the_cached_map() -> None:
    jobs, second = Jobs(), Inbox()
    first = compute_cached_map(jobs)
    jobs.request(RegularityRequest(QUICK), second.result, second.error)
    assert second.done.wait(30)
    expected = compute_regularity(first)
    np.testing.assert_array_equal(second.results[-1].character, expected.character)


def test_regularity_computes_a_map_that_is_not_cached() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(RegularityRequest(QUICK), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert inbox.results[-1].complete


def test_complete_map_is_cached() -> None:
    jobs, second = Jobs(), Inbox()
    first = compute_cached_map(jobs)
    jobs.request_map(QUICK, second.result, second.error)
    assert second.results == [first]
    assert jobs.in_flight == 0


def test_shared_job_continues_until_its_last_subscription_is_cancelled() -> None:
    jobs, first, second = Jobs(), Inbox(), Inbox()
    one = jobs.request_map(LONG, first.result, first.error)
    two = jobs.request_map(LONG, second.result, second.error)
    assert jobs.in_flight == 1
    assert first.first.wait(30)
    one.cancel()
    assert jobs.in_flight == 1
    count = len(second.results)
    wait_until(lambda: len(second.results) > count)
    two.cancel()
    wait_until_idle(jobs)


def test_cancelled_map_is_resumed() -> None:
    jobs, first, second = Jobs(), Inbox(), Inbox()
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.3, (64, 64), t_max=5e3)
    subscription = jobs.request_map(spec, first.result, first.error)
    assert first.first.wait(30)
    subscription.cancel()
    wait_until(lambda: jobs.cache.get(spec) is not None)
    assert jobs.cache.get(spec).complete is False
    jobs.request_map(spec, second.result, second.error)
    assert second.done.wait(60)
    np.testing.assert_array_equal(second.results[-1].crossings, compute_map(spec).crossings)


def test_longer_t_max_resumes_the_cached_map(monkeypatch: pytest.MonkeyPatch) -> None:
    jobs, second = Jobs(), Inbox()
    compute_cached_map(jobs)
    resumed = []

    def spy(spec, *args, resume=None, **kwargs):  # type: ignore[no-untyped-def]
        resumed.append(resume)
        return compute_map(spec, *args, resume=resume, **kwargs)

    monkeypatch.setattr("engine.jobs.manager.compute_map", spy)
    longer = MapSpec(QUICK.potential, QUICK.plane, QUICK.energy, QUICK.resolution, QUICK.window, 2e3)
    jobs.request_map(longer, second.result, second.error)
    assert second.done.wait(60)
    assert resumed[0] is jobs.cache.get(QUICK)
    np.testing.assert_array_equal(second.results[-1].fate, compute_map(longer).fate)


def test_orbit_equals_integrate_orbit() -> None:
    jobs, inbox = Jobs(), Inbox()
    spec = OrbitRequest(CASES["I"], (0.1, 0.0, 0.05, 0.5), 500.0)
    jobs.request(spec, inbox.result, inbox.error)
    assert inbox.done.wait(30)
    np.testing.assert_array_equal(inbox.results[0].sali, integrate_orbit(spec.potential, spec.state, spec.t_max).sali)


def test_divergent_start_equals_find_divergent_start() -> None:
    # With one thread, the search would deadlock if it ran on a worker.
    with ThreadPoolExecutor(1) as executor:
        jobs, inbox = Jobs(executor), Inbox()
        jobs.request(REQUEST, inbox.result, inbox.error)
        assert inbox.done.wait(30)
    expected = find_divergent_start(
        REQUEST.potential,
        REQUEST.plane,
        REQUEST.energy,
        REQUEST.x,
        REQUEST.ordinate,
        REQUEST.t_max,
    )
    assert [answer.value for answer in inbox.results] == [expected]


def test_missing_divergent_start_is_cached() -> None:
    jobs, first, second = Jobs(), Inbox(), Inbox()
    spec = replace(REQUEST, energy=0.1)
    jobs.request(spec, first.result, first.error)
    assert first.done.wait(30)
    wait_until_idle(jobs)
    jobs.request(spec, second.result, second.error)
    assert first.results == second.results == [Answer(None)]
    assert jobs.in_flight == 0


def test_divergent_start_of_a_forbidden_start_fails() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(replace(REQUEST, ordinate=2.0), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert isinstance(inbox.errors[0], ValueError)


def test_cancelled_orbit_is_not_delivered() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(OrbitRequest(CASES["III"], (0.0, 0.0, 0.1, 0.5), 1e6), inbox.result, inbox.error).cancel()
    wait_until(lambda: jobs.stats().cancelled == 1)
    assert not inbox.results
    assert not inbox.errors


def test_invalid_request_delivers_its_error() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(OrbitRequest(CASES["I"], (0.1, 0.0, 0.05, float("nan")), 500.0), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert isinstance(inbox.errors[0], ValueError)


def test_failing_callback_does_not_affect_other_subscriptions() -> None:
    jobs, inbox = Jobs(), Inbox()

    def fail(_result: object) -> None:
        raise RuntimeError("closed")

    jobs.request_map(QUICK, fail, fail)
    jobs.request_map(QUICK, inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert inbox.results[-1].complete


def test_other_executors_can_be_used() -> None:
    with ThreadPoolExecutor(1) as executor:
        jobs, inbox = Jobs(executor), Inbox()
        jobs.request_map(QUICK, inbox.result, inbox.error)
        assert inbox.done.wait(30)
    np.testing.assert_array_equal(inbox.results[-1].fate, compute_map(QUICK).fate)


def test_separation_equals_compute_separation() -> None:
    jobs, inbox = Jobs(), Inbox()
    first, second = (0.1, 0.0, 0.05, 0.6), (0.1001, 0.0, 0.05, 0.6)
    jobs.request(SeparationRequest(CASES["I"], first, second, 3.0), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    expected = compute_separation(CASES["I"], first, second, 3.0)
    np.testing.assert_array_equal(inbox.results[0].distance, expected.distance)


def test_stop_ends_all_jobs_without_callbacks() -> None:
    inbox, jobs = Inbox(), Jobs()
    jobs.request_map(LONG, inbox.result, inbox.error)
    assert inbox.first.wait(30)
    jobs.stop()
    delivered = len(inbox.results)
    wait_until_idle(jobs)
    assert (len(inbox.results), inbox.errors) == (delivered, [])


def test_warmup_resolves_the_spec() -> None:
    jobs, inbox = Jobs(), Inbox()
    unresolved = UnresolvedMapSpec(CASES["I"], Plane.X_Y, 0.3, (40, 40), None, 1e3)
    jobs.request(WarmupRequest(unresolved), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert inbox.results[-1].value == MapSpec(CASES["I"], Plane.X_Y, 0.3, (40, 40), t_max=1e3)


def test_warmup_of_an_invalid_spec_fails() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(WarmupRequest(UnresolvedMapSpec(CASES["I"], Plane.X_Y, -1.0, (40, 40), None, 1e3)), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert isinstance(inbox.errors[0], ValueError)


@dataclass(frozen=True)
class Compilation:
    """A compilation that lasts until `end` is set."""

    end: threading.Event
    begun: threading.Event = field(default_factory=threading.Event)

    def run(self, context: JobContext) -> Answer[None]:
        def compile_kernels() -> None:
            self.begun.set()
            self.end.wait(30)

        context.compilation_executor.submit(compile_kernels).result()
        return Answer(None)


def test_orbits_do_not_wait_for_a_compilation() -> None:
    jobs, inbox, end = Jobs(threads=1), Inbox(), threading.Event()
    compilation = Compilation(end)
    jobs.request(compilation, Inbox().result, Inbox().error)
    assert compilation.begun.wait(30)
    jobs.request(REQUEST, inbox.result, inbox.error)
    assert inbox.done.wait(30)
    end.set()


def test_one_compilation_runs_at_a_time() -> None:
    jobs, end = Jobs(threads=4), threading.Event()
    compilations, inboxes = [Compilation(end), Compilation(end)], [Inbox(), Inbox()]
    for compilation, inbox in zip(compilations, inboxes, strict=True):
        jobs.request(compilation, inbox.result, inbox.error, client=inbox)
    wait_until(lambda: jobs._compilations.pending_calls == 1)
    assert sum(compilation.begun.is_set() for compilation in compilations) <= 1
    end.set()
    assert all(inbox.done.wait(30) for inbox in inboxes)
    assert [inbox.errors for inbox in inboxes] == [[], []]


@pytest.fixture
def paused() -> Iterator[Jobs]:
    """A manager whose background is paused; a job that a failed test leaves would keep the process from ending."""
    jobs = Jobs(threads=2)
    jobs.pause_background(True)
    yield jobs
    jobs.stop()


def test_first_frames_are_computed_while_background_is_paused(paused: Jobs) -> None:
    jobs, inbox = paused, Inbox()
    jobs.request_map(replace(LONG, t_max=1e3), inbox.result, inbox.error)
    assert inbox.first.wait(30)
    assert not inbox.done.wait(0.5)
    jobs.pause_background(False)
    assert inbox.done.wait(60)


def test_cancelled_map_ends_while_background_is_paused(paused: Jobs) -> None:
    jobs, inbox = paused, Inbox()
    subscription = jobs.request_map(replace(LONG, t_max=1e3), inbox.result, inbox.error)
    assert inbox.first.wait(30)
    subscription.cancel()
    wait_until_idle(jobs)
    assert jobs.stats().calls_waiting == 0


def test_finished_job_leaves_no_reference_cycles() -> None:
    jobs, inbox = Jobs(cache_bytes=0), Inbox()
    gc.collect()
    gc.disable()
    try:
        jobs.request_map(replace(LONG, t_max=1e3), inbox.result, inbox.error)
        assert inbox.done.wait(60)
        wait_until_idle(jobs)
        frames = [ref(frame) for frame in inbox.results]
        inbox.results.clear()
        wait_until(lambda: all(frame() is None for frame in frames))
    finally:
        gc.enable()
