"""The picture in numbers: shares of each fate, escape times and their histogram, the chance to leave at each crossing."""

from __future__ import annotations

from typing import Any

import holoviews as hv
import numpy as np
import panel as pn
import panel_material_ui as pmui

from app.rendering.palette import PAPER, Palette
from app.views.components.legends import patch
from app.views.components.plots import FRAME, with_help
from engine import EscapeMap, EscapeStatistics, Fate, Window, compute_statistics

hv.extension("bokeh")

BINS = 40
MOST_CROSSINGS = 15
"""The chance to leave is shown up to this many crossings."""

CROSSINGS, CHANCE = "n", "p"
"""Columns of the second chart."""

_NUMBERS = [str(n) for n in range(MOST_CROSSINGS + 1)]
_BAR = "#5b8db8"


class StatisticsView:
    """A table and two charts of what is in view, or in a box drawn on a map."""

    def __init__(self, on_whole: Any) -> None:
        self._palette = PAPER
        self._frame: EscapeMap | None = None
        self._box: Window | None = None
        self.table = pn.pane.HTML("", name="numbers", width=360)
        self.whole = pmui.Button(label="Count the whole view", variant="outlined", size="small", disabled=True)
        self.whole.on_click(lambda event: on_whole())
        self._times, self._chances = _plot(_draw_times()), _plot(_draw_chances())
        self.histogram, self.probabilities = (pn.pane.Bokeh(plot.state, margin=0) for plot in (self._times, self._chances))

    def layout(self) -> list[pn.viewable.Viewable]:
        """The table, and the charts with their explanations."""
        title = pn.pane.HTML("<h2 style='font-size:15px;margin:4px 0'>The picture in numbers</h2>")
        left = pn.Column(title, self.whole, self.table, width=370, margin=(0, 6))
        return [left, with_help(self.histogram, "histogram"), with_help(self.probabilities, "probabilities")]

    def show(self, frame: EscapeMap) -> None:
        """Count a frame."""
        self._frame = frame
        self._count()

    def show_box(self, box: Window | None) -> None:
        """Count in a box, or with None in the whole view."""
        if box == self._box:
            return
        self._box = box
        self.whole.disabled = box is None
        self._count()

    def set_palette(self, palette: Palette) -> None:
        """Colours of the channels."""
        self._palette = palette
        self._count()

    def _count(self) -> None:
        if self._frame is None:
            return
        statistics = compute_statistics(self._frame, self._box)
        self.table.object = self._table(statistics)
        if self._frame.complete:
            self._show_times(*statistics.time_histogram(BINS))
            self._show_chances(statistics.escape_probabilities[: len(_NUMBERS)])

    def _show_times(self, edges: np.ndarray, counts: np.ndarray) -> None:
        drawn = self._times.handles
        drawn["source"].data = {"left": edges[:-1], "right": edges[1:], "top": counts}
        drawn["x_range"].update(start=edges[0], end=edges[-1])
        drawn["y_range"].update(start=0.0, end=1.05 * max(float(counts.max()), 1.0))

    def _show_chances(self, chances: np.ndarray) -> None:
        shown = np.zeros(len(_NUMBERS))
        shown[: len(chances)] = chances
        self._chances.handles["source"].data = {CROSSINGS: _NUMBERS, CHANCE: shown}

    def _table(self, statistics: EscapeStatistics) -> str:
        shares = statistics.shares
        rows = [(f"channel {k + 1}", self._palette.channels[k], shares[k + 1]) for k in range(len(statistics.channel_counts))]
        rows += [("bounded", self._palette.bounded, shares[Fate.BOUNDED])]
        if shares[Fate.NOT_COMPUTED]:
            rows += [("not decided yet", self._palette.outcomes[Fate.NOT_COMPUTED].colour, shares[Fate.NOT_COMPUTED])]
        body = "".join(f"<tr><td>{patch(colour)}{name}</td><td>{share:.2%}</td></tr>" for name, colour, share in rows)
        facts = {
            "interior starts": f"{statistics.starts:,}".replace(",", " "),
            "direct escapes": f"{statistics.direct_share:.2%}",
            "mean escape time": _number(statistics.mean_escape_time),
            "median escape time": _number(statistics.median_escape_time),
        }
        body += "".join(f"<tr><td>{name}</td><td>{value}</td></tr>" for name, value in facts.items())
        place = "the whole view" if self._box is None else "the box drawn on the maps"
        head = f"<caption style='text-align:left'>Shares of the interior starts in {place}</caption>"
        return f"<table aria-label='numbers table' style='font-size:14px;border-spacing:14px 2px'>{head}{body}</table>"


def _draw_times() -> hv.Histogram:
    style = {"color": _BAR, "line_color": None, "logx": True, "xlabel": "escape time", "ylabel": "starts"}
    return hv.Histogram((np.array([1.0, 10.0]), np.zeros(1))).opts(title="Escape times", **style, **_frame())


def _draw_chances() -> hv.Bars:
    bars = hv.Bars([(number, 0.0) for number in _NUMBERS], (CROSSINGS, "upward crossings n"), (CHANCE, "p"))
    style = {"color": _BAR, "line_color": None, "ylabel": "p", "ylim": (0.0, 1.0)}
    return bars.opts(title="Chance to leave after n crossings", **style, **_frame())


def _frame() -> dict[str, Any]:
    fonts = {"title": "14px", "labels": "12px", "ticks": "11px"}
    return {
        "width": FRAME + 60, "height": FRAME + 20, "fontsize": fonts, "toolbar": None,
        "hooks": [_see_through],
    }  # fmt: skip


def _see_through(plot: Any, _element: Any) -> None:
    plot.state.background_fill_alpha = plot.state.border_fill_alpha = 0.0


def _plot(element: hv.Element) -> Any:
    """Drawn once: to draw anew takes 20 times as long as to change what is drawn."""
    return hv.renderer("bokeh").get_plot(element)


def _number(value: float) -> str:
    return f"{value:.4g}" if np.isfinite(value) else "nothing escaped"
