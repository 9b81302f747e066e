"""R² = x² + y² of one orbit over its whole life, in a bounded number of values however long it lives.

That of a bounded orbit rises and falls twice a round; when it leaves it grows past the Lyapunov orbits. The paper shows a
super-sticky orbit by it (Zotos 2014, figure 17b).
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from concurrent.futures import CancelledError
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.arrays import read_only
from engine.dynamics.classification import classify_orbits
from engine.dynamics.compiled import kernels_of, step_tolerance
from engine.dynamics.fates import Fate
from engine.execution import SerialExecutor
from engine.potentials.potential import Potential
from engine.taylor.kernels.dense_output import sample_path, trace_pieces
from engine.validation import read_count, read_state, read_t_max, shown

MOST_INTERVALS = 100_000
"""Most intervals of an envelope: more than any screen or page shows."""

# Between looks at R², which turns in π or so, it moves by less than a thousandth of its range.
_INTERVAL = 0.05


@dataclass(frozen=True, eq=False)
class RadiusEnvelope:
    """Least and greatest R² in intervals of time, dimensionless; arrays are read-only.

    Attributes
    ----------
    t
        (n + 1,) ends of the intervals, evenly spaced from 0 to the escape or t_max.
    low, high
        (n,) least and greatest R² = x² + y² in each, ends included.
    fate
        Channel k ≥ 1, or a `Fate`.
    escape_time
        Time of the outward crossing of the Lyapunov orbit; NaN when bounded.
    """

    t: np.ndarray
    low: np.ndarray
    high: np.ndarray
    fate: int
    escape_time: float


def compute_radius_envelope(
    potential: Potential, state: Any, t_max: float, intervals: int = 1000, *, cancel: threading.Event | None = None
) -> RadiusEnvelope:
    """Follow one orbit until it escapes or `t_max`, and keep the least and greatest R² of each interval of time.

    The orbit is that of `integrate_orbit`, step by step to the bit, without its deviation vectors; memory does not grow with its
    length.

    Parameters
    ----------
    potential
        The `Potential`.
    state
        (4,) x, y, px, py; finite, dimensionless; not outside.
    t_max
        How long to follow it, 0 < t_max ≤ 1e8.
    intervals
        How many, 1 to 100 000.
    cancel
        When set, the work stops within about 0.1 s.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When a parameter is out of its range, or the start is outside.
    """
    start, t_max = read_state("state", state), read_t_max(t_max)
    intervals = read_count("intervals", intervals, 1, MOST_INTERVALS)
    energy = float(potential.energy(start))
    outcome = classify_orbits(potential, energy, start[None], t_max, executor=SerialExecutor(), cancel=cancel)
    fate, escape_time = int(outcome.fate[0]), float(outcome.escape_time[0])
    if fate == Fate.NOT_COMPUTED:
        raise CancelledError
    if fate == Fate.OUTSIDE:
        raise ValueError(f"state={shown(state)}: lies beyond a Lyapunov orbit; must be inside")
    t = np.linspace(0.0, escape_time if fate >= 1 else t_max, intervals + 1)
    low, high = np.full(intervals, np.inf), np.full(intervals, -np.inf)
    for times, r2 in _walk(potential, start, float(t[-1]), t, cancel):
        # An end belongs to the intervals on both sides.
        for side in ("left", "right"):
            place = np.clip(np.searchsorted(t, times, side=side) - 1, 0, intervals - 1)
            np.minimum.at(low, place, r2)
            np.maximum.at(high, place, r2)
    return RadiusEnvelope(read_only(t), read_only(low), read_only(high), fate, escape_time)


def _walk(
    potential: Potential, start: np.ndarray, t_end: float, ends: np.ndarray, cancel: threading.Event | None
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Times and R² at these, a piece of the way after the other: often enough, and at every one of `ends`."""
    kernels = kernels_of(potential)
    for steps, until in trace_pieces(kernels, start, t_end, potential.channels, cancel, step_tolerance(potential)):
        begin = steps[0, 4]
        often = np.linspace(begin, until, int(np.ceil((until - begin) / _INTERVAL)) + 1)
        times = np.union1d(often, ends[(ends >= begin) & (ends <= until)])
        x, y, _, _ = sample_path(kernels, steps, times, cancel)
        yield times, x * x + y * y
