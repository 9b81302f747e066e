"""The view that the browser gets follows the state of the page."""

from __future__ import annotations

from app.state.view_state import ViewState
from app.views.panels.engine_component import describe_view
from engine import Coordinate, ParameterAxis, Plane, Slice, System


def test_a_view_follows_the_state() -> None:
    view = describe_view(ViewState(system=System("III"), energy=0.45, plane=Plane.X_Y, palette="safe"))
    assert (view["energy"], view["plane"], view["home"]) == (0.45, "x_y", True)
    assert view["colours"][0] == "#009e73"
    assert view["labels"] == ["exit 1", "exit 2", "exit 3", "exit 4"]
    assert view["coding"]["ends"] == [0, 1, 2, 3]


def test_slices_along_a_parameter_have_no_browser_view() -> None:
    view = describe_view(
        ViewState(system=System("I"), plane=Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I"))))
    )
    assert view["slice"] is None
    assert view["plane"] == "x,epsilon=0.5:2.0"
