"""One of the many who ask: requests that take turns with those of others, and are limited in number."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from engine.jobs.cache import Sized
from engine.jobs.manager import JobRequest, Jobs
from engine.jobs.subscription import Subscription
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.validation import read_count

MOST_REQUESTS = 32
"""Requests of one visitor under way at the same time, unless told otherwise: more than all switches of the page make together."""


MOST_REQUESTS_EVER = 1000
"""Largest limit: beyond it there is none to speak of."""


class Requests(Protocol):
    """Where requests are made: `Jobs` itself, or one visitor's way to it."""

    def request_map(
        self, spec: MapSpec, on_frame: Callable[[EscapeMap], None], on_error: Callable[[Exception], None]
    ) -> Subscription:
        """Ask for a map, as `Jobs.request_map` says."""

    def request[Result: Sized](
        self, spec: JobRequest[Result], on_result: Callable[[Result], None], on_error: Callable[[Exception], None]
    ) -> Subscription:
        """Ask for anything else, as `Jobs.request` says."""


class JobClient:
    """One visitor's way to the jobs of a process.

    Parameters
    ----------
    jobs
        The background work of the process.
    most_requests
        How many may be under way at the same time, 1 to 1000.
    """

    def __init__(self, jobs: Jobs, most_requests: int = MOST_REQUESTS) -> None:
        self._jobs = jobs
        self._most_requests = read_count("most_requests", most_requests, 1, MOST_REQUESTS_EVER)
        self._tickets: list[Subscription] = []

    def request_map(
        self, spec: MapSpec, on_frame: Callable[[EscapeMap], None], on_error: Callable[[Exception], None]
    ) -> Subscription:
        """As `Jobs.request_map`; ValueError to `on_error` when too many requests are under way."""
        return self._admit(on_error) or self._keep(self._jobs.request_map(spec, on_frame, on_error, owner=self))

    def request[Result: Sized](
        self, spec: JobRequest[Result], on_result: Callable[[Result], None], on_error: Callable[[Exception], None]
    ) -> Subscription:
        """As `Jobs.request`; ValueError to `on_error` when too many requests are under way."""
        return self._admit(on_error) or self._keep(self._jobs.request(spec, on_result, on_error, owner=self))

    def close(self) -> None:
        """Nobody waits any more, for anything."""
        for ticket in self._tickets:
            ticket.cancel()
        self._tickets.clear()

    def _keep(self, ticket: Subscription) -> Subscription:
        self._tickets.append(ticket)
        return ticket

    def _admit(self, on_error: Callable[[Exception], None]) -> Subscription | None:
        """None where there is room for one more request; else the ticket of one that has failed."""
        self._tickets = [ticket for ticket in self._tickets if ticket.open]
        if len(self._tickets) < self._most_requests:
            return None
        refused = Subscription(lambda ticket: None, _nobody, on_error)
        refused.fail(
            ValueError(
                f"requests: {self._most_requests} are under way for this page, and that is all it may have; "
                "wait for one to end, or switch something off"
            )
        )
        return refused


def _nobody(_result: Any) -> None:
    """Where a request that was never made would have been answered."""
