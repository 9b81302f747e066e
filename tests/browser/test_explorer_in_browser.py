"""The main functions of the page: energy, case, axes, clicks, zoom and stop."""

from __future__ import annotations

import re
from collections.abc import Callable
from urllib.parse import urlsplit

import numpy as np
import pytest
from playwright.sync_api import expect

from app.views.components.notice import PASSING_SECONDS
from engine import CASES, Coordinate, EscapeMap, Evidence, Fate, MapSpec, Plane, Slice, compute_map, integrate_orbit
from plots.pictures.image_columns import map_columns
from tests.browser.explorer_page import ExplorerPage

MAPS = ("basins", "times", "crossings")
# Names of the axes of each picture, below its frame and above it.
_AXIS_NAMES = """names => {
    const strips = [...Bokeh.index.all_views()].find(view => view.model.css_classes?.includes("strips")).shadow_el
    const text = element => element.querySelector(".axis-name").textContent
    return [...Bokeh.index.all_views()].filter(view => names.includes(view.model.name))
        .map(view => `${text(strips.querySelector(`[data-picture=${view.model.name}]`))} ${text(view.shadow_el)}`)
}"""


def quick_map(energy: float, **options: object) -> EscapeMap:
    """Return the map of the page `explorer` at an energy."""
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, energy, (112, 112), t_max=100.0, **options))


def assert_same_crossings(explorer: ExplorerPage, expected: EscapeMap) -> None:
    """Compare crossings of escaping orbits only, because a bounded orbit is integrated only until there is evidence."""
    escaped = expected.fate >= 1
    np.testing.assert_array_equal(explorer.column("crossings")[escaped], expected.crossings[escaped])
    np.testing.assert_array_equal(np.isfinite(explorer.column("escape_time")), escaped)


@pytest.fixture(scope="module")
def shared(open_for_all: Callable[..., ExplorerPage]) -> ExplorerPage:
    """Return the page as it opens by default, for tests that leave it unchanged."""
    return open_for_all()


@pytest.fixture(scope="module")
def first_map() -> EscapeMap:
    """Return the map with which the page opens."""
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, t_max=1e5))


def test_the_first_map_is_that_of_the_engine(shared: ExplorerPage, first_map: EscapeMap) -> None:
    assert_same_crossings(shared, first_map)
    assert Fate.FAILED not in np.unique(shared.column("fate"))


def test_the_controls_choose_the_map(explorer: ExplorerPage) -> None:
    explorer.pick("III")
    explorer.wait_for_view("case=III&")
    expect(explorer.text("4 exits above")).to_be_visible()
    explorer.pick(Plane.X_Y.title)
    explorer.wait_for_view("plane=x_y")
    labels = explorer.page.evaluate(_AXIS_NAMES, list(MAPS))
    assert set(labels) == {"x → y ↑"}
    explorer.choose("Resolution", "224 × 224")
    explorer.choose("t_max", "1 000")
    explorer.type_number("Exact h", "0.4567")
    explorer.wait_for_view("h=0.4567", "resolution=224", "t_max=1000&")
    assert_same_crossings(explorer, compute_map(MapSpec(CASES["III"], Plane.X_Y, 0.4567, (224, 224), t_max=1e3)))


def test_a_launch_angle_is_chosen_as_an_axis(explorer: ExplorerPage) -> None:
    explorer.press("Axes …")
    explorer.page.get_by_label("Vertical axis").select_option(label="θ")
    explorer.wait_for_view("plane=x,theta")
    expect(explorer.button("(x, θ) …")).to_be_visible()
    found = compute_map(MapSpec(CASES["I"], Slice(Coordinate.X, Coordinate.THETA), 0.19, (112, 112), t_max=100.0))
    np.testing.assert_array_equal(explorer.column("fate"), map_columns(found)["fate"][0])
    explorer.press("Close")


def test_an_invalid_energy_gives_a_warning_and_the_picture_stays_grey(explorer: ExplorerPage) -> None:
    before = explorer.column("fate")
    explorer.type_number("Exact h", "1000")
    warning = explorer.page.get_by_role("alert")
    expect(warning).to_contain_text("h = 1000")
    np.testing.assert_array_equal(explorer.column("fate"), before)
    pictures = explorer.page.locator(".map, .well")
    expect(pictures).to_have_count(4)
    for picture in pictures.all():
        expect(picture).to_have_css("filter", "grayscale(1)")
    explorer.type_number("Exact h", "0.2")
    expect(warning).to_have_count(0)
    for picture in pictures.all():
        expect(picture).to_have_css("filter", "none")


def test_a_click_integrates_the_orbit_of_that_pixel_and_marks_it(explorer: ExplorerPage) -> None:
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.19, (112, 112), t_max=100.0)
    pixel = spec.pixel_at(0.1, 0.05)
    assert pixel is not None
    columns, rows = spec.pixel_centres()
    x, px = float(columns[pixel[1]]), float(rows[pixel[0]])
    orbit = integrate_orbit(spec.potential, (x, 0.0, px, np.sqrt(2 * (0.19 - x * x / 2) - px * px)), 100.0)
    explorer.click("times", 0.1, 0.05)
    expect(explorer.text(f"Escapes through exit {orbit.fate} at t = {orbit.escape_time:.4g}, after")).to_be_visible()
    marked = explorer.model_data("starts")
    assert [marked["x"], marked["y"]] == [[x], [px]]


def test_a_click_on_a_forbidden_pixel_gives_a_passing_message_and_adds_no_start(shared: ExplorerPage) -> None:
    x_low, _, low, _ = shared.ranges("basins")
    shared.click("basins", x_low + 0.02, low + 0.02)
    message = shared.text("Forbidden: no orbit of this energy can start here")
    expect(message).to_be_visible()
    expect(message).to_have_css("animation-duration", f"{PASSING_SECONDS:g}s")
    assert not shared.model_data("starts").get("x")


def test_a_start_can_be_typed(explorer: ExplorerPage) -> None:
    explorer.open_fold("Type a start")
    explorer.type_number("x", "0.1")
    explorer.type_number("px", "0.2")
    explorer.press("Integrate")
    orbit = integrate_orbit(CASES["I"], (0.1, 0.0, 0.2, np.sqrt(2 * (0.19 - 0.005) - 0.04)), 100.0)
    expect(explorer.text(f"Escapes through exit {orbit.fate} at t = {orbit.escape_time:.4g}, after")).to_be_visible()


def test_zooming_one_map_computes_the_region_for_all_maps(explorer: ExplorerPage) -> None:
    width = explorer.column("dw")
    explorer.turn_wheel("times", 0.4, 0.1, -500)
    explorer.wait_for_view("window=")
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] < 0.9 * {width}")
    x, dw, y, dh = (explorer.column(name) for name in ("x", "dw", "y", "dh"))
    window = (x, x + dw, y, y + dh)
    for picture in MAPS:
        assert explorer.ranges(picture) == pytest.approx(window)
    # The browser holds the window as an origin and a size, so its ends are rounded.
    expected = quick_map(0.19, window=window)
    assert np.mean(explorer.column("crossings") == expected.crossings) > 0.98


def test_hovering_describes_the_pixel(shared: ExplorerPage, first_map: EscapeMap) -> None:
    for picture in MAPS:
        shared.hover(picture, 0.1, 0.05)
        expect(shared.text("escapes through exit 1")).to_be_visible()
        expect(shared.text(re.compile(r"escape time 3\.\d+"))).to_be_visible()
        expect(shared.text("0 upward crossings of y = 0")).to_be_visible()
        expect(shared.text(re.compile(r"\(0\.\d+, 0\.0\d+\)"))).to_be_visible()
    row, column = np.argwhere(first_map.evidence == Evidence.ENCLOSED)[0]
    shared.hover("basins", float(first_map.x[column]), float(first_map.ordinate[row]))
    expect(shared.text("invariant curves separate it from every exit")).to_be_visible()


_PAINTED = """() => [...Bokeh.index.all_views()]
    .find(view => view.model.name == 'times').canvas_view.primary.el.toDataURL()"""


def test_a_picture_is_not_painted_again_when_the_mouse_moves(shared: ExplorerPage) -> None:
    shared.hover("basins", 0.1, 0.05)
    expect(shared.text(re.compile(r"\(0\.\d+, 0\.0\d+\)"))).to_be_visible()
    painted = shared.page.evaluate(_PAINTED)
    shared.hover("basins", -0.2, 0.3)
    expect(shared.text(re.compile(r"\(−0\.\d+, 0\.\d+\)"))).to_be_visible()
    assert shared.page.evaluate(_PAINTED) == painted


def begin_a_long_map(explorer: ExplorerPage) -> None:
    """Choose a map that takes longer than a test, and wait for its first pixels."""
    explorer.choose("t_max", "1 000 000")
    explorer.wait_for_view("t_max=1e")
    explorer.forget_pixels()
    explorer.pick("III")
    explorer.wait_for_new_pixels()


@pytest.mark.slow
def test_escape_closes_a_help_text_and_then_stops_the_map_which_can_be_continued_and_stopped(explorer: ExplorerPage) -> None:
    begin_a_long_map(explorer)
    explorer.press("About: Basins of escape")
    explorer.page.keyboard.press("Escape")
    expect(explorer.page.locator(".help-text:popover-open")).to_have_count(0)
    expect(explorer.button("Stop")).to_be_visible()
    explorer.page.keyboard.press("Escape")
    expect(explorer.text("Stopped:")).to_be_visible()
    assert explorer.column("complete") is False
    expect(explorer.button("Stop")).to_be_hidden()
    explorer.press("Continue")
    expect(explorer.button("Continue")).to_be_hidden()
    explorer.press("Stop")
    expect(explorer.button("Continue")).to_be_visible()


def test_the_address_opens_the_same_view(explorer: ExplorerPage, open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer.pick("III")
    explorer.wait_for_view("case=III&")
    explorer.type_number("Exact h", "0.4567")
    explorer.wait_for_view("h=0.4567")
    explorer.click("basins", 0.1, 0.2)
    explorer.wait_for_view("orbits=")
    verdict = explorer.text("Escapes through exit 1")
    expect(verdict).to_be_visible()
    there = open_explorer(link="?" + urlsplit(explorer.page.url).query)
    expect(there.text("Escapes through exit 1")).to_have_text(verdict.inner_text())
    np.testing.assert_array_equal(there.column("fate"), explorer.column("fate"))
    expect(there.page.get_by_label("Exact h", exact=True)).to_have_value("0.4567")
