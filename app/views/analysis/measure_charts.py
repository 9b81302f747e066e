"""Charts for the measures of a map: uncertain pairs of starts with their power law, and survival with its decay laws."""

from __future__ import annotations

from typing import Any

import numpy as np
import panel as pn
from bokeh.models import ColumnDataSource, Line, Range1d, Scatter, Segment, Step
from bokeh.plotting import figure

from app.views.components.legends import legend
from app.views.components.plots import chart_hover, set_decades, set_range, square_figure
from app.views.components.texts import TextPane
from engine.results import DecayLaws, UncertaintyExponent
from plots.pictures.charts import law_curve
from plots.pictures.palette import LAW_COLOURS, LIGHT, MEASURED, SET_ASIDE, Entry

_PAIRS_TEXT = (
    "<b>@share{percent}</b> of the pairs have different fates<br>at a separation of @separation{number}@note<br>"
    "95 % interval @low{percent} to @high{percent}"
)
_SURVIVAL_TEXT = "<b>@share{percent}</b> of the starts are still inside<br>at t = @t{number}"
_NO_PAIRS: dict[str, list[Any]] = {name: [] for name in ("separation", "share", "low", "high", "colour", "note")}


class PairsChart:
    """Draws the uncertain share against separation with the fitted power law, while there is a result."""

    def __init__(self) -> None:
        self._x_range = Range1d(1e-10, 1.0)
        self._y_range = Range1d(1e-3, 1.0)
        self.pairs = ColumnDataSource(_NO_PAIRS, name="pairs")
        self._line = ColumnDataSource({"separation": [], "share": []}, name="exponent_line")
        self.view = pn.Column(margin=0, sizing_mode="stretch_width", visible=False)

    def show(self, fit: UncertaintyExponent | None) -> None:
        """Show the shares and the power law; None hides the chart."""
        self.view.visible = fit is not None
        if fit is None:
            self.pairs.data, self._line.data = _NO_PAIRS, {"separation": [], "share": []}
            return
        shares = fit.shares
        is_positive = shares > 0.0
        low, high = fit.share_intervals
        self.pairs.data = {
            "separation": fit.separations[is_positive], "share": shares[is_positive],
            "low": low[is_positive], "high": high[is_positive],
            "colour": np.where(fit.used[is_positive], MEASURED, SET_ASIDE),
            "note": np.where(fit.used[is_positive], "", "; not used for the exponent"),
        }  # fmt: skip
        fitted = fit.separations[fit.used] if np.isfinite(fit.exponent) else np.zeros(0)
        self._line.data = {"separation": fitted, "share": fit.amplitude * fitted**fit.exponent}
        set_range(self._x_range, 0.5 * float(fit.separations.min()), 2.0 * float(fit.separations.max()))
        if is_positive.any():
            set_decades(self._y_range, float(shares[is_positive].min()), float(shares.max()))

    def build(self) -> list[pn.viewable.Viewable]:
        """Fill the view with the chart and return the view."""
        self.view.objects = [pn.pane.Bokeh(self.draw(), margin=0)]
        return [self.view]

    def draw(self) -> figure:
        """Return a new Bokeh figure of the chart."""
        plot = square_figure(
            "uncertainty", "Uncertain pairs of starts", x_axis_label="separation", y_axis_label="uncertain share",
            x_range=self._x_range, y_range=self._y_range, x_axis_type="log", y_axis_type="log",
        )  # fmt: skip
        style: dict[str, Any] = {"x": "separation", "y": "share"}
        plot.add_glyph(self._line, Line(line_color=LAW_COLOURS["power law"], line_width=2, **style))
        plot.add_glyph(self.pairs, Segment(x0="separation", x1="separation", y0="low", y1="high", line_color="colour"))
        pairs = plot.add_glyph(self.pairs, Scatter(size=8, fill_color="colour", line_color=LIGHT.halo, **style))
        plot.add_tools(chart_hover(_PAIRS_TEXT, [pairs]))
        return plot


class SurvivalChart:
    """Draws the share of survivors S(t) with the fitted laws, once there are escapes."""

    def __init__(self) -> None:
        self._x_range = Range1d(1.0, 100.0)
        self._y_range = Range1d(1e-3, 1.0)
        self.steps = ColumnDataSource({"t": [], "share": []}, name="survival_steps")
        self._laws = {law: ColumnDataSource({"t": [], "share": []}, name=f"{law}_law") for law in LAW_COLOURS}
        self.view = pn.Column(margin=0, sizing_mode="stretch_width", visible=False)

    def show(self, laws: DecayLaws | None) -> None:
        """Show S(t) with the fitted laws; None, which stands for a map without a result yet, keeps the chart of the last map."""
        if laws is None:
            return
        self.steps.data = {"t": laws.times, "share": laws.survival}
        self.view.visible = laws.times.size > 0
        for law, fit in {"exponential": laws.exponential, "power law": laws.power_law}.items():
            t, share = law_curve(fit) if fit is not None else ([], [])
            self._laws[law].data = {"t": t, "share": share}
        is_positive = laws.survival > 0.0
        if np.count_nonzero(is_positive) > 1 and laws.times[is_positive][-1] > 0.0:
            latest = float(laws.times[is_positive][-1])
            set_range(self._x_range, min(1.0, 0.1 * latest), 1.5 * latest)
            set_decades(self._y_range, float(laws.survival[is_positive].min()), 1.0)

    def build(self) -> list[pn.viewable.Viewable]:
        """Fill the view with the chart and its legend, and return the view."""
        entries = [Entry("starts", MEASURED), *(Entry(law, colour) for law, colour in LAW_COLOURS.items())]
        self.view.objects = [pn.pane.Bokeh(self.draw(), margin=0), TextPane(legend(entries), margin=(0, 10))]
        return [self.view]

    def draw(self) -> figure:
        """Return a new Bokeh figure of the chart."""
        plot = square_figure(
            "survival", "Still inside", x_axis_label="t", y_axis_label="share of the starts",
            x_range=self._x_range, y_range=self._y_range, x_axis_type="log", y_axis_type="log",
        )  # fmt: skip
        plot.add_glyph(self.steps, Step(x="t", y="share", line_color=MEASURED, line_width=2, mode="after"))
        # The hover tool finds lines, but not steps, so an invisible line joins the points.
        line = plot.add_glyph(self.steps, Line(x="t", y="share", line_alpha=0.0))
        plot.add_tools(chart_hover(_SURVIVAL_TEXT, [line], mode="vline", line_policy="prev"))
        for law, source in self._laws.items():
            plot.add_glyph(source, Line(x="t", y="share", line_color=LAW_COLOURS[law], line_width=2, line_dash="dashed"))
        return plot
