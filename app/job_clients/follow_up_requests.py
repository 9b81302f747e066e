"""Requests for follow-up analyses of complete maps, while the view state asks for these analyses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from app.job_clients.latest_request import LatestRequest, Locked
from app.state.view_state import ViewState
from engine import EscapeMap
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job


@dataclass(frozen=True, eq=False)
class FollowUp:
    """A follow-up analysis.

    Attributes
    ----------
    find_job
        Returns the job for a complete map; None if the analysis is not wanted.
    show
        Shows a result for the map, partial or final, under the session's lock.
    watched
        Attributes of the view state on which the job depends.
    """

    find_job: Callable[[EscapeMap], Job[Any] | None]
    show: Callable[[EscapeMap, Any], None]
    watched: Sequence[str] = ()


class FollowUpRequests:
    """Requests the follow-up analyses of one session. `fail` shows why an analysis has failed, under the session's lock."""

    def __init__(
        self, state: ViewState, jobs: JobSubmitter, follow_ups: Sequence[FollowUp], fail: Callable[[str], None], locked: Locked
    ) -> None:
        self._complete_map: EscapeMap | None = None
        self._requests = [(each, LatestRequest(jobs, partial(self._show, each), fail, locked)) for each in follow_ups]
        for follow_up, request in self._requests:
            if follow_up.watched:
                state.param.watch(partial(self._update, follow_up, request), list(follow_up.watched))

    def follow(self, complete_map: EscapeMap | None) -> None:
        """Analyse this complete map; None cancels the analyses of the previous map."""
        self._complete_map = complete_map
        for follow_up, request in self._requests:
            request.cancel()
            self._update(follow_up, request)

    def _update(self, follow_up: FollowUp, request: LatestRequest, *_: Any) -> None:
        job = follow_up.find_job(self._complete_map) if self._complete_map is not None else None
        if job is None:
            request.cancel()
        else:
            request.submit(job)

    def _show(self, follow_up: FollowUp, result: Any) -> None:
        # `follow(None)` cancels all requests, so no result arrives without a map.
        assert self._complete_map is not None
        follow_up.show(self._complete_map, result)
