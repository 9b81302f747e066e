"""One request at a time: a new one takes the place of the last, whose answer nobody hears any more."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from app.job_clients.error_messages import sentence
from app.job_clients.locking import Locked
from engine import JobRequest, Requests, Subscription


class LatestRequest:
    """`show(answer)` is told what comes, more than once where it grows; `fail(sentence)` what went wrong; both under the lock."""

    def __init__(self, jobs: Requests, show: Callable[[Any], None], fail: Callable[[str], None], locked: Locked) -> None:
        self._jobs, self._show, self._fail = jobs, show, fail
        self._wanted: JobRequest[Any] | None = None
        self._ticket: Subscription | None = None
        self._answer = locked(self._answered)

    def ask(self, spec: JobRequest[Any]) -> None:
        """Ask for this, unless it has been asked for already."""
        if spec == self._wanted:
            return
        self.cancel()
        self._wanted = spec
        self._ticket = self._jobs.request(spec, partial(self._answer, spec), partial(self._answer, spec))

    def cancel(self) -> None:
        """Nobody waits for it any more."""
        self._wanted = None
        if self._ticket is not None:
            self._ticket.cancel()
            self._ticket = None

    def _answered(self, spec: JobRequest[Any], answer: Any) -> None:
        if spec != self._wanted:
            return
        if isinstance(answer, Exception):
            # It may be asked for again.
            self._wanted = None
            self._fail(sentence(answer))
        else:
            self._show(answer)
