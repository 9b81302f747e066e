"""Detection of quasi-periodic orbits by weighted Birkhoff averages.

Along a quasi-periodic orbit, the average of a smooth observable, weighted by a window function that vanishes smoothly at both
ends, converges fast with the window length T. Along a chaotic orbit, the average converges no faster than 1/√T. The averages over
two consecutive windows therefore agree to many digits on an invariant torus and to few digits otherwise (Das, Saiki, Sander &
Yorke 2017, Nonlinearity 30, 4111; Duignan & Meiss 2023, Physica D 449, 133749). On a weakly chaotic orbit two averages can agree
by chance. A third average, over a window that overlaps half of each of these windows, must therefore also agree. The observables
are x² and y², sampled at even intervals of any length: the flow over an interval also has the tori of the orbits.

With the weight exp(−1/(s(1 − s))), s = t/T, of these papers, averages converge faster than any power of T. Here, eight digits are
enough. With the Kaiser window (Kaiser & Schafer 1980, IEEE Trans. ASSP 28, 105), averages reach eight digits for motion that
completes 7 or more revolutions within T. The weight of these papers requires 30 revolutions.
"""

from __future__ import annotations

import functools

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.propagation.limited_steps import LOOSE_TOLERANCE, is_energy_conserved, step_budget
from engine.propagation.tiles import map_tiles
from engine.systems.potential import Potential

WINDOWS = (1000.0, 4000.0, 16000.0, 64000.0)
"""Window lengths T to try in turn, in units of the well; the first window suffices for most tori."""

TORUS_DIGITS = 8.0
"""Smallest number of agreeing digits with which an orbit counts as quasi-periodic.

Of 1975 orbits on five maps that escape after t = 1000, none exceeded 6.1 digits.
"""

REGULAR_DIGITS = 7.0
"""Smallest number of digits from `compare_halves` with which an orbit counts as regular, see `benchmarks.verdicts`."""

# Shape parameter β of the Kaiser window. A larger β gives smaller weights at the ends but needs a longer window.
_KAISER_SHAPE = 20.0
# Largest number of digits, also for equal averages.
_MOST_DIGITS = 16.0


def count_agreeing_digits(
    potential: Potential, states: np.ndarray, window: float, *, execution: Execution = DEFAULT_EXECUTION
) -> np.ndarray:
    """Count the digits to which weighted averages of x² and y² agree over two consecutive windows and a window between them.

    Parameters
    ----------
    potential
        The `Potential` in units of its well.
    states
        (n, 4) x, y, px, py at the start of the first window; finite, in units of the well.
    window
        Length T of each window, in units of the well, at least 10.
    execution
        How the computation runs. When it is cancelled, orbits not processed yet get NaN.

    Returns
    -------
    −log10 of the largest relative difference of the averages, from 0 to 16, of shape (n,). It is 0 for an orbit that escapes,
    that does not conserve its energy, or along which x or y is always 0. An orbit with `TORUS_DIGITS` or more counts as
    quasi-periodic.
    """
    return compare_averages(potential, states, window, execution=execution)[:, 1]


def compare_averages(
    potential: Potential, states: np.ndarray, window: float, *, execution: Execution = DEFAULT_EXECUTION
) -> np.ndarray:
    """Return the digits to which the first two averages of each orbit agree, and the digits to which all three agree, (n, 2).

    The parameters are those of `count_agreeing_digits`.
    """
    return map_tiles(_agreeing_digits, potential, states, window, shape=(2,), execution=execution)


def compare_halves(x: np.ndarray, y: np.ndarray) -> float:
    """Return the digits to which averages of x² and y² over the halves of one orbit, and over a window between them, agree.

    Parameters
    ----------
    x, y
        (n,) positions at n evenly spaced times, at least 2, several of them in each revolution.

    Returns
    -------
    Digits from 0 to 16, as `count_agreeing_digits` with windows half as long as the orbit; 0 for an orbit along an axis.
    """
    half = len(x) // 2
    squares = np.array([x * x, y * y])
    weights = window_weights(float(half), 1.0)
    averages = np.array([squares[:, start : start + half] @ weights for start in (0, half, half // 2)])
    return float(_digits(averages[:, :, None])[1, 0])


def _agreeing_digits(potential: Potential, tile: np.ndarray, window: float) -> np.ndarray:
    """Return the result of `compare_averages` for the orbits of a tile (4, lanes), of shape (lanes, 2)."""
    initial_energy = potential.energy(tile.T)
    interval = potential.well.sample_interval
    weights = window_weights(window, interval)
    averages = np.zeros((3, 2, tile.shape[1]))
    # The kernel changes the states of the tile, and adds to the averages.
    limits = LOOSE_TOLERANCE, interval, step_budget(2.0 * window)
    potential.well.kernels.birkhoff_averages(*limits, weights, tile, averages)
    is_conserved = is_energy_conserved(potential, tile.T, initial_energy)
    return np.where(is_conserved, _digits(averages), 0.0).T


def _digits(averages: np.ndarray) -> np.ndarray:
    """Return the digits to which the first two of three averages agree, and the digits to which all three agree, (2, n).

    `averages`, (3, 2, n), belong to two observables. The observable with fewer digits decides.
    """
    with np.errstate(all="ignore"):
        difference = np.array([np.ptp(averages[:count], axis=0) / np.abs(averages).max(axis=0) for count in (2, 3)])
        digits = -np.log10(np.maximum(difference.max(axis=1), 10.0**-_MOST_DIGITS))
    # An observable that is always 0 has the digits NaN, which count as 0.
    return np.where(np.isfinite(digits), np.maximum(digits, 0.0), 0.0)


@functools.lru_cache(maxsize=16)
def window_weights(window: float, step: float) -> np.ndarray:
    """Return the Kaiser weights I0(β √(1 − (2s − 1)²)) of samples at s = t/T in a window of length T. Their sum is 1.

    Parameters
    ----------
    window
        Length T, dimensionless.
    step
        Time between samples, dimensionless.
    """
    weights: np.ndarray = np.kaiser(int(window / step), _KAISER_SHAPE)
    weights /= weights.sum()
    return read_only(weights)
