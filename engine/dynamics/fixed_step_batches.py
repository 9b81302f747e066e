"""Work on many orbits side by side at a fixed step, tile by tile, on any executor."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any

import numpy as np

from engine.dynamics.batch import LANES
from engine.execution import count_workers, default_executor, is_cancelled
from engine.potentials.potential import Potential
from engine.taylor.kernels.propagate import VECTOR


def glide(
    work: Callable[..., np.ndarray],
    potential: Potential,
    states: np.ndarray,
    *arguments: Any,
    shape: tuple[int, ...] = (),
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> np.ndarray:
    """(n, *shape): what `work(potential, tile, *arguments)` makes of each tile of the (n, columns) states.

    A tile is a (columns, lanes) array of its own; lanes is LANES, or in the last one as many whole vectors as it needs, filled
    with copies of its last orbit. `work` is a function of a module, so that processes elsewhere can run it; it returns
    (lanes, *shape) numbers. When `cancel` is set, orbits not reached are NaN.
    """
    executor = executor or default_executor()
    ahead = 2 * count_workers(executor)
    running: deque[tuple[int, Future[np.ndarray]]] = deque()
    results = np.full((len(states), *shape), np.nan)

    def collect(most: int) -> None:
        while len(running) > most:
            begin, future = running.popleft()
            if not future.cancelled():
                results[begin : begin + LANES] = future.result()[: len(states) - begin]

    for begin in range(0, len(states), LANES):
        collect(ahead - 1)
        if is_cancelled(cancel):
            break
        lanes = min(LANES, -(-(len(states) - begin) // VECTOR) * VECTOR)
        tile = states[np.minimum(np.arange(begin, begin + lanes), len(states) - 1)].T.copy()
        running.append((begin, executor.submit(work, potential, tile, *arguments)))
    collect(0)
    return results
