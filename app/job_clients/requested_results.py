"""Results of several jobs at a time: wanted results are requested, and requests that are no longer wanted are cancelled."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Mapping
from typing import Any

from app.job_clients.latest_request import Locked
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job
from engine.jobs.subscription import Subscription


class RequestedResults:
    """Results by job, in `found`.

    Parameters
    ----------
    jobs
        Computes the results.
    convert
        Called on the thread of a result with its job and the result or error; its return value is stored in `found`.
    on_arrival
        Called with the results that have arrived, under the lock of the session.
    latest
        Wraps a function so that only the latest of its waiting calls runs: results that arrive together are handled once.
    """

    def __init__(
        self,
        jobs: JobSubmitter,
        convert: Callable[[Job[Any], Any], Any],
        on_arrival: Callable[[Mapping[Job[Any], Any]], None],
        latest: Locked,
    ) -> None:
        self._jobs, self._convert, self._on_arrival = jobs, convert, on_arrival
        self.found: dict[Job[Any], Any] = {}
        self._subscriptions: dict[Job[Any], Subscription | None] = {}
        # Results that are not handled yet; threads append to it.
        self._arrived: deque[tuple[Job[Any], Any]] = deque()
        self._take_arrived = latest(self._take)

    def follow(self, wanted: Collection[Job[Any]]) -> None:
        """Request the results of new jobs, and cancel those that are no longer wanted."""
        for job in [job for job in self._subscriptions if job not in wanted]:
            subscription = self._subscriptions.pop(job)
            if subscription is not None:
                subscription.cancel()
        self.found = {job: result for job, result in self.found.items() if job in wanted}
        for job in wanted:
            if job not in self.found and job not in self._subscriptions:
                self._request(job)

    def _request(self, job: Job[Any]) -> None:
        def deliver(result: Any) -> None:
            self._arrived.append((job, self._convert(job, result)))
            self._take_arrived()

        # A cached result is delivered before `request` returns.
        self._subscriptions[job] = None
        subscription = self._jobs.request(job, deliver, deliver)
        if job in self._subscriptions:
            self._subscriptions[job] = subscription

    def _take(self) -> None:
        arrived: dict[Job[Any], Any] = {}
        while self._arrived:
            job, result = self._arrived.popleft()
            if job in self._subscriptions:
                del self._subscriptions[job]
                arrived[job] = result
        self.found |= arrived
        self._on_arrival(arrived)
