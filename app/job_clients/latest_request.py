"""One request at a time: a new request replaces the last one, whose results are dropped."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from app.job_clients.error_messages import sentence
from app.job_clients.locking import Locked
from engine.service import JobRequest, JobSubmitter, Subscription


class LatestRequest:
    """Submits requests; calls `show(result)` for each result and `fail(sentence)` for errors, under the session's lock."""

    def __init__(self, jobs: JobSubmitter, show: Callable[[Any], None], fail: Callable[[str], None], locked: Locked) -> None:
        self._jobs, self._show, self._fail = jobs, show, fail
        self._wanted: JobRequest[Any] | None = None
        self._subscription: Subscription | None = None
        self._deliver = locked(self._on_result)

    def submit(self, spec: JobRequest[Any]) -> None:
        """Submit a request, unless it is the current one."""
        if spec == self._wanted:
            return
        self.cancel()
        self._wanted = spec
        self._subscription = self._jobs.request(spec, partial(self._deliver, spec), partial(self._deliver, spec))

    def cancel(self) -> None:
        """Cancel the current request, if any."""
        self._wanted = None
        if self._subscription is not None:
            self._subscription.cancel()
            self._subscription = None

    def _on_result(self, spec: JobRequest[Any], result: Any) -> None:
        if spec != self._wanted:
            return
        if isinstance(result, Exception):
            # Allow the same request again.
            self._wanted = None
            self._fail(sentence(result))
        else:
            self._show(result)
