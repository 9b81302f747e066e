"""Reduce histories of an orbit for drawing: to the curve where pixels resolve the curve, elsewhere to its envelope and mean."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

ENVELOPE_ALPHA = 0.3
"""Opacity of envelopes, low enough to see the mean through them."""

# Number of intervals of a history, of equal length on the axis of time: about one for each pixel of a plot.
_BINS = 300

# Time (dimensionless) up to which values on a linear axis are drawn against linear time, which shows their oscillations.
_SHORT = 1000.0

# Largest number of minima and maxima in an interval whose curve is drawn. An interval with more of them is fast.
_MOST_TURNS = 2

# Largest number of samples of the curve that are drawn in an interval.
_MOST_SAMPLES = 16


@dataclass(frozen=True, eq=False)
class History:
    """A quantity of an orbit against time.

    Attributes
    ----------
    line
        (t, value), each (n,): the curve, or the mean where the curve oscillates too fast to be drawn.
    band
        (t, low, high), each (m,): the envelope where `line` is the mean; empty if `line` is the curve everywhere.
    """

    line: tuple[np.ndarray, np.ndarray]
    band: tuple[np.ndarray, np.ndarray, np.ndarray]

    @property
    def highest(self) -> float:
        """The largest value; NaN without samples."""
        return float(max([*self.line[1], *self.band[2]], default=np.nan))

    @property
    def outline(self) -> tuple[np.ndarray, np.ndarray]:
        """t and value of the polygon around the envelope."""
        t, low, high = self.band
        return np.concatenate([t, t[::-1]]), np.concatenate([low, high[::-1]])


def logarithmic_limits(low: float, high: float) -> tuple[float, float]:
    """Return the ends of a logarithmic axis: the largest power of ten up to `low`, and a number a little above `high`."""
    return 10.0 ** math.floor(math.log10(low)), 1.3 * high


def has_log_time(end: float, *, logarithmic: bool) -> bool:
    """Return whether histories until the time `end` are drawn against log t; `logarithmic` describes the axis of the values."""
    return logarithmic or end > _SHORT


def reduce_history(t: np.ndarray, values: np.ndarray, *, logarithmic: bool) -> History:
    """Reduce a history for the axis of time that `has_log_time` determines.

    Parameters
    ----------
    t, values
        Times, increasing and above 0, and values, each of shape (n,).
    logarithmic
        Whether the axis of the values is logarithmic. If so, values must be positive, and means are geometric.
    """
    if t.size <= _BINS:
        return History((t, values), (t[:0], values[:0], values[:0]))
    space = np.geomspace if has_log_time(float(t[-1]), logarithmic=logarithmic) else np.linspace
    # Indices of the first samples of the intervals. Intervals without samples are dropped.
    edges = np.unique(np.searchsorted(t, space(t[0], t[-1], _BINS + 1)[:-1]))
    fast_intervals = np.flatnonzero(np.add.reduceat(_turns(values), edges) > _MOST_TURNS)
    # The envelope replaces the curve in the first fast interval and in all later intervals.
    split = int(fast_intervals[0]) if fast_intervals.size else edges.size
    curve_edges, envelope_edges = edges[:split], edges[split:]
    curve_end = int(envelope_edges[0]) if envelope_edges.size else t.size
    curve_samples = _visible_samples(curve_edges, curve_end)
    times, low, high, mean = _envelope(t, values, envelope_edges, logarithmic=logarithmic)
    return History((np.append(t[curve_samples], times), np.append(values[curve_samples], mean)), (times, low, high))


def _turns(values: np.ndarray) -> np.ndarray:
    """Return whether each value is a local minimum or maximum, of shape (n,)."""
    rises = np.diff(values) > 0.0
    return np.concatenate([[False], rises[1:] != rises[:-1], [False]])


def _visible_samples(edges: np.ndarray, end: int) -> np.ndarray:
    """Return the indices of samples before `end`, evenly spaced in each interval, including the last sample."""
    counts = np.diff(np.append(edges, end))
    index_in_interval = np.arange(end) - np.repeat(edges, counts)
    stride = np.repeat(np.ceil(counts / _MOST_SAMPLES).astype(np.intp), counts)
    return np.flatnonzero((index_in_interval % stride == 0) | (np.arange(end) == end - 1))


def _envelope(t: np.ndarray, values: np.ndarray, edges: np.ndarray, *, logarithmic: bool) -> tuple[np.ndarray, ...]:
    """Return time, minimum, maximum and mean in each interval. The first and last times are those of the end samples."""
    if not edges.size:
        return (t[:0],) * 4
    ends = np.append(edges[1:], t.size)
    times = t[(edges + ends) // 2]
    times[0], times[-1] = t[edges[0]], t[-1]
    scaled_values = np.log(values) if logarithmic else values
    mean = np.add.reduceat(scaled_values, edges) / (ends - edges)
    return times, np.minimum.reduceat(values, edges), np.maximum.reduceat(values, edges), np.exp(mean) if logarithmic else mean
