"""The drawer "Help": the tour, how to read the pictures, the equations of the system, terms, a table of the page, and keys."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import astuple
from html import escape

import panel as pn

from app.job_clients.shown_results import ShownResults
from app.state.glossary import glossary_list
from app.state.help_texts import HELP_TEXTS
from app.state.view_state import ViewState
from app.views.components.collapsible_section import Fold
from app.views.components.texts import TextPane, escape_facts
from app.views.components.widgets import button
from app.views.panels.browser_events import key_legend
from engine import Fate, System, compute_statistics
from engine.foundations.wording import format_number, format_share, format_whole
from engine.propagation.fates import UNRESOLVED
from plots.layers.table import PICTURES


def help_panes(state: ViewState, results: ShownResults, take_tour: Callable[[], None]) -> list[pn.viewable.Viewable]:
    """Return the parts of the drawer, first the button that calls `take_tour`. Terms and table open on demand."""
    return [
        button("Take the tour", take_tour, margin=(0, 10)),
        TextPane(f"<h3>How to read the pictures</h3>{_meanings()}", sizing_mode="stretch_width", margin=(0, 10)),
        _equations_pane(state),
        *Fold("Terms", lambda: [TextPane(glossary_list(), sizing_mode="stretch_width", margin=(0, 10))]).parts(),
        *AccessibleTable(state, results).fold.parts(),
        TextPane(f"<h3>Keys</h3>{key_legend()}", sizing_mode="stretch_width", margin=(0, 10)),
    ]


def _meanings() -> str:
    """Return what the well, the basins, the times and the crossings mean, a paragraph each."""
    titles = {"well": "The well"} | {name: PICTURES[name].title for name in ("basins", "times", "crossings")}
    return "".join(f"<p><b>{title}.</b> {escape(HELP_TEXTS[name])}</p>" for name, title in titles.items())


def _equations_pane(state: ViewState) -> pn.viewable.Viewable:
    """Return a pane that follows the system of a view state."""
    pane = TextPane("", margin=(0, 10), sizing_mode="stretch_width")

    def show(system: System) -> None:
        pane.object = f"<h3>Equations: {escape(system.title)}</h3>{state.reviewed.equations}"

    state.follow(show, "system")
    return pane


class AccessibleTable:
    """Writes what the page shows into a table, for screen readers and for copying numbers, while the table is open."""

    def __init__(self, state: ViewState, results: ShownResults) -> None:
        self._state, self._results = state, results
        self.text = TextPane("", name="accessible-table", sizing_mode="stretch_width", margin=(0, 10))
        self.fold = Fold("This page as a table", lambda: [self.text])
        self.fold.button.on_click(lambda event: self._write())
        results.param.watch(lambda *events: self._write(), ["frame", "orbits"])

    def _write(self) -> None:
        if not self.fold.is_open:
            return
        named_values = (*self._view_values(), *self._map_values(), *self._orbit_texts())
        rows = "".join(f"<tr><th scope=row>{escape(name)}</th><td>{escape(value)}</td></tr>" for name, value in named_values)
        head = "<tr><th scope=col>quantity</th><th scope=col>value</th></tr>"
        self.text.object = f"<table><caption>What is shown</caption>{head}{rows}</table>"

    def _view_values(self) -> list[tuple[str, str]]:
        state, reviewed = self._state, self._state.reviewed
        rows = [("system", reviewed.system.title), ("potential V(x, y)", reviewed.formula)]
        rows += [("plane", state.plane.title), ("t_max", format_whole(state.t_max))]
        rows += [("resolution", f"{state.resolution} × {state.resolution} starts")]
        if state.window is not None:
            x_low, x_high, ordinate_low, ordinate_high = astuple(state.window)
            rows += [("window", f"x from {x_low!r} to {x_high!r}, ordinate from {ordinate_low!r} to {ordinate_high!r}")]
        return [*rows, ("energy h", f"{state.energy!r}")]

    def _map_values(self) -> list[tuple[str, str]]:
        frame = self._results.whole_map
        if frame is None:
            return []
        statistics = compute_statistics(frame)
        shares = statistics.shares
        rows = [(end.action, format_share(shares[fate], 2)) for fate, end in enumerate(statistics.outcomes, 1)]
        rows += [(UNRESOLVED, format_share(shares[Fate.FAILED], 2))] if statistics.failed else []
        return [*rows, ("bounded", format_share(shares[Fate.BOUNDED], 2)), *escape_facts(statistics).items()]

    def _orbit_texts(self) -> list[tuple[str, str]]:
        return [
            (f"orbit {place + 1}, from {format_number(one.start[0], 6)}, {format_number(one.start[1], 6)}", one.describe())
            for place, one in enumerate(self._results.orbits)
        ]
