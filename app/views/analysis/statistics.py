"""Statistics of the map: shares of the fates, escape times and their histogram, and escape probabilities at crossings."""

from __future__ import annotations

import math
from collections.abc import Callable
from html import escape
from typing import Any

import holoviews as hv
import numpy as np
import panel as pn
from bokeh.models import CustomJSTickFormatter, FixedTicker, LogAxis
from bokeh.models.dom import HTML

from app.browser.javascript import callback_code
from app.browser.module_files import NUMBERS
from app.job_clients.shown_results import ShownResults
from app.state.help_texts import title_with_help
from app.state.view import Analysis
from app.state.view_state import ViewState
from app.views.components.in_turns import Make
from app.views.components.legends import patch
from app.views.components.plots import chart_hover
from app.views.components.texts import TextPane, escape_facts
from app.views.components.widgets import COUNT_WHOLE, button, copy_button
from engine import EscapeMap, Fate, compute_statistics
from engine.foundations.wording import format_share, format_share_range
from engine.propagation.fates import UNRESOLVED
from engine.results import EscapeStatistics
from plots.pictures.charts import BINS, MOST_CROSSINGS

CROSSINGS = "n"
"""Column of the numbers of crossings in the second chart."""

PROBABILITY = "p"
"""Column of the escape probabilities in the second chart."""

_TIMES_TEXT = "<b>@top{count} starts</b> escape<br>from t = @left{number} to @right{number}"
_PROBABILITIES_TEXT = (
    f"n = @{CROSSINGS} upward crossings:<br><b>@{PROBABILITY}{{percent}}</b> of the orbits still inside<br>"
    "escape before the next one"
)
# Numbers of crossings, as categories of an axis.
_CROSSING_LABELS = [str(n) for n in range(MOST_CROSSINGS + 1)]
_BAR_COLOUR = "#5b8db8"
_TICK = callback_code(NUMBERS, "number(tick)")
# Largest number of labels of the axis of time.
_MOST_TICKS = 5


class StatisticsView:
    """Counts the starts of the whole view, or of a box drawn on a map, in a table and two charts.

    Parameters
    ----------
    state
        View state. A button removes its box.
    results
        The results of the session.
    on_copy
        Copies the table, given as tab-separated text.
    """

    def __init__(self, state: ViewState, results: ShownResults, on_copy: Callable[[str], None]) -> None:
        self._state = state
        self._frame: EscapeMap | None = None
        # Whether the charts are on the page.
        self._is_built = False
        self.table = TextPane("", name="statistics", sizing_mode="stretch_width")
        self.whole = button(COUNT_WHOLE, lambda: state.param.update(box=None))
        self.copy = copy_button(self._rows, on_copy)
        state.follow(lambda box: self.whole.param.update(visible=box is not None), "box")
        state.param.watch(lambda *events: self._count(), ["box", "analysis", "palette"])
        results.param.watch(lambda event: self._show(event.new), "frame")

    def _show(self, frame: EscapeMap | None) -> None:
        """Count the pixels of a frame of full resolution."""
        if frame is not None and frame.stride == 1:
            self._frame = frame
            self._count()

    def parts(self) -> list[Make]:
        """Return functions that make the parts of the section."""
        return [self._build_table, self._build_times, self._build_probabilities]

    def _build_table(self) -> list[pn.viewable.Viewable]:
        return [pn.Column(self.whole, self.table, self.copy, margin=0, css_classes=["plot"])]

    def _build_times(self) -> list[pn.viewable.Viewable]:
        self._times = _plot(_draw_times, "histogram", "Escape times")
        _describe(self._times, _TIMES_TEXT)
        return [pn.pane.Bokeh(self._times.state, margin=0)]

    def _build_probabilities(self) -> list[pn.viewable.Viewable]:
        self._probabilities = _plot(_draw_probabilities, "probabilities", "Escapes after n crossings")
        _describe(self._probabilities, _PROBABILITIES_TEXT)
        self._is_built = True
        self._count()
        return [pn.pane.Bokeh(self._probabilities.state, margin=0)]

    def _count(self) -> None:
        """Count and show the pixels of the last frame, if the tab is open."""
        if self._frame is None or not self._is_built or self._state.analysis is not Analysis.STATISTICS:
            return
        statistics = compute_statistics(self._frame, self._state.box)
        self.table.object = self._table(statistics)
        self._show_times(*statistics.time_histogram(BINS))
        self._show_probabilities(statistics.escape_probabilities[: len(_CROSSING_LABELS)])

    def _show_times(self, edges: np.ndarray, counts: np.ndarray) -> None:
        handles = self._times.handles
        handles["source"].data = {"left": edges[:-1], "right": edges[1:], "top": counts}
        handles["x_range"].update(start=edges[0], end=edges[-1])
        handles["xaxis"].ticker.ticks = _few_ticks(*edges[[0, -1]].tolist())
        handles["y_range"].update(start=0.0, end=1.05 * max(float(counts.max()), 1.0))

    def _show_probabilities(self, probabilities: np.ndarray) -> None:
        heights = np.zeros(len(_CROSSING_LABELS))
        heights[: len(probabilities)] = probabilities
        self._probabilities.handles["source"].data = {CROSSINGS: _CROSSING_LABELS, PROBABILITY: heights}
        self._probabilities.handles["y_range"].end = 1.05 * float(heights.max()) if heights.any() else 1.0

    def _shares(self, statistics: EscapeStatistics) -> list[tuple[str, str, int]]:
        """Return name, colour and code of each fate in the table."""
        palette = self._state.colours
        ends = [(entry.label, entry.colour, fate) for fate, entry in palette.legend_entries(statistics.outcomes).items()]
        bounded = [("bounded", palette.bounded, int(Fate.BOUNDED))]
        others = (("undecided", Fate.NOT_COMPUTED, statistics.undecided), (UNRESOLVED, Fate.FAILED, statistics.failed))
        return [*ends, *bounded, *((name, palette.outcomes[fate].colour, int(fate)) for name, fate, count in others if count)]

    def _table(self, statistics: EscapeStatistics) -> str:
        shares, intervals = statistics.shares, statistics.share_intervals
        body = "".join(
            f"<tr><td>{patch(colour, escape(name))}</td><td>{format_share(shares[code], 2)}</td>"
            f"<td class='quiet'>{format_share_range(*intervals[code])}</td></tr>"
            for name, colour, code in self._shares(statistics)
        )
        body += "".join(f"<tr><td>{name}</td><td>{value}</td></tr>" for name, value in escape_facts(statistics).items())
        place = "the whole view" if self._state.box is None else "the box drawn on the maps"
        caption = f"Interior starts in {place}"
        head = "<tr><td></td><th scope=col>share</th><th scope=col>95 % interval</th></tr>"
        return f"<table aria-label='statistics'><caption>{caption}</caption>{head}{body}</table>"

    def _rows(self) -> list[tuple[str, ...]]:
        """Return the rows of the table, with shares at full precision."""
        if self._frame is None:
            return []
        statistics = compute_statistics(self._frame, self._state.box)
        shares, intervals = statistics.shares, statistics.share_intervals
        rows: list[tuple[str, ...]] = [("fate", "share", "95 % low", "95 % high")]
        for name, _, code in self._shares(statistics):
            low, high = intervals[code]
            rows.append((name, repr(shares[code]), repr(low), repr(high)))
        return rows + [(name, value, "", "") for name, value in escape_facts(statistics).items()]


def _draw_times() -> hv.Histogram:
    style = {"color": _BAR_COLOUR, "line_color": None, "logx": True, "xlabel": "escape time (logarithmic)", "ylabel": "starts"}
    return hv.Histogram((np.array([1.0, 10.0]), np.zeros(1))).opts(**style, **_frame())


def _draw_probabilities() -> hv.Bars:
    bars = hv.Bars([(number, 0.0) for number in _CROSSING_LABELS], (CROSSINGS, "upward crossings n"), (PROBABILITY, "p"))
    style = {"color": _BAR_COLOUR, "line_color": None, "ylabel": "p", "ylim": (0.0, 1.0)}
    return bars.opts(**style, **_frame())


def _frame() -> dict[str, Any]:
    fonts = {"labels": "12px", "ticks": "12px"}
    return {
        "responsive": True,
        "aspect": 1.6,
        "title": "",
        "fontsize": fonts,
        "toolbar": None,
        "default_tools": [],
        "hooks": [_simplify],
    }


def _simplify(plot: Any, _element: Any) -> None:
    """Remove background and tick marks, as `square_figure` does."""
    plot.state.min_border_top = 28
    plot.state.sizing_mode = "scale_width"
    plot.state.background_fill_alpha = plot.state.border_fill_alpha = 0.0
    plot.state.axis.major_tick_line_color = plot.state.axis.minor_tick_line_color = None
    for axis in plot.state.select(LogAxis):
        axis.update(ticker=FixedTicker(ticks=[]), formatter=CustomJSTickFormatter(code=_TICK))


def _few_ticks(low: float, high: float) -> list[float]:
    """Return 1, 2 and 5 times the powers of ten from `low` to `high`; only the powers if these would be too many labels."""
    decades = [10.0**k for k in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)]
    fine_ticks, powers = ([m * ten for ten in decades for m in steps if low <= m * ten <= high] for steps in ((1, 2, 5), (1,)))
    return fine_ticks if len(fine_ticks) <= _MOST_TICKS else powers


def _plot(draw: Callable[[], hv.Element], name: str, title: str) -> Any:
    """Return the plot of an element with its help text. New data for a plot are 20 times faster than a new plot."""
    # Elements cannot be made before their renderer is loaded.
    renderer = hv.renderer("bokeh")
    plot = renderer.get_plot(draw())
    plot.state.elements = [HTML(html=title_with_help(title, name))]
    return plot


def _describe(plot: Any, text: str) -> None:
    """Make the plot describe the bar under the mouse, also while the mouse is above the top of the bar."""
    plot.state.add_tools(chart_hover(text, [plot.handles["glyph_renderer"]], mode="vline"))


def prepare() -> None:
    """Draw both charts once. The first charts of a process load what HoloViews needs, which delays the event loop by 0.3 s."""
    for draw in (_draw_times, _draw_probabilities):
        _plot(draw, "histogram", "")
