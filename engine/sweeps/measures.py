"""What a sweep measures on the map of each value: functions of a map, by name."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from concurrent.futures import CancelledError
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.foundations.codes import describe_codes
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.maps.compute import compute_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.measures.basin_entropy import compute_basin_entropy
from engine.measures.decay_law_fits import fit_decay_laws
from engine.measures.escape_statistics import EscapeStatistics, compute_statistics
from engine.measures.uncertainty_exponent import WORK, compute_uncertainty_exponent
from engine.measures.wada import compute_wada_test
from engine.propagation.fates import Fate, renumber
from engine.systems.outcomes import Outcome

if TYPE_CHECKING:
    import xarray as xr

# Smaller connected parts of the bounded starts are not counted as islands, in pixels.
_LEAST_ISLAND = 4
_LOW, _HIGH = "lower end of the 95 % interval of the {}", "upper end of the 95 % interval of the {}"
# A tenth of the work for a single map: about ten times faster, with intervals up to three times as wide.
_WORK = 0.1 * WORK


@dataclass(frozen=True)
class SweepPoint:
    """The measurement at one value.

    Attributes
    ----------
    map_spec
        The map to measure.
    name, value
        The name of the energy or of the parameter, and its value.
    measures
        Names of `MEASURES`.
    numbers
        The fate in the sweep of each fate of the map, from 0 on; as in `ParameterFamily`.
    outcomes
        The outcomes of the sweep.
    """

    map_spec: MapSpec
    name: str
    value: float
    measures: tuple[str, ...]
    numbers: tuple[int, ...]
    outcomes: tuple[Outcome, ...]


@dataclass(frozen=True, eq=False)
class MeasuredMap:
    """A complete map and the measurement that it is for."""

    point: SweepPoint
    frame: EscapeMap
    execution: Execution

    @cached_property
    def statistics(self) -> EscapeStatistics:
        """Counts of the interior starts."""
        return compute_statistics(self.frame)

    @property
    def pixel_area(self) -> float:
        """Area of a pixel, in units of the axes."""
        window, (columns, rows) = self.frame.spec.find_window(), self.frame.spec.resolution
        return (window.x_high - window.x_low) * (window.ordinate_high - window.ordinate_low) / (columns * rows)


Variables = Mapping[str, Any]
"""Variables of a dataset by name, as xarray takes them: dimensions, values and attributes."""


def compute_point(point: SweepPoint, *, frame: EscapeMap | None = None, execution: Execution = DEFAULT_EXECUTION) -> xr.Dataset:
    """Measure one value.

    Parameters
    ----------
    point
        The request.
    frame
        The map of `point.map_spec`; None to compute it.
    execution
        How the computation runs.

    Returns
    -------
    Dataset of the measures, whose first dimension, of size 1, is that of the values.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    """
    # Slow to import.
    import xarray as xr

    if frame is None:
        frame = compute_map(point.map_spec, execution=execution.part(0, 2))
    if not frame.complete:
        raise CancelledError
    measured = MeasuredMap(point, frame, execution.part(1, 2))
    variables: dict[str, Any] = {}
    for name in point.measures:
        variables |= MEASURES[name](measured)
    value = ((), point.value, {"long_name": point.name, "units": "1"})
    return xr.Dataset(variables, {point.name: value}).expand_dims(point.name)


def _number(value: float, words: str) -> tuple[tuple[()], float, dict[str, str]]:
    return (), value, {"long_name": words, "units": "1"}


def _measure_shares(measured: MeasuredMap) -> Variables:
    """Shares of the interior starts that are bounded, and of each outcome, with 95 % intervals (Wilson 1927).

    The intervals are those of independent random starts.
    """
    statistics, numbers = measured.statistics, measured.point.numbers
    shares, low, high = np.zeros((3, len(measured.point.outcomes) + 1))
    for fate, number in enumerate(numbers):
        shares[number] = statistics.shares[fate]
        low[number], high[number] = statistics.share_intervals[fate]
    words = {"share": "share of the interior starts", "share_low": _LOW.format("share"), "share_high": _HIGH.format("share")}
    return {
        "outcome": ("outcome", np.arange(shares.size), _describe_fates(measured.point)),
        **{
            name: ("outcome", values, {"long_name": words[name], "units": "1"})
            for name, values in (("share", shares), ("share_low", low), ("share_high", high))
        },
        "direct_share": _number(statistics.direct_share, "share that escapes without an upward crossing of y = 0"),
    }


def _measure_escape_times(measured: MeasuredMap) -> Variables:
    """Escape times; NaN if no orbit escapes."""
    return {
        "mean_escape_time": _number(measured.statistics.mean_escape_time, "mean escape time"),
        "median_escape_time": _number(measured.statistics.median_escape_time, "median escape time"),
    }


def _measure_islands(measured: MeasuredMap) -> Variables:
    """Connected parts of the bounded starts, where pixels that share a corner are connected; areas in units of the axes."""
    # Slow to import.
    from scipy import ndimage

    bounded = measured.frame.fate == Fate.BOUNDED
    parts, _ = ndimage.label(bounded, np.ones((3, 3)))
    pixels = np.bincount(parts.ravel())[1:]
    islands = pixels[pixels >= _LEAST_ISLAND]
    return {
        "bounded_area": _number(np.count_nonzero(bounded) * measured.pixel_area, "area of the bounded starts"),
        "islands": _number(islands.size, f"connected parts of the bounded starts with at least {_LEAST_ISLAND} pixels"),
        "largest_island": _number(islands.max(initial=0) * measured.pixel_area, "area of the largest of these parts"),
    }


def _measure_entropy(measured: MeasuredMap) -> Variables:
    """Basin entropies with their standard errors, see `compute_basin_entropy`."""
    entropy = compute_basin_entropy(measured.frame)
    return {
        "s_b": _number(entropy.s_b, "basin entropy"),
        "s_b_error": _number(entropy.s_b_error, "standard error of the basin entropy"),
        "s_bb": _number(entropy.s_bb, "boundary basin entropy"),
        "s_bb_error": _number(entropy.s_bb_error, "standard error of the boundary basin entropy"),
    }


def _measure_wada(measured: MeasuredMap) -> Variables:
    """See `compute_wada_test`; NaN for fewer than three basins."""
    distance = compute_wada_test(measured.frame).radius_99
    return {"wada_distance": _number(distance, "pixels within which 99 % of the boundaries coincide")}


def _measure_decay_rate(measured: MeasuredMap) -> Variables:
    """Exponential law of late escapes, see `fit_decay_laws`; NaN where it is ruled out or the escapes are too few."""
    fit = fit_decay_laws(measured.statistics, measured.frame.spec.t_max).exponential
    found = (fit.rate, fit.low, fit.high) if fit is not None and fit.plausible else (math.nan,) * 3
    return _with_interval("decay_rate", found, "rate of the exponential law of late escapes")


def _measure_exponent(measured: MeasuredMap) -> Variables:
    """See `compute_uncertainty_exponent`; NaN if it is undetermined or no exit is open."""
    spec, found = measured.frame.spec, (math.nan,) * 3
    if spec.potential.well.open_channels(spec.common_energy or 0.0):
        fit = compute_uncertainty_exponent(spec, work=_WORK, execution=measured.execution)
        found = fit.exponent, fit.low, fit.high
    return _with_interval("exponent", found, "uncertainty exponent")


def _with_interval(name: str, found: tuple[float, ...], words: str) -> Variables:
    value, low, high = found
    return {
        name: _number(value, words),
        f"{name}_low": _number(low, _LOW.format(words)),
        f"{name}_high": _number(high, _HIGH.format(words)),
    }


def _measure_accuracy(measured: MeasuredMap) -> Variables:
    return {"worst_energy_error": _number(measured.frame.worst_energy_error, "largest relative energy error of any orbit")}


def _keep_map(measured: MeasuredMap) -> Variables:
    """All arrays of the map, as in `EscapeMap.to_xarray`; fates have the numbers of the sweep."""
    dataset, fate = measured.frame.to_xarray(), measured.frame.fate
    renumbered = renumber(fate, np.array(measured.point.numbers, fate.dtype))
    attributes = {**dataset["fate"].attrs, **_describe_fates(measured.point)}
    kept = {str(name): variable for name, variable in dataset.variables.items()}
    return kept | {"fate": (dataset["fate"].dims, renumbered, attributes)}


def _describe_fates(point: SweepPoint) -> dict[str, str]:
    return describe_codes(Fate, [outcome.label for outcome in point.outcomes])


MEASURES: Mapping[str, Callable[[MeasuredMap], Variables]] = MappingProxyType(
    {
        "shares": _measure_shares,
        "escape_times": _measure_escape_times,
        "islands": _measure_islands,
        "basin_entropy": _measure_entropy,
        "wada": _measure_wada,
        "decay_rate": _measure_decay_rate,
        "uncertainty_exponent": _measure_exponent,
        "accuracy": _measure_accuracy,
        "maps": _keep_map,
    }
)
"""The measures of a sweep by name; each gives variables of its dataset."""

QUICK_CURVES = ("shares", "escape_times", "islands", "basin_entropy", "wada", "decay_rate")
"""Measures that are curves against the energy or a parameter and take little longer than the map."""

CURVES = (*QUICK_CURVES, "uncertainty_exponent")
"""All measures that are curves."""
