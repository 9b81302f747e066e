from __future__ import annotations

import threading
from concurrent.futures import BrokenExecutor, Future, ThreadPoolExecutor

import numpy as np
import pytest

from engine.execution import collect_result, run_parts


def doubled(values: np.ndarray) -> np.ndarray:
    return 2 * values


@pytest.mark.parametrize("workers", [1, 3])
@pytest.mark.parametrize("count", [0, 1, 999, 5000])
def test_parts_cover_all_indices_in_order(count: int, workers: int) -> None:
    indices = 3 * np.arange(count)
    with ThreadPoolExecutor(workers) as pool:
        parts = list(run_parts(doubled, indices, lambda part: (part,), executor=pool))
    np.testing.assert_array_equal(np.concatenate([indices[:0], *(part for part, _ in parts)]), indices)
    assert all(np.array_equal(result, 2 * part) for part, result in parts)


def test_many_indices_are_shared_among_all_workers() -> None:
    with ThreadPoolExecutor(3) as pool:
        assert len(list(run_parts(doubled, np.arange(100_000), lambda part: (part,), executor=pool))) >= 3


class CancelledWhileWaiting(Future[None]):
    """A call that is cancelled after `result` has been called."""

    def result(self, timeout: float | None = None) -> None:
        self.cancel()
        self.set_running_or_notify_cancel()
        return super().result(timeout)


def test_call_cancelled_while_waited_for_has_no_result() -> None:
    cancel = threading.Event()
    cancel.set()
    assert collect_result(CancelledWhileWaiting(), cancel) is None


def test_call_dropped_while_waited_for_is_an_error() -> None:
    with pytest.raises(BrokenExecutor):
        collect_result(CancelledWhileWaiting(), threading.Event())
