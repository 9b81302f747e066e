"""Second looks: what is asked about a map once it is whole, again for each new one, while the view wants it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from app.job_clients.latest_request import LatestRequest
from app.job_clients.locking import Locked
from app.state.view_state import ViewState
from engine import EscapeMap, JobRequest, Requests


@dataclass(frozen=True, eq=False)
class FollowUp:
    """One question about a whole map.

    Attributes
    ----------
    ask
        The request to make about a map; None where there is nothing to ask.
    show
        Called with the map and the answer, more than once where it grows.
    watched
        Names of what it depends on in the view state; a change asks anew.
    """

    ask: Callable[[EscapeMap], JobRequest[Any] | None]
    show: Callable[[EscapeMap, Any], None]
    watched: Sequence[str] = ()


class FollowUpRequests:
    """One session's second looks; `fail(sentence)` hears what went wrong, under the session's lock like `show`."""

    def __init__(
        self, state: ViewState, jobs: Requests, looks: Sequence[FollowUp], fail: Callable[[str], None], locked: Locked
    ) -> None:
        self._frame: EscapeMap | None = None
        self._requests = [(look, LatestRequest(jobs, partial(self._show, look), fail, locked)) for look in looks]
        for look, request in self._requests:
            if look.watched:
                state.param.watch(partial(self._look, look, request), list(look.watched))

    def follow(self, frame: EscapeMap | None) -> None:
        """Ask about this whole map; None to ask nothing, and to hear no more of the last one."""
        self._frame = frame
        for look, request in self._requests:
            request.cancel()
            self._look(look, request)

    def _look(self, look: FollowUp, request: LatestRequest, *_: Any) -> None:
        spec = look.ask(self._frame) if self._frame is not None else None
        if spec is None:
            request.cancel()
        else:
            request.ask(spec)

    def _show(self, look: FollowUp, answer: Any) -> None:
        # Requests are cancelled with the map that they are about.
        assert self._frame is not None
        look.show(self._frame, answer)
