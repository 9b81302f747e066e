"""One point of the curves against energy or a parameter: what is measured on the map of one value."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from engine.dynamics.fates import Fate
from engine.execution import DEFAULT_EXECUTION, Execution
from engine.maps.compute import run_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.measures.basin_entropy import compute_basin_entropy
from engine.measures.decay_law_fits import MIN_RESAMPLES, fit_decay_laws
from engine.measures.escape_statistics import EscapeStatistics, compute_statistics
from engine.measures.uncertainty_exponent import WORK, compute_uncertainty_exponent
from engine.measures.wada import compute_wada_test
from engine.sweeps.complete_map import require_complete

# Smaller connected parts of the bounded starts are not counted as islands, in pixels.
_LEAST_ISLAND = 4
# A tenth of the work for a single map: about ten times faster, with intervals up to three times as wide.
_WORK = 0.1 * WORK


@dataclass(frozen=True)
class CurvePointSpec:
    """The measurement at one energy, or at one value of a parameter.

    Attributes
    ----------
    map_spec
        The map to evaluate.
    value
        The energy, or the value of the parameter.
    numbers
        The fates on the curves of the outcomes of the map, after 0; as in `ParameterFamily`.
    outcomes
        Number of outcomes of the curves.
    exponent
        Whether to compute the uncertainty exponent, which takes longest.
    """

    map_spec: MapSpec
    exponent: bool
    value: float
    numbers: tuple[int, ...]
    outcomes: int


@dataclass(frozen=True)
class CurvePoint:
    """Measured values at one energy, or at one value of a parameter, dimensionless.

    Attributes
    ----------
    value
        h, or the parameter.
    shares
        (outcomes + 1,) shares of the interior starts: bounded, then those of outcome 1, 2, …, such as escapes through a channel.
    bounded_low, bounded_high
        95 % interval of the share of bounded starts (Wilson 1927), as for independent random starts.
    bounded_area
        Area of the bounded starts on the slice: of their pixels, in units of its axes.
    islands, largest_island
        Number of connected parts of the bounded starts with at least 4 pixels, and the area of the largest one; 0 without any.
    direct_share
        Share of the interior starts that escape without an upward crossing of y = 0.
    mean_escape_time, median_escape_time
        Over the escaping orbits; NaN if there are none.
    s_b, s_bb
        Basin entropy and boundary basin entropy; see `compute_basin_entropy`.
    wada_distance
        Distance in pixels within which the boundaries of all basins coincide at 99 % of their pixels; see `compute_wada_test`.
        NaN for fewer than three basins.
    decay_rate, decay_low, decay_high
        Rate κ of the exponential law of late escapes and its 95 % interval; see `fit_decay_laws`. NaN where the law is ruled out
        or the escapes are too few.
    exponent, exponent_low, exponent_high
        Uncertainty exponent and its 95 % interval; see `compute_uncertainty_exponent`. NaN if undetermined or not requested.
    nbytes
        Approximate size in bytes, including the request.
    """

    value: float
    shares: tuple[float, ...]
    bounded_low: float
    bounded_high: float
    bounded_area: float
    islands: int
    largest_island: float
    direct_share: float
    mean_escape_time: float
    median_escape_time: float
    s_b: float
    s_bb: float
    wada_distance: float
    decay_rate: float
    decay_low: float
    decay_high: float
    exponent: float = math.nan
    exponent_low: float = math.nan
    exponent_high: float = math.nan
    nbytes: ClassVar[int] = 1024


def compute_curve_point(
    spec: CurvePointSpec,
    *,
    execution: Execution = DEFAULT_EXECUTION,
    frame: EscapeMap | None = None,
) -> CurvePoint:
    """Measure one energy, or one value of a parameter.

    Parameters
    ----------
    spec
        The request.
    execution
        As in `compute_curves`.
    frame
        The complete map of `spec.map_spec`; None to compute it.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    """
    if frame is None:
        frame = run_map(spec.map_spec, execution.part(0, 2))
    point = _evaluate_map(spec, require_complete(frame), execution)
    open_channels = spec.map_spec.potential.well.open_channels(spec.map_spec.common_energy or 0.0)
    if not (spec.exponent and open_channels):
        return point
    found = compute_uncertainty_exponent(spec.map_spec, work=_WORK, execution=execution.part(1, 2))
    return replace(point, exponent=found.exponent, exponent_low=found.low, exponent_high=found.high)


def _evaluate_map(spec: CurvePointSpec, frame: EscapeMap, execution: Execution) -> CurvePoint:
    statistics = compute_statistics(frame)
    rate, slowest, fastest = _find_decay_rate(statistics, spec.map_spec.t_max, execution)
    shares = [0.0] * (spec.outcomes + 1)
    for fate, number in enumerate(spec.numbers):
        shares[number] = statistics.shares[fate]
    low, high = statistics.share_intervals[Fate.BOUNDED]
    entropy, areas = compute_basin_entropy(frame), _island_areas(frame)
    return CurvePoint(
        value=spec.value,
        shares=tuple(shares),
        bounded_low=low,
        bounded_high=high,
        bounded_area=statistics.bounded * _pixel_area(frame),
        islands=areas.size,
        largest_island=float(areas.max(initial=0.0)),
        direct_share=statistics.direct_share,
        mean_escape_time=statistics.mean_escape_time,
        median_escape_time=statistics.median_escape_time,
        s_b=entropy.s_b,
        s_bb=entropy.s_bb,
        wada_distance=compute_wada_test(frame).radius_99,
        decay_rate=rate,
        decay_low=slowest,
        decay_high=fastest,
    )


def _find_decay_rate(statistics: EscapeStatistics, t_max: float, execution: Execution) -> tuple[float, float, float]:
    """The rate of the exponential law and its interval; NaN where it does not describe the escapes."""
    fit = fit_decay_laws(statistics, t_max, resamples=MIN_RESAMPLES, execution=execution).exponential
    return (fit.rate, fit.low, fit.high) if fit is not None and fit.plausible else (math.nan, math.nan, math.nan)


def _pixel_area(frame: EscapeMap) -> float:
    window, (columns, rows) = frame.spec.find_window(), frame.spec.resolution
    return (window.x_high - window.x_low) * (window.ordinate_high - window.ordinate_low) / (columns * rows)


def _island_areas(frame: EscapeMap) -> np.ndarray:
    """(n,) areas of the connected parts of the bounded starts, where pixels that share a corner are connected."""
    # Slow to import.
    from scipy import ndimage

    parts, _ = ndimage.label(frame.fate == Fate.BOUNDED, np.ones((3, 3)))
    pixels = np.bincount(parts.ravel())[1:]
    areas: np.ndarray = pixels[pixels >= _LEAST_ISLAND] * _pixel_area(frame)
    return areas
