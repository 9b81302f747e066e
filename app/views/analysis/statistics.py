"""Statistics of the map: shares of each fate, escape times and their histogram, escape probability at each crossing."""

from __future__ import annotations

from collections.abc import Callable
from html import escape

import numpy as np
import panel as pn
from bokeh.models import ColumnDataSource, FactorRange, Quad, Range1d, VBar
from bokeh.plotting import figure

from app.views.components.legends import patch
from app.views.components.numbers import grouped, percent, percent_range
from app.views.components.plots import chart_hover, set_range, square_figure
from app.views.components.texts import TextPane
from app.views.components.widgets import COUNT_WHOLE, button, copy_button
from engine import EscapeMap, EscapeStatistics, Fate, Window, compute_statistics
from engine.propagation.fates import UNRESOLVED
from plots.pictures.palette import PAPER, Palette
from plots.pictures.statistics_charts import BINS, MOST_CROSSINGS

CROSSINGS, PROBABILITY = "n", "p"
"""Columns of the second chart."""

_TIMES_TEXT = "<b>@top{custom} starts</b> escape<br>from t = @left{custom} to @right{custom}"
_PROBABILITIES_TEXT = (
    f"n = @{CROSSINGS} upward crossings:<br><b>@{PROBABILITY}{{custom}}</b> of the orbits still inside<br>"
    "escape before the next one"
)
_NUMBERS = [str(n) for n in range(MOST_CROSSINGS + 1)]
_BAR = {"fill_color": "#5b8db8", "line_color": None}
_ASPECT = 1.1


class StatisticsView:
    """A table and two charts of the whole view, or of a box drawn on a map.

    Parameters
    ----------
    on_whole
        Called to remove the box.
    on_copy
        Called with the table as tab-separated text.
    """

    def __init__(self, on_whole: Callable[[], None], on_copy: Callable[[str], None]) -> None:
        self._palette = PAPER
        self._frame: EscapeMap | None = None
        self._box: Window | None = None
        self._active = False
        self.table = TextPane("", name="statistics", sizing_mode="stretch_width")
        self.whole = button(COUNT_WHOLE, on_whole, visible=False)
        self.copy = copy_button(self._rows, on_copy)
        self.times = ColumnDataSource({"left": [], "right": [], "top": []}, name="escape_times")
        self.probabilities = ColumnDataSource({CROSSINGS: [], PROBABILITY: []}, name="escape_probabilities")
        self._escape_times, self._counts = Range1d(1.0, 10.0), Range1d(0.0, 1.0)

    def activate(self, active: bool) -> None:
        """Count while the section is on the page."""
        self._active = active
        self._count()

    def show(self, frame: EscapeMap) -> None:
        """Show the statistics of a frame."""
        self._frame = frame
        self._count()

    def show_box(self, box: Window | None) -> None:
        """Count in a box; None is the whole view."""
        if box == self._box:
            return
        self._box = box
        self.whole.visible = box is not None
        self._count()

    def set_palette(self, palette: Palette) -> None:
        """Set the colours of the outcomes."""
        self._palette = palette
        self._count()

    def build(self) -> list[pn.viewable.Viewable]:
        """Make the content of the section."""
        left = pn.Column(self.whole, self.table, self.copy, margin=0, css_classes=["plot"])
        return [left, *(pn.pane.Bokeh(plot, margin=0) for plot in (self._draw_times(), self._draw_probabilities()))]

    def _draw_times(self) -> figure:
        plot = square_figure(
            "histogram", "Escape times", aspect_ratio=_ASPECT, x_axis_type="log",
            x_range=self._escape_times, y_range=self._counts, x_axis_label="escape time", y_axis_label="starts",
        )  # fmt: skip
        bars = plot.add_glyph(self.times, Quad(bottom=0.0, **_BAR))
        formats = {"@left": "number", "@right": "number", "@top": "count"}
        # Also when the mouse is above a low bar.
        plot.add_tools(chart_hover(_TIMES_TEXT, formats, [bars], mode="vline"))
        return plot

    def _draw_probabilities(self) -> figure:
        plot = square_figure(
            "probabilities", "Escapes after n crossings", aspect_ratio=_ASPECT,
            x_range=FactorRange(factors=_NUMBERS), y_range=Range1d(0.0, 1.0),
            x_axis_label="upward crossings n", y_axis_label=PROBABILITY,
        )  # fmt: skip
        bars = plot.add_glyph(self.probabilities, VBar(x=CROSSINGS, top=PROBABILITY, width=0.8, **_BAR))
        plot.add_tools(chart_hover(_PROBABILITIES_TEXT, {f"@{PROBABILITY}": "percent"}, [bars], mode="vline"))
        return plot

    def _count(self) -> None:
        if self._frame is None or not self._active:
            return
        statistics = compute_statistics(self._frame, self._box)
        self.table.object = self._table(statistics)
        self._show_times(*statistics.time_histogram(BINS))
        self._show_probabilities(statistics.escape_probabilities[: len(_NUMBERS)])

    def _show_times(self, edges: np.ndarray, counts: np.ndarray) -> None:
        self.times.data = {"left": edges[:-1], "right": edges[1:], "top": counts}
        set_range(self._escape_times, edges[0], edges[-1])
        set_range(self._counts, 0.0, 1.05 * max(float(counts.max()), 1.0))

    def _show_probabilities(self, probabilities: np.ndarray) -> None:
        shown = np.zeros(len(_NUMBERS))
        shown[: len(probabilities)] = probabilities
        self.probabilities.data = {CROSSINGS: _NUMBERS, PROBABILITY: shown}

    def _shares(self, statistics: EscapeStatistics) -> list[tuple[str, str, int]]:
        """Name, colour and code of each fate in the table."""
        palette, outcomes = self._palette, statistics.outcomes
        entries = zip(palette.end_entries(outcomes), outcomes, strict=True)
        ends = [(entry.label, entry.colour, fate) for fate, (entry, outcome) in enumerate(entries, 1) if outcome.occurs]
        bounded = [("bounded", palette.bounded, int(Fate.BOUNDED))]
        others = (("undecided", Fate.NOT_COMPUTED, statistics.undecided), (UNRESOLVED, Fate.FAILED, statistics.failed))
        return [*ends, *bounded, *((name, palette.outcomes[fate].colour, int(fate)) for name, fate, count in others if count)]

    def _table(self, statistics: EscapeStatistics) -> str:
        shares, intervals = statistics.shares, statistics.share_intervals
        body = "".join(
            f"<tr><td>{patch(colour, escape(name))}</td><td>{percent(shares[code], 2)}</td>"
            f"<td class='quiet'>{percent_range(*intervals[code])}</td></tr>"
            for name, colour, code in self._shares(statistics)
        )
        body += "".join(f"<tr><td>{name}</td><td>{value}</td></tr>" for name, value in _facts(statistics).items())
        place = "the whole view" if self._box is None else "the box drawn on the maps"
        caption = f"Interior starts in {place}, with 95 % intervals"
        return f"<table aria-label='statistics'><caption>{caption}</caption>{body}</table>"

    def _rows(self) -> list[tuple[str, ...]]:
        """The table, with shares at full precision."""
        if self._frame is None:
            return []
        statistics = compute_statistics(self._frame, self._box)
        shares, intervals = statistics.shares, statistics.share_intervals
        rows: list[tuple[str, ...]] = [("fate", "share", "95 % low", "95 % high")]
        for name, _, code in self._shares(statistics):
            low, high = intervals[code]
            rows.append((name, repr(shares[code]), repr(low), repr(high)))
        return rows + [(name, value, "", "") for name, value in _facts(statistics).items()]


def _facts(statistics: EscapeStatistics) -> dict[str, str]:
    return {
        "interior starts": grouped(statistics.starts),
        "direct escapes": percent(statistics.direct_share, 2),
        "mean escape time": _number(statistics.mean_escape_time),
        "median escape time": _number(statistics.median_escape_time),
    }


def _number(value: float) -> str:
    return f"{value:.4g}" if np.isfinite(value) else "nothing escaped"
