"""When one client requests and cancels in any order, its limit of jobs holds, and every request is answered."""

from __future__ import annotations

import functools
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import CASES, MapSpec, Plane, integrate_orbit
from engine.jobs.client import JobClient
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from engine.jobs.subscription import Subscription
from engine.sweeps.map_jobs import map_job
from tests.engine.jobs.inbox import Inbox, wait_until_idle
from tests.fuzz.hostile import anything
from tests.waiting import SECONDS

ORBITS = [Job(integrate_orbit, (CASES["I"], (0.01 * k, 0.0, 0.1, 0.5), 20.0), queue=Queue.LONG_CALL) for k in range(4)]
BROKEN = Job(integrate_orbit, (CASES["I"], (float("nan"), 0.0, 0.1, 0.5), 20.0), queue=Queue.LONG_CALL)
MAPS = [map_job(MapSpec(CASES["I"], Plane.X_PX, 0.19 + 0.001 * k, (6, 6), t_max=20.0)) for k in range(3)]
actions = st.sampled_from(["cancel", "close", BROKEN, *ORBITS, *MAPS])


@functools.cache
def jobs() -> Jobs:
    return Jobs(threads=2)


@given(st.integers(1, 4), st.lists(actions, max_size=12))
def test_concurrent_jobs_stay_within_the_limit(most: int, actions: list[Any]) -> None:
    client = JobClient(jobs(), most)
    subscriptions: list[Subscription] = []
    inboxes: list[tuple[Any, Subscription, Inbox]] = []
    for action in actions:
        if action == "cancel":
            for subscription in subscriptions[-1:]:
                subscription.cancel()
        elif action == "close":
            client.close()
            assert not any(subscription.open for subscription in subscriptions)
        else:
            inbox = Inbox()
            before = sum(subscription.open for subscription in subscriptions)
            subscription = client.request(action, inbox.result, inbox.error)
            subscriptions.append(subscription)
            inboxes.append((action, subscription, inbox))
            if before < most:
                assert not any("under way" in str(error) for error in inbox.errors)
        assert sum(subscription.open for subscription in subscriptions) <= most
    for action, subscription, inbox in inboxes:
        # A cancelled request may have been answered before.
        if subscription.open:
            assert inbox.done.wait(SECONDS)
        for error in inbox.errors:
            assert isinstance(error, ValueError)
            assert "under way" in str(error) or action is BROKEN
    client.close()
    wait_until_idle(jobs())


@given(anything)
def test_invalid_limits_are_rejected(most: Any) -> None:
    if isinstance(most, int) and 1 <= most <= 1000:
        return
    with pytest.raises((ValueError, TypeError)):
        JobClient(jobs(), most)
