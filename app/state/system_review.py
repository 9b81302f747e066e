"""Reviews of systems by jobs, so that the event loop computes nothing for them."""

from __future__ import annotations

from functools import cache

from engine import CASES, System
from engine.jobs.job import Job, Queue
from engine.systems.review.potential_review import SystemReview, review_system
from engine.systems.system import TYPED


def is_known(system: System) -> bool:
    """Whether this is a case of the paper, which is reviewed when the server starts."""
    return system.case in CASES and not system.parameters


def review_job(system: System) -> Job[SystemReview]:
    """Return the job of `review_system`; for formulas that visitors type, time and memory are limited."""
    return Job(review_system, (system,), queue=Queue.LIMITED if system.case == TYPED else Queue.LONG_CALL)


@cache
def review_catalogue_entry(case: str) -> SystemReview:
    """Return the review of a catalogue entry; the server reviews the cases of the paper before it serves pages."""
    return review_system(System(case))
