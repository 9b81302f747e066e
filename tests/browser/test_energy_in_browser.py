"""The energy, dragged and played: previews on the way, the map where it ends."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import Locator, expect

from engine import CASES, Fate, MapSpec, Plane, compute_map
from engine.service import compute_preview, preview_spec
from plots.palette import OUTCOMES
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

# Previews have 76 pixels per side.
WATCH = """() => {
    const source = Bokeh.documents[0].get_model_by_name('maps')
    window.previews = 0
    source.connect(source.properties.data.change, () => { if (source.data.fate[0].shape[0] == 76) window.previews += 1 })
}"""


def assert_same_fates(explorer: ExplorerPage, expected: np.ndarray) -> None:
    """Compare escaping orbits."""
    shown, escaped = explorer.column("fate"), expected >= 1
    assert shown.shape == expected.shape
    np.testing.assert_array_equal(shown[escaped] - list(OUTCOMES).index(Fate.BOUNDED), expected[escaped])


def exact_energy(explorer: ExplorerPage) -> Locator:
    return explorer.page.get_by_label("Exact h", exact=True)


def test_previews_follow_the_slider_and_the_map_its_release(explorer: ExplorerPage) -> None:
    explorer.page.evaluate(WATCH)
    explorer.drag_energy_to(0.9, steps=10, let_go=False, pause=50)
    explorer.page.wait_for_function("() => window.previews >= 3")
    expect(explorer.text("Preview up to t = 100")).to_be_visible()
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.46, (112, 112), t_max=100.0)
    # The number follows the previews.
    expect(exact_energy(explorer)).to_have_value("0.46")
    assert_same_fates(explorer, compute_preview(preview_spec(spec)).fate)
    explorer.page.mouse.up()
    explorer.wait_for_view("h=0.46&")
    assert_same_fates(explorer, compute_map(spec).fate)


def test_dragging_back_shows_the_map_again(explorer: ExplorerPage) -> None:
    before = explorer.column("fate")
    explorer.drag_energy_to(0.9, let_go=False)
    explorer.wait_for_data("maps", "data.fate[0].shape[0] == 76")
    explorer.drag_energy_to(0.225)
    explorer.wait_for_data("maps", "data.fate[0].shape[0] == 112 && data.complete[0]")
    np.testing.assert_array_equal(explorer.column("fate"), before)


def test_the_energy_can_be_played_and_stopped(explorer: ExplorerPage) -> None:
    explorer.page.evaluate(WATCH)
    explorer.press("▶ Play")
    explorer.page.wait_for_function("() => window.previews >= 5")
    explorer.press("■ Stop")
    explorer.page.wait_for_url(re.compile(r"h=0\.(19\d|[2-5]\d*)"))
    expect(explorer.button("▶ Play")).to_be_visible()
    explorer.wait_until_done()


def test_in_a_zoom_the_window_stays_while_the_energy_moves(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link=f"{QUICK}&window=0.1,0.3,0.0,0.2")
    explorer.drag_energy_to(0.6, let_go=False)
    explorer.wait_for_data("maps", "data.fate[0].shape[0] == 76")
    assert explorer.ranges("basins") == [0.1, 0.3, 0.0, 0.2]
    explorer.page.mouse.up()
    explorer.wait_for_view("window=0.1,0.3,0.0,0.2")
    assert explorer.ranges("basins") == [0.1, 0.3, 0.0, 0.2]


@pytest.mark.slow
def test_the_energy_plane_opens_the_plane_of_an_energy(explorer: ExplorerPage) -> None:
    explorer.pick("II")
    explorer.pick("(x, h)")
    explorer.wait_for_view("plane=x_h")
    explorer.click("basins", 0.1, 0.3)
    verdict = explorer.text(re.compile("Escaped through"))
    expect(verdict).to_be_visible()
    sentence = verdict.inner_text()
    explorer.press("Open (x, px) at this h")
    explorer.wait_for_view("plane=x_px", "orbits=")
    explorer.page.wait_for_url(re.compile(r"h=0\.(29|30)\d+.*orbits=0\.\d+,0\.0"))
    expect(verdict).to_have_text(sentence)


def test_an_energy_typed_right_after_choosing_a_case_is_used_and_shown(explorer: ExplorerPage) -> None:
    explorer.pick("III")
    explorer.type_number("Exact h", "0.6")
    explorer.wait_for_view("case=III", "h=0.6&")
    expect(exact_energy(explorer)).to_have_value("0.6")


def test_an_energy_that_is_being_typed_stays_when_the_case_changes(explorer: ExplorerPage) -> None:
    exact_energy(explorer).press("ControlOrMeta+a")
    exact_energy(explorer).press_sequentially("0.6")
    # Without taking the focus from the box.
    explorer.radio("III").evaluate("radio => radio.click()")
    explorer.wait_for_view("case=III", "h=0.35&")
    expect(exact_energy(explorer)).to_have_value("0.6")
    exact_energy(explorer).press("Enter")
    explorer.wait_for_view("case=III", "h=0.6&")


def test_the_number_before_can_be_typed_for_another_case(explorer: ExplorerPage) -> None:
    exact_energy(explorer).press("ControlOrMeta+a")
    exact_energy(explorer).press_sequentially("0.19")
    explorer.radio("II").evaluate("radio => radio.click()")
    explorer.wait_for_view("case=II", "h=0.2&")
    exact_energy(explorer).press("Enter")
    explorer.wait_for_view("case=II", "h=0.19&")


def test_a_box_that_is_left_empty_shows_the_energy_again(explorer: ExplorerPage) -> None:
    exact_energy(explorer).fill("")
    exact_energy(explorer).press("Tab")
    expect(exact_energy(explorer)).to_have_value("0.19")
