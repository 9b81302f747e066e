"""One finger scrolls the page; two fingers move and zoom a map."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

# Number of moves between the beginning and the end of a touch.
STEPS = 12

Path = tuple[tuple[float, float], tuple[float, float]]
"""Where a finger begins and ends, in pixels from the middle of a picture."""


@pytest.fixture(scope="module")
def opened(open_for_all: Callable[..., ExplorerPage]) -> ExplorerPage:
    # On a wide screen the maps keep their place when the line above them changes.
    return open_touched(open_for_all, 1600)


def open_touched(open_page: Callable[..., ExplorerPage], width: int) -> ExplorerPage:
    explorer = open_page(width, 900, QUICK, touch=True)
    expect(explorer.radio("Scroll")).to_be_checked()
    return explorer


def move_fingers(explorer: ExplorerPage, *paths: Path) -> None:
    """Move fingers over the picture of the basins, all at once and in steps."""
    begins, ends = (middle_of(explorer) + np.array([path[end] for path in paths]) for end in (0, 1))
    session = explorer.page.context.new_cdp_session(explorer.page)

    def touch(kind: str, points: np.ndarray) -> None:
        touches = [{"x": float(x), "y": float(y), "id": number} for number, (x, y) in enumerate(points)]
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})

    touch("touchStart", begins)
    for step in range(1, STEPS + 1):
        touch("touchMove", begins + (ends - begins) * step / STEPS)
    touch("touchEnd", ends[:0])
    session.detach()


def middle_of(explorer: ExplorerPage) -> np.ndarray:
    """Return the middle of the picture of the basins on the screen."""
    (x, _), (ordinate, _) = window(explorer)
    return np.array(explorer.point("basins", x, ordinate))


def window(explorer: ExplorerPage) -> np.ndarray:
    """Return the middle and the length of the window on each axis, of shape (2, 2)."""
    x_low, x_high, low, high = explorer.ranges("basins")
    return np.array([[0.5 * (x_low + x_high), x_high - x_low], [0.5 * (low + high), high - low]])


def test_one_finger_scrolls_the_page_and_leaves_the_map(open_explorer: Callable[..., ExplorerPage]) -> None:
    phone = open_touched(open_explorer, 420)
    before, address = window(phone), phone.page.url
    move_fingers(phone, ((0, 60), (0, -100)))
    phone.page.wait_for_function("() => window.scrollY > 50")
    np.testing.assert_array_equal(window(phone), before)
    assert phone.page.url == address


def test_two_fingers_that_part_zoom_the_map(explorer: ExplorerPage) -> None:
    before, middle = window(explorer), middle_of(explorer)
    move_fingers(explorer, ((-40, 0), (-80, 0)), ((40, 0), (80, 0)))
    explorer.wait_for_view("window=")
    np.testing.assert_allclose(window(explorer)[:, 1], 0.5 * before[:, 1], rtol=1e-6)
    np.testing.assert_allclose(explorer.point("basins", *before[:, 0]), middle, atol=1.0)
    assert explorer.page.evaluate("history.state.entry") == 1


@pytest.mark.slow
def test_a_finger_that_rests_shows_the_orbit_under_it(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_touched(open_explorer, 420)
    explorer.start_engine()
    card, session = explorer.page.locator(".orbit-card"), explorer.page.context.new_cdp_session(explorer.page)
    x, y = middle_of(explorer)

    def touch(kind: str, *points: dict[str, float]) -> None:
        session.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": list(points)})

    touch("touchStart", {"x": float(x), "y": float(y)})
    expect(card).to_be_visible()
    before, label = window(explorer), card.get_attribute("aria-label")
    touch("touchMove", {"x": float(x) + 40.0, "y": float(y) + 30.0})
    expect(card).not_to_have_attribute("aria-label", label or "")
    np.testing.assert_array_equal(window(explorer), before)
    touch("touchEnd")
    expect(card).to_be_hidden()
