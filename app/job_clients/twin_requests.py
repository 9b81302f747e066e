"""The search for the twin of an orbit: the nearest start that leaves elsewhere."""

from __future__ import annotations

from collections.abc import Callable

from app.job_clients.latest_request import LatestRequest
from app.job_clients.locking import Locked
from app.state.view_state import ViewState
from engine import DivergentStartAnswer, DivergentStartRequest, Requests, describe_fate


class TwinRequests:
    """One session's search; the twin becomes one of the starts, and `say(sentence)` hears how it goes."""

    def __init__(self, state: ViewState, jobs: Requests, say: Callable[[str], None], locked: Locked) -> None:
        self._state, self._say = state, say
        self._spec: DivergentStartRequest | None = None
        self._request = LatestRequest(jobs, self._answered, say, locked)

    def search(self) -> None:
        """Look around the orbit that is looked at."""
        self._request.cancel()
        state, start = self._state, self._state.chosen_start
        if start is None:
            self._say("Click a start first: its twin is the nearest start that leaves elsewhere.")
            return
        self._say("Searching for the nearest start that leaves elsewhere …")
        self._spec = DivergentStartRequest(state.potential, state.plane, state.energy, *start, state.t_max)
        self._request.ask(self._spec)

    def close(self) -> None:
        """Search no more."""
        self._request.cancel()

    def _answered(self, answer: DivergentStartAnswer) -> None:
        spec, twin = self._spec, answer.twin
        if spec is None or self._state.chosen_start != (spec.x, spec.ordinate):
            return
        if twin is None:
            self._say("No start near this one leaves elsewhere.")
        else:
            self._state.add_start((twin.x, twin.ordinate))
            self._say(f"The twin starts {twin.distance:.2g} away. {describe_fate(twin.fate)}")
