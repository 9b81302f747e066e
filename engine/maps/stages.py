"""The loop that computes maps and their analyses: stage after stage, with progress, frames and cancellation."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Protocol

from engine.foundations.execution import Execution

SHORTEST_PAUSE, LONGEST_PAUSE = 0.1, 1.0
"""Limits of the pause between two frames, in seconds."""

# Pause between frames as a share of the time elapsed.
_PAUSE_SHARE = 0.3

Stage = Callable[[], None]
"""A part of a computation, which ends early when the execution is cancelled."""

Pause = Callable[[float], float]
"""The pause in seconds after a frame, given the time in seconds since the start of the computation."""

OnChange = Callable[[bool], None]
"""Called whenever pixels may have changed, with whether a stage is over."""


class Frame(Protocol):
    """A map or an analysis so far."""

    @property
    def complete(self) -> bool:
        """Whether every pixel is decided."""


class Staged[F: Frame](Protocol):
    """A computation in stages: coarse to fine, short to long integration times, or part of a map after part."""

    def stages(self, execution: Execution, on_change: OnChange) -> Iterator[Stage]:
        """The parts of the work; each is called before the next one is asked for. They call `on_change` on the way."""

    def progress(self) -> float:
        """Share of the work done, 0 to 1."""

    def frame(self) -> F:
        """The result so far."""


def frame_pause(elapsed: float) -> float:
    """Pause in seconds after a frame, given the time in seconds since the start of the computation."""
    return min(max(SHORTEST_PAUSE, _PAUSE_SHARE * elapsed), LONGEST_PAUSE)


def run_stages[F: Frame](
    work: Staged[F], execution: Execution, on_frame: Callable[[F], None] | None = None, pause: Pause = frame_pause
) -> None:
    """Run all stages until done or cancelled.

    Parameters
    ----------
    work
        The computation.
    execution
        How it runs; its progress is reported whenever pixels may have changed.
    on_frame
        Called in this thread with incomplete frames: first when a stage is over, so that its frame is even, then with pauses.
    pause
        The pauses, which grow by default.
    """
    follow = _Follower(work, execution, on_frame, pause)
    for stage in work.stages(execution, follow):
        if execution.is_cancelled:
            break
        stage()
        follow(True)


def run_to_frame[F: Frame](
    work: Staged[F], execution: Execution, on_frame: Callable[[F], None] | None = None, pause: Pause = frame_pause
) -> F:
    """The last frame after `run_stages`, which is published, too, if it is complete."""
    run_stages(work, execution, on_frame, pause)
    frame = work.frame()
    if on_frame is not None and frame.complete:
        on_frame(frame)
    return frame


class _Follower[F: Frame]:
    """Publishes incomplete frames of a computation, with pauses between them, and reports its progress."""

    def __init__(self, work: Staged[F], execution: Execution, on_frame: Callable[[F], None] | None, pause: Pause) -> None:
        self._work, self._execution, self._on_frame, self._pause = work, execution, on_frame, pause
        self._started = time.monotonic()
        self._next_frame: float | None = None

    def __call__(self, stage_over: bool) -> None:
        now = time.monotonic()
        is_due = stage_over if self._next_frame is None else now >= self._next_frame
        if self._on_frame is not None and is_due:
            frame = self._work.frame()
            if not frame.complete:
                self._on_frame(frame)
                self._next_frame = time.monotonic() + self._pause(now - self._started)
        self._execution.report(self._work.progress)
