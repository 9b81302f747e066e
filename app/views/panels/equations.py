"""The equations of motion of the system in view."""

from __future__ import annotations

from html import escape

import panel as pn

from app.state.view_state import ViewState
from app.views.components.texts import TextPane
from engine import System
from plots.texts.mathml import equations


def equations_pane(state: ViewState) -> pn.viewable.Viewable:
    """A pane that follows the system of a view state."""

    pane = TextPane("", margin=(0, 10), sizing_mode="stretch_width")

    def show(system: System) -> None:
        pane.object = f"<h3>Equations: {escape(system.title)}</h3>{equations(state.potential)}"

    state.follow(show, "system")
    return pane
