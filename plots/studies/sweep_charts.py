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
    series = [
        Series(label, colour, curves.values, curves[name], Shape.JOINED_POINTS, curves.interval(name))
        for (name, label), colour in zip(measure.labels.items(), _NUMBER_COLOURS, strict=False)
    ]
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
    series = [
        Series(entry.label, entry.colour, curves.values, 100.0 * share, Shape.DASHED if _is_dashed(code) else Shape.LINE)
        for code, (entry, share) in enumerate(zip(entries, curves["share"].T, strict=True))
    ]
    return Chart(measure_frame(SHARES, curves.symbol), series, (_swept_limits(curves), (0.0, 100.0)))


def _is_dashed(code: int) -> bool:
    """Whether the curve of a fate is dashed: that of every second outcome. Code 0 stands for bounded starts."""
    return code > 0 and code % 2 == 0


def _swept_limits(curves: Sweep) -> Limits | None:
    requested = curves.dataset.attrs["requested"]
    return (requested[0], requested[-1]) if len(requested) > 1 else None
