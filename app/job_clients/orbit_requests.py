"""Requests for the orbits of the starts in the view state and for their Birkhoff digits."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from app.job_clients.error_messages import error_sentence
from app.job_clients.latest_request import Locked
from app.job_clients.requested_results import RequestedResults
from app.state.view_state import ViewState
from engine import Fate, Orbit, PeriodicOrbit, judge_orbit
from engine.jobs.client import JobSubmitter
from engine.jobs.job import Job, Queue
from engine.propagation.fates import describe_fate
from engine.results import BirkhoffDigits, OrbitVerdict
from plots.links.map_view import Start
from plots.pictures.orbit_curves import OrbitCurves, compute_orbit_curves


@dataclass(frozen=True)
class StartOrbit:
    """A start, and what is known about its orbit.

    Attributes
    ----------
    start
        The start.
    curves
        The orbit with its curves; None until they are computed, and for a start without an orbit.
    problem
        Why the start has no orbit; empty for other starts.
    digits
        Birkhoff digits of a bounded orbit; None until they are computed, and for other orbits.
    periodic
        The periodic orbit that starts there; None if none is known.
    """

    start: Start
    curves: OrbitCurves | None = None
    problem: str = ""
    digits: BirkhoffDigits | None = None
    periodic: PeriodicOrbit | None = None

    @property
    def orbit(self) -> Orbit | None:
        """The orbit; None until it is computed, and for a start without an orbit."""
        return self.curves.orbit if self.curves is not None else None

    @cached_property
    def verdict(self) -> OrbitVerdict | None:
        """The verdict on the orbit, preliminary until the digits are known; None without an orbit."""
        return judge_orbit(self.orbit, self.digits) if self.orbit is not None else None

    def headline(self) -> str:
        """Return the description of a periodic orbit, or the verdict in a few words, the problem, or "Integrating …"."""
        if self.periodic is not None:
            return self.periodic.describe()
        return self.verdict.headline() if self.verdict is not None else self.problem or "Integrating …"

    def summarize(self) -> str:
        """Return what is known in a few words, for lists: "none" for a problem, "…" without an orbit."""
        if self.periodic is not None:
            return f"periodic, {self.periodic.stability}"
        return self.verdict.summarize() if self.verdict is not None else "none" if self.problem else "…"

    def describe(self) -> str:
        """Return the whole verdict, the problem, or "Integrating …"."""
        return self.verdict.describe() if self.verdict is not None else self.problem or "Integrating …"


class OrbitRequests:
    """Requests the orbits of one session, then the Birkhoff digits of bounded orbits, which need a second integration.

    Parameters
    ----------
    state
        View state with the starts.
    jobs
        Computes orbits and digits.
    show
        Shows the orbits after each change, under the session's lock.
    notify
        Shows a sentence that says why digits could not be computed.
    latest
        Wraps a function so that only the latest of its waiting calls runs.
    """

    def __init__(
        self,
        state: ViewState,
        jobs: JobSubmitter,
        show: Callable[[tuple[StartOrbit, ...]], None],
        notify: Callable[[str], None],
        latest: Locked,
    ) -> None:
        self._state, self._show, self._notify = state, show, notify
        self._orbits = RequestedResults(jobs, _curves_or_sentence, lambda arrived: self._update(), latest)
        self._digits = RequestedResults(jobs, _digits_or_sentence, self._take_digits, latest)
        self._periodic: dict[tuple[Any, ...], PeriodicOrbit] = {}
        self._shown_orbits: tuple[StartOrbit, ...] = ()
        state.param.watch(lambda *events: self.follow(), ["starts", "system", "plane", "section", "energy", "t_max"])

    def follow(self) -> None:
        """Request the orbits of new starts, and cancel the requests of removed starts."""
        self._orbits.follow([job for job in map(self._state.orbit_job, self._state.starts) if job is not None])
        self._update()

    def name_periodic(self, start: Start, orbit: PeriodicOrbit) -> None:
        """Show a start in the view as that of a periodic orbit, for as long as its system and its energy stay the same."""
        job = self._state.orbit_job(start)
        assert job is not None
        self._periodic[_potential_and_state(job)] = orbit
        self._update()

    def _take_digits(self, arrived: Mapping[Job[Any], BirkhoffDigits | str]) -> None:
        for result in arrived.values():
            if isinstance(result, str):
                self._notify(result)
        self._update()

    def _update(self) -> None:
        """Request missing digits, and show what is known about the orbits."""
        bounded_jobs = [job for job, result in self._orbits.found.items() if _is_bounded(result)]
        self._digits.follow([_digits_job(job) for job in bounded_jobs])
        # An orbit of which nothing new is known keeps its verdict.
        new_orbits = map(self._orbit_of, self._state.starts)
        orbits = tuple(next((shown for shown in self._shown_orbits if shown == orbit), orbit) for orbit in new_orbits)
        # Showing unchanged orbits again would delay a map that is requested at the same time.
        if orbits != self._shown_orbits:
            self._shown_orbits = orbits
            self._show(orbits)

    def _orbit_of(self, start: Start) -> StartOrbit:
        """Return a start with what is known about its orbit."""
        job = self._state.orbit_job(start)
        if job is None:
            return StartOrbit(start, problem=describe_fate(Fate.FORBIDDEN))
        curves = self._orbits.found.get(job)
        if isinstance(curves, str):
            return StartOrbit(start, problem=curves)
        digits = self._digits.found.get(_digits_job(job))
        periodic = self._periodic.get(_potential_and_state(job))
        return StartOrbit(start, curves, digits=None if isinstance(digits, str) else digits, periodic=periodic)


def _potential_and_state(job: Job[Orbit]) -> tuple[Any, ...]:
    """Return the arguments that the orbit of a job has in common with those for another t_max or section."""
    return job.arguments[:2]


def _is_bounded(result: OrbitCurves | str) -> bool:
    return not isinstance(result, str) and result.orbit.fate == Fate.BOUNDED


def _digits_job(job: Job[Orbit]) -> Job[BirkhoffDigits]:
    # The manager passes the orbit in place of its job.
    return Job(Orbit.compute_birkhoff_digits, (job,), queue=Queue.LONG_CALL)


def _digits_or_sentence(job: Job[Any], result: BirkhoffDigits | Exception) -> BirkhoffDigits | str:
    return error_sentence(result) if isinstance(result, Exception) else result


def _curves_or_sentence(job: Job[Orbit], result: Orbit | Exception) -> OrbitCurves | str:
    if isinstance(result, Exception):
        return error_sentence(result)
    assert result.potential is not None
    if result.fate == Fate.BOUNDED:
        # The verdict needs these digits, which take a tenth of a second for a long orbit. The orbit keeps them.
        _ = result.digits_of_halves
    return compute_orbit_curves(result.potential, result)
