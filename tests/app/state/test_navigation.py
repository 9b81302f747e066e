"""Keys move the window."""

from __future__ import annotations

import pytest

from app.state.navigation import PAN_SHARE, WINDOW_MOVES, ZOOM_FACTOR, zoom
from engine import Window

WINDOW = Window(-1.0, 3.0, 0.0, 2.0)


@pytest.mark.parametrize(
    ("key", "moved"),
    [("ArrowLeft", (-1, 0)), ("ArrowRight", (1, 0)), ("ArrowUp", (0, 1)), ("ArrowDown", (0, -1))],
)
def test_an_arrow_moves_by_a_share_of_the_side(key: str, moved: tuple[int, int]) -> None:
    window = WINDOW_MOVES[key].change(WINDOW)
    assert window is not None
    assert window.x_low - WINDOW.x_low == pytest.approx(PAN_SHARE * 4.0 * moved[0])
    assert window.x_high - WINDOW.x_high == pytest.approx(PAN_SHARE * 4.0 * moved[0])
    assert window.ordinate_low - WINDOW.ordinate_low == pytest.approx(PAN_SHARE * 2.0 * moved[1])


def test_a_zoom_about_a_point_keeps_its_place_in_the_window() -> None:
    assert zoom(WINDOW, 2.0) == Window(0.0, 2.0, 0.5, 1.5)
    zoomed = zoom(WINDOW, 4.0, (0.0, 1.5))
    assert zoomed == Window(-0.25, 0.75, 1.125, 1.625)
    for low, high, was_low, was_high, at in ((-0.25, 0.75, -1.0, 3.0, 0.0), (1.125, 1.625, 0.0, 2.0, 1.5)):
        assert (at - low) / (high - low) == pytest.approx((at - was_low) / (was_high - was_low))


def test_a_zoom_beyond_double_precision_is_rejected() -> None:
    with pytest.raises(ValueError, match="window x range"):
        zoom(Window(1.0, 1.0 + 4e-16, 0.0, 1.0), 4.0)


@pytest.mark.parametrize(("key", "factor"), [("+", ZOOM_FACTOR), ("-", 1.0 / ZOOM_FACTOR)])
def test_keys_zoom_the_window(key: str, factor: float) -> None:
    change = WINDOW_MOVES[key].change
    assert change is not None
    assert change(WINDOW) == zoom(WINDOW, factor)


def test_the_key_of_the_whole_plane_needs_no_window() -> None:
    assert WINDOW_MOVES["h"].change is None
