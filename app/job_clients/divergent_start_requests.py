"""Search for the divergent start of an orbit: the nearest start whose orbit escapes elsewhere."""

from __future__ import annotations

from collections.abc import Callable

from app.job_clients.latest_request import LatestRequest, Locked
from app.state.view import Start
from app.state.view_state import ViewState
from engine import find_divergent_start
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job
from engine.propagation.fates import describe_fate
from engine.results import DivergentStart


class DivergentStartRequests:
    """Searches for divergent starts, and adds them to the view state. `notify(sentence)` reports progress."""

    def __init__(self, state: ViewState, jobs: JobSubmitter, notify: Callable[[str], None], locked: Locked) -> None:
        self._state, self._notify = state, notify
        self._origin: Start | None = None
        self._request = LatestRequest(jobs, self._on_result, notify, locked)
        # A search is for one system, plane, energy and t_max.
        state.param.watch(lambda *events: self._request.cancel(), ["system", "plane", "energy", "t_max"])

    def search(self) -> None:
        """Search for the divergent start of the chosen start."""
        self._request.cancel()
        state = self._state
        start = state.chosen_start
        if start is None:
            self._notify("Click a start first. The nearest start that escapes elsewhere is then searched for.")
            return
        self._notify("Searching for the nearest start that escapes elsewhere …")
        self._origin = start
        arguments = (state.potential, state.plane, state.energy, *start, state.t_max)
        self._request.submit(Job(find_divergent_start, arguments))

    def _on_result(self, divergent: DivergentStart | None) -> None:
        if self._origin is None or self._state.chosen_start != self._origin:
            return
        if divergent is None:
            self._notify("No start near this one escapes elsewhere.")
        else:
            added = self._state.add_start((divergent.x, divergent.ordinate))
            hint = "" if added else " Remove an orbit, and search again to see it."
            self._notify(
                f"The divergent start is {divergent.distance:.2g} away. {describe_fate(divergent.fate, divergent.outcomes)}{hint}"
            )
