"""The choice of analyses: layers over the maps, and what is shown beside them."""

from __future__ import annotations

from collections.abc import Callable
from html import escape

import panel as pn

from app.state.view import IMAGE_CHOICES, LAYERS, Analysis, View
from app.state.view_state import ViewState
from app.views.components.texts import TextPane
from app.views.components.widgets import SegmentedControl, Switches, bind, button

LAYER_LABELS = {
    "judge": "Regular or chaotic",
    "trust": "Pixels to trust",
    "manifolds": "Stable manifolds",
    "origins": "Origin and exit",
}
"""Labels of the layers of a view state."""

IMAGE_LABELS = {f"Image {name}" if image == 1 else name.capitalize(): image for name, image in IMAGE_CHOICES.items()}
"""Labels of the images of the manifolds, in a row."""

ANALYSIS_LABELS = {
    Analysis.ORBIT: "Orbit",
    Analysis.STATISTICS: "Statistics",
    Analysis.MEASURES: "Measures",
    Analysis.ENERGIES: "Against",
    Analysis.WATCH: "Watch",
}
"""Labels of the tabs beside the maps."""


class LayerSwitches:
    """Switches that write to the view state and follow it.

    They are separate widgets: of one that held them all, a change by the user would undo one that the server has just sent.
    """

    def __init__(self, state: ViewState) -> None:
        self._state = state
        self.switches = {name: self._make(name) for name in LAYERS}
        self._images: SegmentedControl | None = None

    def parts(self) -> list[pn.viewable.Viewable]:
        """The switches and, while the manifolds are on, the choice of an image."""
        return [*self.switches.values(), *([self._choose_image()] if self._state.manifolds else [])]

    def _make(self, name: str) -> Switches:
        """The switch of a layer."""
        on = [LAYER_LABELS[name]]
        switch = Switches(label="Layer", options=on, margin=(0, 10, 4, 10))
        self._state.follow(lambda is_on: switch.param.update(value=on if is_on else []), name)
        switch.param.watch(lambda event: self._write(name, on=bool(event.new)), "value")
        return switch

    def _choose_image(self) -> SegmentedControl:
        """The choice, made when it is first wanted."""
        if self._images is None:
            images = SegmentedControl(label="Image of the manifolds", options=IMAGE_LABELS, margin=(6, 10))
            self._images = bind(images, self._state, "images")
        return self._images

    def _write(self, name: str, *, on: bool) -> None:
        with pn.io.hold():
            self._state.param.update({name: on})


class ComparisonSwitch:
    """A switch that compares what is shown later with the present view, and follows the view state.

    Parameters
    ----------
    state
        The view state.
    compare
        Called with whether the view is to be compared with the present one.
    swap
        Called to exchange the two views.
    """

    def __init__(self, state: ViewState, compare: Callable[[bool], None], swap: Callable[[], None]) -> None:
        self._state, self._on = state, ["Compare with this view"]
        self.switch = Switches(label="Comparison", options=self._on, margin=(0, 10, 4, 10))
        self.view = TextPane("", sizing_mode="stretch_width", margin=(0, 10), css_classes=["quiet"])
        self.swap = button("Swap the views", swap, kind="light", margin=(2, 10))
        state.follow(self._show, "compared")
        self.switch.param.watch(lambda event: self._take(bool(event.new), compare), "value")

    def parts(self) -> list[pn.viewable.Viewable]:
        """The switch and, while it is on, the other view and the button."""
        return [self.switch, *([self.view, self.swap] if self._state.compared is not None else [])]

    def _take(self, on: bool, compare: Callable[[bool], None]) -> None:
        if on != (self._state.compared is not None):
            compare(on)

    def _show(self, compared: View | None) -> None:
        self.switch.value = [] if compared is None else self._on
        self.view.object = escape(compared.title) if compared is not None else ""


class AnalysisTabs:
    """A segmented control that writes to the view state and follows it."""

    def __init__(self, state: ViewState) -> None:
        options = {label: analysis for analysis, label in ANALYSIS_LABELS.items()}
        tabs = SegmentedControl(label="Analysis", options=options, margin=(5, 4), css_classes=["segmented", "narrow", "tight"])
        self.tabs = bind(tabs, state, "analysis")
