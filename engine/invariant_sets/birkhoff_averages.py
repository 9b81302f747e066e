"""Which orbits run on an invariant torus, told early by weighted Birkhoff averages.

Along a quasi-periodic orbit the average of a smooth observable over a window that fades in and out smoothly converges fast
with the length T of the window; along a chaotic one no faster than 1/√T. So two consecutive windows agree to many digits on
a torus and to few otherwise (Das, Saiki, Sander & Yorke 2017, Nonlinearity 30, 4111; Duignan & Meiss 2023, Physica D 449,
133749). Observables are x² and y², sampled at a fixed step.

Those authors weight by exp(−1/(s(1 − s))), s = t/T, which beats any power of T in the end. We need eight digits, not all:
the Kaiser window (Kaiser & Schafer 1980, IEEE Trans. ASSP 28, 105) takes that much off any motion that turns 7 times or more
within T, the other needs 30 turns.
"""

from __future__ import annotations

import threading
from concurrent.futures import Executor

import numpy as np

from engine.dynamics.compiled import fixed_step_size, kernels_of
from engine.dynamics.fixed_step_batches import glide
from engine.potentials.potential import Potential

WINDOWS = (1000.0, 4000.0, 16000.0, 64000.0)
"""Lengths of windows worth trying one after the other: most tori show themselves in the first."""

CERTIFIED_DIGITS = 8.0
"""Digits to which both averages of two windows must agree for a torus.

Of 1975 orbits on five maps that escape after t = 1000, the best reached 6.1.
"""

# Shape β of the Kaiser window: higher ones fade out further, and need a longer window to do so.
_KAISER_SHAPE = 20.0
_ENERGY_TOLERANCE = 1e-9
_MOST_DIGITS = 16.0


def count_agreeing_digits(
    potential: Potential,
    states: np.ndarray,
    window: float,
    *,
    executor: Executor | None = None,
    cancel: threading.Event | None = None,
) -> np.ndarray:
    """To how many digits the weighted averages of x² and y² over two consecutive windows agree.

    Parameters
    ----------
    potential
        The `Potential`.
    states
        (n, 4) x, y, px, py, finite; where the first window begins.
    window
        Length T of each window, dimensionless, at least 10.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    cancel
        When set, orbits not reached get NaN.

    Returns
    -------
    (n,) −log10 of the larger relative difference, 0 to 16; 0 for an orbit that leaves on the way or does not keep its energy;
    an orbit on a torus is one with `CERTIFIED_DIGITS` or more.
    """
    return glide(_agreeing_digits, potential, states, window, executor=executor, cancel=cancel)


def _agreeing_digits(potential: Potential, tile: np.ndarray, window: float) -> np.ndarray:
    energy, step = potential.energy(tile.T), fixed_step_size(potential)
    averages = np.zeros((2, 2, tile.shape[1]))
    kernels_of(potential).birkhoff_averages(step, window_weights(window, step), tile, averages)
    with np.errstate(all="ignore"):
        difference = np.abs(averages[1] - averages[0]) / np.abs(averages).max(axis=0)
        digits = -np.log10(np.maximum(difference.max(axis=0), 10.0**-_MOST_DIGITS))
        kept = np.abs(potential.energy(tile.T) - energy) <= _ENERGY_TOLERANCE * potential.length**2
    agreeing: np.ndarray = np.where(kept & np.isfinite(digits), np.maximum(digits, 0.0), 0.0)
    return agreeing


def window_weights(window: float, step: float) -> np.ndarray:
    """Kaiser's I0(β √(1 − (2s − 1)²)) at the samples, `step` apart, of a window; their sum is 1."""
    weights: np.ndarray = np.kaiser(int(window / step), _KAISER_SHAPE)
    weights /= weights.sum()
    return weights
