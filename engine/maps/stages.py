"""The loop that computes maps and their analyses in stages, with progress, frames and cancellation."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Protocol

from engine.foundations.execution import Execution

SHORTEST_PAUSE = 0.1
"""Shortest pause between two frames, in seconds."""

LONGEST_PAUSE = 1.0
"""Longest pause between two frames, in seconds."""

# Pause between frames as a share of the time since the start of the computation.
_PAUSE_SHARE = 0.3

Stage = Callable[[], None]
"""A function that does a part of a computation, and returns early when the execution is cancelled."""

Pause = Callable[[float], float]
"""A function that returns the pause in seconds after a frame, given the time in seconds since the start of the computation."""

OnChange = Callable[[bool], None]
"""A function to call whenever pixels may have changed. Its argument is True at the end of a stage."""


class Frame(Protocol):
    """The result of a computation so far: a map or an analysis."""

    @property
    def complete(self) -> bool:
        """Whether every pixel is decided."""


class Staged[F: Frame](Protocol):
    """A computation in stages: coarse to fine, short to long integration times, or part by part of a map."""

    def stages(self, execution: Execution, on_change: OnChange) -> Iterator[Stage]:
        """Yield the stages. Each stage is called before the next one is requested. Stages call `on_change` repeatedly."""

    def progress(self) -> float:
        """Return the share of the work done, 0 to 1."""

    def frame(self) -> F:
        """Return the result so far."""


def frame_pause(elapsed: float) -> float:
    """Return the pause after a frame, see `Pause`: a share of the elapsed time, from `SHORTEST_PAUSE` to `LONGEST_PAUSE`."""
    return min(max(SHORTEST_PAUSE, _PAUSE_SHARE * elapsed), LONGEST_PAUSE)


def run_stages[F: Frame](
    work: Staged[F], execution: Execution, on_frame: Callable[[F], None] | None = None, pause: Pause = frame_pause
) -> None:
    """Run all stages until they are finished or cancelled.

    Parameters
    ----------
    work
        The computation.
    execution
        How the computation runs. Progress is reported whenever pixels may have changed.
    on_frame
        Called in this thread with incomplete frames: first at the end of a stage, so that the frame has one resolution, and then
        after pauses.
    pause
        Returns the pause after a frame. By default, pauses grow with the elapsed time.
    """
    on_change = _FrameReporter(work, execution, on_frame, pause)
    for stage in work.stages(execution, on_change):
        if execution.is_cancelled:
            break
        stage()
        on_change(True)


def run_to_frame[F: Frame](
    work: Staged[F], execution: Execution, on_frame: Callable[[F], None] | None = None, pause: Pause = frame_pause
) -> F:
    """Apply `run_stages`, and return the last frame. If this frame is complete, `on_frame` also receives it."""
    run_stages(work, execution, on_frame, pause)
    frame = work.frame()
    if on_frame is not None and frame.complete:
        on_frame(frame)
    return frame


class _FrameReporter[F: Frame]:
    """An `OnChange` that reports progress, and publishes incomplete frames of a computation with pauses between them."""

    def __init__(self, work: Staged[F], execution: Execution, on_frame: Callable[[F], None] | None, pause: Pause) -> None:
        self._work, self._execution, self._on_frame, self._pause = work, execution, on_frame, pause
        self._start_time = time.monotonic()
        # Time of the next frame; None before the first frame.
        self._next_time: float | None = None

    def __call__(self, stage_has_ended: bool) -> None:
        now = time.monotonic()
        is_due = stage_has_ended if self._next_time is None else now >= self._next_time
        if self._on_frame is not None and is_due:
            frame = self._work.frame()
            if not frame.complete:
                self._on_frame(frame)
                self._next_time = time.monotonic() + self._pause(now - self._start_time)
        self._execution.report(self._work.progress)
