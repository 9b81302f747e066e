"""The equations of motion of the system in view."""

from __future__ import annotations

from html import escape

import panel as pn

from app.state.view_state import ViewState
from app.views.components.texts import TextPane
from plots.texts.mathml import equations


def equations_pane(state: ViewState) -> pn.viewable.Viewable:
    """A pane that follows the system of a view state."""

    def html() -> str:
        return f"<h3>Equations: {escape(state.system.title)}</h3>{equations(state.potential)}"

    pane = TextPane(html(), margin=(0, 10), sizing_mode="stretch_width")
    state.param.watch(lambda *events: pane.param.update(object=html()), "system")
    return pane
