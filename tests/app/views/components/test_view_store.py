"""The store takes windows to which the pictures are moved, up to double precision, and numbers those chosen elsewhere."""

from __future__ import annotations

from typing import Any

import pytest

from app.state.view_state import ViewState
from engine import CASES, MapSpec, Plane, Window
from plots.browser.browser_system import window_in_browser
from tests.app.browser_messages import send
from tests.app.map_actions import make_browser_engine

HOME = MapSpec(CASES["I"], Plane.X_PX, 0.19)


class Shown:
    """A store that shows the window of the whole interior first. Records the windows to which the visitor moves the pictures."""

    def __init__(self) -> None:
        self.zooms: list[Window | None] = []
        self.store = make_browser_engine(on_zoom=self.zooms.append)
        self.home = HOME.find_window()
        self.store.set_home(HOME)
        self.store.follow(self.home)

    def move(self, window: Window, count: int) -> None:
        """Send a window as the browser does."""
        self.move_edges(window_in_browser(window), count)

    def move_edges(self, edges: dict[str, float], count: int) -> None:
        send(self.store, {"name": "window", "value": edges, "count": count, "done": False})

    @property
    def shown(self) -> tuple[Any, int]:
        return self.store.window["value"], self.store.window["count"]


def shown(window: Window, count: int) -> tuple[Any, int]:
    return window_in_browser(window), count


def test_reversed_edges_do_not_give_a_window() -> None:
    page = Shown()
    for count, (low, high) in enumerate(((0.2, 0.1), (0.1, 0.2)), start=1):
        page.move_edges(window_in_browser(page.home) | {"xLow": low, "xHigh": high}, count)
    assert [(zoom.x_low, zoom.x_high) for zoom in page.zooms if zoom] == [(0.1, 0.2)]


def test_edges_that_give_no_window_are_counted_so_that_the_browser_shows_the_previous_window_again() -> None:
    page = Shown()
    page.move_edges(window_in_browser(page.home) | {"xLow": 0.2, "xHigh": 0.1}, 1)
    assert page.shown == shown(page.home, 1)


def test_the_window_of_the_whole_interior_is_no_zoom() -> None:
    page = Shown()
    page.store.follow(Window(0.1, 0.2, 0.1, 0.2))
    page.move(page.home, 1)
    assert page.zooms == [None]


@pytest.mark.parametrize("corner", [(0.0, 0.0), (0.1149, 0.3006), (-0.45, -0.4)])
def test_the_smallest_window_can_be_computed_and_a_tenth_of_it_cannot(corner: tuple[float, float]) -> None:
    store = make_browser_engine()
    store.set_home(HOME)

    def window(share: float) -> Window:
        x, ordinate = corner
        return Window(x, x + share * store.x.min_interval, ordinate, ordinate + share * store.ordinate.min_interval)

    smallest = window(1.0)
    assert MapSpec(HOME.potential, HOME.plane, HOME.energy, window=smallest).find_window() == smallest
    with pytest.raises(ValueError, match="double precision ends here"):
        MapSpec(HOME.potential, HOME.plane, HOME.energy, window=window(0.1)).find_window()


def test_a_move_that_the_browser_makes_before_it_has_the_window_is_ignored() -> None:
    page, closer, closest = Shown(), Window(-0.1, 0.1, -0.1, 0.1), Window(-0.05, 0.05, -0.1, 0.1)
    page.store.go_to(closer)
    assert page.shown == shown(closer, 1)
    page.move(closest, 1)
    assert page.zooms == []
    assert page.shown == shown(closer, 1)
    page.move(closest, 2)
    assert page.zooms == [closest]


def test_a_window_is_shown_with_the_number_of_the_move_so_that_it_does_not_undo_later_moves() -> None:
    page, moved = Shown(), Window(-0.2, 0.2, -0.1, 0.1)
    page.move(moved, 1)
    page.store.go_to(moved)
    assert page.shown == shown(moved, 1)


def test_a_refused_move_is_undone_with_a_larger_number() -> None:
    page = Shown()
    page.move(Window(-0.2, 0.2, -0.1, 0.1), 1)
    page.store.go_to(page.home)
    assert page.shown == shown(page.home, 2)


def test_a_window_that_the_browser_finds_is_replaced_by_that_of_the_map_even_if_it_was_shown_before() -> None:
    page = Shown()
    page.store.leave_window()
    assert page.shown == (None, 1)
    assert page.store.magnification == 1.0
    page.store.follow(page.home)
    assert page.shown == shown(page.home, 1)


def test_the_window_of_an_earlier_map_does_not_hide_a_move_that_is_on_its_way() -> None:
    page, moved = Shown(), Window(-0.2, 0.2, -0.1, 0.1)
    page.store.follow(Window(-0.3, 0.3, -0.3, 0.3))
    assert page.shown[1] == 0
    page.move(moved, 1)
    assert page.zooms == [moved]


def test_rounding_differences_show_nothing() -> None:
    page = Shown()
    page.store.go_to(Window(*(edge * (1.0 + 1e-9) for edge in page.home.edges)))
    assert page.shown == shown(page.home, 0)


def test_the_magnification_is_that_of_the_width() -> None:
    page = Shown()
    page.store.follow(Window(0.0, 0.01 * (page.home.x_high - page.home.x_low), 0.0, 0.1))
    assert page.store.magnification == pytest.approx(100.0)


def test_the_energy_follows_the_state_with_the_number_of_energies_received_before() -> None:
    state = ViewState(energy=0.45)
    store = make_browser_engine(state)
    assert store.energy == {"value": 0.45, "count": 0}
    send(store, {"name": "energy", "value": 0.3, "count": 3, "done": True})
    assert store.energy == {"value": 0.3, "count": 3}
    state.energy = 0.25
    assert store.energy == {"value": 0.25, "count": 3}


def test_a_refused_energy_is_counted_so_that_the_browser_shows_the_previous_energy_again() -> None:
    state = ViewState(energy=0.45, plane=Plane.X_H)
    store = make_browser_engine(state)
    send(store, *({"name": "energy", "value": value, "count": count, "done": True} for value, count in (("x", 1), (0.3, 2))))
    assert store.energy == {"value": 0.45, "count": 2}
