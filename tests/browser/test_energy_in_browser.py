"""The energy, dragged and played: previews on the way, the map where it ends."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
from playwright.sync_api import expect

from app.rendering.palette import OUTCOMES
from engine import CASES, Fate, MapSpec, Plane, Window, compute_preview, default_window, preview_spec
from tests.browser.explorer_page import ExplorerPage

WATCH = """() => {
    const source = Bokeh.documents[0].get_model_by_name('maps')
    window.previews = 0
    source.connect(source.properties.data.change, () => { if (source.data.fate[0].shape[0] == 75) window.previews += 1 })
}"""


def test_previews_follow_the_slider_while_it_is_dragged(explorer: ExplorerPage) -> None:
    explorer.page.evaluate(WATCH)
    explorer.drag_energy_to(0.9, steps=10, let_go=False, pause=100)
    explorer.page.wait_for_function("() => window.previews >= 3")
    expect(explorer.text("Preview up to t = 100")).to_be_visible()
    explorer.page.wait_for_timeout(1000)
    shown = explorer.column("fate")
    expected = compute_preview(preview_spec(MapSpec(CASES["I"], Plane.X_PX, 0.46)))
    assert shown.shape == expected.fate.shape
    escaped = expected.fate >= 1
    first = list(OUTCOMES).index(Fate.BOUNDED)
    np.testing.assert_array_equal(shown[escaped] - first, expected.fate[escaped])
    explorer.page.mouse.up()
    expect(explorer.text("Done, t = 100 000")).to_be_visible()
    assert explorer.column("fate").shape == (225, 225)


def test_dragging_back_shows_the_map_again(explorer: ExplorerPage) -> None:
    before = explorer.column("fate")
    explorer.drag_energy_to(0.9, let_go=False, pause=100)
    explorer.wait_for_data("maps", "data.fate[0].shape[0] == 75")
    explorer.drag_energy_to(0.225, pause=100)
    explorer.wait_for_data("maps", "data.fate[0].shape[0] == 225 && data.complete[0]")
    np.testing.assert_array_equal(explorer.column("fate"), before)


def test_the_energy_can_be_played_and_stopped(explorer: ExplorerPage) -> None:
    explorer.page.evaluate(WATCH)
    explorer.press("▶ Play")
    explorer.page.wait_for_function("() => window.previews >= 5")
    explorer.press("■ Stop")
    expect(explorer.text("Done, t = 100 000")).to_be_visible()
    explorer.page.wait_for_url(re.compile(r"h=0\.(19\d|[2-5]\d*)"))
    expect(explorer.page.get_by_role("button", name="▶ Play")).to_be_visible()


def test_in_a_zoom_the_window_stays_while_the_energy_moves(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link="?case=I&h=0.3&window=0.1,0.3,0.0,0.2")
    explorer.drag_energy_to(0.6, let_go=False, pause=100)
    explorer.wait_for_data("maps", "data.fate[0].shape[0] == 75")
    assert explorer.ranges("basins") == [0.1, 0.3, 0.0, 0.2]
    explorer.page.mouse.up()
    explorer.wait_until_complete()


def test_the_energy_plane_opens_the_plane_of_an_energy(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link="?case=II&plane=x_h&t_max=1000")
    explorer.click("basins", 0.1, 0.3)
    expect(explorer.text(re.compile("Escaped through"))).to_be_visible()
    verdict = explorer.text(re.compile("Escaped through")).inner_text()
    explorer.press("Open (x, px) at this h")
    explorer.page.wait_for_url(re.compile(r"plane=x_px&h=0\.(29|30)\d+.*orbits=0\.\d+,0\.0"))
    explorer.wait_until_complete()
    expect(explorer.text(re.compile("Escaped through"))).to_have_text(verdict)
    ranges = explorer.ranges("basins")
    assert Window(*ranges) != default_window(CASES["II"], Plane.X_PX, 0.2)
