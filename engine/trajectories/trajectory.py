"""One orbit in full: path, SALI, R², crossings, exit and energy error."""

from __future__ import annotations

import threading
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.dynamics.classification import classify_orbits
from engine.dynamics.compiled import kernels_of, step_tolerance
from engine.dynamics.deviation_vectors import DEVIATION_VECTORS
from engine.dynamics.fates import Fate, Regularity, describe_fate, judge_regularity
from engine.execution import SerialExecutor
from engine.potentials.potential import Potential
from engine.taylor.kernels.dense_output import propagate_deviations, sample_path, trace_steps
from engine.validation import read_state, read_t_max

LONGEST_ORBIT = 1e7
"""Largest t_max of an orbit in full: its samples take 3 GB then."""

_FINEST_INTERVAL = 0.02
_FEWEST_SAMPLES = 400
_MOST_SAMPLES = 500_000


@dataclass(frozen=True, eq=False)
class Orbit:
    """One orbit, dimensionless; arrays share one length n, evenly spaced in time from 0 to the escape or t_max.

    Attributes
    ----------
    t, x, y, px, py
        (n,) time and state.
    sali
        (n,) smaller alignment index, 0 to √2: min(‖w1 − w2‖, ‖w1 + w2‖) of two unit deviation vectors.
    lyapunov_exponent
        (n,) finite-time maximal Lyapunov exponent (1/t) ln(|w1(t)|/|w1(0)|) of the first deviation vector, per unit of time; NaN
        at t = 0. It falls like ln t / t along regular motion and levels off at a positive value along chaotic motion.
    r2
        (n,) R² = x² + y².
    fate
        Channel k ≥ 1, or a `Fate`; a forbidden start cannot be asked for.
    escape_time
        Time of the outward crossing of the Lyapunov orbit; NaN when bounded.
    crossings
        Upward crossings of y = 0 before the escape or t_max; the start is not counted.
    energy_error
        |H − h| / |h| at the end.
    energy
        h of the start.
    """

    t: np.ndarray
    x: np.ndarray
    y: np.ndarray
    px: np.ndarray
    py: np.ndarray
    sali: np.ndarray
    lyapunov_exponent: np.ndarray
    r2: np.ndarray
    fate: int
    escape_time: float
    crossings: int
    energy_error: float
    energy: float

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays."""
        state = (self.x, self.y, self.px, self.py)
        return sum(array.nbytes for array in (self.t, *state, self.sali, self.lyapunov_exponent, self.r2))

    @property
    def regularity(self) -> Regularity | None:
        """Regular or chaotic by the SALI at t_max, for a bounded orbit; None for one that escapes."""
        return judge_regularity(float(self.sali[-1])) if self.fate == Fate.BOUNDED else None

    def describe(self) -> str:
        """The verdict in words."""
        if self.fate >= 1:
            kind = (
                "directly, without crossing y = 0 upward"
                if self.crossings == 0
                else f"after {self.crossings} upward crossings of y = 0"
            )
            return f"Escaped through channel {self.fate} at t = {self.escape_time:.6g}, {kind}."
        if self.regularity is not None:
            return f"Bounded until t = {self.t[-1]:g} and {self.regularity}, with {self.crossings} upward crossings of y = 0."
        return describe_fate(self.fate)


def integrate_orbit(potential: Potential, state: Any, t_max: float = 1e5, *, cancel: threading.Event | None = None) -> Orbit:
    """Integrate one orbit until it escapes or `t_max`.

    Fate, escape time and crossings are those that a map gives for the same start. The deviation vectors obey eq. 4 of
    Zotos (2014), SALI is eq. 9; the growth of the first one is the finite-time Lyapunov exponent (Benettin, Galgani, Giorgilli &
    Strelcyn 1980, Meccanica 15, 9; Skokos 2010, Lect. Notes Phys. 790, 63). They follow the orbit's own steps and never change
    them.

    Parameters
    ----------
    potential
        The `Potential`.
    state
        (4,) x, y, px, py; finite, dimensionless. Its energy becomes that of the orbit and of the exits.
    t_max
        How long to follow it, 0 < t_max ≤ 1e7. Beyond 1e5 or so samples are up to a step of the integrator apart and take
        some 300 bytes a time unit.
    cancel
        When set, the work stops within about 0.1 s.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When `state` is not four finite numbers, or `t_max` is out of its range.
    """
    start = read_state("state", state)
    t_max = read_t_max(t_max, LONGEST_ORBIT)
    energy = float(potential.energy(start))
    outcome = classify_orbits(potential, energy, start[None], t_max, executor=SerialExecutor(), cancel=cancel)
    fate = int(outcome.fate[0])
    t_end = 0.0 if fate == Fate.OUTSIDE else float(outcome.escape_time[0]) if fate >= 1 else t_max
    times, path, sali, exponent = _follow(potential, start, t_end, cancel)
    x, y, px, py = path
    arrays = (times, x, y, px, py, sali, exponent, x * x + y * y)
    for array in arrays:
        array.flags.writeable = False
    return Orbit(
        *arrays, fate, float(outcome.escape_time[0]), int(outcome.crossings[0]), float(outcome.energy_error[0]), energy
    )  # fmt: skip


def _follow(
    potential: Potential, start: np.ndarray, t_end: float, cancel: threading.Event | None
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Times, path, SALI and Lyapunov exponent from 0 to `t_end`."""
    if t_end == 0.0:
        return np.zeros(1), start[:, None].copy(), np.full(1, np.sqrt(2.0)), np.full(1, np.nan)
    kernels = kernels_of(potential)
    steps = trace_steps(kernels, start, t_end, potential.channels, cancel, step_tolerance(potential))
    times = np.linspace(0.0, t_end, _sample_count(t_end, len(steps)))
    path = sample_path(kernels, steps, times, cancel)
    sali, growth = propagate_deviations(kernels, path, times, DEVIATION_VECTORS, cancel)
    exponent = np.full_like(times, np.nan)
    with np.errstate(over="ignore"):
        # A time may be so short that it has no reciprocal.
        np.divide(growth, times, out=exponent, where=times > 0.0)
    return times, path, sali, exponent


def _sample_count(t_end: float, steps: int) -> int:
    """Finely for a short orbit, and never further apart than the steps are on average, which the tangent flow needs."""
    wanted = int(np.clip(t_end / _FINEST_INTERVAL, _FEWEST_SAMPLES, _MOST_SAMPLES))
    return max(wanted, steps) + 1
