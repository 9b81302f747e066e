"""Charts of the measures of a sweep against the energy or a parameter."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine import MEASURES, Measure
from engine.results import Sweep
from plots.pictures.charts import Chart, Frame, Limits, Series, Shape
from plots.pictures.histories import logarithmic_limits
from plots.pictures.palette import LAW_COLOURS, MEASURED, Entry, Palette

SHARES = MEASURES["shares"]
"""The measure of a sweep with a curve for each outcome."""

CURVE_PANELS = tuple(measure for measure in MEASURES.values() if measure.labels)
"""The other measures of a sweep that have a chart, in order."""

# Colours of the numbers of a measure, in order.
_NUMBER_COLOURS = MEASURED, LAW_COLOURS["exponential"]


def measure_frame(measure: Measure[Any], symbol: str = "") -> Frame:
    """Return the frame of a measure of sweeps along an axis with this symbol."""
    curve, is_shares = measure.curve, measure is SHARES
    bars = f", {measure.bars} @low{{number}} to @high{{number}}" if measure.bars else ""
    numbers = f"{measure.title}, @label: <b>@y{{number}}</b>{bars}<br>at @x{{number}}"
    shares = "<b>$snap_y{number} %</b> of the interior starts: @label<br>at $snap_x{number}"
    return Frame(
        measure.name,
        measure.title,
        (symbol, curve.axis),
        measure.help,
        shares if is_shares else numbers,
        Shape.LINE if is_shares else Shape.POINTS,
        "y" if curve.logarithmic else "",
        curve.level,
    )


def sweep_charts(curves: Sweep, palette: Palette) -> list[Chart]:
    """Return the charts of the measures that a sweep contains, the shares first; empty before the first value."""
    if not curves.values.size:
        return []
    shares = [_shares_chart(curves, palette)] if "share" in curves.dataset else []
    measures = (measure for measure in CURVE_PANELS if set(measure.labels) <= set(curves.dataset))
    return [*shares, *(_measure_chart(measure, curves) for measure in measures)]


def _measure_chart(measure: Measure[Any], curves: Sweep) -> Chart:
    """Return the chart of the numbers of a measure with their error bars, against the energy or a parameter."""
    gaps, series = _find_gaps(curves), []
    for (name, label), colour in zip(measure.labels.items(), _NUMBER_COLOURS, strict=False):
        columns = curves.values, curves[name], *curves.interval(name)
        x, y, low, high = (np.insert(column, gaps, np.nan) for column in columns)
        series.append(Series(label, colour, x, y, Shape.JOINED_POINTS, (low, high)))
    numbers = np.concatenate([values for one in series for values in (one.y, *(one.bars or ()))])
    numbers = numbers[np.isfinite(numbers)]
    limits: Limits | None = None
    if numbers.size and measure.curve.logarithmic:
        limits = logarithmic_limits(float(numbers.min()), float(numbers.max()))
    elif numbers.size:
        limits = 0.0, 1.05 * max([*numbers, measure.curve.least_top])
    return Chart(measure_frame(measure, curves.symbol), series, (_swept_limits(curves), limits))


def _shares_chart(curves: Sweep, palette: Palette) -> Chart:
    """Return the chart of the percentages of bounded starts and of each outcome."""
    entries = [Entry("bounded", palette.bounded), *palette.end_entries(curves.outcomes)]
    # Symmetric exits have equal shares: dashed curves leave the solid curves below visible.
    gaps = _find_gaps(curves)
    x, shares = np.insert(curves.values, gaps, np.nan), np.insert(100.0 * curves["share"], gaps, np.nan, axis=0).T
    series = [
        Series(entry.label, entry.colour, x, share, Shape.DASHED if _is_dashed(code) else Shape.LINE)
        for code, (entry, share) in enumerate(zip(entries, shares, strict=True))
    ]
    alone = _without_neighbours(curves.values.size, gaps)
    points = [
        Series("", entry.colour, curves.values[alone], 100.0 * share[alone], Shape.POINTS)
        for entry, share in zip(entries, curves["share"].T, strict=True)
    ]
    return Chart(measure_frame(SHARES, curves.symbol), series + points, (_swept_limits(curves), (0.0, 100.0)))


def _find_gaps(curves: Sweep) -> np.ndarray:
    """Return the indices of the values before which requested values are still missing, where no line is drawn."""
    requested, values = np.array(curves.dataset.attrs["requested"]), curves.values
    before, after = np.searchsorted(requested, values[:-1], "right"), np.searchsorted(requested, values[1:], "left")
    return np.flatnonzero(after > before) + 1


def _without_neighbours(count: int, gaps: np.ndarray) -> np.ndarray:
    """Return the indices of those of `count` values that have no line to another value."""
    edges = np.array([0, *gaps, count])
    return edges[:-1][np.diff(edges) == 1]


def _is_dashed(code: int) -> bool:
    """Whether the curve of a fate is dashed: that of every second outcome. Code 0 stands for bounded starts."""
    return code > 0 and code % 2 == 0


def _swept_limits(curves: Sweep) -> Limits | None:
    requested = curves.dataset.attrs["requested"]
    return (requested[0], requested[-1]) if len(requested) > 1 else None
