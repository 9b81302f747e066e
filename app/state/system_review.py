"""Reviews of systems, which jobs compute outside the event loop, with all that the page derives from a formula."""

from __future__ import annotations

import pickle
import re
from dataclasses import dataclass, fields
from functools import cache, cached_property

from engine import CASES, System
from engine.jobs.job import Job, Queue
from engine.systems.review.potential_review import SystemReview, review_system
from engine.systems.system import TYPED
from plots.texts.accepted_potentials import page_refusal
from plots.texts.mathml import equations, potential_formula
from plots.texts.mathml_elements import COEFFICIENT_DIGITS

# A number of a formula, without its exponent.
_NUMBER = re.compile(r"[0-9]+\.?[0-9]*|\.[0-9]+")
# Smallest number of significant digits of coefficients of a typed formula.
_FEWEST_DIGITS = 6
# Size of a review in memory, in units of the size of its pickle.
_MEMORY_OF_PICKLE = 5


@dataclass(frozen=True, repr=False)
class PageReview(SystemReview):
    """The review of a system for the page, with texts and structures, so that the page derives nothing from the formula.

    Attributes
    ----------
    problem
        A sentence with the reason why the page cannot show the system; None if it can.
    typeset
        V(x, y) = … as HTML, see `potential_formula`.
    equations
        The equations of the system as HTML, see `equations`; empty if there is a `problem`.
    """

    problem: str | None
    typeset: str
    equations: str

    @cached_property
    def nbytes(self) -> int:
        """Approximate size in memory, in bytes. The objects of an expression take several times as much as their pickle."""
        return _MEMORY_OF_PICKLE * len(pickle.dumps(self))


def is_known(system: System) -> bool:
    """Whether the system is a case of the paper, which the server reviews at its start."""
    return system.case in CASES and not system.parameters


def review_for_page(system: System) -> PageReview:
    """Review a system for the page; ValueError if the formula or a parameter is invalid."""
    review = review_system(system)
    problem = page_refusal(review)
    if problem is None:
        # The page asks whether kernels of this structure are compiled. Its first use finds and caches the structure.
        _ = review.potential.in_well_units.well.structure
    page_review = PageReview(
        **{each.name: getattr(review, each.name) for each in fields(review)},
        problem=problem,
        typeset=potential_formula(review.potential, _shown_digits(system)),
        equations=equations(review.potential) if problem is None else "",
    )
    # The cache of results asks for the size.
    _ = page_review.nbytes
    return page_review


def _shown_digits(system: System) -> int:
    """Return the number of significant digits of coefficients in the typeset formula of a system.

    About another well, or after products, coefficients of a typed formula have more digits than the numbers in it.
    """
    if system.case != TYPED:
        return COEFFICIENT_DIGITS
    text = " ".join((system.formula, *map(repr, system.parameters.values())))
    return max([_FEWEST_DIGITS, *(len(number.replace(".", "").lstrip("0")) for number in _NUMBER.findall(text))])


def review_job(system: System) -> Job[PageReview]:
    """Return the job of `review_for_page`. For a typed formula, the job has limits of time and memory."""
    return Job(review_for_page, (system,), queue=Queue.LIMITED if system.case == TYPED else Queue.LONG_CALL)


@cache
def review_catalogue_entry(case: str) -> PageReview:
    """Return the cached review of an entry of the catalogue."""
    return review_for_page(System(case))
