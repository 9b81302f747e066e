"""Results of several jobs at once. A job that is no longer wanted is cancelled, and its result is dropped."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Collection, Mapping
from typing import Any

from app.job_clients.latest_request import Locked
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job
from engine.jobs.subscription import Subscription


class RequestedResults:
    """Requests the results of wanted jobs, and keeps them by job in `found`.

    Parameters
    ----------
    jobs
        Computes the results.
    convert
        Returns the value to keep, given a job and its result or error. Runs on the thread that delivers the result.
    on_arrival
        Handles the values that have arrived, under the session's lock.
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
        # Values that are not handled yet. Any thread may append to this queue.
        self._new_values: deque[tuple[Job[Any], Any]] = deque()
        self._handle_later = latest(self._handle)

    def follow(self, wanted: Collection[Job[Any]]) -> None:
        """Request the results of new jobs, and drop jobs that are no longer wanted."""
        unwanted_jobs = [job for job in self._subscriptions if job not in wanted]
        for job in unwanted_jobs:
            subscription = self._subscriptions.pop(job)
            if subscription is not None:
                subscription.cancel()
        self.found = {job: value for job, value in self.found.items() if job in wanted}
        for job in wanted:
            if job not in self.found and job not in self._subscriptions:
                self._request(job)

    def _request(self, job: Job[Any]) -> None:
        def deliver(result: Any) -> None:
            self._new_values.append((job, self._convert(job, result)))
            self._handle_later()

        # Enter the job first, because a cached result is delivered before `request` returns.
        self._subscriptions[job] = None
        subscription = self._jobs.request(job, deliver, deliver)
        if job in self._subscriptions:
            self._subscriptions[job] = subscription

    def _handle(self) -> None:
        """Keep and report the new values of jobs that are still wanted."""
        arrived: dict[Job[Any], Any] = {}
        while self._new_values:
            job, value = self._new_values.popleft()
            if job in self._subscriptions:
                del self._subscriptions[job]
                arrived[job] = value
        self.found |= arrived
        self._on_arrival(arrived)
