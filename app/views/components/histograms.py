"""Histograms of the page, which HoloViews draws from `plots.pictures.charts.Chart`."""

from __future__ import annotations

import math
from typing import Any

import holoviews as hv
import numpy as np
import panel as pn
from bokeh.models import CustomJSTickFormatter

from app.browser.module_files import NUMBERS_MODULE
from app.views.components.plots import CHART_BORDERS, chart_hover, style_chart
from plots.browser.javascript import callback_code
from plots.pictures.charts import Chart, Frame, Series, Shape
from plots.pictures.holoviews_elements import axis_options, chart_elements
from plots.pictures.palette import MEASURED

_TICK = callback_code(NUMBERS_MODULE, "number(tick)")
# Largest number of labels of a logarithmic axis.
_MOST_TICKS = 5
# Width of a histogram over its height.
_ASPECT = 1.6


class HistogramView:
    """Draws a histogram from a chart, and draws it again for each new chart.

    Parameters
    ----------
    frame
        What the charts have in common.
    """

    def __init__(self, frame: Frame) -> None:
        self._frame = frame
        self._labels = CustomJSTickFormatter(code=_TICK)
        self._charts = hv.streams.Pipe(data=_empty_chart(frame))

    def show(self, chart: Chart) -> None:
        """Show a chart."""
        self._charts.send(chart)

    def build(self) -> pn.pane.Bokeh:
        """Return the pane with the histogram, whose figure stays the same when other tabs have been shown in between."""
        # Panel's pane for HoloViews would draw a new figure each time it returns to the page.
        drawing = hv.renderer("bokeh").get_plot(hv.DynamicMap(self._draw, streams=[self._charts]))
        return pn.pane.Bokeh(drawing.state, margin=0)

    def _draw(self, data: Chart) -> hv.Histogram:
        (element,) = chart_elements(data)
        ticks = {"xticks": _few_ticks(*data.axis_limits[0])} if "x" in self._frame.logarithmic else {}
        return element.opts(
            color=MEASURED,
            line_color=None,
            framewise=True,
            responsive=True,
            aspect=_ASPECT,
            title="",
            fontsize={"ticks": "12px", "labels": "12px"},
            toolbar=None,
            default_tools=[],
            hooks=[self._style],
            xformatter=self._labels,
            yformatter=self._labels,
            **axis_options(data),
            **ticks,
        )

    def _style(self, drawing: Any, _element: hv.Element) -> None:
        """Style a new figure as the other charts."""
        plot = drawing.state
        # HoloViews sets the borders again with each chart.
        plot.update(**CHART_BORDERS)
        if plot.name != self._frame.name:
            style_chart(plot, self._frame.name, self._frame.title, self._frame.help)
            bars = drawing.handles["glyph_renderer"]
            # HoloViews names these models after the values, but a name must be unique on the page.
            for model in (plot.x_range, plot.y_range, bars):
                model.name = None
            # The hover tool describes a bar also while the mouse is above its top.
            plot.add_tools(chart_hover(self._frame.text, [bars], mode="vline"))


def prepare() -> None:
    """Load the part of HoloViews that draws with Bokeh. Loading it on the event loop would delay other sessions."""
    hv.renderer("bokeh")


def _empty_chart(frame: Frame) -> Chart:
    """Return a chart before there are numbers, with one bar of height 0."""
    bar = Series("", MEASURED, np.array([1.5]), np.zeros(1), Shape.BARS, (np.array([1.0]), np.array([2.0])))
    return Chart(frame, [bar], ((1.0, 2.0), (0.0, 1.0)))


def _few_ticks(low: float, high: float) -> list[float]:
    """Return 1, 2 and 5 times the powers of ten from `low` to `high`; only the powers if these would be too many labels."""
    decades = [10.0**k for k in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)]
    fine_ticks, powers = ([m * ten for ten in decades for m in steps if low <= m * ten <= high] for steps in ((1, 2, 5), (1,)))
    return fine_ticks if len(fine_ticks) <= _MOST_TICKS else powers
