"""Parallel computations on many orbits, in tiles of at most `LANES` orbits on any executor."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from typing import Any

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.kernels.lanes import fill_vectors
from engine.integrator.source.recurrence import LANES
from engine.systems.potential import Potential


def map_tiles(
    work: Callable[..., np.ndarray],
    potential: Potential,
    states: np.ndarray,
    *arguments: Any,
    shape: tuple[int, ...] = (),
    execution: Execution = DEFAULT_EXECUTION,
    tiles_per_task: int = 1,
) -> np.ndarray:
    """Apply a function to many states in parallel, tile by tile.

    Parameters
    ----------
    work
        ``work(potential, tile, *arguments)`` returns a (lanes, *shape) array. `tile` is a (columns, lanes) array, which may be
        changed. The function must belong to a module, so that it can be pickled for other processes.
    potential
        The potential.
    states
        (n, columns) one row per orbit.
    arguments
        Further arguments of `work`.
    shape
        Shape of the result of one orbit; () for a number.
    execution
        How the computation runs. When it is cancelled, no further tiles are submitted.
    tiles_per_task
        Largest number of tiles that a worker computes in one call; more than 1 if a tile takes less than a millisecond.

    Returns
    -------
    (n, *shape) the results; NaN for orbits that were not computed because of a cancellation.
    """
    results = np.full((len(states), *shape), np.nan)
    tiles = run_tiles(work, potential, states, *arguments, execution=execution, tiles_per_task=tiles_per_task)
    for begin, result in tiles:
        results[begin : begin + len(result)] = result
    return results


def run_tiles(
    work: Callable[..., Any],
    potential: Potential,
    states: np.ndarray,
    *arguments: Any,
    execution: Execution = DEFAULT_EXECUTION,
    tiles_per_task: int = 1,
) -> Iterator[tuple[int, Any]]:
    """Run a function on tiles of states in parallel; yield the first row of each tile, and its result without repeated lanes.

    The parameters are those of `map_tiles`, but `work` may return any sequence with one entry per lane.
    """
    workers = execution.workers
    lanes = _lanes_per_tile(len(states), workers)
    # There are two tasks for each worker if there are enough tiles.
    rows_per_task = lanes * min(tiles_per_task, max(len(states) // (2 * workers * lanes), 1))
    running: deque[tuple[int, Future[list[Any]]]] = deque()

    def collect_until(most_running: int) -> Iterator[tuple[int, Any]]:
        while len(running) > most_running:
            begin, future = running.popleft()
            results: list[Any] | None = execution.collect(future)
            # None after a cancellation.
            for number, result in enumerate(results or ()):
                first_row = begin + number * lanes
                yield first_row, result[: len(states) - first_row]

    for begin in range(0, len(states), rows_per_task):
        yield from collect_until(2 * workers - 1)
        if execution.is_cancelled:
            break
        first_rows = range(begin, min(begin + rows_per_task, len(states)), lanes)
        tiles = [_copy_tile(states, first_row, lanes) for first_row in first_rows]
        running.append((begin, execution.submit(_run_on_tiles, work, potential, tiles, *arguments)))
    yield from collect_until(0)


def _run_on_tiles(work: Callable[..., Any], potential: Potential, tiles: list[np.ndarray], *arguments: Any) -> list[Any]:
    """Return the results of several tiles; called in a worker."""
    return [work(potential, tile, *arguments) for tile in tiles]


def _lanes_per_tile(count: int, workers: int) -> int:
    """Return the number of lanes, in whole SIMD vectors and at most `LANES`, with which all workers have equally many tiles."""
    tiles_per_worker = max(1, math.ceil(count / (workers * LANES)))
    share = max(1, math.ceil(count / (tiles_per_worker * workers)))
    return fill_vectors(share)


def _copy_tile(states: np.ndarray, begin: int, lanes: int) -> np.ndarray:
    """Return up to `lanes` states from row `begin`, of shape (columns, lanes).

    The last state is repeated to fill whole SIMD vectors.
    """
    lanes = min(lanes, fill_vectors(len(states) - begin))
    return states[np.minimum(np.arange(begin, begin + lanes), len(states) - 1)].T.copy()
