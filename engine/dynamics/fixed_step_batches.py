"""Parallel fixed-step computations on many orbits, in tiles of `LANES` orbits on any executor."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any

import numpy as np

from engine.dynamics.batch import LANES
from engine.execution import collect_result, count_workers, default_executor, is_cancelled
from engine.potentials.potential import Potential
from engine.taylor.kernels.propagate import VECTOR


def map_tiles(
    work: Callable[..., np.ndarray],
    potential: Potential,
    states: np.ndarray,
    *arguments: Any,
    shape: tuple[int, ...] = (),
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> np.ndarray:
    """Apply a function to many states in parallel, tile by tile.

    Parameters
    ----------
    work
        ``work(potential, tile, *arguments)`` returns a (lanes, *shape) array. `tile` is a (columns, lanes) array that `work` may
        change. `work` must be a module-level function, so that it can be pickled for other processes.
    potential
        The potential.
    states
        (n, columns) one row per orbit.
    arguments
        Further arguments of `work`.
    shape
        Shape of the result for one orbit.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    cancel
        When set, no further tiles are submitted.

    Returns
    -------
    (n, *shape) the results; NaN for orbits that were not computed because of `cancel`.
    """
    executor = executor or default_executor()
    most_running = 2 * count_workers(executor)
    running: deque[tuple[int, Future[np.ndarray]]] = deque()
    results = np.full((len(states), *shape), np.nan)

    def collect(left_running: int) -> None:
        while len(running) > left_running:
            begin, future = running.popleft()
            result = collect_result(future, cancel)
            if result is not None:
                results[begin : begin + LANES] = result[: len(states) - begin]

    for begin in range(0, len(states), LANES):
        collect(most_running - 1)
        if is_cancelled(cancel):
            break
        running.append((begin, executor.submit(work, potential, _copy_tile(states, begin), *arguments)))
    collect(0)
    return results


def _copy_tile(states: np.ndarray, begin: int) -> np.ndarray:
    """(columns, lanes) up to `LANES` states from row `begin`; the last state is repeated to fill whole SIMD vectors."""
    lanes = min(LANES, -(-(len(states) - begin) // VECTOR) * VECTOR)
    return states[np.minimum(np.arange(begin, begin + lanes), len(states) - 1)].T.copy()
