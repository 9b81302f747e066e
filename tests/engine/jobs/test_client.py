"""One visitor among many: limited in number of requests, and in turn with the others."""

from __future__ import annotations

import threading
import time
from typing import Any

import pytest

from engine import CASES, JobClient, Jobs, MapSpec, OrbitRequest, Plane

SLOW = [MapSpec(CASES["III"], Plane.X_PX, 0.26, (128, 128), t_max=t_max) for t_max in (1e6, 2e6, 3e6)]
ORBIT = OrbitRequest(CASES["I"], (0.1, 0.0, 0.05, 0.6), 10.0)


class Inbox:
    """What one request brings."""

    def __init__(self) -> None:
        self.errors: list[Exception] = []
        self.first, self.failed = threading.Event(), threading.Event()

    def result(self, _result: Any) -> None:
        self.first.set()

    def error(self, error: Exception) -> None:
        self.errors.append(error)
        self.failed.set()


def wait_until_idle(jobs: Jobs) -> None:
    end = time.monotonic() + 20
    while jobs.in_flight and time.monotonic() < end:
        time.sleep(0.01)
    assert jobs.in_flight == 0


def test_one_request_too_many_is_refused_with_a_sentence() -> None:
    visitor, inbox, refused = JobClient(Jobs(), most_requests=1), Inbox(), Inbox()
    visitor.request_map(SLOW[0], inbox.result, inbox.error)
    ticket = visitor.request_map(SLOW[1], refused.result, refused.error)
    assert not ticket.open
    assert "1 are under way" in str(refused.errors[0])
    visitor.close()


def test_a_request_that_is_over_makes_room_for_another() -> None:
    jobs = Jobs()
    visitor, inboxes = JobClient(jobs, most_requests=1), [Inbox(), Inbox()]
    for inbox in inboxes:
        visitor.request(ORBIT, inbox.result, inbox.error)
        assert inbox.first.wait(20)
        wait_until_idle(jobs)
    assert not inboxes[1].errors


def test_a_visitor_who_leaves_stops_all_that_nobody_else_waits_for() -> None:
    jobs = Jobs()
    visitor, other, inbox = JobClient(jobs), JobClient(jobs), Inbox()
    for spec in SLOW:
        visitor.request_map(spec, inbox.result, inbox.error)
    other.request_map(SLOW[0], inbox.result, inbox.error)
    assert jobs.in_flight == len(SLOW)
    visitor.close()
    assert jobs.in_flight == 1
    other.close()
    wait_until_idle(jobs)


def test_a_limit_below_one_is_refused() -> None:
    with pytest.raises(ValueError, match="most_requests=0"):
        JobClient(Jobs(), most_requests=0)


def test_a_first_look_does_not_wait_for_others_fine_pictures() -> None:
    jobs = Jobs()
    early, late = JobClient(jobs), JobClient(jobs)
    inboxes = [Inbox() for _ in SLOW]
    for spec, inbox in zip(SLOW, inboxes, strict=True):
        early.request_map(spec, inbox.result, inbox.error)
        assert inbox.first.wait(20)
    look = Inbox()
    begun = time.monotonic()
    late.request_map(MapSpec(CASES["III"], Plane.X_PX, 0.5, (64, 64)), look.result, look.error)
    assert look.first.wait(20)
    assert jobs.in_flight >= len(SLOW), f"the others were done before, after {time.monotonic() - begun} s"
    for visitor in (early, late):
        visitor.close()
    wait_until_idle(jobs)


def test_what_jobs_come_to_is_counted() -> None:
    jobs, inbox = Jobs(), Inbox()
    visitor = JobClient(jobs)
    visitor.request(ORBIT, inbox.result, inbox.error)
    visitor.request_map(SLOW[0], inbox.result, inbox.error)
    assert jobs.figures().in_flight >= 1
    visitor.close()
    wait_until_idle(jobs)
    end = time.monotonic() + 20
    while sum((jobs.figures().done, jobs.figures().cancelled)) < 2 and time.monotonic() < end:
        time.sleep(0.01)
    figures = jobs.figures()
    assert (figures.done + figures.cancelled, figures.failed) == (2, 0)
    assert 0 < figures.cache_bytes <= figures.cache_limit
