"""Keys move the window, and its history allows to go back."""

from __future__ import annotations

import pytest

from app.state.navigation import PAN_SHARE, Navigation, pan, zoom
from app.state.view_state import ViewState
from engine import Plane, Window

WINDOW = Window(-1.0, 3.0, 0.0, 2.0)


@pytest.mark.parametrize(
    ("key", "moved"),
    [("ArrowLeft", (-1, 0)), ("ArrowRight", (1, 0)), ("ArrowUp", (0, 1)), ("ArrowDown", (0, -1))],
)
def test_an_arrow_moves_by_a_share_of_the_side(key: str, moved: tuple[int, int]) -> None:
    window = pan(WINDOW, key)
    assert window.x_low - WINDOW.x_low == pytest.approx(PAN_SHARE * 4.0 * moved[0])
    assert window.x_high - WINDOW.x_high == pytest.approx(PAN_SHARE * 4.0 * moved[0])
    assert window.ordinate_low - WINDOW.ordinate_low == pytest.approx(PAN_SHARE * 2.0 * moved[1])


def test_a_zoom_keeps_the_centre() -> None:
    assert zoom(WINDOW, 2.0) == Window(0.0, 2.0, 0.5, 1.5)
    assert zoom(zoom(WINDOW, 2.0), 0.5) == WINDOW


def test_a_zoom_beyond_double_precision_is_rejected() -> None:
    with pytest.raises(ValueError, match="window x range"):
        zoom(Window(1.0, 1.0 + 4e-16, 0.0, 1.0), 4.0)


def test_the_first_zoom_starts_from_the_whole_interior() -> None:
    state = ViewState(case="I", energy=0.2)
    whole = state.map_spec().window
    Navigation(state).moves()["+"]()
    assert state.window == zoom(whole, 2.0)


def test_back_and_forward_follow_the_history() -> None:
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


def test_home_is_the_whole_interior_and_part_of_the_history() -> None:
    state = ViewState(case="I", energy=0.2, window=WINDOW)
    moves = Navigation(state).moves()
    moves["h"]()
    assert state.window is None
    moves["b"]()
    assert state.window == WINDOW


def test_another_plane_has_no_history() -> None:
    state = ViewState(case="I", energy=0.2)
    navigation = Navigation(state)
    navigation.moves()["+"]()
    state.param.update(plane=Plane.X_Y, window=None)
    assert not navigation.history.can_go_back
