"""The job of a link's picture, and waiting for the result of a job on the event loop."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Hashable
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

from app.state.link_picture import SIDE, LinkPicture
from app.state.system_review import review_job
from engine import EscapeMap, Execution
from engine.jobs.job import Job, Queue
from engine.jobs.manager import Jobs
from engine.maps.compute import run_map
from engine.potentials.review.potential_review import SystemReview
from engine.warmup import is_ready_for_maps
from plots.palette import PALETTES


class NotCompiledError(Exception):
    """The integrator of the system is not compiled."""


@dataclass(frozen=True)
class PngFile:
    """A picture as the bytes of its file."""

    content: bytes

    @property
    def nbytes(self) -> int:
        """Size in bytes, for the result cache."""
        return len(self.content)


def link_picture_job(picture: LinkPicture) -> Job[PngFile]:
    """The job of a picture. It runs when nothing else does, and fails instead of compiling an integrator.

    It fails with a ValueError if the link is invalid, and with a `NotCompiledError`.
    """
    return Job(_compute_picture, (picture,), queue=Queue.IDLE, orbits=SIDE * SIDE)


def _compute_picture(
    picture: LinkPicture, *, execution: Execution, find_result: Callable[[Job[SystemReview]], SystemReview]
) -> PngFile:
    spec = picture.map_spec(find_result(review_job(picture.system)))
    if not is_ready_for_maps(spec.potential):
        raise NotCompiledError
    frame = run_map(spec, execution)
    execution.raise_if_cancelled()
    file = execution.collect(execution.submit(_draw, picture, frame))
    execution.raise_if_cancelled()
    assert file is not None, "only a cancelled call has no result"
    return file


def _draw(picture: LinkPicture, frame: EscapeMap) -> PngFile:
    # Matplotlib takes longer to import than the rest of the page.
    from plots.link_picture import link_picture_bytes

    return PngFile(link_picture_bytes(frame, picture.title, PALETTES[picture.palette]))


async def result_of[Result](jobs: Jobs, job: Job[Result], client: Hashable) -> Result:
    """The result of a job, for `client` as in `Jobs.request`; the request is cancelled together with the task that waits."""
    loop = asyncio.get_running_loop()
    future: asyncio.Future[Result] = loop.create_future()

    def settle(outcome: Callable[[Any], None], value: Any) -> None:
        # The loop is closed when the server has stopped.
        with suppress(RuntimeError):
            loop.call_soon_threadsafe(lambda: None if future.done() else outcome(value))

    subscription = jobs.request(job, partial(settle, future.set_result), partial(settle, future.set_exception), client=client)
    try:
        return await future
    finally:
        subscription.cancel()
