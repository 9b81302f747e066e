"""Requests about the chosen orbit: its separation from another orbit, the nearest start that ends elsewhere, and the nearest
periodic orbit."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import ClassVar

import numpy as np

from app.job_clients.latest_request import LatestRequest, Locked
from app.job_clients.orbit_requests import StartOrbit
from app.state.view_state import ViewState
from engine import Orbit, PeriodicOrbit, Stability, compute_separation, find_divergent_start
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job, Queue
from engine.propagation.fates import describe_fate
from engine.results import DivergentStart, Separation
from plots.links.map_view import Start
from plots.pictures.orbit_curves import initial_state
from plots.studies.family import nearest_orbit_job
from plots.studies.section import start_through
from plots.studies.study import Changes

# Largest difference of equal states, in units of the well. Periodic orbits close to 1e-10.
_EQUAL = 1e-9
_PATH_LEAVES = "Rounding errors grow on this unstable orbit: the path that is drawn leaves it after some periods."

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


class _StartSearch[Found](ABC):
    """Searches from the chosen start of one session. `notify` shows the progress, and why a search has failed.

    A result is dropped if another start is chosen, or if the system, the slice, the section, the energy or t_max has changed.
    """

    _progress: ClassVar[str]

    def __init__(self, state: ViewState, jobs: JobSubmitter, notify: Callable[[str], None], locked: Locked) -> None:
        self._state, self._notify = state, notify
        self._origin: Start | None = None
        self._request = LatestRequest(jobs, self._on_result, notify, locked)
        state.param.watch(lambda *events: self._request.cancel(), ["system", "plane", "section", "energy", "t_max"])

    def search(self) -> None:
        """Search from the chosen start."""
        self._request.cancel()
        self._origin = self._state.chosen_start
        # Orbits may have been removed in the meantime.
        if self._origin is not None:
            self._notify(self._progress)
            self._request.submit(self._job(self._origin))

    def _on_result(self, found: Found) -> None:
        if self._origin is not None and self._state.chosen_start == self._origin:
            self._show(self._origin, found)

    @abstractmethod
    def _job(self, start: Start) -> Job[Found]:
        """Return the job of a search from a start."""

    @abstractmethod
    def _show(self, origin: Start, found: Found) -> None:
        """Show what a search from a start has found."""


class DivergentStartRequests(_StartSearch[DivergentStart | None]):
    """Finds divergent starts, the nearest that escape elsewhere, and adds them to the state."""

    _progress = "Searching for the nearest start that escapes elsewhere …"

    def _job(self, start: Start) -> Job[DivergentStart | None]:
        state = self._state
        return Job(find_divergent_start, (state.potential, state.plane, state.energy, *start, state.t_max))

    def _show(self, origin: Start, found: DivergentStart | None) -> None:
        if found is None:
            self._notify("No start near this one escapes elsewhere.")
            return
        added = self._state.add_start((found.x, found.ordinate))
        hint = "" if added else " Remove an orbit, and search again to see it."
        self._notify(f"The divergent start is {found.distance:.2g} away. {describe_fate(found.fate, found.outcomes)}{hint}")


class PeriodicOrbitRequests(_StartSearch[PeriodicOrbit]):
    """Finds periodic orbits, and adds their starts to the state.

    Parameters
    ----------
    state, jobs, notify, locked
        As for the other searches.
    change
        Changes the view.
    name
        Called with the start of a periodic orbit in the view, and the orbit.
    """

    _progress = "Searching for the nearest periodic orbit …"

    def __init__(
        self,
        state: ViewState,
        jobs: JobSubmitter,
        notify: Callable[[str], None],
        locked: Locked,
        change: Callable[[Changes], None],
        name: Callable[[Start, PeriodicOrbit], None],
    ) -> None:
        super().__init__(state, jobs, notify, locked)
        self._change, self._name = change, name

    def _job(self, start: Start) -> Job[PeriodicOrbit]:
        return nearest_orbit_job(self._state.subject)

    def _show(self, origin: Start, found: PeriodicOrbit) -> None:
        state = self._state
        if _is_at(found, state.start_state(origin)):
            changes: Changes = {"start": origin}
        else:
            energy = float(state.plane.energies(state.energy, *origin))
            changes = start_through(found.section, found.potential, found.start, energy)
        if not changes:
            self._notify(f"{found.describe()} It cannot be added: no slice contains its start.")
            return
        self._change(changes)
        self._notify(_PATH_LEAVES if found.stability is not Stability.STABLE else "")
        self._name(changes["start"], found)


def _is_at(orbit: PeriodicOrbit, state: tuple[float, ...] | None) -> bool:
    """Return whether an orbit starts at a state."""
    return state is not None and bool(np.all(np.abs(orbit.start - state) <= _EQUAL * orbit.potential.units.state))
