"""Make HoloViews elements of charts."""

from __future__ import annotations

from typing import Any

import holoviews as hv
import numpy as np

from plots.pictures.charts import ONLY_POINTS, Chart, Series, Shape


def chart_elements(chart: Chart) -> list[hv.Element]:
    """Return the HoloViews elements of the series of a chart and of their error bars."""
    x, y = chart.frame.labels
    elements: list[hv.Element] = []
    for series in chart.series:
        if series.shape is Shape.BARS:
            elements.append(_histogram(series, x, y))
            continue
        kind = hv.Scatter if series.shape in ONLY_POINTS else hv.Curve
        elements.append(kind(series.curve, x, y, label=series.label))
        if series.bars is not None:
            low, high = series.bars
            elements.append(hv.ErrorBars((series.x, series.y, series.y - low, high - series.y), x, [y, "below", "above"]))
    return elements


def axis_options(chart: Chart) -> dict[str, Any]:
    """Return the options that give elements the limits and logarithmic axes of a chart."""
    limits = {f"{axis}lim": ends for axis, ends in zip("xy", chart.axis_limits, strict=True)}
    return {**limits, **{f"log{axis}": True for axis in chart.frame.logarithmic}}


def _histogram(series: Series, x: str, y: str) -> hv.Histogram:
    assert series.bars is not None
    low, high = series.bars
    # HoloViews takes n + 1 edges of n adjacent bars.
    return hv.Histogram((np.append(low, high[-1:]), series.y), kdims=x, vdims=y)
