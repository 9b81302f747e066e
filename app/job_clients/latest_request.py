"""One request at a time: a new request replaces the previous request, whose results are dropped."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from app.job_clients.error_messages import sentence
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job
from engine.jobs.subscription import Subscription

Locked = Callable[[Callable[..., None]], Callable[..., None]]
"""Wraps a function so that any thread may call it: the call returns at once, and the function runs under the session's lock."""


class LatestRequest:
    """Passes the results of the latest job to `show(result)`, and an error to `fail(sentence)`, both under the session's lock."""

    def __init__(self, jobs: JobSubmitter, show: Callable[[Any], None], fail: Callable[[str], None], locked: Locked) -> None:
        self._jobs, self._show, self._fail = jobs, show, fail
        self._job: Job[Any] | None = None
        self._subscription: Subscription | None = None
        self._deliver = locked(self._on_result)

    def submit(self, job: Job[Any]) -> None:
        """Request the result of a job, unless the job is requested already."""
        if job == self._job:
            return
        self.cancel()
        self._job = job
        self._subscription = self._jobs.request(job, partial(self._deliver, job), partial(self._deliver, job))

    def cancel(self) -> None:
        """Cancel the current request, if any."""
        self._job = None
        if self._subscription is not None:
            self._subscription.cancel()
            self._subscription = None

    def _on_result(self, job: Job[Any], result: Any) -> None:
        if job != self._job:
            return
        if isinstance(result, Exception):
            # The same job may be submitted again.
            self._job = None
            self._fail(sentence(result))
        else:
            self._show(result)
