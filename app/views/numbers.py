"""The picture in numbers: shares of each fate, escape times and their histogram, the chance to leave at each crossing."""

from __future__ import annotations

from typing import Any

import holoviews as hv
import numpy as np
import panel as pn
import panel_material_ui as pmui

from app.palette import PAPER, Palette
from app.views.figures import FRAME, with_help
from app.views.legends import patch
from engine import EscapeMap, EscapeStatistics, Fate, Window, compute_statistics

hv.extension("bokeh")

BINS = 40
MOST_CROSSINGS = 15
"""The chance to leave is shown up to this many crossings."""

_BAR = "#5b8db8"


class NumbersView:
    """A table and two charts of what is in view, or in a box drawn on a map."""

    def __init__(self, on_whole: Any) -> None:
        self._palette = PAPER
        self._frame: EscapeMap | None = None
        self._box: Window | None = None
        self.table = pn.pane.HTML("", name="numbers", width=360)
        self.whole = pmui.Button(label="Count the whole view", variant="outlined", size="small", disabled=True)
        self.whole.on_click(lambda event: on_whole())
        self._times, self._chances = hv.streams.Pipe(data=None), hv.streams.Pipe(data=None)
        self.histogram = _pane(hv.DynamicMap(_draw_times, streams=[self._times]))
        self.probabilities = _pane(hv.DynamicMap(_draw_chances, streams=[self._chances]))

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
        # The charts take longer to draw than a frame of the map.
        if self._frame.complete:
            self._times.send(statistics)
            self._chances.send(statistics)

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


def _draw_times(data: EscapeStatistics | None) -> hv.Histogram:
    edges, counts = data.time_histogram(BINS) if data is not None else (np.array([1.0, 10.0]), np.zeros(1))
    style = {"color": _BAR, "line_color": None, "logx": True, "xlabel": "escape time", "ylabel": "starts"}
    return hv.Histogram((edges, counts)).opts(title="Escape times", **style, **_frame())


def _draw_chances(data: EscapeStatistics | None) -> hv.Bars:
    chances = data.escape_probabilities[: MOST_CROSSINGS + 1] if data is not None else np.zeros(0)
    bars = hv.Bars([(str(n), float(p)) for n, p in enumerate(chances)] or [("0", 0.0)], "upward crossings n", "p")
    style = {"color": _BAR, "line_color": None, "ylabel": "p", "ylim": (0.0, 1.0)}
    return bars.opts(title="Chance to leave after n crossings", **style, **_frame())


def _frame() -> dict[str, Any]:
    fonts = {"title": "14px", "labels": "12px", "ticks": "11px"}
    return {
        "width": FRAME + 60, "height": FRAME + 20, "framewise": True, "fontsize": fonts, "toolbar": None,
        "hooks": [_see_through],
    }  # fmt: skip


def _see_through(plot: Any, _element: Any) -> None:
    plot.state.background_fill_alpha = plot.state.border_fill_alpha = 0.0


def _pane(drawn: hv.DynamicMap) -> pn.pane.HoloViews:
    return pn.pane.HoloViews(drawn, linked_axes=False, margin=0)


def _number(value: float) -> str:
    return f"{value:.4g}" if np.isfinite(value) else "nothing escaped"
