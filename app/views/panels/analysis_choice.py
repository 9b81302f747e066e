"""The choice of analyses: layers over the maps, comparison with another view, and the analysis beside the maps."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import Any

import panel as pn

from app.state.view import ANALYSES, View
from app.state.view_state import ViewState
from app.views.components.setting_choice import setting_choice
from app.views.components.texts import TextPane
from app.views.components.widgets import SegmentedControl, Switches, bind, button, switch
from plots.layers.layer import Layer
from plots.layers.table import LAYERS
from plots.pictures.setting import Setting
from plots.studies.table import STUDIES

ANALYSIS_LABELS = {str(name): STUDIES[name].title if name in STUDIES else name.capitalize() for name in ANALYSES}
"""Labels of the tabs beside the maps, by the name of the analysis."""


class LayerSwitches:
    """Switches of the layers. They write to the view state and follow it.

    Each switch is a widget of its own: in a common widget, a change by the user would undo a change just sent by the server.
    """

    def __init__(self, state: ViewState) -> None:
        self._state = state
        self.switches = {name: self._make(layer) for name, layer in LAYERS.items()}
        # Choices of settings, by name of the setting. A choice is made when it is first needed.
        self._choices: dict[str, SegmentedControl] = {}

    def parts(self) -> list[pn.viewable.Viewable]:
        """Return the switches; each switch that is on is followed by the choices of its layer."""
        return [part for layer in LAYERS.values() for part in (self.switches[layer.name], *self._choices_of(layer))]

    def _choices_of(self, layer: Layer[Any]) -> list[SegmentedControl]:
        return [self._choice(setting) for setting in layer.settings] if layer.name in self._state.layers else []

    def _make(self, layer: Layer[Any]) -> Switches:
        """Make the switch of a layer."""
        is_on = lambda layers: layer.name in layers  # noqa: E731
        turn = lambda on: self._state.switch_layer(layer.name, on=on)  # noqa: E731
        return switch("Layer", layer.title, self._state, "layers", is_on, turn, margin=(0, 10, 4, 10))

    def _choice(self, setting: Setting) -> SegmentedControl:
        """Return the radio buttons of a setting, which the first call makes."""
        if setting.name not in self._choices:
            self._choices[setting.name] = setting_choice(self._state, setting)
        return self._choices[setting.name]


class ComparisonSwitch:
    """A switch that compares later views with the present view. It follows the view state.

    Parameters
    ----------
    state
        The view state.
    swap_views
        Exchanges the two views.
    """

    def __init__(self, state: ViewState, swap_views: Callable[[], None]) -> None:
        self._state = state
        turn = lambda on: state.compare(on=on)  # noqa: E731
        self.switch = switch(
            "Comparison", "Compare with this view", state, "compared", lambda view: view is not None, turn, margin=(0, 10, 4, 10)
        )
        self.title = TextPane("", sizing_mode="stretch_width", margin=(0, 10), css_classes=["quiet"])
        self.swap = button("Swap the views", swap_views, kind="light", margin=0)
        state.follow(self._show, "compared")

    def parts(self) -> list[pn.viewable.Viewable]:
        """Return the switch. While it is on, also return the title of the other view and the button."""
        return [self.switch, *([self.title, self.swap] if self._state.compared is not None else [])]

    def _show(self, compared: View | None) -> None:
        self.title.object = escape(compared.title) if compared is not None else ""


def analysis_tabs(state: ViewState) -> SegmentedControl:
    """Return the tabs of the analyses. They write to the view state and follow it."""
    options = {label: name for name, label in ANALYSIS_LABELS.items()}
    tabs = SegmentedControl(label="Analysis", options=options, margin=(0, 10), css_classes=["segmented", "narrow", "tight"])
    return bind(tabs, state, "analysis")
