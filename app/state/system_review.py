"""A system with everything that the page derives from its potential, computed by a job."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from engine import CASES, Potential, PotentialReview, Slice, System, review_potential
from engine.jobs.job import Job, Queue
from engine.potentials.energy_ranges import EnergyRange
from engine.potentials.system import TYPED
from plots.accepted_potentials import refusal


@dataclass(frozen=True)
class SystemReview:
    """A system with everything that the page derives from its potential, so that the event loop computes none of it.

    Attributes
    ----------
    system
        The system.
    review
        The review of its potential.
    problem
        Reason why the page cannot show it; None if it can.
    formula_shown
        V(x, y) as text, with the values of the parameters.
    energies
        Energy range of the paper for its cases, else multiples of the escape energy; None if there is a problem.
    """

    system: System
    review: PotentialReview
    problem: str | None
    formula_shown: str
    energies: EnergyRange | None

    @property
    def potential(self) -> Potential:
        """The potential, with its saddles already found."""
        return self.review.potential

    @property
    def shown_energies(self) -> EnergyRange:
        """The energy range of a system that is shown, which has no problem."""
        assert self.energies is not None, "a refused system is not shown"
        return self.energies

    def energy_on(self, plane: Slice, energy: float) -> float | tuple[float, float]:
        """The energy of a map on a plane: `energy`, or the range of an axis h."""
        energies = self.shown_energies
        return energy if plane.energy_axis is None else (max(self.potential.escape_energy, energies.low), energies.high)


def is_known(system: System) -> bool:
    """Whether this is a case of the paper, whose review is known from the start."""
    return system.case in CASES and not system.parameters


def review_system(system: System) -> SystemReview:
    """Review a system: up to seconds, so that the page calls this through `review_job` only.

    Raises
    ------
    ValueError
        If the formula or a parameter is invalid.
    """
    review = review_potential(system.potential)
    problem = refusal(review)
    return SystemReview(system, review, problem, system.formula_shown, None if problem else system.energies)


def review_job(system: System) -> Job[SystemReview]:
    """The job of `review_system`; what visitors type has limits on its time and memory."""
    return Job(review_system, (system,), queue=Queue.LIMITED if system.case == TYPED else Queue.LONG_CALL)


@cache
def review_catalogue_entry(case: str) -> SystemReview:
    """The review of a catalogue entry; the server reviews the cases of the paper before it serves pages."""
    return review_system(System(case))
