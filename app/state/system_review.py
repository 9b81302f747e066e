"""Reviews of systems by jobs, so that the event loop computes nothing of them."""

from __future__ import annotations

from functools import cache

from engine import CASES, System
from engine.jobs.job import Job, Queue
from engine.systems.review.potential_review import SystemReview, review_system
from engine.systems.system import TYPED


def is_known(system: System) -> bool:
    """Whether this is a case of the paper, whose review is known from the start."""
    return system.case in CASES and not system.parameters


def review_job(system: System) -> Job[SystemReview]:
    """The job of `review_system`; what visitors type has limits on its time and memory."""
    return Job(review_system, (system,), queue=Queue.LIMITED if system.case == TYPED else Queue.LONG_CALL)


@cache
def review_catalogue_entry(case: str) -> SystemReview:
    """The review of a catalogue entry; the server reviews the cases of the paper before it serves pages."""
    return review_system(System(case))
