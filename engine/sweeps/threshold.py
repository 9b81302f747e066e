"""The energy, or the value of a parameter, at which a measure of the maps reaches a value."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.result import RecordedResult
from engine.foundations.validation import checked_count, checked_flag, checked_number, checked_t_max, checks_types, short_repr
from engine.foundations.wording import format_count
from engine.measures.table import MEASURES
from engine.sweeps.spec import SweepSpec
from engine.sweeps.sweep import Sweep, compute_sweep, share_names

# Width of the interval at which a search ends by default, as a share of the range of the request.
_TOLERANCE = 1e-3
# Largest legal number of maps.
_MOST_MAPS = 1000
# Half the width of a 95 % interval, in standard errors.
_ERRORS = 1.96
# Name of the column of a share before the name of its outcome.
_SHARE = "share_"


@dataclass(frozen=True, eq=False, repr=False)
class Threshold(RecordedResult):
    """Where a measure of the maps reaches a value, as returned by `find_where`; arrays are read-only.

    Attributes
    ----------
    quantity
        Name of the measure, a column of `Sweep.to_pandas`.
    wanted
        The value that is reached.
    axis
        "h", or the name of the parameter.
    low, high
        Ends of the interval: there the 95 % intervals of the measure lie on opposite sides of the wanted value.
    estimate
        The place where the straight line between the ends has the wanted value.
    starts
        Number of starts of all maps, including forbidden and outside starts.
    value
        (n,) energies, or values of the parameter, of the n maps, ascending.
    measured, measured_low, measured_high
        (n,) the measure of each map, and the ends of its 95 % interval; NaN where it is not defined.
    """

    quantity: str
    wanted: float
    axis: str
    low: float
    high: float
    estimate: float
    starts: int
    value: np.ndarray
    measured: np.ndarray
    measured_low: np.ndarray
    measured_high: np.ndarray
    row_dimension: ClassVar = "map"

    def describe(self) -> str:
        """Return the interval, the method and the cost, in a sentence."""
        place = f"{self.axis} = {self.estimate:.6g}, between {self.low:.6g} and {self.high:.6g}"
        maps = f"{self.value.size} maps of {self.starts // self.value.size} starts"
        return f"{self.quantity} is {self.wanted:.6g} at {place}, by bisection with {maps}."


@shows_progress("search")
@checks_types(spec=SweepSpec, quantity=str, execution=Execution)
def find_where(
    spec: SweepSpec,
    quantity: str,
    value: float,
    *,
    tolerance: float | None = None,
    most_maps: int = 40,
    last: bool = False,
    execution: Execution = DEFAULT_EXECUTION,
) -> Threshold:
    """Find the energy, or the value of a parameter, at which a measure of the maps reaches a value.

    Maps are computed at the values of the request. Between the first (or last) two neighbours whose measures are on opposite
    sides of the wanted value, the interval is bisected. A map counts on a side only if the 95 % interval of its measure excludes
    the wanted value; around maps that do not count, both parts are bisected. Thus the answer is not narrower than the statistical
    error of the maps allows; a higher `SweepSpec.resolution` makes it narrower. Several crossings between two values are not
    detected: a measure that rises and falls, such as the number of islands, needs more values in the request.

    Parameters
    ----------
    spec
        The request, with 2 to `most_maps` values of the energy or of a parameter. Its measures are not used.
    quantity
        Name of the measure: a number of `MEASURES`, such as "s_b", or the share of an outcome, such as "share_bounded".
    value
        The wanted value, finite.
    tolerance
        Width of the interval, above 0, at which the search ends; by default a thousandth of the range of the values.
    most_maps
        Largest number of maps, 2 to 1000.
    last
        Whether the last crossing is found, at the highest value; otherwise the first.
    execution
        How the computation runs.

    Returns
    -------
    The `Threshold`.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    ValueError
        If there is no such measure, or it does not reach the value between two values of the request, with their 95 % intervals.

    Examples
    --------
    >>> from escape_explorer import CASES, SweepSpec, find_where
    >>> spec = SweepSpec(CASES["I"], "x_px", (0.15, 0.2), resolution=(60, 60), t_max=1e3)
    >>> found = find_where(spec, "share_bounded", 0.1)
    >>> round(found.low, 3), round(found.high, 3), found.value.size
    (0.174, 0.177, 21)
    """
    wanted = checked_number("value", value)
    most = checked_count("most_maps", most_maps, 2, _MOST_MAPS)
    last = checked_flag("last", last)
    if len(spec.axes) > 1:
        raise ValueError(f"spec: has the axes {' and '.join(axis.key for axis in spec.axes)}; must have one axis")
    if not 2 <= len(spec.values) <= most:
        raise ValueError(f"spec: has {format_count(len(spec.values), 'value')}; must have from 2 to most_maps={most} values")
    width = _TOLERANCE * (spec.values[-1] - spec.values[0]) if tolerance is None else checked_t_max(tolerance, name="tolerance")
    measure = _measure_of(spec, quantity)
    request = replace(spec, measures=(measure,), refine=0)
    points = _measure(request, None, quantity, execution.part(0, most))
    while (middle := _next_value(points, wanted, width, last=last)) is not None and points.size < most:
        request = replace(request, values=(*points.values, middle))
        points = _measure(request, points.sweep, quantity, execution.part(points.size, most))
    execution.report(lambda: 1.0)
    return _threshold(spec, quantity, wanted, points, last=last)


@dataclass(frozen=True, eq=False)
class _Points:
    """A measure of the maps of a sweep with its 95 % intervals."""

    sweep: Sweep
    measured: np.ndarray
    low: np.ndarray
    high: np.ndarray

    @property
    def values(self) -> list[float]:
        values: list[float] = self.sweep.values.tolist()
        return values

    @property
    def size(self) -> int:
        return self.measured.size

    def bracket(self, wanted: float, *, last: bool) -> tuple[int, int]:
        """Return the indices of the first or last two maps on opposite sides of a value; maps between them are undecided."""
        sides = np.where(self.low > wanted, 1, np.where(self.high < wanted, -1, 0))
        decided = np.flatnonzero(sides)
        changes = np.flatnonzero(np.diff(sides[decided]))
        if not changes.size:
            lowest, highest = np.nanmin(self.low, initial=np.inf), np.nanmax(self.high, initial=-np.inf)
            raise ValueError(
                f"value={wanted!r}: is not reached between two values of {self.sweep.name}, where the measure is {lowest:.4g} to "
                f"{highest:.4g} with its 95 % intervals; must be between those of two maps"
            )
        change = changes[-1 if last else 0]
        return int(decided[change]), int(decided[change + 1])


def _measure_of(spec: SweepSpec, quantity: str) -> str:
    """Return the name of the measure to which a number or a share belongs."""
    measures = {number.name: measure.name for measure in MEASURES.values() for number in measure.quantities}
    measures |= {f"{_SHARE}{name}": "shares" for name in share_names(spec.outcomes)}
    if quantity not in measures:
        raise ValueError(f"quantity={short_repr(quantity)}: must be one of {', '.join(measures)}")
    return measures[quantity]


def _measure(request: SweepSpec, earlier: Sweep | None, quantity: str, execution: Execution) -> _Points:
    """Return the measures at all values of a request, of which some are known."""
    sweep = compute_sweep(request, earlier=earlier, execution=execution)
    columns = sweep.columns()
    return _Points(sweep, columns[quantity], *_interval(columns, quantity))


def _interval(columns: Mapping[str, np.ndarray], quantity: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the ends of the 95 % intervals of a column; the column itself if it has no error."""
    if quantity.startswith(_SHARE):
        outcome = quantity.removeprefix(_SHARE)
        return columns[f"share_low_{outcome}"], columns[f"share_high_{outcome}"]
    if f"{quantity}_low" in columns:
        return columns[f"{quantity}_low"], columns[f"{quantity}_high"]
    margin = _ERRORS * columns.get(f"{quantity}_error", np.zeros(1))
    return columns[quantity] - margin, columns[quantity] + margin


def _next_value(points: _Points, wanted: float, width: float, *, last: bool) -> float | None:
    """Return the middle of the widest gap between the ends of the bracket and the maps that are not decided; None at the end."""
    begin, end = points.bracket(wanted, last=last)
    values = points.values
    gaps = [(begin, begin + 1), (end - 1, end)]
    low, high = (values[index] for index in max(gaps, key=lambda gap: values[gap[1]] - values[gap[0]]))
    if high - low <= width:
        return None
    middle = 0.5 * (low + high)
    # Neighbouring floating-point numbers have no middle.
    return middle if low < middle < high else None


def _threshold(spec: SweepSpec, quantity: str, wanted: float, points: _Points, *, last: bool) -> Threshold:
    begin, end = points.bracket(wanted, last=last)
    low, high = points.values[begin], points.values[end]
    share = (wanted - points.measured[begin]) / (points.measured[end] - points.measured[begin])
    columns, rows = spec.resolution
    made_by = spec.potential.describe_run(
        plane=spec.plane.title, resolution=spec.resolution, t_max=spec.t_max, section=spec.section.text
    )
    return Threshold(
        quantity, wanted, spec.name, low, high, float(low + share * (high - low)), points.size * columns * rows,
        points.sweep.values, points.measured, points.low, points.high, made_by=made_by,
    )  # fmt: skip
