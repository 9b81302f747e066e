"""The main functions of the page."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from engine import (
    CASES,
    Certificate,
    EscapeMap,
    Fate,
    MapSpec,
    Plane,
    Regularity,
    compute_map,
    compute_regularity,
    integrate_orbit,
)
from tests.browser.explorer_page import ExplorerPage

PICTURES = ("curves", "basins", "times", "crossings")


def assert_same_crossings(explorer: ExplorerPage, expected: EscapeMap) -> None:
    """Compare escaping orbits; the counts of certified orbits end where the certificate is found."""
    escaped = expected.fate >= 1
    np.testing.assert_array_equal(explorer.column("crossings")[escaped], expected.crossings[escaped])
    np.testing.assert_array_equal(np.isfinite(explorer.column("escape_time")), escaped)


def test_the_first_map_is_that_of_the_engine(shared: ExplorerPage) -> None:
    expected = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, t_max=1e5))
    assert_same_crossings(shared, expected)


def test_dragging_the_energy_gives_another_map(explorer: ExplorerPage) -> None:
    before = explorer.column("fate")
    explorer.forget_pixels()
    explorer.drag_energy_to(0.6)
    explorer.wait_for_new_pixels()
    explorer.wait_until_complete()
    assert not np.array_equal(explorer.column("fate"), before)


@pytest.mark.parametrize(("button", "shown"), [("II", "Case II"), ("III", "Case III")])
def test_the_case_can_be_changed(explorer: ExplorerPage, button: str, shown: str) -> None:
    explorer.forget_pixels()
    explorer.pick(button)
    explorer.wait_for_new_pixels()
    expect(explorer.text(shown)).to_be_visible()
    assert set(np.unique(explorer.column("fate"))) >= {5, 6, 7}


@pytest.mark.parametrize(("button", "ordinate"), [("(x, y)", "y"), ("(x, h)", "h")])
def test_the_plane_can_be_changed(explorer: ExplorerPage, button: str, ordinate: str) -> None:
    explorer.forget_pixels()
    explorer.pick(button)
    explorer.wait_for_new_pixels()
    explorer.wait_until_complete()
    label = explorer.page.evaluate("() => Bokeh.documents[0].get_model_by_name('basins').left[0].axis_label")
    assert label == ordinate


def test_the_resolution_can_be_changed(explorer: ExplorerPage) -> None:
    explorer.forget_pixels()
    explorer.choose("Resolution", "113 × 113")
    explorer.wait_for_new_pixels()
    explorer.wait_until_complete()
    assert explorer.column("fate").shape == (113, 113)


def test_a_longer_t_max_leaves_fewer_bounded(explorer: ExplorerPage) -> None:
    bounded = np.sum(explorer.column("fate") == 4)
    explorer.forget_pixels()
    explorer.choose("t_max", "100")
    explorer.wait_for_new_pixels()
    explorer.wait_until_complete()
    assert np.sum(explorer.column("fate") == 4) > bounded


def test_an_energy_can_be_typed(explorer: ExplorerPage) -> None:
    explorer.forget_pixels()
    explorer.type_number("Exact h", "0.2345")
    explorer.wait_for_new_pixels()
    explorer.wait_until_complete()
    expected = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.2345, t_max=1e5))
    assert_same_crossings(explorer, expected)


def test_an_invalid_energy_gives_a_message_and_the_picture_stays(explorer: ExplorerPage) -> None:
    before = explorer.column("fate")
    explorer.type_number("Exact h", "7")
    expect(explorer.text("energy=7.0")).to_be_visible()
    np.testing.assert_array_equal(explorer.column("fate"), before)


@pytest.mark.parametrize("picture", PICTURES)
def test_a_click_integrates_the_orbit_of_that_pixel(for_orbits: ExplorerPage, picture: str) -> None:
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.19, t_max=1e5)
    pixel = spec.pixel_at(0.1, 0.05)
    assert pixel is not None
    columns, rows = spec.pixel_centres()
    x, px = float(columns[pixel[1]]), float(rows[pixel[0]])
    orbit = integrate_orbit(spec.potential, (x, 0.0, px, np.sqrt(2 * (0.19 - x * x / 2) - px * px)), 1e5)
    for_orbits.click(picture, 0.1, 0.05)
    expect(for_orbits.text(f"Escaped through channel {orbit.fate} at t = {orbit.escape_time:.6g}")).to_be_visible()


def test_a_click_marks_the_start_on_every_map(for_orbits: ExplorerPage) -> None:
    for_orbits.click("times", 0.1, 0.05)
    expect(for_orbits.text("Escaped through")).to_be_visible()
    marked = for_orbits.model_data("starts")
    assert [marked["x"][0], marked["y"][0]] == pytest.approx([0.1, 0.05], abs=0.006)


def test_a_bounded_orbit_is_judged_by_its_sali(for_orbits: ExplorerPage) -> None:
    fate = for_orbits.column("fate")
    x, px = MapSpec(CASES["I"], Plane.X_PX, 0.19).pixel_centres()
    middle = np.argwhere(fate == 4).mean(axis=0)
    row, column = min(np.argwhere(fate == 4), key=lambda pixel: np.sum((pixel - middle) ** 2))
    for_orbits.click("basins", float(x[column]), float(px[row]))
    expect(for_orbits.text(re.compile("Bounded until t = 100000 and (regular|chaotic)"))).to_be_visible()


def test_a_click_on_a_forbidden_pixel_gives_a_message(shared: ExplorerPage) -> None:
    x_low, _, low, _ = shared.ranges("basins")
    shared.click("basins", x_low + 0.02, low + 0.02)
    expect(shared.text("Forbidden: no orbit of this energy can start here")).to_be_visible()


def test_a_start_can_be_typed(for_orbits: ExplorerPage) -> None:
    for_orbits.type_number("x", "0.1")
    for_orbits.type_number("px", "0.2")
    for_orbits.press("Integrate")
    orbit = integrate_orbit(CASES["I"], (0.1, 0.0, 0.2, np.sqrt(2 * (0.19 - 0.005) - 0.04)), 1e5)
    expect(for_orbits.text(f"Escaped through channel {orbit.fate} at t = {orbit.escape_time:.6g}")).to_be_visible()


def test_zooming_one_map_zooms_all(explorer: ExplorerPage) -> None:
    before = explorer.ranges("basins")
    explorer.page.mouse.move(*explorer.point("times", 0.0, 0.0))
    explorer.page.mouse.wheel(0, -300)
    explorer.page.wait_for_function(
        "start => Bokeh.documents[0].get_model_by_name('basins').x_range.start > start + 1e-3", arg=before[0]
    )
    assert len({tuple(explorer.ranges(picture)) for picture in PICTURES}) == 1


def test_zooming_computes_the_region_and_back_returns(explorer: ExplorerPage) -> None:
    whole = explorer.column("x"), explorer.column("dw")
    explorer.forget_pixels()
    explorer.page.mouse.move(*explorer.point("times", 0.4, 0.1))
    explorer.page.mouse.wheel(0, -500)
    explorer.wait_for_new_pixels()
    explorer.wait_until_complete()
    x, dw, y, dh = (explorer.column(name) for name in ("x", "dw", "y", "dh"))
    assert dw < 0.9 * whole[1]
    window = (x, x + dw, y, y + dh)
    assert explorer.ranges("basins") == pytest.approx(window)
    # The browser holds the window as an origin and a size, so its ends are rounded.
    expected = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, window=window, t_max=1e5))
    assert np.mean(explorer.column("crossings") == expected.crossings) > 0.98
    explorer.forget_pixels()
    explorer.press("← Back")
    explorer.wait_for_new_pixels()
    explorer.wait_until_complete()
    assert (explorer.column("x"), explorer.column("dw")) == whole


@pytest.mark.parametrize("picture", PICTURES)
def test_hovering_describes_the_pixel(shared: ExplorerPage, picture: str) -> None:
    shared.hover(picture, 0.1, 0.05)
    expect(shared.text("escapes through channel 1")).to_be_visible()
    expect(shared.text(re.compile(r"escape time 3\.\d+, crossings of y = 0: 0"))).to_be_visible()
    expect(shared.text(re.compile(r"\(0\.\d+, 0\.0\d+\)"))).to_be_visible()


def test_a_map_can_be_stopped_and_continued(explorer: ExplorerPage) -> None:
    explorer.choose("t_max", "1 000 000")
    explorer.wait_until_complete()
    explorer.forget_pixels()
    explorer.pick("III")
    explorer.wait_for_new_pixels()
    explorer.press("Stop")
    expect(explorer.text("Stopped:")).to_be_visible()
    assert explorer.column("complete") is False
    explorer.forget_pixels()
    explorer.press("Continue")
    explorer.wait_for_new_pixels()
    expect(explorer.page.get_by_role("button", name="Stop", exact=True)).to_be_enabled()


def test_bounded_orbits_show_their_certificate(shared: ExplorerPage) -> None:
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.19, t_max=1e5)
    whole = compute_map(spec)
    row, column = np.argwhere(whole.certificate == Certificate.ENCLOSED)[0]
    shared.hover("basins", float(whole.x[column]), float(whole.ordinate[row]))
    expect(shared.text("invariant curves separate it from every exit")).to_be_visible()


def test_regular_and_chaotic_orbits_can_be_distinguished(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link="?case=I&h=0.19&resolution=113&t_max=1000")
    title = explorer.page.get_by_text("bounded and chaotic")
    expect(title).not_to_be_visible()
    explorer.page.get_by_label("Regular or chaotic").click()
    expect(title).to_be_visible()
    expect(explorer.text(re.compile(r"\d % of the bounded orbits are chaotic"))).to_be_visible()
    codes = explorer.column("character")
    expected = compute_regularity(compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (113, 113), t_max=1e3)))
    chaotic = expected.character == Regularity.CHAOTIC
    assert chaotic.any()
    assert len(set(codes[chaotic])) == 1
    explorer.page.get_by_label("Regular or chaotic").click()
    expect(title).not_to_be_visible()


def test_the_address_opens_the_same_view(open_explorer: Callable[..., ExplorerPage]) -> None:
    here = open_explorer()
    here.forget_pixels()
    here.pick("III")
    here.wait_for_new_pixels()
    here.type_number("Exact h", "0.4567")
    here.forget_pixels()
    here.choose("Resolution", "113 × 113")
    here.page.wait_for_url(re.compile(r"h=0\.4567.*resolution=113"))
    here.wait_for_new_pixels()
    here.wait_until_complete()
    here.click("basins", 0.1, 0.05)
    here.page.wait_for_url(re.compile("orbits="))
    expect(here.text(re.compile("Escaped through|Bounded until"))).to_be_visible()
    here.wait_until_complete()
    there = open_explorer(link="?" + here.page.url.split("?")[1])
    expect(there.text(re.compile("Escaped through|Bounded until"))).to_be_visible()
    np.testing.assert_array_equal(there.column("fate"), here.column("fate"))
    assert there.column("fate").shape == (113, 113)
    assert there.page.get_by_label("Exact h", exact=True).first.input_value() == "0.4567"


def test_an_invalid_link_gives_a_message_and_shows_the_rest(open_explorer: Callable[..., ExplorerPage]) -> None:
    page = open_explorer(link="?case=II&h=%3Cimg%20src=x%20onerror=alert(1)%3E&t_max=100").page
    expect(page.get_by_text("Ignored h=?img src?x onerror?alert?1?? in the link: choose a finite number.")).to_be_visible()
    expect(page.get_by_text("3 exit channels")).to_be_visible()
    assert page.locator("img[src=x]").count() == 0


def test_two_sessions_are_independent(open_explorer: Callable[..., ExplorerPage]) -> None:
    one, other = open_explorer(), open_explorer()
    before = one.column("fate")
    other.forget_pixels()
    other.pick("III")
    other.wait_for_new_pixels()
    other.wait_until_complete()
    np.testing.assert_array_equal(one.column("fate"), before)
    one.click("basins", 0.1, 0.05)
    expect(one.text("Escaped through channel 1")).to_be_visible()
    expect(other.text("Escaped through channel")).to_have_count(0)


@pytest.mark.parametrize("width", [1600, 420])
def test_pictures_are_square_and_fit_the_screen(open_explorer: Callable[..., ExplorerPage], width: int) -> None:
    explorer = open_explorer(width)
    boxes = explorer.page.evaluate(
        """names => [...Bokeh.index.all_views()].filter(v => names.includes(v.model.name)).map(v => {
            const box = v.canvas_view.el.getBoundingClientRect(), f = v.frame.bbox
            return [box.left, box.right, f.width, f.height]
        })""",
        list(PICTURES),
    )
    assert len(boxes) == 4
    assert all(box[2] == box[3] for box in boxes)
    assert all(box[0] >= 0 and box[1] <= width for box in boxes)
    x_low, x_high, low, high = explorer.ranges("basins")
    assert x_high - x_low == pytest.approx(high - low)


def test_the_legend_has_every_outcome(shared: ExplorerPage) -> None:
    for label in (
        "channel 1",
        "channel 2",
        "bounded",
        "forbidden: no such orbit",
        "outside: starts beyond an exit",
        "not decided yet",
    ):
        expect(shared.page.get_by_text(label, exact=True).first).to_be_visible()
    assert Fate.FAILED not in np.unique(shared.column("fate"))
