"""The drawer "Help": keys, the equations of the system in view, and terms."""

from __future__ import annotations

from html import escape

import panel as pn

from app.state.glossary import glossary_list
from app.state.view_state import ViewState
from app.views.components.collapsible_section import Fold
from app.views.components.texts import TextPane
from app.views.panels.browser_events import key_legend
from engine import System
from plots.texts.mathml import equations


def help_panes(state: ViewState) -> list[pn.viewable.Viewable]:
    """Return the content of the drawer."""
    return [
        TextPane(f"<h3>Keys</h3>{key_legend()}", sizing_mode="stretch_width", margin=(0, 10)),
        _equations_pane(state),
        *Fold("Terms", lambda: [TextPane(glossary_list(), sizing_mode="stretch_width", margin=(0, 10))]).parts(),
    ]


def _equations_pane(state: ViewState) -> pn.viewable.Viewable:
    """Return a pane that follows the system of a view state."""
    pane = TextPane("", margin=(0, 10), sizing_mode="stretch_width")

    def show(system: System) -> None:
        pane.object = f"<h3>Equations: {escape(system.title)}</h3>{equations(state.potential)}"

    state.follow(show, "system")
    return pane
