"""Jobs: shared while in flight, kept when done, stopped when nobody waits, bounded in memory."""

from __future__ import annotations

import gc
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any
from weakref import ref

import numpy as np
import pytest

from engine import (
    CASES,
    DivergentStartAnswer,
    DivergentStartRequest,
    EscapeMap,
    Jobs,
    MapSpec,
    OrbitRequest,
    Plane,
    PreviewRequest,
    RegularityRequest,
    SeparationRequest,
    UnresolvedMapSpec,
    WarmupRequest,
    compute_map,
    compute_regularity,
    compute_separation,
    find_twin,
    integrate_orbit,
    preview_spec,
)

QUICK = MapSpec(CASES["I"], Plane.X_PX, 0.3, (64, 64), t_max=200.0)
TWIN = DivergentStartRequest(CASES["I"], Plane.X_PX, 0.2, -0.2, 0.1, 500.0)
LONG = MapSpec(CASES["III"], Plane.X_PX, 0.26, (128, 128), t_max=1e6)


class Inbox:
    """Collects what a request delivers."""

    def __init__(self) -> None:
        self.results: list[Any] = []
        self.errors: list[Exception] = []
        self.first, self.done = threading.Event(), threading.Event()

    def result(self, result: Any) -> None:
        self.results.append(result)
        self.first.set()
        if getattr(result, "complete", True):
            self.done.set()

    def error(self, error: Exception) -> None:
        self.errors.append(error)
        self.done.set()


def wait_until_idle(jobs: Jobs, seconds: float = 20.0) -> None:
    end = time.monotonic() + seconds
    while jobs.in_flight and time.monotonic() < end:
        time.sleep(0.01)
    assert jobs.in_flight == 0


def kept_map(jobs: Jobs) -> EscapeMap:
    """The map of `QUICK`, computed and kept."""
    inbox = Inbox()
    jobs.request_map(QUICK, inbox.result, inbox.error)
    assert inbox.done.wait(30)
    wait_until_idle(jobs)
    result = inbox.results[-1]
    assert isinstance(result, EscapeMap)
    return result


def test_the_last_frame_is_the_map() -> None:
    inbox, jobs = Inbox(), Jobs()
    jobs.request_map(QUICK, inbox.result, inbox.error)
    assert inbox.done.wait(30)
    expected = compute_map(QUICK)
    np.testing.assert_array_equal(inbox.results[-1].fate, expected.fate)
    np.testing.assert_array_equal(inbox.results[-1].escape_time, expected.escape_time)


def test_the_bounded_orbits_of_a_kept_map_are_judged_without_computing_it_again() -> None:
    jobs, second = Jobs(), Inbox()
    first = kept_map(jobs)
    jobs.request(RegularityRequest(QUICK), second.result, second.error)
    assert second.done.wait(30)
    expected = compute_regularity(first)
    np.testing.assert_array_equal(second.results[-1].character, expected.character)


def test_a_map_not_kept_is_computed_to_judge_its_orbits() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(RegularityRequest(QUICK), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert inbox.results[-1].complete


def test_a_finished_map_is_kept() -> None:
    jobs, second = Jobs(), Inbox()
    first = kept_map(jobs)
    jobs.request_map(QUICK, second.result, second.error)
    assert second.results == [first]
    assert jobs.in_flight == 0


def test_two_people_share_one_job_and_it_outlives_the_first() -> None:
    jobs, first, second = Jobs(), Inbox(), Inbox()
    one = jobs.request_map(LONG, first.result, first.error)
    two = jobs.request_map(LONG, second.result, second.error)
    assert jobs.in_flight == 1
    assert first.first.wait(30)
    one.cancel()
    assert jobs.in_flight == 1
    count = len(second.results)
    deadline = time.monotonic() + 20
    while len(second.results) <= count and time.monotonic() < deadline:
        time.sleep(0.01)
    assert len(second.results) > count
    two.cancel()
    wait_until_idle(jobs)


def test_a_cancelled_map_goes_on_from_where_it_was() -> None:
    jobs, first, second = Jobs(), Inbox(), Inbox()
    spec = MapSpec(CASES["III"], Plane.X_PX, 0.3, (96, 96), t_max=5e3)
    ticket = jobs.request_map(spec, first.result, first.error)
    assert first.first.wait(30)
    ticket.cancel()
    deadline = time.monotonic() + 20
    while jobs.cache.get(spec) is None and time.monotonic() < deadline:
        time.sleep(0.01)
    assert jobs.cache.get(spec).complete is False
    jobs.request_map(spec, second.result, second.error)
    assert second.done.wait(60)
    np.testing.assert_array_equal(second.results[-1].crossings, compute_map(spec).crossings)


def test_a_longer_t_max_starts_from_the_kept_map(monkeypatch: pytest.MonkeyPatch) -> None:
    jobs, second = Jobs(), Inbox()
    kept_map(jobs)
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


def test_an_orbit_is_the_one_that_integrate_orbit_gives() -> None:
    jobs, inbox = Jobs(), Inbox()
    spec = OrbitRequest(CASES["I"], (0.1, 0.0, 0.05, 0.5), 500.0)
    jobs.request(spec, inbox.result, inbox.error)
    assert inbox.done.wait(30)
    np.testing.assert_array_equal(inbox.results[0].sali, integrate_orbit(spec.potential, spec.state, spec.t_max).sali)


def test_a_twin_is_the_one_that_find_twin_gives() -> None:
    # One thread: the search must not wait for the very worker it runs on.
    with ThreadPoolExecutor(1) as executor:
        jobs, inbox = Jobs(executor), Inbox()
        jobs.request(TWIN, inbox.result, inbox.error)
        assert inbox.done.wait(30)
    expected = find_twin(TWIN.potential, TWIN.plane, TWIN.energy, TWIN.x, TWIN.ordinate, TWIN.t_max)
    assert [answer.twin for answer in inbox.results] == [expected]


def test_that_there_is_no_twin_is_an_answer_and_kept() -> None:
    jobs, first, second = Jobs(), Inbox(), Inbox()
    spec = replace(TWIN, energy=0.1)
    jobs.request(spec, first.result, first.error)
    assert first.done.wait(30)
    wait_until_idle(jobs)
    jobs.request(spec, second.result, second.error)
    assert first.results == second.results == [DivergentStartAnswer(None)]
    assert jobs.in_flight == 0


def test_a_twin_of_a_forbidden_start_is_answered_with_its_error() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(replace(TWIN, ordinate=2.0), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert isinstance(inbox.errors[0], ValueError)


def test_a_cancelled_orbit_never_arrives() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(OrbitRequest(CASES["III"], (0.0, 0.0, 0.1, 0.5), 1e6), inbox.result, inbox.error).cancel()
    wait_until_idle(jobs)
    time.sleep(0.3)
    assert not inbox.results
    assert not inbox.errors


def test_a_bad_request_is_answered_with_its_error() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(OrbitRequest(CASES["I"], (0.1, 0.0, 0.05, float("nan")), 500.0), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert isinstance(inbox.errors[0], ValueError)


def test_a_listener_that_fails_harms_nobody_else() -> None:
    jobs, inbox = Jobs(), Inbox()

    def fail(_result: object) -> None:
        raise RuntimeError("closed")

    jobs.request_map(QUICK, fail, fail)
    jobs.request_map(QUICK, inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert inbox.results[-1].complete


def test_any_executor_serves() -> None:
    with ThreadPoolExecutor(1) as executor:
        jobs, inbox = Jobs(executor), Inbox()
        jobs.request_map(QUICK, inbox.result, inbox.error)
        assert inbox.done.wait(30)
    np.testing.assert_array_equal(inbox.results[-1].fate, compute_map(QUICK).fate)


def test_a_quick_look_comes_once_and_is_kept() -> None:
    jobs, first, second = Jobs(), Inbox(), Inbox()
    wish = UnresolvedMapSpec(CASES["I"], Plane.X_PX, 0.3, (225, 225), None, 1e5)
    jobs.request(PreviewRequest(wish), first.result, first.error)
    assert first.first.wait(30)
    wait_until_idle(jobs)
    jobs.request(PreviewRequest(wish), second.result, second.error)
    assert second.results == first.results
    assert first.results[0].frame.spec == preview_spec(wish.spec())


def test_two_orbits_are_compared() -> None:
    jobs, inbox = Jobs(), Inbox()
    first, second = (0.1, 0.0, 0.05, 0.6), (0.1001, 0.0, 0.05, 0.6)
    jobs.request(SeparationRequest(CASES["I"], first, second, 3.0), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    expected = compute_separation(CASES["I"], first, second, 3.0)
    np.testing.assert_array_equal(inbox.results[0].distance, expected.distance)


def test_stopping_ends_all_jobs_and_nobody_hears_of_it() -> None:
    inbox, jobs = Inbox(), Jobs()
    jobs.request_map(LONG, inbox.result, inbox.error)
    assert inbox.first.wait(30)
    jobs.stop()
    heard = len(inbox.results)
    wait_until_idle(jobs)
    assert (len(inbox.results), inbox.errors) == (heard, [])


def test_what_a_map_needs_is_prepared_and_its_window_found() -> None:
    jobs, inbox = Jobs(), Inbox()
    wish = UnresolvedMapSpec(CASES["I"], Plane.X_Y, 0.3, (40, 40), None, 1e3)
    jobs.request(WarmupRequest(wish), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert inbox.results[-1].map_spec == MapSpec(CASES["I"], Plane.X_Y, 0.3, (40, 40), t_max=1e3)


def test_a_wish_that_cannot_be_had_is_refused_in_the_background() -> None:
    jobs, inbox = Jobs(), Inbox()
    jobs.request(WarmupRequest(UnresolvedMapSpec(CASES["I"], Plane.X_Y, -1.0, (40, 40), None, 1e3)), inbox.result, inbox.error)
    assert inbox.done.wait(30)
    assert isinstance(inbox.errors[0], ValueError)


def test_a_process_that_is_behind_still_gives_first_frames() -> None:
    jobs, inbox = Jobs(threads=2), Inbox()
    jobs.put_off_tiles(True)
    jobs.request_map(replace(LONG, t_max=1e3), inbox.result, inbox.error)
    assert inbox.first.wait(30)
    assert not inbox.done.wait(0.5)
    jobs.put_off_tiles(False)
    assert inbox.done.wait(60)


def test_a_map_that_is_cancelled_while_it_is_held_up_ends_at_once() -> None:
    jobs, inbox = Jobs(threads=2), Inbox()
    jobs.put_off_tiles(True)
    ticket = jobs.request_map(replace(LONG, t_max=1e3), inbox.result, inbox.error)
    assert inbox.first.wait(30)
    ticket.cancel()
    wait_until_idle(jobs)
    assert jobs.figures().calls_waiting == 0


def test_a_job_that_is_over_leaves_nothing_to_search_for() -> None:
    jobs, inbox = Jobs(cache_bytes=0), Inbox()
    gc.collect()
    gc.disable()
    try:
        jobs.request_map(replace(LONG, t_max=1e3), inbox.result, inbox.error)
        assert inbox.done.wait(60)
        wait_until_idle(jobs)
        frames = [ref(frame) for frame in inbox.results]
        inbox.results.clear()
        end = time.monotonic() + 10.0
        while any(frame() is not None for frame in frames) and time.monotonic() < end:
            time.sleep(0.01)
        assert [frame for frame in frames if frame() is not None] == []
    finally:
        gc.enable()
