"""Reviews of systems, which jobs compute outside the event loop."""

from __future__ import annotations

from functools import cache

from engine import CASES, System
from engine.jobs.job import Job, Queue
from engine.systems.review.potential_review import SystemReview, review_system
from engine.systems.system import TYPED


def is_known(system: System) -> bool:
    """Whether the system is a case of the paper, which the server reviews at its start."""
    return system.case in CASES and not system.parameters


def review_job(system: System) -> Job[SystemReview]:
    """Return the job of `review_system`. For a typed formula, the job has limits of time and memory."""
    return Job(review_system, (system,), queue=Queue.LIMITED if system.case == TYPED else Queue.LONG_CALL)


@cache
def review_catalogue_entry(case: str) -> SystemReview:
    """Return the cached review of an entry of the catalogue."""
    return review_system(System(case))
