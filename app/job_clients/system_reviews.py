"""The request for the review of a system."""

from __future__ import annotations

from dataclasses import dataclass

from app.state.system_review import SystemReview, review_system
from engine.service import Answer, JobContext, System


@dataclass(frozen=True)
class SystemReviewRequest:
    """Request for the review of a system: the argument of `review_system`."""

    system: System

    def run(self, context: JobContext) -> Answer[SystemReview]:
        """Review the system. Raises ValueError if its formula or a parameter is invalid."""
        return Answer(context.long_call_executor.submit(review_system, self.system).result(), nbytes=8192)
