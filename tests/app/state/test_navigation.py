"""Keys move the window, and back leads through where it was."""

from __future__ import annotations

import pytest

from app.state.navigation import PAN_SHARE, Navigation, panned, zoomed
from app.state.view_state import ViewState
from engine import Plane, Window

WINDOW = Window(-1.0, 3.0, 0.0, 2.0)


@pytest.mark.parametrize(
    ("key", "moved"),
    [("ArrowLeft", (-1, 0)), ("ArrowRight", (1, 0)), ("ArrowUp", (0, 1)), ("ArrowDown", (0, -1))],
)
def test_an_arrow_moves_by_a_share_of_the_side(key: str, moved: tuple[int, int]) -> None:
    window = panned(WINDOW, key)
    assert window.x_low - WINDOW.x_low == pytest.approx(PAN_SHARE * 4.0 * moved[0])
    assert window.x_high - WINDOW.x_high == pytest.approx(PAN_SHARE * 4.0 * moved[0])
    assert window.ordinate_low - WINDOW.ordinate_low == pytest.approx(PAN_SHARE * 2.0 * moved[1])


def test_a_zoom_keeps_the_centre() -> None:
    assert zoomed(WINDOW, 2.0) == Window(0.0, 2.0, 0.5, 1.5)
    assert zoomed(zoomed(WINDOW, 2.0), 0.5) == WINDOW


def test_where_double_precision_ends_a_zoom_is_refused() -> None:
    with pytest.raises(ValueError, match="window x range"):
        zoomed(Window(1.0, 1.0 + 4e-16, 0.0, 1.0), 4.0)


def test_the_first_zoom_is_into_the_whole_plane() -> None:
    state = ViewState(case="I", energy=0.2)
    whole = state.map_spec().window
    Navigation(state).moves()["+"]()
    assert state.window == zoomed(whole, 2.0)


def test_back_and_forward_walk_through_the_windows() -> None:
    state = ViewState(case="I", energy=0.2)
    navigation = Navigation(state)
    moves = navigation.moves()
    moves["+"]()
    first = state.window
    moves["ArrowLeft"]()
    second = state.window
    moves["b"]()
    assert state.window == first
    moves["b"]()
    assert state.window is None
    moves["f"]()
    moves["f"]()
    assert state.window == second


def test_home_is_the_whole_plane_and_can_be_left_again() -> None:
    state = ViewState(case="I", energy=0.2, window=WINDOW)
    moves = Navigation(state).moves()
    moves["h"]()
    assert state.window is None
    moves["b"]()
    assert state.window == WINDOW


def test_another_plane_has_no_past() -> None:
    state = ViewState(case="I", energy=0.2)
    navigation = Navigation(state)
    navigation.moves()["+"]()
    state.param.update(plane=Plane.X_Y, window=None)
    assert not navigation.history.can_go_back
