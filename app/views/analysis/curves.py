"""Curves against energy or a parameter: shares, islands, measures of the basins, escapes; a click opens the map of a value."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from html import escape

import numpy as np
import panel as pn
from bokeh.events import Tap
from bokeh.models import ColumnDataSource, Line, MultiLine, Range1d, Scatter, Segment, Span
from bokeh.plotting import figure

from app.views.components.chart_hover import chart_hover
from app.views.components.flex_row import FULL_HEIGHT, flex_row
from app.views.components.legends import legend
from app.views.components.plots import FigurePane, set_decades, set_range, square_figure
from app.views.components.texts import TextPane
from app.views.components.widgets import button
from engine import Curves, Outcome, System
from engine.potentials.parameters import symbol_of
from plots.palette import LAW_COLOURS, MARK_EDGE, MEASURED, PAPER, THRESHOLD, Entry, Palette

TITLES = {
    "shares": "Shares of the interior starts",
    "entropies": "Basin entropy",
    "exponents": "Uncertainty exponent",
    "escapes": "Escape time",
    "islands": "Area of the bounded starts",
    "decays": "Decay rate",
    "boundaries": "Distance of the boundaries",
}
START, STOP = "Compute the curves", "Stop"
SWEPT_VALUES, REFINED_VALUES = 25, 8
"""Energies, or values of a parameter, of the curves, and further ones where the shares change most."""

HINT = (
    "Shares, basin entropy, uncertainty exponent, escape times and their decay, islands and Wada distance at "
    f"{SWEPT_VALUES + REFINED_VALUES} values, closer together where the shares change: a minute or more."
)
_SECOND = LAW_COLOURS["exponential"]
_NO_SHARES: dict[str, list[object]] = {"xs": [], "ys": [], "colour": [], "dash": [], "fate": []}
_DASH = "8 8"
# Least height of the axes of areas and of decay rates.
_SMALLEST_AREA = _SMALLEST_RATE = 1e-6
# Of the vertical axes before there are curves; that of the entropies has room for the line at ln 2.
_FIRST_RANGE = {"entropies": (0.0, 0.75), "escapes": (1.0, 100.0), "islands": (0.0, 1.0), "boundaries": (0.0, 10.0)}
_SHARES_TEXT = "<b>$snap_y{custom}</b> of the interior starts @fate<br>at $snap_x{custom}"
_WORDS = {
    "s_b": "basin entropy <b>S_b = @s_b{custom}</b>",
    "s_bb": "entropy of the boundary boxes <b>S_bb = @s_bb{custom}</b>",
    "exponent": "<b>α = @exponent{custom}</b>, 95 % interval @exponent_low{custom} to @exponent_high{custom}",
    "mean_escape_time": "mean escape time <b>@mean_escape_time{custom}</b>",
    "median_escape_time": "median escape time <b>@median_escape_time{custom}</b>",
    "bounded_area": "bounded starts cover <b>@bounded_area{custom}</b> of the slice, in @islands islands",
    "decay_rate": "<b>κ = @decay_rate{custom}</b>, 95 % interval @decay_low{custom} to @decay_high{custom}",
    "wada_distance": "99 % of the boundary pixels lie within <b>@wada_distance{custom} pixels</b> of all basins",
    "largest_island": "area of the largest island <b>@largest_island{custom}</b>",
}
_COLUMNS = (
    "value", "s_b", "s_bb", "exponent", "exponent_low", "exponent_high", "mean_escape_time", "median_escape_time",
    "bounded_area", "islands", "largest_island", "decay_rate", "decay_low", "decay_high", "wada_distance",
)  # fmt: skip


class CurvesView:
    """Figures with one axis of energies, or of a parameter.

    Parameters
    ----------
    on_sweep
        Called when the button is pressed.
    on_value
        Called with the energy, or the value of the parameter, of the point clicked.
    """

    def __init__(self, on_sweep: Callable[[], None], on_value: Callable[[float], None]) -> None:
        self._palette = PAPER
        self._on_value = on_value
        self.shown: Curves | None = None
        self.running = False
        self.button = button(START, on_sweep, width=180, align="end")
        self.against = pn.widgets.Select(label="Against", options={"h": "h"}, value="h", width=80)
        self.text = TextPane(HINT, name="sweep", margin=(4, 10), sizing_mode="stretch_width", css_classes=["whole-row"])
        self._axis = Range1d(0.0, 1.0)
        # Automatic ranges would warn in the browser as long as there are no numbers.
        self._values = {name: Range1d(*_FIRST_RANGE.get(name, (0.0, 1.0))) for name in TITLES}
        self.points = ColumnDataSource({name: [] for name in _COLUMNS}, name="curve_points")
        self._shares = ColumnDataSource(_NO_SHARES, name="share_curves")
        self._energy = 0.0
        self._here = Span(location=0.0, dimension="height", line_color=MARK_EDGE, line_dash="dotted")
        self._legend = TextPane(margin=(0, 10))
        self._figures: list[figure] = []
        self._plots = pn.Column(sizing_mode="stretch_width", margin=0, styles=FULL_HEIGHT, css_classes=["curves"], visible=False)

    def follow_system(self, system: System) -> None:
        """Offer the parameters of a system."""
        self.against.options = {"h": "h"} | {symbol_of(name): name for name in system.parameter_names}

    def follow_energy(self, energy: float) -> None:
        """Mark the energy in view."""
        self._energy = energy
        self._mark()

    def _mark(self) -> None:
        """Mark the energy in view, or the system's own value of the parameter."""
        along = None if self.shown is None else self.shown.spec.along
        self._here.location = self._energy if along is None else along.system.value_of(along.key)

    def show_running(self, running: bool) -> None:
        """Label the button with what it does next."""
        self.running = running
        self.button.label = STOP if running else START

    def show(self, curves: Curves | None) -> None:
        """Draw the curves; None removes them."""
        self.shown = curves
        if curves is not None and not self._plots.objects:
            self._plots.objects = self._build_plots()
        self._plots.visible = curves is not None
        if curves is None:
            self.points.data, self._shares.data = {name: [] for name in _COLUMNS}, _NO_SHARES
            self.text.object = HINT
            return
        self.points.data = {name: curves.values if name == "value" else curves.curve(name) for name in _COLUMNS}
        shares = curves.shares.T
        entries, outcomes = self._entries(curves.spec.outcomes), curves.spec.outcomes
        # Symmetric channels have equal shares: dashed curves, drawn last, leave the solid ones visible.
        order = sorted(range(len(shares)), key=_is_dashed)
        self._shares.data = {
            "xs": [curves.values] * len(shares),
            "ys": [shares[k] for k in order],
            "colour": [entries[k].colour for k in order],
            "dash": [_DASH if _is_dashed(k) else "solid" for k in order],
            "fate": [outcomes[k - 1].action if k else "are bounded" for k in order],
        }
        swept = curves.spec.values
        if len(swept) > 1:
            set_range(self._axis, swept[0], swept[-1])
        for plot in self._figures:
            plot.xaxis.axis_label = curves.spec.symbol
        self._mark()
        self._scale_values(curves)
        self.text.object = _progress(curves)
        self._legend.object = legend(entries)

    def _scale_values(self, curves: Curves) -> None:
        """Fit the ranges of all but the shares and the exponents."""
        entropies = _finite(curves, "s_b", "s_bb")
        set_range(self._values["entropies"], 0.0, 1.05 * max([*entropies, _FIRST_RANGE["entropies"][1]]))
        set_range(self._values["islands"], 0.0, 1.05 * max([*_finite(curves, "bounded_area"), _SMALLEST_AREA]))
        set_range(self._values["decays"], 0.0, 1.05 * max([*_finite(curves, "decay_high"), _SMALLEST_RATE]))
        distances = _finite(curves, "wada_distance")
        set_range(self._values["boundaries"], 0.0, 1.05 * max([*distances, _FIRST_RANGE["boundaries"][1]]))
        times = _finite(curves, "mean_escape_time", "median_escape_time")
        if times.size:
            set_decades(self._values["escapes"], float(times.min()), float(times.max()))

    def say(self, sentence: str) -> None:
        """Show why there are no curves."""
        self.text.object = escape(sentence)

    def open_near(self, value: float) -> None:
        """Open the map of the measured value next to this one."""
        values = np.asarray(self.points.data["value"])
        if values.size:
            self._on_value(float(values[np.argmin(np.abs(values - value))]))

    def set_palette(self, palette: Palette) -> None:
        """Colours of the outcomes."""
        self._palette = palette
        if self.shown is not None:
            self.show(self.shown)

    def _entries(self, outcomes: Sequence[Outcome]) -> list[Entry]:
        return [Entry("bounded", self._palette.bounded), *self._palette.end_entries(outcomes)]

    def build(self) -> list[pn.viewable.Viewable]:
        """Make the button and the place of the plots, which are made with the first curves."""
        row = flex_row(self.against, self.button, gap="8px", align="end")
        row.css_classes = ["whole-row"]
        return [row, self.text, self._plots]

    def _build_plots(self) -> list[pn.viewable.Viewable]:
        below = {
            "shares": [self._legend],
            "entropies": [_key({"S_b": MEASURED, "S_bb": _SECOND, "ln 2": THRESHOLD})],
            "exponents": [_key({"α with its 95 % interval": MEASURED})],
            "escapes": [_key({"mean": MEASURED, "median": _SECOND})],
            "islands": [_key({"all islands": MEASURED, "the largest": _SECOND})],
            "decays": [_key({"κ with its 95 % interval": MEASURED})],
            "boundaries": [_key({"pixels, of 99 % of the boundary": MEASURED})],
        }
        return [
            pn.Column(
                FigurePane(plot, {Tap: lambda event: self.open_near(event.x)}),
                *below[name],
                margin=0,
                sizing_mode="stretch_width",
            )
            for name, plot in self._draw().items()
        ]

    def _draw(self) -> dict[str, figure]:
        logarithmic = {"escapes": {"y_axis_type": "log"}}
        figures = {
            name: square_figure(
                name, title, x_axis_label=" ", x_range=self._axis, y_range=self._values[name], **logarithmic.get(name, {})
            )
            for name, title in TITLES.items()
        }
        self._figures = list(figures.values())
        for plot in self._figures:
            plot.add_layout(self._here)
        shares = figures["shares"].add_glyph(self._shares, MultiLine(line_color="colour", line_width=2, line_dash="dash"))
        values = {"$snap_x": "number", "$snap_y": "percent"}
        figures["shares"].add_tools(chart_hover(_SHARES_TEXT, values, [shares], line_policy="nearest"))
        drawn = {
            "entropies": {"s_b": MEASURED, "s_bb": _SECOND},
            "exponents": {"exponent": MEASURED},
            "escapes": {"mean_escape_time": MEASURED, "median_escape_time": _SECOND},
            "islands": {"bounded_area": MEASURED, "largest_island": _SECOND},
            "decays": {"decay_rate": MEASURED},
            "boundaries": {"wada_distance": MEASURED},
        }
        for name, curves in drawn.items():
            for column, colour in curves.items():
                _draw_curve(figures[name], self.points, column, colour)
        for name, column in (("exponents", "exponent"), ("decays", "decay")):
            ends = {"x0": "value", "x1": "value", "y0": f"{column}_low", "y1": f"{column}_high"}
            figures[name].add_glyph(self.points, Segment(**ends, line_color=MEASURED, line_alpha=0.6))
        ln2 = Span(location=float(np.log(2.0)), dimension="width", line_color=THRESHOLD, line_dash="dashed", line_width=1.5)
        figures["entropies"].add_layout(ln2)
        return figures


def _draw_curve(plot: figure, source: ColumnDataSource, column: str, colour: str) -> None:
    plot.add_glyph(source, Line(x="value", y=column, line_color=colour, line_width=2))
    points = plot.add_glyph(source, Scatter(x="value", y=column, size=5, fill_color=colour, line_color=colour))
    ends = (f"@{name}_{end}" for name in ("exponent", "decay") for end in ("low", "high"))
    values = dict.fromkeys(("@value", f"@{column}", *ends), "number")
    plot.add_tools(chart_hover(f"{_WORDS[column]}<br>at @value{{custom}}", values, [points], mode="vline"))


def _finite(curves: Curves, *columns: str) -> np.ndarray:
    """The numbers in some columns, without NaN."""
    values = np.concatenate([curves.curve(column) for column in columns])
    return values[np.isfinite(values)]


def _is_dashed(code: int) -> bool:
    """Whether the curve of an outcome is dashed; 0 stands for bounded starts."""
    return code > 0 and code % 2 == 0


def _key(entries: dict[str, str]) -> pn.viewable.Viewable:
    return TextPane(legend(Entry(label, colour) for label, colour in entries.items()), margin=(0, 10))


def _progress(curves: Curves) -> str:
    done, total, spec = len(curves.points), curves.spec.count, curves.spec
    where = f"values of {spec.symbol} on {spec.plane.title}" + ("" if spec.energy is None else f" at h = {spec.energy:.6g}")
    if curves.complete:
        return f"{total} {where}. Click a curve to open the map there."
    return f"{done} of {total} {where} …"
