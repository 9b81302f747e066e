"""The choice of analyses writes to the view state and follows it."""

from __future__ import annotations

from app.state.view_state import ViewState
from app.views.components.widgets import SegmentedControl
from app.views.panels.analysis_choice import LayerSwitches


def test_the_image_of_the_manifolds_can_be_chosen_below_their_switch_while_they_are_on() -> None:
    state = ViewState()
    layers = LayerSwitches(state)
    assert layers.parts() == [*layers.switches.values()]
    state.layers = frozenset({"manifolds"})
    images = layers.parts()[layers.parts().index(layers.switches["manifolds"]) + 1]
    assert isinstance(images, SegmentedControl)
    images.value = 2
    assert state.settings["images"] == 2
    state.settings = {**state.settings, "images": 0}
    assert images.value == 0
    state.layers = frozenset()
    assert layers.parts() == [*layers.switches.values()]
