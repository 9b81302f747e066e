"""Statistics of the map: shares of the fates, escape times and their histogram, and escape probabilities at crossings."""

from __future__ import annotations

from collections.abc import Callable
from html import escape

import panel as pn

from app.job_clients.shown_results import ShownResults
from app.state.view import Analysis
from app.state.view_state import ViewState
from app.views.components.collapsible_section import Build
from app.views.components.histograms import HistogramView
from app.views.components.texts import TextPane, escape_facts
from app.views.components.widgets import COUNT_WHOLE, button, copy_button
from engine import EscapeMap, Fate, compute_statistics
from engine.foundations.wording import format_share, format_share_range
from engine.propagation.fates import UNRESOLVED
from engine.results import EscapeStatistics
from plots.studies.escape_charts import PROBABILITIES, TIMES, probabilities_chart, times_chart
from plots.texts.legends import patch


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
        self._times = HistogramView(TIMES)
        self._probabilities = HistogramView(PROBABILITIES)
        self.table = TextPane("", name="statistics", sizing_mode="stretch_width")
        self.count_whole = button(COUNT_WHOLE, lambda: state.param.update(box=None))
        self.copy = copy_button(self._rows, on_copy)
        state.follow(lambda box: self.count_whole.param.update(visible=box is not None), "box")
        state.param.watch(lambda *events: self._count(), ["box", "analysis", "palette"])
        results.param.watch(lambda event: self._take_frame(event.new), "frame")

    def _take_frame(self, frame: EscapeMap | None) -> None:
        """Count the pixels of a frame of full resolution."""
        if frame is not None and frame.stride == 1:
            self._frame = frame
            self._count()

    def parts(self) -> list[Build]:
        """Return functions that make the parts of the section."""
        return [self._build_table, lambda: [self._times.build()], lambda: [self._probabilities.build()]]

    def _build_table(self) -> list[pn.viewable.Viewable]:
        return [pn.Column(self.count_whole, self.table, self.copy, margin=0, css_classes=["plot"])]

    def _count(self) -> None:
        """Count and show the pixels of the last frame, if the tab is open."""
        if self._frame is None or self._state.analysis != Analysis.STATISTICS:
            return
        statistics = compute_statistics(self._frame, self._state.box)
        self.table.object = self._table(statistics)
        self._times.show(times_chart(statistics))
        self._probabilities.show(probabilities_chart(statistics))

    def _listed_fates(self, statistics: EscapeStatistics) -> list[tuple[str, str, int]]:
        """Return name, colour and code of each fate in the table."""
        palette = self._state.colours
        ends = [(entry.label, entry.colour, fate) for fate, entry in palette.legend_entries(statistics.outcomes).items()]
        bounded = [("bounded", palette.bounded, int(Fate.BOUNDED))]
        rare_fates = (("undecided", Fate.NOT_COMPUTED, statistics.undecided), (UNRESOLVED, Fate.FAILED, statistics.failed))
        return [*ends, *bounded, *((name, palette.outcomes[fate].colour, int(fate)) for name, fate, count in rare_fates if count)]

    def _table(self, statistics: EscapeStatistics) -> str:
        shares, intervals = statistics.shares, statistics.share_intervals
        body = "".join(
            f"<tr><td>{patch(colour, escape(name))}</td><td>{format_share(shares[code], 2)}</td>"
            f"<td class='quiet'>{format_share_range(*intervals[code])}</td></tr>"
            for name, colour, code in self._listed_fates(statistics)
        )
        facts = escape_facts(statistics).items()
        # The long names would widen the first column, so each extends over the second one.
        body += "".join(f"<tr><td colspan=2>{name}</td><td>{value}</td></tr>" for name, value in facts)
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
        for name, _, code in self._listed_fates(statistics):
            low, high = intervals[code]
            rows.append((name, repr(shares[code]), repr(low), repr(high)))
        return rows + [(name, value, "", "") for name, value in escape_facts(statistics).items()]
