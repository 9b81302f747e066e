"""Parallel calls cover all parts, report progress, and end with an error when calls are cancelled or lost."""

from __future__ import annotations

import threading
from concurrent.futures import BrokenExecutor, Future, ThreadPoolExecutor
from contextlib import redirect_stderr
from io import StringIO

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane, compute_map
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, run_parts, shows_progress


def doubled(values: np.ndarray) -> np.ndarray:
    return 2 * values


@pytest.mark.parametrize("workers", [1, 3])
@pytest.mark.parametrize("count", [0, 999, 5000])
def test_parts_cover_all_indices_in_order(count: int, workers: int) -> None:
    indices = 3 * np.arange(count)
    with ThreadPoolExecutor(workers) as pool:
        parts = list(run_parts(doubled, indices, lambda part: (part,), Execution(pool)))
    np.testing.assert_array_equal(np.concatenate([indices[:0], *(part for part, _ in parts)]), indices)
    assert all(np.array_equal(result, 2 * part) for part, result in parts)


class CancelledWhileWaiting(Future[None]):
    """A call that is cancelled while `result` waits."""

    def result(self, timeout: float | None = None) -> None:
        self.cancel()
        self.set_running_or_notify_cancel()
        return super().result(timeout)


def test_call_cancelled_while_waited_for_has_no_result() -> None:
    cancel = threading.Event()
    cancel.set()
    assert Execution(cancel=cancel).collect(CancelledWhileWaiting()) is None


def test_call_dropped_while_waited_for_is_an_error() -> None:
    with pytest.raises(BrokenExecutor):
        Execution(cancel=threading.Event()).collect(CancelledWhileWaiting())


SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.36, (24, 24), t_max=200.0)


@shows_progress("test")
def long_call(*, on_frame: object = None, execution: Execution = DEFAULT_EXECUTION) -> object:
    return execution.on_progress


class Terminal(StringIO):
    """A stream that claims to be a terminal."""

    def isatty(self) -> bool:
        return True


def test_a_bar_is_shown_in_a_terminal_unless_progress_has_a_listener() -> None:
    with redirect_stderr(Terminal()), ThreadPoolExecutor(1) as thread:
        assert callable(long_call())
        assert long_call(on_frame=print) is None
        assert long_call(execution=Execution(on_progress=print)) is print
        # A call on another thread shows no bar, because it would be written between the bars of this thread.
        assert thread.submit(long_call).result() is None
    assert long_call() is None


@pytest.mark.parametrize(("value", "is_shown"), [("1", False), ("true", False), ("0", True), ("", True)])
def test_the_environment_switches_bars_off_at_any_time(value: str, is_shown: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    with redirect_stderr(Terminal()):
        assert callable(long_call())
        monkeypatch.setenv("TQDM_DISABLE", value)
        assert callable(long_call()) is is_shown


def test_progress_rises_to_one_and_changes_no_result() -> None:
    shares: list[float] = []
    found = compute_map(SPEC, on_progress=shares.append)
    assert shares == sorted(shares)
    assert shares[-1] == 1.0
    assert (found.fate == compute_map(SPEC).fate).all()
