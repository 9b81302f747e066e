"""Measures of the basins: basin entropy, merging (Wada), uncertainty exponent, and the law by which orbits escape."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import Any

import numpy as np
import panel as pn
from bokeh.models import ColumnDataSource, Line, Range1d, Scatter, Segment, Step
from bokeh.plotting import figure

from app.state.glossary import with_terms
from app.views.components.legends import legend
from app.views.components.plots import chart_hover, set_decades, set_range, square_figure
from app.views.components.texts import TextPane
from app.views.components.widgets import COUNT_WHOLE, button, copy_button, number_rows
from engine import DecayLaws, EscapeFlux, Result, UncertaintyExponent, Window
from engine.jobs.map_jobs import BasinMeasures
from engine.measures.decay_laws import LawFit
from plots.pictures.palette import LAW_COLOURS, LIGHT, MEASURED, SET_ASIDE, Entry

_LAW_POINTS = 200
_PAIRS_TEXT = (
    "<b>@share{percent}</b> of the pairs have different fates<br>at a separation of @separation{number}@note<br>"
    "95 % interval @low{percent} to @high{percent}"
)
_SURVIVAL_TEXT = "<b>@share{percent}</b> of the starts are still inside<br>at t = @t{number}"
_NO_PAIRS: dict[str, list[Any]] = {name: [] for name in ("separation", "share", "low", "high", "colour", "note")}
# Measures that do not count the starts of a box.
_NOT_OF_BOX = ("Uncertainty exponent", "Flux")
_MEASURING = "Comparing pairs of starts …"


class BasinMeasuresView:
    """Texts, the uncertain share against separation, and the survival.

    Parameters
    ----------
    on_exponent
        Called to measure the exponent.
    on_copy
        Called with the numbers as tab-separated text.
    on_whole
        Called to remove the box.
    """

    def __init__(self, on_exponent: Callable[[], None], on_copy: Callable[[str], None], on_whole: Callable[[], None]) -> None:
        self.button = button("Measure the uncertainty exponent", on_exponent)
        self.whole = button(COUNT_WHOLE, on_whole, visible=False)
        self.text = TextPane("", name="measures", sizing_mode="stretch_width")
        self.copy = copy_button(self._rows, on_copy)
        self._sentences: dict[str, str] = {}
        self._results: dict[str, Result] = {}
        self._separations, self._uncertain = Range1d(1e-10, 1.0), Range1d(1e-3, 1.0)
        self._times, self._survivors = Range1d(1.0, 100.0), Range1d(1e-3, 1.0)
        self.pairs = ColumnDataSource(_NO_PAIRS, name="pairs")
        self._line = ColumnDataSource({"separation": [], "share": []}, name="exponent_line")
        self.steps = ColumnDataSource({"t": [], "share": []}, name="survival_steps")
        # Shown when there is something to draw.
        self._survival = pn.Column(margin=0, sizing_mode="stretch_width", visible=False)
        self._uncertainty = pn.Column(margin=0, sizing_mode="stretch_width", visible=False)
        self._laws = {law: ColumnDataSource({"t": [], "share": []}, name=f"{law}_law") for law in LAW_COLOURS}

    def begin(self) -> None:
        """Remove the measures of the previous map."""
        if self._sentences:
            self._sentences, self._results = {}, {}
            self.show_exponent(None)
            self._write()

    def show_box(self, box: Window | None) -> None:
        """Show that the measures are those of a box; None is the whole view."""
        self.whole.visible = box is not None
        self._write()

    def show_basins(self, measures: BasinMeasures) -> None:
        """Show the measures that follow from the pixels."""
        self._results |= {"Basin entropy": measures.entropy, "Wada": measures.merging}
        self._sentences |= {"Basin entropy": measures.entropy.describe(), "Wada": measures.merging.describe()}
        self._write()

    def show_flux(self, flux: EscapeFlux) -> None:
        """Show the decay rate for mixed motion inside."""
        self._results["Flux"] = flux
        self._sentences["Flux"] = flux.describe()
        self._write()

    def show_laws(self, laws: DecayLaws) -> None:
        """Show S(t) with the fitted laws."""
        self._results["Escape law"] = laws
        self._sentences["Escape law"] = laws.describe()
        self.steps.data = {"t": laws.times, "share": laws.survival}
        self._survival.visible = laws.times.size > 0
        for fit, source in zip((laws.exponential, laws.power_law), self._laws.values(), strict=True):
            source.data = _law_line(fit)
        seen = laws.survival > 0.0
        if np.count_nonzero(seen) > 1 and laws.times[seen][-1] > 0.0:
            latest = float(laws.times[seen][-1])
            set_range(self._times, min(1.0, 0.1 * latest), 1.5 * latest)
            set_decades(self._survivors, float(laws.survival[seen].min()), 1.0)
        self._write()

    def wait_for_exponent(self) -> None:
        """Show that the exponent is being measured."""
        self.button.disabled = True
        self._sentences["Uncertainty exponent"] = _MEASURING
        self._write()

    def show_exponent(self, found: UncertaintyExponent | None) -> None:
        """Show the shares and the fit; None removes them."""
        self.button.disabled = False
        self._sentences.pop("Uncertainty exponent", None)
        self._results.pop("Uncertainty exponent", None)
        self._uncertainty.visible = found is not None
        if found is None:
            self.pairs.data, self._line.data = _NO_PAIRS, {"separation": [], "share": []}
            return
        shares = found.shares
        positive = shares > 0.0
        low, high = found.share_intervals
        self.pairs.data = {
            "separation": found.separations[positive], "share": shares[positive],
            "low": low[positive], "high": high[positive],
            "colour": np.where(found.used[positive], MEASURED, SET_ASIDE),
            "note": np.where(found.used[positive], "", "; not used for the exponent"),
        }  # fmt: skip
        ends = found.separations[found.used]
        fitted = ends if np.isfinite(found.exponent) else ends[:0]
        self._line.data = {"separation": fitted, "share": found.amplitude * fitted**found.exponent}
        set_range(self._separations, 0.5 * float(found.separations.min()), 2.0 * float(found.separations.max()))
        if positive.any():
            set_decades(self._uncertain, float(shares[positive].min()), float(shares.max()))
        self._results["Uncertainty exponent"] = found
        self._sentences["Uncertainty exponent"] = found.describe()
        self._write()

    def say(self, sentence: str) -> None:
        """Show why there is no exponent."""
        self.button.disabled = False
        self._sentences["Uncertainty exponent"] = sentence
        self._write()

    def build(self) -> list[pn.viewable.Viewable]:
        """Make the content of the section."""
        self._survival.objects = [pn.pane.Bokeh(self._draw_survival(), margin=0), self._law_legend()]
        self._uncertainty.objects = [pn.pane.Bokeh(self._draw_uncertainty(), margin=0)]
        return [pn.Column(self.text, self.whole, self.copy, self.button, margin=0), self._survival, self._uncertainty]

    def _draw_uncertainty(self) -> figure:
        plot = square_figure(
            "uncertainty", "Uncertain pairs of starts", x_axis_label="separation", y_axis_label="uncertain share",
            x_range=self._separations, y_range=self._uncertain, x_axis_type="log", y_axis_type="log",
        )  # fmt: skip
        style: dict[str, Any] = {"x": "separation", "y": "share"}
        plot.add_glyph(self._line, Line(line_color=LAW_COLOURS["power law"], line_width=2, **style))
        plot.add_glyph(self.pairs, Segment(x0="separation", x1="separation", y0="low", y1="high", line_color="colour"))
        pairs = plot.add_glyph(self.pairs, Scatter(size=8, fill_color="colour", line_color=LIGHT.halo, **style))
        plot.add_tools(chart_hover(_PAIRS_TEXT, [pairs]))
        return plot

    def _draw_survival(self) -> figure:
        plot = square_figure(
            "survival", "Still inside", x_axis_label="t", y_axis_label="share of the starts",
            x_range=self._times, y_range=self._survivors, x_axis_type="log", y_axis_type="log",
        )  # fmt: skip
        plot.add_glyph(self.steps, Step(x="t", y="share", line_color=MEASURED, line_width=2, mode="after"))
        # The mouse finds lines between points, but not steps.
        line = plot.add_glyph(self.steps, Line(x="t", y="share", line_alpha=0.0))
        plot.add_tools(chart_hover(_SURVIVAL_TEXT, [line], mode="vline", line_policy="prev"))
        for law, source in self._laws.items():
            plot.add_glyph(source, Line(x="t", y="share", line_color=LAW_COLOURS[law], line_width=2, line_dash="dashed"))
        return plot

    def _law_legend(self) -> pn.viewable.Viewable:
        entries = [Entry("starts", MEASURED), *(Entry(law, colour) for law, colour in LAW_COLOURS.items())]
        return TextPane(legend(entries), margin=(0, 10))

    def _rows(self) -> list[tuple[str, str, str]]:
        """The numbers of all measures, at full precision."""
        return [row for title, result in self._results.items() for row in number_rows(title, result.numbers())]

    def _write(self) -> None:
        regions = dict.fromkeys(self._sentences, "in the whole view") | {"Flux": "through all exits"}
        if self.whole.visible:
            regions |= {name: "in the box drawn on the maps" for name in regions if name not in _NOT_OF_BOX}
        texts = (f"<p><b>{name}</b> {regions[name]}. {escape(text)}</p>" for name, text in self._sentences.items())
        self.text.object = with_terms("".join(texts))


def _law_line(fit: LawFit | None) -> dict[str, np.ndarray]:
    if fit is None:
        return {"t": np.zeros(0), "share": np.zeros(0)}
    t = np.geomspace(fit.t_low, fit.t_high, _LAW_POINTS)
    share = fit.curve(t)
    drawn = share > 0.0
    return {"t": t[drawn], "share": share[drawn]}
