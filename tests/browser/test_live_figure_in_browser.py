"""A live figure works from a disk without a network: it computes maps that agree with those of the library."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page, expect

from engine import CASES, Fate, MapSpec, Plane, classify_orbits, compute_map
from plots.live.live_figure import live_figure
from plots.live.live_view import LiveView
from plots.pictures.palette import DEFAULT_COLOURS, rgba
from tests.conftest import TIMEOUT_MS

FIRST, OTHER = 0.45, 0.3
III = CASES["III"]

# Colours of the pixels of the map at shares of the frame. The frame is where the canvas has no labels.
_READ = """(canvas, places) => {
  const [left, right, top, bottom] = [62, 12, 8, 44]
  const {width, height} = canvas.getBoundingClientRect()
  const ratio = canvas.width / width
  const image = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height)
  return places.map(([u, v]) => {
    const x = left + u * (width - left - right)
    const y = top + (1 - v) * (height - top - bottom)
    const pixel = Math.floor(y * ratio) * canvas.width + Math.floor(x * ratio)
    return [...image.data.slice(4 * pixel, 4 * pixel + 4)]
  })
}"""


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    found = compute_map(MapSpec(III, Plane.X_PX, FIRST, (112, 112), t_max=100.0))
    path = tmp_path_factory.mktemp("live") / "figure.html"
    view = LiveView(found.spec, energies=(0.2, 0.6), starts=[(0.05, 0.0)])
    path.write_text(live_figure(view, found), encoding="utf-8")
    return path


@pytest.fixture
def open_figure(open_offline: Callable[..., Page], file: Path) -> Callable[..., Page]:
    """Return a function that opens the figure in a window of a given width."""

    def open_page(width: int = 1280, theme: str = "light") -> Page:
        page = open_offline(file, width, theme)
        expect(page.locator("#live")).to_be_visible()
        return page

    return open_page


def set_energy(page: Page, energy: float) -> None:
    page.locator("#energy").evaluate(f"slider => {{ slider.value = {energy}; slider.dispatchEvent(new Event('input')) }}")


def at_rest(page: Page) -> None:
    """Wait for the finest preview."""
    expect(page.locator("#status")).to_contain_text("224 × 224 pixels", timeout=TIMEOUT_MS)


def test_the_first_picture_is_the_exact_map(open_figure: Callable[..., Page]) -> None:
    page = open_figure()
    expect(page.locator("#status")).to_have_text("Exact map, computed before: 112 × 112 pixels, up to t = 100.")
    expect(page.locator("#still")).to_be_hidden()


def test_a_figure_does_not_call_the_map_exact_at_another_energy(open_figure: Callable[..., Page]) -> None:
    page = open_figure()
    status = page.locator("#energy").evaluate(
        """slider => {
          slider.value = 0.3
          slider.dispatchEvent(new Event("input"))
          return document.getElementById("status").textContent
        }"""
    )
    assert status == "A preview is computed here."
    at_rest(page)


def test_the_map_of_another_energy_is_that_of_the_library(open_figure: Callable[..., Page]) -> None:
    page = open_figure()
    set_energy(page, OTHER)
    at_rest(page)
    window = MapSpec(III, Plane.X_PX, OTHER).find_window()
    places = np.random.default_rng(1).uniform(0.05, 0.95, (200, 2))
    # Starts around each place, as far apart as two pixels of the screen, must have one fate: boundaries are left out.
    offsets = np.array([[0.0, 0.0], [1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]]) * 0.005
    around = places[:, None] + offsets
    x = window.x_low + around[..., 0] * window.width
    ordinate = window.ordinate_low + around[..., 1] * window.height
    states = Plane.X_PX.states(III, OTHER, x.ravel(), ordinate.ravel())
    is_start = np.isfinite(states).all(axis=1).reshape(x.shape).all(axis=1)
    fates = classify_orbits(III, OTHER, states[np.repeat(is_start, len(offsets))], t_max=90.0).fate.reshape(-1, len(offsets))
    is_robust = (fates == fates[:, :1]).all(axis=1) & (fates[:, 0] > Fate.BOUNDED)
    colours = page.locator("#map").evaluate(_READ, places[is_start][is_robust].tolist())
    expected = rgba([entry.colour for entry in DEFAULT_COLOURS.end_entries(III.outcomes)])[fates[is_robust, 0] - 1]
    assert is_robust.sum() > 20
    np.testing.assert_array_equal(colours, expected)


def test_a_click_lists_an_orbit_and_the_button_clears_the_list(open_figure: Callable[..., Page]) -> None:
    page = open_figure()
    page.locator("#map").click(position={"x": 250, "y": 150})
    expect(page.locator("#orbit-rows tr")).to_have_count(2)
    page.locator("#clear").click()
    expect(page.locator("#orbits")).to_be_hidden()


def test_the_orbit_under_the_pointer_is_that_of_the_library(open_figure: Callable[..., Page]) -> None:
    page = open_figure()
    box = page.locator("#map").bounding_box()
    assert box is not None
    left, top, margins = 62, 8, 74
    page.locator("#map").hover(position={"x": 250, "y": 120})
    expect(page.locator("#well")).to_have_attribute("aria-label", re.compile("^Exit 1 at t = "), timeout=TIMEOUT_MS)
    label = page.locator("#well").get_attribute("aria-label")
    window, side = MapSpec(III, Plane.X_PX, FIRST).find_window(), box["width"] - margins
    x = window.x_low + (250 - left) / side * window.width
    ordinate = window.ordinate_high - (120 - top) / side * window.height
    states = Plane.X_PX.states(III, FIRST, np.array([x]), np.array([ordinate]))
    found = classify_orbits(III, FIRST, states, t_max=100.0)
    match = re.fullmatch(r"Exit (\d) at t = ([\d.]+), (\d+) crossings?", label or "")
    assert match is not None
    assert (int(match[1]), int(match[3])) == (found.fate[0], found.crossings[0])
    assert float(match[2]) == pytest.approx(found.escape_time[0], rel=5e-3)


def test_the_first_view_is_restored_after_a_zoom(open_figure: Callable[..., Page]) -> None:
    page = open_figure()
    page.locator("#map").focus()
    page.keyboard.press("+")
    expect(page.locator("#status")).to_contain_text("Preview")
    page.locator("#home").click()
    expect(page.locator("#status")).to_contain_text("Exact map")


def test_the_energy_plays_until_it_is_stopped(open_figure: Callable[..., Page]) -> None:
    page = open_figure()
    page.locator("#play").click()
    expect(page.locator("#play")).to_have_text("Stop")
    expect(page.locator("#shown-energy")).not_to_have_text(f"{FIRST:.4f}", timeout=TIMEOUT_MS)
    expect(page.locator("#status")).to_contain_text("Preview")
    page.locator("#play").click()
    expect(page.locator("#play")).to_have_text("Play")


@pytest.mark.parametrize(("width", "theme"), [(320, "dark"), (420, "light"), (1600, "light")])
def test_nothing_is_wider_than_the_window(open_figure: Callable[..., Page], width: int, theme: str) -> None:
    page = open_figure(width, theme)
    for x in (100, 120, 150, 170, 200):
        page.locator("#map").click(position={"x": x, "y": 120})
    for wide in ("html", "#orbits"):
        assert page.locator(wide).evaluate("element => element.scrollWidth - element.clientWidth") == 0


def test_a_print_in_the_dark_theme_has_dark_lines_and_square_pictures(open_figure: Callable[..., Page]) -> None:
    page = open_figure(theme="dark")
    page.emulate_media(media="print")
    canvas = page.locator("#map")
    # The browser tells the page of the print with its next frame.
    line = "canvas => canvas.getContext('2d').getImageData(61, 200, 1, 1).data.join() === '27,32,39,255'"
    page.wait_for_function(line, arg=canvas.element_handle())
    box = canvas.bounding_box()
    assert box is not None
    assert box["height"] / box["width"] == pytest.approx(canvas.evaluate("canvas => canvas.height / canvas.width"), rel=0.01)
    assert page.locator("#play").is_hidden()


def test_without_scripts_there_is_a_still_picture(open_offline: Callable[..., Page], file: Path) -> None:
    page = open_offline(file, java_script_enabled=False)
    expect(page.locator("#still")).to_be_visible()
    expect(page.locator("#live")).to_be_hidden()
