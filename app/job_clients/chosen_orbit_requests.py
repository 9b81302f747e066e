"""Requests about the chosen orbit: its separation from another orbit, the nearest start that ends elsewhere, and the nearest
periodic orbit."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from app.job_clients.latest_request import LatestRequest, Locked
from app.job_clients.orbit_requests import StartOrbit
from app.state.view_state import ViewState
from engine import Fate, Orbit, PeriodicOrbit, Stability, compute_separation, find_divergent_start
from engine.foundations.wording import format_number
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job, Queue
from engine.propagation.fates import outcome_of
from engine.results import DivergentStart, Separation
from plots.links.map_view import Start
from plots.pictures.orbit_curves import initial_state
from plots.studies.family import nearest_orbit_job
from plots.studies.section import start_through
from plots.studies.study import Changes

# Largest difference of equal states, in units of the well. Periodic orbits close to 1e-10.
_EQUAL = 1e-9
_SEARCHING = "Searching for the nearest start that ends elsewhere …"
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


class NeighbourRequests:
    """Requests the nearest start that ends elsewhere than the chosen start, for one session.

    Parameters
    ----------
    state, jobs, locked
        The view state, what computes, and a wrapper to run under the session's lock.
    show
        Shows a sentence, which may say why a search has failed, and the neighbour if it is known.
    """

    def __init__(self, state: ViewState, jobs: JobSubmitter, show: Callable[[str, Start | None], None], locked: Locked) -> None:
        self._state, self._show = state, show
        self._request = LatestRequest(
            jobs, self._show_found, lambda sentence: show(sentence, None), locked, begin=lambda job: show(_SEARCHING, None)
        )

    def follow(self, orbits: Sequence[StartOrbit]) -> None:
        """Request the neighbour of the chosen start, once its orbit is known."""
        state = self._state
        orbit = orbits[state.chosen].orbit if state.chosen < len(orbits) else None
        if orbit is None or not (orbit.fate == Fate.BOUNDED or orbit.fate >= 1) or state.chosen_start is None:
            self._request.cancel()
            self._show("", None)
            return
        arguments = (state.potential, state.plane, state.energy, *state.chosen_start, state.t_max)
        self._request.submit(Job(find_divergent_start, arguments, queue=Queue.LONG_CALL))

    def _show_found(self, found: DivergentStart | None) -> None:
        if found is None:
            self._show("No start that ends elsewhere was found near this one.", None)
            return
        ending = outcome_of(found.fate, found.outcomes).present
        self._show(f"A start {format_number(found.distance, 2)} away {ending}.", (found.x, found.ordinate))


class PeriodicOrbitRequests:
    """Finds the periodic orbit nearest to the chosen start of one session, and adds its start to the state.

    A result is dropped if another start is chosen, or if the system, the slice, the section, the energy or t_max has changed.

    Parameters
    ----------
    state, jobs, notify, locked
        As for neighbours; `notify` shows the progress, and why a search has failed.
    change
        Changes the view.
    name
        Called with the start of a periodic orbit in the view, and the orbit.
    """

    def __init__(
        self,
        state: ViewState,
        jobs: JobSubmitter,
        notify: Callable[[str], None],
        locked: Locked,
        change: Callable[[Changes], None],
        name: Callable[[Start, PeriodicOrbit], None],
    ) -> None:
        self._state, self._notify, self._change, self._name = state, notify, change, name
        self._origin: Start | None = None
        self._request = LatestRequest(jobs, self._show, notify, locked)
        state.param.watch(lambda *events: self._request.cancel(), ["system", "plane", "section", "energy", "t_max"])

    def search(self) -> None:
        """Search from the chosen start."""
        self._request.cancel()
        self._origin, subject = self._state.chosen_start, self._state.subject
        # Since the click, the start may have been removed, or the view may have changed to one in which it is no orbit.
        if subject.state is not None:
            self._notify("Searching for the nearest periodic orbit …")
            self._request.submit(nearest_orbit_job(subject))

    def _show(self, found: PeriodicOrbit) -> None:
        state, origin = self._state, self._origin
        if origin is None or state.chosen_start != origin:
            return
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
