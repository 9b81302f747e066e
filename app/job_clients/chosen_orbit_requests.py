"""Requests about the chosen orbit: its separation from the previously chosen orbit, and the nearest start that ends elsewhere."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from app.job_clients.latest_request import LatestRequest, Locked
from app.job_clients.orbit_requests import StartOrbit
from app.state.view import Start
from app.state.view_state import ViewState
from engine import Orbit, compute_separation, find_divergent_start
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job, Queue
from engine.propagation.fates import describe_fate
from engine.results import DivergentStart, Separation
from plots.pictures.orbit_curves import initial_state

Pair = tuple[int, int]
"""Indices of two orbits in the list of starts, in ascending order."""


class SeparationRequests:
    """Requests separations for one session, which `show(pair, separation)` shows. Without a pair of orbits, both are None."""

    def __init__(
        self,
        state: ViewState,
        jobs: JobSubmitter,
        show: Callable[[Pair | None, Separation | None], None],
        notify: Callable[[str], None],
        locked: Locked,
    ) -> None:
        self._state, self._show = state, show
        self._pair: Pair | None = None
        # Index of the previously chosen orbit. The list may be shorter now.
        self._previous_index = 0
        state.param.watch(lambda event: setattr(self, "_previous_index", event.old), "chosen")
        self._request = LatestRequest(jobs, lambda separation: show(self._pair, separation), notify, locked)

    def follow(self, orbits: Sequence[StartOrbit]) -> None:
        """Request the separation of the chosen orbit from the previously chosen orbit, or else from a neighbour in the list."""
        self._pair = self._find_pair(orbits)
        job = None if self._pair is None else self._separation_job(*(orbits[index].orbit for index in self._pair))
        if job is not None:
            self._request.submit(job)
        else:
            self._request.cancel()
            self._show(None, None)

    def _find_pair(self, orbits: Sequence[StartOrbit]) -> Pair | None:
        """Return the pair to compare; None unless both orbits are computed."""
        chosen = self._state.chosen
        candidates = [self._previous_index, chosen - 1, chosen + 1]
        others = [index for index in candidates if index != chosen and 0 <= index < len(orbits)]
        if not others or chosen >= len(orbits):
            return None
        pair = min(chosen, others[0]), max(chosen, others[0])
        return pair if all(orbits[index].orbit is not None for index in pair) else None

    def _separation_job(self, first: Orbit | None, second: Orbit | None) -> Job[Separation] | None:
        """Return the job for two computed orbits; None if one of them ends at once."""
        assert first is not None
        assert second is not None
        t_end = float(min(first.t[-1], second.t[-1]))
        arguments = (self._state.potential, initial_state(first), initial_state(second), t_end)
        return Job(compute_separation, arguments, queue=Queue.LONG_CALL) if t_end > 0.0 else None


class DivergentStartRequests:
    """Finds divergent starts, the nearest that escape elsewhere, and adds them to the state. `notify` shows the progress."""

    def __init__(self, state: ViewState, jobs: JobSubmitter, notify: Callable[[str], None], locked: Locked) -> None:
        self._state, self._notify = state, notify
        self._origin: Start | None = None
        self._request = LatestRequest(jobs, self._on_result, notify, locked)
        # A search is for one system, plane, energy and t_max.
        state.param.watch(lambda *events: self._request.cancel(), ["system", "plane", "section", "energy", "t_max"])

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
