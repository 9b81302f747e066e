"""One visitor who asks and takes back as they like: never more under way than they may have, and each request is answered."""

from __future__ import annotations

import functools
import threading
import time
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import CASES, JobClient, Jobs, MapSpec, OrbitRequest, Plane, Subscription
from tests.fuzz.hostile import anything

ORBITS = [OrbitRequest(CASES["I"], (0.01 * k, 0.0, 0.1, 0.5), 20.0) for k in range(4)]
BROKEN = OrbitRequest(CASES["I"], (float("nan"), 0.0, 0.1, 0.5), 20.0)
MAPS = [MapSpec(CASES["I"], Plane.X_PX, 0.19 + 0.001 * k, (6, 6), t_max=20.0) for k in range(3)]
asked = st.sampled_from(["take back", "leave", BROKEN, *ORBITS, *MAPS])


@functools.cache
def jobs() -> Jobs:
    return Jobs(threads=2)


class Inbox:
    """What one request brings."""

    def __init__(self) -> None:
        self.errors: list[Exception] = []
        self.over = threading.Event()

    def result(self, result: Any) -> None:
        if getattr(result, "complete", True):
            self.over.set()

    def error(self, error: Exception) -> None:
        self.errors.append(error)
        self.over.set()


@given(st.integers(1, 4), st.lists(asked, max_size=12))
def test_what_is_under_way_stays_within_the_limit(most: int, actions: list[Any]) -> None:
    visitor = JobClient(jobs(), most)
    tickets: list[Subscription] = []
    inboxes: list[tuple[Any, Subscription, Inbox]] = []
    for action in actions:
        if action == "take back":
            for ticket in tickets[-1:]:
                ticket.cancel()
        elif action == "leave":
            visitor.close()
            assert not any(ticket.open for ticket in tickets)
        else:
            inbox = Inbox()
            ask = visitor.request_map if isinstance(action, MapSpec) else visitor.request
            before = sum(ticket.open for ticket in tickets)
            ticket = ask(action, inbox.result, inbox.error)
            tickets.append(ticket)
            inboxes.append((action, ticket, inbox))
            if before < most:
                assert not any("under way" in str(error) for error in inbox.errors)
        assert sum(ticket.open for ticket in tickets) <= most
    for action, ticket, inbox in inboxes:
        # A request that was taken back may have been answered before.
        if ticket.open:
            assert inbox.over.wait(30)
        for error in inbox.errors:
            assert isinstance(error, ValueError)
            assert "under way" in str(error) or action is BROKEN
    visitor.close()
    end = time.monotonic() + 30
    while jobs().in_flight and time.monotonic() < end:
        time.sleep(0.005)
    assert jobs().in_flight == 0


@given(anything)
def test_a_limit_that_is_none(most: Any) -> None:
    if isinstance(most, int) and 1 <= most <= 1000:
        return
    with pytest.raises((ValueError, TypeError)):
        JobClient(jobs(), most)
