"""Kernels that call the generated functions, for machines that cannot call these otherwise."""

from __future__ import annotations

import numpy as np

from engine.integrator.jit.decorator import kernel
from engine.integrator.jit.function_pointers import call_jets
from engine.integrator.kernels.events import series_value
from engine.integrator.source.series import ORDER


@kernel
def compute_series(jets, coefficients, start, series):
    """Set `series` (2, ORDER + 1, n) to the series of x and y of the steps that begin at `start` (4, n); n is even."""
    call_jets(jets, coefficients, start.shape[1], start[0], start[1], start[2], start[3], series[0], series[1])


@kernel
def sample_steps(jets, coefficients, steps, count, end, path):
    """Set `path` (2, count · m) to x and y at m equally spaced times in each of the first steps, their ends included.

    steps (n, 5): x, y, px, py, t at the start of each; end: the time at which the last one ends.
    """
    points = path.shape[1] // count
    # WebAssembly computes the series of pairs, so that two steps are processed at a time.
    start = np.zeros((4, 2))
    x_series, y_series = np.zeros((ORDER + 1, 2)), np.zeros((ORDER + 1, 2))
    for first in range(0, count, 2):
        for k in range(2):
            for row in range(4):
                start[row, k] = steps[min(first + k, count - 1), row]
        call_jets(jets, coefficients, 2, start[0], start[1], start[2], start[3], x_series, y_series)
        for k in range(min(2, count - first)):
            step = first + k
            size = (steps[step + 1, 4] if step + 1 < count else end) - steps[step, 4]
            for point in range(points):
                tau = size * (point + 1) / points
                path[0, step * points + point] = series_value(x_series, k, tau)
                path[1, step * points + point] = series_value(y_series, k, tau)
