"""The loop of stages publishes frames, reports progress and can be cancelled. In these tests, the work is counting."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import dataclass, field

import pytest

from engine.foundations.execution import Execution
from engine.maps.stages import OnChange, Stage, frame_pause, run_stages, run_to_frame


@dataclass(frozen=True)
class Count:
    """The progress of the work."""

    done: int
    complete: bool


@dataclass
class Counting:
    """Counts to 6 in three stages."""

    done: int = 0
    finished: list[int] = field(default_factory=list)

    def stages(self, _execution: Execution, on_change: OnChange) -> Iterator[Stage]:
        """Yield stages of two steps each."""
        for number in range(3):

            def stage(number: int = number) -> None:
                for _ in range(2):
                    self.done += 1
                    on_change(False)
                self.finished.append(number)

            yield stage

    def progress(self) -> float:
        """Return the share of the steps."""
        return self.done / 6

    def frame(self) -> Count:
        """Return the steps so far."""
        return Count(self.done, self.done == 6)


def no_pause(_elapsed: float) -> float:
    return 0.0


def test_frames_begin_after_the_first_stage_and_end_with_one_complete_frame() -> None:
    frames: list[Count] = []
    assert run_to_frame(Counting(), Execution(), frames.append, no_pause) == Count(6, complete=True)
    assert [frame.done for frame in frames] == [2, 3, 4, 4, 5, 6]
    assert [frame.complete for frame in frames] == [False] * 5 + [True]


def test_there_is_a_pause_between_frames() -> None:
    frames: list[Count] = []
    run_stages(Counting(), Execution(), frames.append, lambda _elapsed: 60.0)
    assert [frame.done for frame in frames] == [2]


def test_progress_is_reported_whenever_something_changes() -> None:
    shares: list[float] = []
    run_stages(Counting(), Execution(on_progress=shares.append))
    assert [round(6 * share) for share in shares] == [1, 2, 2, 3, 4, 4, 5, 6, 6]


def test_no_stage_begins_after_a_cancellation() -> None:
    cancel, work = threading.Event(), Counting()
    found = run_to_frame(work, Execution(cancel=cancel), lambda _frame: cancel.set(), no_pause)
    assert work.finished == [0]
    assert found == Count(2, complete=False)


def test_pauses_grow_with_the_time_elapsed_between_limits() -> None:
    assert [frame_pause(elapsed) for elapsed in (0.0, 1.0, 2.0, 100.0)] == pytest.approx([0.1, 0.3, 0.6, 1.0])
