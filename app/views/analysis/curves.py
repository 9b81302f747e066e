"""Curves of measures against the energy or a parameter. A click on a curve opens the map at this value."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from html import escape
from typing import Any

import numpy as np
import panel as pn
from bokeh.events import Tap
from bokeh.models import ColumnDataSource, Line, MultiLine, Range1d, Scatter, Segment, Span
from bokeh.plotting import figure

from app.state.view_state import ViewState
from app.views.components.in_turns import InTurns, Later
from app.views.components.legends import legend
from app.views.components.plots import FigurePane, chart_hover, set_decades, set_range, square_figure
from app.views.components.texts import TextPane, plain_symbol
from app.views.components.widgets import FULL_HEIGHT, button, flex_row
from engine import Measure, Outcome, System
from engine.foundations.wording import format_number, format_whole
from engine.results import Sweep
from engine.systems.parameters import symbol_of
from plots.pictures.charts import CURVE_PANELS, NUMBER_COLOURS, SHARES, find_numbers
from plots.pictures.palette import MARK_EDGE, THRESHOLD, Entry

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

_NO_SHARES: dict[str, list[object]] = {"xs": [], "ys": [], "colour": [], "dash": [], "fate": []}
_DASH = "8 8"
# Range of a logarithmic axis before there are numbers.
_FIRST_DECADES = 1.0, 100.0
_SHARES_TEXT = "<b>$snap_y{percent}</b> of the interior starts @fate<br>at $snap_x{number}"
_NAMES = tuple(name for panel in CURVE_PANELS for name in panel.labels)
_NO_POINTS: dict[str, list[float]] = {"value": [], **{f"{name}{end}": [] for name in _NAMES for end in ("", "_low", "_high")}}
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
        later: Later = lambda call: call,
    ) -> None:
        self._state, self._on_value = state, on_value
        self.shown: Sweep | None = None
        self.running = False
        self._began = 0.0
        self.button = button(START, on_sweep, width=180, align="end")
        self.against = pn.widgets.Select(label="Against", options={"h": "h"}, value="h", width=80)
        self.text = TextPane(HINT, name="sweep", margin=(4, 10), sizing_mode="stretch_width", css_classes=["whole-row"])
        self._x_range = Range1d(0.0, 1.0)
        # Automatic ranges would cause warnings in the browser until there are numbers.
        self._y_ranges = {
            panel.name: Range1d(*(_FIRST_DECADES if panel.curve.logarithmic else (0.0, panel.curve.least_top)))
            for panel in CURVE_PANELS
        }
        self.points = ColumnDataSource(_NO_POINTS, name="curve_points")
        self._shares = ColumnDataSource(_NO_SHARES, name="share_curves")
        self._mark_line = Span(location=0.0, dimension="height", line_color=MARK_EDGE, line_dash="dotted")
        self._legend = TextPane(margin=(0, 10))
        self._figures: list[figure] = []
        self._panels_in_turns = InTurns(
            [self._build_shares, *(partial(self._build_panel, each) for each in CURVE_PANELS)], self._add, later
        )
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
            self._began = time.monotonic()
        self.running = running
        self.button.label = STOP if running else START

    def show(self, curves: Sweep | None) -> None:
        """Draw curves of the system in view; None removes the curves."""
        self.shown = curves
        if curves is not None:
            self._panels_in_turns.begin()
        self._plots.visible = curves is not None
        if curves is None:
            self.points.data, self._shares.data = _NO_POINTS, _NO_SHARES
            self.text.object = HINT
            return
        points = {"value": curves.values}
        for name in _NAMES:
            points[name] = curves[name]
            points[f"{name}_low"], points[f"{name}_high"] = curves.interval(name)
        self.points.data = points
        shares, outcomes = curves["share"].T, curves.outcomes
        entries = self._entries(outcomes)
        # Symmetric exits have equal shares: dashed curves, drawn last, leave the solid curves below visible.
        order = sorted(range(len(shares)), key=_is_dashed)
        self._shares.data = {
            "xs": [curves.values] * len(shares),
            "ys": [shares[k] for k in order],
            "colour": [entries[k].colour for k in order],
            "dash": [_DASH if _is_dashed(k) else "solid" for k in order],
            "fate": [outcomes[k - 1].action if k else "are bounded" for k in order],
        }
        requested = curves.dataset.attrs["requested"]
        if len(requested) > 1:
            set_range(self._x_range, requested[0], requested[-1])
        self._name_axes()
        self._mark()
        self._scale_values(curves)
        self.text.object = _progress(curves, time.monotonic() - self._began)
        self._legend.object = legend(entries)

    def _scale_values(self, curves: Sweep) -> None:
        """Fit the vertical ranges to the numbers, except the fixed range of the shares."""
        for panel in CURVE_PANELS:
            numbers = find_numbers(panel, curves)
            y_range = self._y_ranges[panel.name]
            if not panel.curve.logarithmic:
                set_range(y_range, 0.0, 1.05 * max([*numbers, panel.curve.least_top]))
            elif numbers.size:
                set_decades(y_range, float(numbers.min()), float(numbers.max()))

    def say(self, sentence: str) -> None:
        """Show why there are no curves."""
        self.text.object = escape(sentence)

    def open_near(self, value: float) -> None:
        """Open the map at the computed value nearest to a value."""
        values = np.asarray(self.points.data["value"])
        if values.size:
            self._on_value(float(values[np.argmin(np.abs(values - value))]))

    def _entries(self, outcomes: Sequence[Outcome]) -> list[Entry]:
        palette = self._state.colours
        return [Entry("bounded", palette.bounded), *palette.end_entries(outcomes)]

    def build(self) -> list[pn.viewable.Viewable]:
        """Return the button, the text, and the container of the figures. The first curves add the figures."""
        row = flex_row(self.against, self.button, gap="8px", align="end")
        row.css_classes = ["whole-row"]
        return [row, self.text, self._plots]

    def _build_shares(self) -> list[pn.viewable.Viewable]:
        return self._with_key(self._draw_shares(), self._legend)

    def _build_panel(self, panel: Measure) -> list[pn.viewable.Viewable]:
        return self._with_key(self._draw_panel(panel), _make_key(panel))

    def _with_key(self, plot: figure, key: pn.viewable.Viewable) -> list[pn.viewable.Viewable]:
        plot.add_layout(self._mark_line)
        self._figures.append(plot)
        self._name_axes()
        pane = FigurePane(plot, {Tap: lambda event: self.open_near(event.x)})
        return [pn.Column(pane, key, margin=0, sizing_mode="stretch_width")]

    def _add(self, plots: Sequence[pn.viewable.Viewable]) -> None:
        self._plots.objects = [*self._plots.objects, *plots]

    def _name_axes(self) -> None:
        if self.shown is not None:
            for plot in self._figures:
                plot.xaxis.axis_label = self.shown.symbol

    def _chart(self, name: str, title: str, **options: Any) -> figure:
        return square_figure(name, title, aspect_ratio=_ASPECT, x_axis_label=" ", x_range=self._x_range, **options)

    def _draw_shares(self) -> figure:
        plot = self._chart(SHARES.name, SHARES.title, y_range=Range1d(0.0, 1.0))
        shares = plot.add_glyph(self._shares, MultiLine(line_color="colour", line_width=2, line_dash="dash"))
        plot.add_tools(chart_hover(_SHARES_TEXT, [shares], line_policy="nearest"))
        return plot

    def _draw_panel(self, panel: Measure) -> figure:
        scale = {"y_axis_type": "log"} if panel.curve.logarithmic else {}
        plot = self._chart(panel.name, panel.title, y_range=self._y_ranges[panel.name], **scale)
        for (name, label), colour in zip(panel.labels.items(), NUMBER_COLOURS, strict=False):
            low, high = f"{name}_low", f"{name}_high"
            plot.add_glyph(self.points, Line(x="value", y=name, line_color=colour, line_width=2))
            plot.add_glyph(self.points, Segment(x0="value", x1="value", y0=low, y1=high, line_color=colour, line_alpha=0.6))
            marks = plot.add_glyph(self.points, Scatter(x="value", y=name, size=5, fill_color=colour, line_color=colour))
            bars = f", {panel.bars} @{low}{{number}} to @{high}{{number}}" if panel.bars else ""
            text = f"{panel.title}, {label}: <b>@{name}{{number}}</b>{bars}<br>at @value{{number}}"
            plot.add_tools(chart_hover(text, [marks], mode="vline"))
        if panel.curve.level is not None:
            line: dict[str, Any] = {"line_color": THRESHOLD, "line_dash": "dashed", "line_width": 1.5}
            plot.add_layout(Span(location=panel.curve.level[0], dimension="width", **line))
        return plot


def _is_dashed(code: int) -> bool:
    """Whether the curve of a fate is dashed; code 0 stands for bounded starts."""
    return code > 0 and code % 2 == 0


def _make_key(panel: Measure) -> pn.viewable.Viewable:
    bars = f" with its {panel.bars}" if panel.bars else ""
    entries = [Entry(label + bars, colour) for label, colour in zip(panel.labels.values(), NUMBER_COLOURS, strict=False)]
    if panel.curve.level is not None:
        entries.append(Entry(panel.curve.level[1], THRESHOLD))
    return TextPane(legend(entries), margin=(0, 10))


def _progress(curves: Sweep, seconds: float) -> str:
    """Return what the curves show. For incomplete curves, estimate the time left from the past `seconds`."""
    request = curves.dataset.attrs
    done = curves.values.size
    total = request["count"]
    energy = f" at h = {format_number(request['energy'], 6)}" if request["along"] else ""
    where = f"values of {curves.symbol} on {request['plane']}{energy}"
    if curves.complete:
        return f"{total} {where}. Click a curve to open the map there."
    time_left = f" about {format_whole(seconds * (total - done) / done)} s left" if done else ""
    return f"{done} of {total} {where} …{time_left}"
