"""While the energy is dragged or played, the browser computes the pixels. At the final energy, the server's map is shown."""

from __future__ import annotations

import re

import numpy as np
import pytest
from playwright.sync_api import Locator, expect

from engine import CASES, Fate, MapSpec, Plane, compute_map
from plots.pictures.palette import DEFAULT_COLOURS, OUTCOMES
from tests.browser.explorer_page import ExplorerPage

# Number of zooms in which the browser must draw a preview.
MOST_ZOOMS = 8

# Counts messages to the server in `window.sent`.
WATCH = """() => {
    window.sent = 0
    const send = WebSocket.prototype.send
    WebSocket.prototype.send = function (data) { window.sent += 1; return send.call(this, data) }
}"""

# Colours of a column of the picture on the slider, at a place from 0 to 1, from the top.
STRIP = """place => {
    const view = [...Bokeh.index.all_views()].find(view => view.model.class_name === 'EnergySlider')
    const canvas = view.shadow_el.querySelector('canvas'), {width, height} = canvas
    const context = new OffscreenCanvas(width, height).getContext('2d', {willReadFrequently: true})
    context.drawImage(canvas, 0, 0)
    const {data} = context.getImageData(Math.floor(place * width), 0, 1, height)
    return Array.from({length: height}, (_, row) => [...data.subarray(4 * row, 4 * row + 4)])
}"""


def assert_same_fates(explorer: ExplorerPage, expected: np.ndarray) -> None:
    """Compare the exits of escaping orbits."""
    shown, escaped = explorer.column("fate"), expected >= 1
    assert shown.shape == expected.shape
    np.testing.assert_array_equal(shown[escaped] - list(OUTCOMES).index(Fate.BOUNDED), expected[escaped])


def exact_energy(explorer: ExplorerPage) -> Locator:
    return explorer.page.get_by_label("Exact h", exact=True)


def moving_picture(explorer: ExplorerPage) -> Locator:
    """Return the canvas over one of the pictures while the energy moves."""
    return explorer.page.locator("canvas[data-energy]").first


def test_the_slider_shows_the_shares_of_the_outcomes_at_each_energy(explorer: ExplorerPage) -> None:
    slider = explorer.page.get_by_role("slider", name="Energy h", exact=True)
    expect(slider).to_have_attribute("title", "Shares of a coarse map at t = 100; grey: still inside")
    low, high = (float(slider.get_attribute(name) or "nan") for name in ("min", "max"))
    # An energy of which the strip has a column.
    place = 0.25
    explorer.page.wait_for_function(f"place => ({STRIP})(place).every(colour => colour[3] > 0)", arg=place)
    colours = [tuple(colour) for colour in explorer.page.evaluate(STRIP, place)]
    fate = compute_map(MapSpec(CASES["I"], Plane.X_PX, low + place * (high - low), (32, 32), t_max=100.0)).fate
    allowed = fate[~np.isin(fate, (Fate.FORBIDDEN, Fate.OUTSIDE))]
    for channel, colour in enumerate(DEFAULT_COLOURS.channels[:2], 1):
        share = colours.count((*bytes.fromhex(colour[1:]), 255)) / len(colours)
        assert share == pytest.approx(np.mean(allowed == channel), abs=1.0 / len(colours))


def test_pixels_follow_the_slider_without_the_server(explorer: ExplorerPage) -> None:
    # Wait until the browser has its engine.
    explorer.drag_energy_to(0.3, let_go=False)
    explorer.wait_for_preview(0.22)
    explorer.page.evaluate(WATCH)
    for share, energy in ((0.5, "0.3"), (0.7, "0.38"), (0.9, "0.46")):
        explorer.move_slider_to(share)
        expect(moving_picture(explorer)).to_have_attribute("data-energy", energy)
    explorer.wait_for_preview(0.46)
    assert explorer.page.evaluate("() => window.sent") == 0
    expect(explorer.text("Preview up to t =")).to_be_visible()
    # The number follows the pixels.
    expect(exact_energy(explorer)).to_have_value("0.46")
    explorer.page.mouse.up()
    explorer.wait_for_view("h=0.46&")


def test_the_preview_at_rest_is_that_of_the_map_which_follows_the_release(explorer: ExplorerPage) -> None:
    explorer.drag_energy_to(0.9, let_go=False)
    explorer.wait_for_preview(0.46, least=112)
    window = explorer.window_of_pixels()
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.46, (112, 112), t_max=100.0)
    np.testing.assert_allclose(window, list(vars(spec.find_window()).values()), rtol=0.05)
    explorer.page.mouse.up()
    explorer.wait_for_view("h=0.46&")
    expected = compute_map(spec).fate
    assert_same_fates(explorer, expected)


def test_a_drag_back_to_the_energy_of_the_server_restores_its_map_and_window(explorer: ExplorerPage) -> None:
    home = explorer.ranges("basins")
    explorer.drag_energy_to(0.3, let_go=False)
    explorer.wait_for_preview(0.22)
    assert explorer.ranges("basins") != home
    explorer.drag_energy_to(0.225)
    explorer.wait_for_data("maps", "data.complete[0]")
    assert explorer.ranges("basins") == home
    expect(exact_energy(explorer)).to_have_value("0.19")


def test_the_energy_can_be_played_and_stopped_without_the_server_between(explorer: ExplorerPage) -> None:
    explorer.start_engine()
    explorer.press("▶ Play")
    expect(explorer.button("■ Stop")).to_be_visible()
    explorer.page.evaluate(WATCH)
    for _ in range(3):
        shown = moving_picture(explorer).get_attribute("data-energy")
        expect(moving_picture(explorer)).not_to_have_attribute("data-energy", shown or "")
    assert explorer.page.evaluate("() => window.sent") == 0
    explorer.press("■ Stop")
    explorer.page.wait_for_url(re.compile(r"h=0\.(19\d|[2-5]\d*)"))
    expect(explorer.button("▶ Play")).to_be_visible()
    explorer.wait_until_done()


def test_a_zoom_is_drawn_by_the_browser_until_the_map_comes(explorer: ExplorerPage) -> None:
    explorer.start_engine()
    explorer.page.evaluate(
        """() => {
            window.previewed = false
            const source = Bokeh.documents[0].get_model_by_name('maps')
            source.connect(source.properties.data.change, () => {
                // The server's crossings are integers.
                window.previewed ||= source.data.crossings[0] instanceof Float32Array
            })
        }"""
    )
    # On a busy machine the server's map of a window can be complete before the first preview of this window.
    for _ in range(MOST_ZOOMS):
        width = explorer.column("dw")
        explorer.turn_wheel("basins", 0.1, 0.1, -100)
        explorer.wait_for_data("maps", f"window.previewed || data.complete[0] && data.dw[0] < {width}")
        if explorer.page.evaluate("() => window.previewed"):
            break
    else:
        pytest.fail(f"no preview in {MOST_ZOOMS} zooms")
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] < {width}")


def test_the_orbit_under_the_cursor_is_drawn(explorer: ExplorerPage) -> None:
    explorer.start_engine()
    explorer.hover("basins", 0.3, 0.1)
    card = explorer.page.locator(".orbit-card")
    expect(card).to_be_visible()
    expect(card).to_have_attribute("aria-label", re.compile(r"Exit [12] at t = |Inside until t = 200"))
    explorer.page.mouse.move(5, 5)
    expect(card).to_be_hidden()


def test_the_orbit_of_a_resting_cursor_is_drawn_again_after_the_wheel(explorer: ExplorerPage) -> None:
    explorer.start_engine()
    explorer.hover("basins", 0.3, 0.1)
    card = explorer.page.locator(".orbit-card")
    expect(card).to_be_visible()
    explorer.page.evaluate("document.addEventListener('pointermove', () => { window.moves = (window.moves ?? 0) + 1 }, true)")
    explorer.page.mouse.wheel(0, -240)
    expect(card).to_be_hidden()
    expect(card).to_be_visible()
    assert explorer.page.evaluate("moves") == 1


def test_an_energy_typed_right_after_choosing_a_case_is_used_and_shown(explorer: ExplorerPage) -> None:
    explorer.pick("III")
    explorer.type_number("Exact h", "1.1")
    explorer.wait_for_view("case=III", "h=1.1&")
    expect(exact_energy(explorer)).to_have_value("1.1")
    expect(explorer.text("h = 1.1, above the slider")).to_be_visible()


def test_an_energy_that_is_being_typed_stays_when_the_case_changes(explorer: ExplorerPage) -> None:
    exact_energy(explorer).press("ControlOrMeta+a")
    exact_energy(explorer).press_sequentially("0.6")
    # This does not take the focus from the box.
    explorer.radio("III").evaluate("radio => radio.click()")
    explorer.wait_for_view("case=III", "h=0.35&")
    expect(exact_energy(explorer)).to_have_value("0.6")
    exact_energy(explorer).press("Enter")
    explorer.wait_for_view("case=III", "h=0.6&")


def test_typing_replaces_a_selected_energy_that_the_server_has_changed_meanwhile(explorer: ExplorerPage) -> None:
    exact_energy(explorer).press("ControlOrMeta+a")
    # This does not take the focus from the box.
    explorer.radio("III").evaluate("radio => radio.click()")
    explorer.wait_for_view("case=III", "h=0.35&")
    expect(exact_energy(explorer)).to_have_value("0.35")
    explorer.page.keyboard.type("0.6")
    explorer.page.keyboard.press("Enter")
    explorer.wait_for_view("case=III", "h=0.6&")


def test_a_box_that_is_left_empty_shows_the_energy_again(explorer: ExplorerPage) -> None:
    exact_energy(explorer).fill("")
    exact_energy(explorer).press("Tab")
    expect(exact_energy(explorer)).to_have_value("0.19")
