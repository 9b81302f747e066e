"""A client of jobs has a limit of requests, cancels its jobs on close, and does not delay other clients."""

from __future__ import annotations

import time

from engine import CASES, MapSpec, Plane, integrate_orbit
from engine.jobs.client import JobClient
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from engine.maps.map_jobs import map_job
from tests.engine.jobs.inbox import Inbox, wait_until_idle
from tests.waiting import SECONDS

SLOW = [MapSpec(CASES["III"], Plane.X_PX, 0.26, (128, 128), t_max=t_max) for t_max in (1e6, 2e6, 3e6)]
ORBIT = Job(integrate_orbit, (CASES["I"], (0.1, 0.0, 0.05, 0.6), 10.0), queue=Queue.LONG_CALL)


def test_request_above_the_limit_is_refused() -> None:
    client, inbox, refused = JobClient(Jobs(), most_requests=1), Inbox(), Inbox()
    client.request(map_job(SLOW[0]), inbox.result, inbox.error)
    subscription = client.request(map_job(SLOW[1]), refused.result, refused.error)
    assert not subscription.open
    assert "1 are under way" in str(refused.errors[0])
    client.close()


def test_close_stops_the_jobs_that_no_other_client_shares() -> None:
    jobs = Jobs()
    client, other, inbox = JobClient(jobs), JobClient(jobs), Inbox()
    for spec in SLOW:
        client.request(map_job(spec), inbox.result, inbox.error)
    other.request(map_job(SLOW[0]), inbox.result, inbox.error)
    assert jobs.in_flight == len(SLOW)
    client.close()
    assert jobs.in_flight == 1
    other.close()
    wait_until_idle(jobs)


def test_first_frame_does_not_wait_for_the_maps_of_other_clients() -> None:
    jobs = Jobs()
    early, late = JobClient(jobs), JobClient(jobs)
    inboxes = [Inbox() for _ in SLOW]
    for spec, inbox in zip(SLOW, inboxes, strict=True):
        early.request(map_job(spec), inbox.result, inbox.error)
        assert inbox.first.wait(SECONDS)
    frame = Inbox()
    begun = time.monotonic()
    late.request(map_job(MapSpec(CASES["III"], Plane.X_PX, 0.5, (64, 64))), frame.result, frame.error)
    assert frame.first.wait(SECONDS)
    assert jobs.in_flight >= len(SLOW), f"the other maps finished first, after {time.monotonic() - begun} s"
    for client in (early, late):
        client.close()
    wait_until_idle(jobs)
