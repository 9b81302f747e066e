"""The drawer of the slice writes legal slices and follows the state."""

from __future__ import annotations

import math

import pytest

from app.browser.inputs.counted_inputs import NumberBox
from app.state.system_review import review_for_page
from app.state.view_state import ViewState
from app.views.panels.slice_panel import SlicePanel
from engine import Coordinate, ParameterAxis, Plane, Section, Slice, System, read_section
from engine.systems.system import TYPED
from tests.app.browser_messages import send

C = Coordinate


class Drawer:
    """The panel and its state. The panel accepts every legal slice."""

    def __init__(self) -> None:
        self.state = ViewState(system=System("I"), energy=0.19)
        self.panel = SlicePanel(self.state)

    @property
    def boxes(self) -> dict[str, NumberBox]:
        """The boxes of numbers, by label."""
        rows = [*self.panel.ranges.objects, *self.panel.held.objects]
        return {box.label: box for row in rows for box in row.objects}

    def type(self, label: str, number: float) -> None:
        """Type a number into a box."""
        send(self.boxes[label], {"value": number, "count": 1, "done": True})


@pytest.fixture
def drawer() -> Drawer:
    return Drawer()


def test_the_drawer_shows_the_slice_of_the_state(drawer: Drawer) -> None:
    drawer.state.show_slice(Plane.TANGENTIAL)
    assert [axis.value for axis in drawer.panel.axes] == ["x", "y"]
    assert drawer.panel.mode.value == "speed, at angle β from the radius"
    assert len(drawer.panel.mode.options) == 6
    assert list(drawer.boxes) == ["β ="]
    assert drawer.boxes["β ="].value == math.pi / 2


def test_axes_ranges_and_held_coordinates_are_chosen(drawer: Drawer) -> None:
    assert drawer.panel.mode.options == ["py > 0", "py < 0"]
    drawer.panel.mode.value = "py < 0"
    assert drawer.state.plane == Slice(C.X, C.PX, C.PY, -1)
    drawer.panel.mode.value = "py > 0"
    drawer.type("y =", 0.1)
    assert drawer.state.plane == Slice(C.X, C.PX, fixed=((C.Y, 0.1),))
    # Choosing the axis of the other list exchanges both axes.
    drawer.panel.axes[0].value = "px"
    assert drawer.state.plane.axis_names == ("px", "x")
    drawer.state.show_slice(Plane.X_PX)
    drawer.panel.axes[1].value = "epsilon"
    drawer.type("to", 1.5)
    assert drawer.state.plane == Slice(C.X, ParameterAxis("epsilon", 0.5, 1.5, System("I")))


def test_an_illegal_slice_is_refused_with_its_reason_and_the_last_slice_stays(drawer: Drawer) -> None:
    drawer.panel.axes[1].value = "epsilon"
    drawer.type("to", -3.0)
    assert "the lower end must be below the upper end" in drawer.panel.message.object
    assert drawer.state.plane.axis_names == ("x", "epsilon")


def test_a_parameter_slice_follows_another_system_that_has_the_parameter(drawer: Drawer) -> None:
    drawer.panel.axes[1].value = "epsilon"
    drawer.state.show_system(review_for_page(System("III")))
    assert drawer.state.plane == Slice(C.X, ParameterAxis("epsilon", 0.5, 2.0, System("III")))


def test_letters_of_a_formula_are_axes_of_this_system_only(drawer: Drawer) -> None:
    reviewed = review_for_page(System(TYPED, "0.5(x^2+y^2) - a x y^2"))
    drawer.state.show_system(reviewed)
    drawer.panel.axes[1].value = "a"
    assert drawer.state.plane.parameter == ParameterAxis("a", 0.5, 2.0, reviewed.system)
    drawer.state.show_system(review_for_page(System("III")))
    assert drawer.state.plane is Plane.X_PX


def test_a_typed_section_is_that_of_the_state_and_offers_its_starts(drawer: Drawer) -> None:
    drawer.panel.section.value = "x = 0, px > 0"
    assert drawer.state.section == read_section("x = 0 up")
    assert drawer.panel.section.value == "x = 0 up"
    assert drawer.state.plane is Plane.X_PX
    assert drawer.panel.start_on_section.visible
    drawer.panel.start_on_section.clicks += 1
    assert drawer.state.plane == Plane.Y_PY
    assert not drawer.panel.start_on_section.visible


def test_an_illegal_section_is_refused_with_legal_ones(drawer: Drawer) -> None:
    drawer.panel.section.value = "z = 3"
    assert "must be a section such as" in drawer.panel.section_message.object
    assert drawer.state.section == Section.Y_UP


@pytest.mark.parametrize("text", ["y=0", "x = 0 down"])
def test_a_legal_section_replaces_the_message_and_is_written_in_the_usual_way(drawer: Drawer, text: str) -> None:
    drawer.panel.section.value = "z = 3"
    drawer.panel.section.value = text
    assert (drawer.panel.section.value, drawer.panel.section_message.object) == (read_section(text).text, "")


def test_without_a_slice_of_starts_none_is_offered(drawer: Drawer) -> None:
    drawer.panel.section.value = "x + 0.3 px = 0"
    assert not drawer.panel.start_on_section.visible


def test_sections_through_bodies_are_offered_where_the_bodies_are(drawer: Drawer) -> None:
    drawer.state.show_system(review_for_page(System("Copenhagen")))
    assert "x = -0.5 up" in drawer.panel.section.options
    drawer.state.show_system(review_for_page(System("Copenhagen").with_parameter("m", 0.3)))
    assert "x = -0.5 up" not in drawer.panel.section.options


def test_sections_of_the_catalogue_are_offered(drawer: Drawer) -> None:
    drawer.state.show_system(review_for_page(System("Hill")))
    assert {"y = 0 up", "pericentre", "x = 0 up"} <= set(drawer.panel.section.options)
