"""The view that the browser gets follows the state of the page."""

from __future__ import annotations

from app.state.view_state import ViewState
from app.views.panels.engine_component import describe_view
from engine import Coordinate, ParameterAxis, Plane, Slice, System, read_section


def test_a_view_follows_the_state() -> None:
    view = describe_view(ViewState(system=System("III"), energy=0.45, plane=Plane.X_Y, palette="safe"))
    assert (view["plane"], view["home"]) == ("x_y", True)
    assert view["colours"][0] == "#009e73"
    assert view["labels"] == ["exit 1", "exit 2", "exit 3", "exit 4"]
    assert view["coding"]["ends"] == [0, 1, 2, 3]


def test_slices_along_a_parameter_have_no_browser_view() -> None:
    view = describe_view(
        ViewState(system=System("I"), plane=Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I"))))
    )
    assert view["slice"] is None
    assert view["plane"] == "x,epsilon=0.5:2.0"


def test_the_browser_learns_the_section_and_where_its_points_are_drawn() -> None:
    state = ViewState(system=System("I"), energy=0.19)
    first = describe_view(state)
    assert first["slice"]["sectionColumns"] == [0, 2]
    state.show_section(read_section("x = 0.05"), with_slice=True)
    view = describe_view(state)
    assert view["system"] != first["system"]
    assert view["slice"]["sectionColumns"] == [1, 3]
    assert view["coding"]["crossingWords"] == ["upward crossing of x = 0.05", "upward crossings of x = 0.05"]
    # Mirror images of orbits cross x = −0.05.
    assert view["slice"]["mirrored"] is None
    state.show_slice(Plane.X_Y)
    assert describe_view(state)["slice"]["sectionColumns"] is None
