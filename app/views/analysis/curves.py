"""Curves of measures against the energy or a parameter. A click on a curve opens the map at the clicked value."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from html import escape
from typing import Any

import numpy as np
import panel as pn
from bokeh.events import Tap
from bokeh.models import Range1d

from app.state.view_state import ViewState
from app.views.components.charts import ChartView
from app.views.components.collapsible_section import InTurns, Later, at_once
from app.views.components.plots import moving_line
from app.views.components.texts import TextPane, plain_symbol
from app.views.components.widgets import FULL_HEIGHT, button, flex_row
from engine import Measure, System
from engine.foundations.wording import format_number, format_whole
from engine.results import Sweep
from engine.systems.parameters import symbol_of
from plots.pictures.charts import CURVE_PANELS, SHARES, Shape, measure_frame, sweep_charts

START = "Compute the curves"
"""Label of the button while nothing is computed."""

STOP = "Stop"
"""Label of the button while the curves are computed."""

SWEPT_VALUES = 25
"""Number of evenly spaced values of the energy or the parameter."""

REFINED_VALUES = 8
"""Number of further values, placed where the shares change most."""

_VALUES = SWEPT_VALUES + REFINED_VALUES
HINT = f"The shares and each measure at {_VALUES} values, closer together where the shares change: a minute or more."
"""Text while there are no curves."""

_SHARES_TEXT = "<b>$snap_y{number} %</b> of the interior starts: @label<br>at $snap_x{number}"
# Width of a chart over its height.
_ASPECT = 1.7


class CurvesView:
    """Draws the curves of all measures, in figures that share an axis of the energy or of a parameter.

    Parameters
    ----------
    state
        The view state.
    on_sweep
        Starts or stops the computation when the button is pressed.
    on_value
        Opens the map at the energy or parameter value of a clicked point.
    later
        Wraps a function that makes a figure, so that it runs in a later iteration of the event loop.
    """

    def __init__(
        self,
        state: ViewState,
        on_sweep: Callable[[], None],
        on_value: Callable[[float], None],
        later: Later = at_once,
    ) -> None:
        self._state, self._on_value = state, on_value
        self.shown: Sweep | None = None
        self.running = False
        self._start_time = 0.0
        self.button = button(START, on_sweep, width=180, align="end")
        self.against = pn.widgets.Select(label="Against", options={"h": "h"}, value="h", width=80)
        self.text = TextPane(HINT, name="sweep", margin=(4, 10), sizing_mode="stretch_width", css_classes=["whole-row"])
        self._x_range = Range1d(0.0, 1.0)
        options: dict[str, Any] = {"x_range": self._x_range, "aspect_ratio": _ASPECT}
        self._charts = {
            SHARES.name: ChartView(measure_frame(SHARES), _SHARES_TEXT, Shape.LINE, **options),
            **{each.name: ChartView(measure_frame(each), _panel_text(each), **options) for each in CURVE_PANELS},
        }
        self._mark_line = moving_line("height", location=0.0, line_dash="dotted")
        self._charts_in_turns = InTurns([partial(self._build_chart, chart) for chart in self._charts.values()], self._add, later)
        self._plots = pn.Column(sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT, css_classes=["curves"], visible=False)
        state.follow(self._follow_system, "system")
        state.follow(lambda energy: self._mark(), "energy")
        state.param.watch(lambda event: self._redraw(), "palette")

    def _redraw(self) -> None:
        if self.shown is not None:
            self.show(self.shown)

    def _follow_system(self, system: System) -> None:
        """Remove the curves of the previous system, and offer the parameters of the new system."""
        if self.shown is not None:
            self.show(None)
        self.against.options = {"h": "h"} | {plain_symbol(symbol_of(name)): name for name in system.parameter_names}

    def _mark(self) -> None:
        """Mark the energy of the view, or the value of the parameter in the system of the view."""
        name = "h" if self.shown is None else self.shown.name
        self._mark_line.location = self._state.energy if name == "h" else self._state.system.value_of(name)

    def show_running(self, running: bool) -> None:
        """Label the button with its next action."""
        if running and not self.running:
            self._start_time = time.monotonic()
        self.running = running
        self.button.label = STOP if running else START

    def show(self, curves: Sweep | None) -> None:
        """Draw curves of the system in view; None removes the curves."""
        self.shown = curves
        self._plots.visible = curves is not None
        if curves is None:
            self.text.object = HINT
            return
        self._charts_in_turns.begin()
        for chart in sweep_charts(curves, self._state.colours):
            self._charts[chart.frame.name].show(chart)
        self._mark()
        self.text.object = _progress(curves, time.monotonic() - self._start_time)

    def say(self, sentence: str) -> None:
        """Show why there are no curves."""
        self.text.object = escape(sentence)

    def open_near(self, value: float) -> None:
        """Open the map at the computed value nearest to a value."""
        if self.shown is not None and self.shown.values.size:
            values = self.shown.values
            self._on_value(float(values[np.argmin(np.abs(values - value))]))

    def build(self) -> list[pn.viewable.Viewable]:
        """Return the button, the text, and the container of the figures. The first curves add the figures."""
        row = flex_row(self.against, self.button, gap="8px", align="end")
        row.css_classes = ["whole-row"]
        return [row, self.text, self._plots]

    def _build_chart(self, chart: ChartView) -> list[pn.viewable.Viewable]:
        view = chart.build({Tap: lambda event: self.open_near(event.x)})
        assert chart.plot is not None
        chart.plot.add_layout(self._mark_line)
        return [view]

    def _add(self, plots: Sequence[pn.viewable.Viewable]) -> None:
        self._plots.objects = [*self._plots.objects, *plots]


def _panel_text(measure: Measure) -> str:
    """Return the hover text of a measure's points."""
    bars = f", {measure.bars} @low{{number}} to @high{{number}}" if measure.bars else ""
    return f"{measure.title}, @label: <b>@y{{number}}</b>{bars}<br>at @x{{number}}"


def _progress(curves: Sweep, seconds: float) -> str:
    """Return what the curves show. For incomplete curves, estimate the time left from the past `seconds`."""
    request = curves.dataset.attrs
    done = curves.values.size
    total = request["count"]
    energy = f" at h = {format_number(request['energy'], 6)}" if request["along"] else ""
    values = f"values of {curves.symbol} on {request['plane']}{energy}"
    if curves.complete:
        return f"{total} {values}. Click a curve to open the map there."
    time_left = f" about {format_whole(seconds * (total - done) / done)} s left" if done else ""
    return f"{done} of {total} {values} …{time_left}"
