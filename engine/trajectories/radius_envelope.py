"""Envelope of R² = x² + y² along one orbit of any length, in a fixed number of intervals.

R² oscillates twice per revolution along a bounded orbit and grows beyond the Lyapunov orbits at an escape. Zotos (2014, figure
17b) shows a super-sticky orbit this way.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from engine.dynamics.classification import Outcomes, classify_in_well_units
from engine.dynamics.fates import Fate
from engine.execution import DEFAULT_EXECUTION, Execution
from engine.potentials.compiled import kernels_of
from engine.potentials.potential import Potential
from engine.potentials.well_units import AREA, TIME
from engine.results.arrays import read_only
from engine.results.result import Result
from engine.taylor.kernels.dense_output import sample_path, trace_pieces
from engine.validation import checked_count, checked_state, short_repr

MAX_INTERVALS = 100_000
"""Largest number of intervals: more than any screen or page can show."""

# In units of the well R² oscillates with a period of about π and changes by less than 0.1 % of its range between samples.
_SAMPLE_INTERVAL = 0.05


@dataclass(frozen=True, eq=False, repr=False)
class RadiusEnvelope(Result):
    """Smallest and largest R² in intervals of time, dimensionless; arrays are read-only.

    Attributes
    ----------
    t
        (n + 1,) interval boundaries, evenly spaced from 0 to the escape or t_max.
    low, high
        (n,) smallest and largest R² = x² + y² in each interval, boundaries included.
    fate
        Channel k ≥ 1, or a `Fate`.
    escape_time
        Time of the outward crossing of the Lyapunov orbit; NaN when bounded.
    """

    t: np.ndarray = field(metadata=TIME)
    low: np.ndarray = field(metadata=AREA)
    high: np.ndarray = field(metadata=AREA)
    fate: int
    escape_time: float = field(metadata=TIME)

    def columns(self) -> Mapping[str, np.ndarray]:
        """Start of each interval, smallest and largest R²."""
        return {"t": self.t[:-1], "low": self.low, "high": self.high}


def compute_radius_envelope(
    potential: Potential, state: Any, t_max: float, *, intervals: int = 1000, execution: Execution = DEFAULT_EXECUTION
) -> RadiusEnvelope:
    """Integrate one orbit until it escapes or `t_max` and return the smallest and largest R² in each interval of time.

    The integration steps are bit-identical to those of `integrate_orbit`, without deviation vectors. Memory use does not grow
    with the length of the orbit.

    Parameters
    ----------
    potential
        The `Potential`.
    state
        (4,) x, y, px, py; finite, dimensionless; inside: beyond no exit, in no body, within the escape radius.
    t_max
        Longest integration time, 0 < t_max ≤ 1e8, dimensionless.
    intervals
        Number of intervals, 1 to 100 000.
    execution
        How the computation runs.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    ValueError
        If a parameter is out of range, or the start lies outside.
    """
    start, t_max = checked_state("state", state), potential.checked_t_max(t_max)
    intervals = checked_count("intervals", intervals, 1, MAX_INTERVALS)
    units, well = potential.units, potential.in_well_units
    start, t_max = start / units.state, t_max / units.time
    outcome = classify_in_well_units(well, float(well.energy(start)), start[None], t_max, execution.in_this_thread())
    execution.raise_if_cancelled()
    if outcome.fate[0] == Fate.OUTSIDE:
        raise ValueError(f"state={short_repr(state)}: lies beyond an exit, in a body or beyond the escape radius; must be inside")
    return units.restore(_find_envelope(well, start, outcome, t_max, intervals, execution))


def _find_envelope(
    potential: Potential, start: np.ndarray, outcome: Outcomes, t_max: float, intervals: int, execution: Execution
) -> RadiusEnvelope:
    """`compute_radius_envelope` of an orbit with a known outcome, in units of the well."""
    fate, escape_time = int(outcome.fate[0]), float(outcome.escape_time[0])
    t = np.linspace(0.0, escape_time if fate >= 1 else t_max, intervals + 1)
    low, high = np.full(intervals, np.inf), np.full(intervals, -np.inf)
    for times, r2 in _sample_r2(potential, start, t, execution):
        # A boundary belongs to the intervals on both sides.
        for side in ("left", "right"):
            interval = np.clip(np.searchsorted(t, times, side=side) - 1, 0, intervals - 1)
            np.minimum.at(low, interval, r2)
            np.maximum.at(high, interval, r2)
    return RadiusEnvelope(read_only(t), read_only(low), read_only(high), fate, escape_time)


def _sample_r2(
    potential: Potential, start: np.ndarray, boundaries: np.ndarray, execution: Execution
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Sample times and R² for successive parts of the orbit: at most `_SAMPLE_INTERVAL` apart, and at every boundary.

    All quantities are in units of the well.
    """
    kernels = kernels_of(potential)
    for steps, until in trace_pieces(kernels, start, float(boundaries[-1]), len(potential.outcomes), execution):
        begin = steps[0, 4]
        even = np.linspace(begin, until, int(np.ceil((until - begin) / _SAMPLE_INTERVAL)) + 1)
        times = np.union1d(even, boundaries[(boundaries >= begin) & (boundaries <= until)])
        x, y, _, _ = sample_path(kernels, steps, times, execution)
        yield times, x * x + y * y
