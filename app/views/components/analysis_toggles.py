"""Switches for all that is shown on demand: what goes beyond the four maps."""

from __future__ import annotations

import panel as pn
import panel_material_ui as pmui

from app.state.view_state import SWITCHES, ViewState
from app.views.components.flex_row import flex_row

LABELS = {
    "judge": "Regular or chaotic",
    "trust": "Pixels to trust",
    "manifolds": "Stable manifolds",
    "origins": "Origin and exit",
    "measures": "Basin measures",
    "energies": "Against energy",
}
"""Of the switches of a view state."""

_ONE_LINE = {"& .MuiFormControlLabel-label": {"whiteSpace": "nowrap"}}


class AnalysisToggles:
    """Widgets that write into the view state and follow it."""

    def __init__(self, state: ViewState) -> None:
        self.widgets = {
            name: pmui.Switch(label=LABELS[name], value=getattr(state, name), sx=_ONE_LINE, margin=(2, 6)) for name in SWITCHES
        }
        for name, widget in self.widgets.items():
            widget.param.watch(lambda event, name=name: state.param.update({name: event.new}), "value")
            state.param.watch(lambda event: self.widgets[event.name].param.update(value=event.new), name)

    def layout(self) -> pn.viewable.Viewable:
        """The switches in a row that wraps."""
        title = pn.pane.HTML("<b style='font-size:14px'>See why</b>", margin=(8, 10))
        return flex_row(title, *self.widgets.values(), align_items="center", gap="2px", sizing_mode="stretch_width")
