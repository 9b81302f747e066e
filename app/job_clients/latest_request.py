"""One request at a time. A new request replaces the previous request, whose results are dropped."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any

from app.job_clients.error_messages import error_sentence
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job
from engine.jobs.subscription import Subscription

Locked = Callable[[Callable[..., None]], Callable[..., None]]
"""Wraps a function so that any thread may call it: the call returns at once, and the function runs under the session's lock."""

SKIPPED = object()
"""What `convert` returns for a result that is not shown."""


class LatestRequest:
    """Requests the results of the latest job.

    Parameters
    ----------
    jobs
        Computes the results.
    show, fail
        Show each result, partial or final, or a sentence that says why there is none. Both run under the session's lock.
    locked
        Wraps a function to run under the session's lock. Of several waiting calls, the latest alone may run.
    convert
        Converts a result to what is shown, or to `SKIPPED`, on the thread of the job. A ValueError counts as an error of the job.
    begin
        Called with each job just before it is requested.
    """

    def __init__(
        self,
        jobs: JobSubmitter,
        show: Callable[[Any], None],
        fail: Callable[[str], None],
        locked: Locked,
        *,
        convert: Callable[[Any], Any] = lambda result: result,
        begin: Callable[[Job[Any]], None] = lambda job: None,
    ) -> None:
        self._jobs, self._show, self._fail, self._convert, self._begin = jobs, show, fail, convert, begin
        self._handle_later = locked(self._handle)
        self._job: Job[Any] | None = None
        # The jobs that are not requested yet.
        self._remaining_jobs: deque[Job[Any]] = deque()
        self._subscriptions: list[Subscription] = []
        # Results of requests with earlier numbers are dropped.
        self._request_number = 0
        # Reentrant, because without a session `_handle_later` calls `_handle` at once, which may cancel the request.
        self._number_lock = threading.RLock()

    def submit(self, *jobs: Job[Any]) -> None:
        """Request the result of the last job, unless it is requested already. Each job needs the results of the previous jobs."""
        if jobs[-1] == self._job:
            return
        self.cancel()
        self._job, self._remaining_jobs = jobs[-1], deque(jobs)
        self._request_next()

    def cancel(self) -> None:
        """Cancel the current request, if any."""
        with self._number_lock:
            self._request_number += 1
        self._job = None
        for subscription in self._subscriptions:
            subscription.cancel()
        self._subscriptions.clear()

    def _request_next(self) -> None:
        job = self._remaining_jobs.popleft()
        receive = partial(self._receive, self._request_number, not self._remaining_jobs)
        self._begin(job)
        self._subscriptions.append(self._jobs.request(job, receive, receive))

    def _receive(self, number: int, is_last: bool, result: Any) -> None:
        """Pass a result or an error of a job to `_handle`. Any thread may call this."""
        if is_last and not isinstance(result, Exception):
            try:
                result = self._convert(result)
            except ValueError as error:
                result = error
        # The lock keeps `number` valid until the call is queued: an outdated call could replace the only waiting call.
        with self._number_lock:
            if number == self._request_number and result is not SKIPPED:
                self._handle_later(number, is_last, result)

    def _handle(self, number: int, is_last: bool, result: Any) -> None:
        """Show a result or an error of the current request, or request the next job."""
        if number != self._request_number:
            return
        if isinstance(result, Exception):
            # The same job may be submitted again.
            self.cancel()
            self._fail(error_sentence(result))
        elif is_last:
            self._show(result)
        else:
            self._request_next()
