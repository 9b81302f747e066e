"""Steps that pass an exit on their way and return are flagged: a disc, a circle, or a line in a rotating frame."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest

from engine import CASES
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.source.recurrence import LANES, ROWS, TOLERANCE
from engine.integrator.source.series import ORDER, Setting
from engine.integrator.source.step_flags import NEAR

# Number of batches of orbits, number of points along a step, and distance beyond an exit that returning orbits reach.
BATCHES, TIMES, DEPTH = 40, 401, 1e-4


class Shape(NamedTuple):
    """An exit: the setting of its kernels, the outward coordinate of points, and its row of numbers at an outward coordinate."""

    setting: Setting
    outward: Callable[[np.ndarray, np.ndarray], np.ndarray]
    row: Callable[[float], tuple[float, float, float]]


SHAPES = {
    "line": Shape(Setting(1, rotates=True), lambda x, y: 0.6 * x + 0.8 * y, lambda place: (0.6, 0.8, place)),
    "disc": Shape(Setting(0, (-1,), rotates=True), lambda x, y: -np.hypot(x - 0.1, y - 0.2), lambda place: (0.1, 0.2, -place)),
    "circle": Shape(Setting(0, (1,), rotates=True), np.hypot, lambda place: (0.0, 0.0, place)),
}


def step(kernels: Any, states: np.ndarray, row: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the flags of a step, and x and y along the step, each of shape (TIMES, LANES)."""
    now, new = np.zeros((ROWS, LANES)), np.zeros((ROWS, LANES))
    flag, crossed = np.zeros(LANES, np.int64), np.zeros(LANES, np.int64)
    now[:4] = states
    kernels.step(LANES, TOLERANCE, 100.0, np.array([row]), now, new, flag, crossed)
    jets = np.zeros((2, ORDER + 1, LANES))
    kernels.jets(LANES, *states.copy(), *jets)
    tau = np.linspace(0.0, 1.0, TIMES)[:, None] * new[5]
    x, y = (np.polynomial.polynomial.polyval(tau, jet[:, None], tensor=False) for jet in jets)
    return flag, x, y


@pytest.mark.parametrize("name", SHAPES)
def test_a_step_that_passes_an_exit_and_returns_is_flagged(name: str) -> None:
    setting, outward, row = SHAPES[name]
    kernels = load_kernels(CASES["I"].form.definition, setting, rotation=0.3)
    chance, returns, spared = np.random.default_rng(1), 0, 0
    for _ in range(BATCHES):
        states = chance.uniform(-0.5, 0.5, (4, LANES))
        places = outward(*step(kernels, states, row(-1.0))[1:])
        peaks = places.max(axis=0)
        turning = np.flatnonzero((peaks > places[0] + DEPTH) & (peaks > places[-1] + DEPTH))
        for peak in peaks[turning]:
            flag = step(kernels, states, row(peak - DEPTH))[0]
            returned = turning[np.abs(peaks[turning] - peak) < 0.5 * DEPTH]
            assert (flag[returned] & NEAR).all()
            returns += returned.size
            spared += np.sum(flag & NEAR == 0)
    assert returns > 50
    assert spared > returns
