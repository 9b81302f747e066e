"""Analyses are shown on the page: measures, curves against energy, and the verdict on an orbit."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from plots.studies.sweep_charts import CURVE_PANELS
from tests.browser.explorer_page import ExplorerPage

OpenExplorer = Callable[..., ExplorerPage]
VIEW = "?case=II&plane=x_px&h=0.25&t_max=1000&resolution=112"

CURVES = {"shares", *(panel.name for panel in CURVE_PANELS)}


@pytest.fixture(scope="module")
def opened(open_for_all: OpenExplorer) -> ExplorerPage:
    return open_for_all(link=VIEW)


def shown_figures(explorer: ExplorerPage) -> set[str]:
    """Return names of the figures that are visible."""
    return set(
        explorer.page.evaluate(
            """() => [...Bokeh.index.all_views()].filter(view => view.model.type == "Figure" && view.el.offsetWidth > 0)
                .map(view => view.model.name)"""
        )
    )


@pytest.mark.slow
def test_basins_are_measured(explorer: ExplorerPage) -> None:
    explorer.pick("Measures")
    for text in ("Basin entropy", "Wada", "Decay law"):
        expect(explorer.text(text)).to_be_visible()
    explorer.wait_for_data("survival_lines", "data.xs.length && data.xs[0].length > 10")
    assert {"survival", "uncertainty"} & shown_figures(explorer) == {"survival"}
    expect(explorer.button("Measure the uncertainty exponent")).to_be_visible()


@pytest.mark.slow
def test_curves_are_drawn_and_a_click_opens_a_map(explorer: ExplorerPage) -> None:
    explorer.pick("Against")
    expect(explorer.button("Compute the curves")).to_be_visible()
    assert not CURVES & shown_figures(explorer)
    explorer.press("Compute the curves")
    explorer.wait_for_data("shares_lines", "data.xs.length && data.xs[0].length >= 2")
    explorer.button("Stop").last.click()
    expect(explorer.button("Compute the curves")).to_be_visible()
    assert shown_figures(explorer) >= CURVES
    (values, *_) = explorer.model_data("shares_lines")["xs"]
    # Curves have gaps, which are NaN.
    last = float(np.nanmax(values))
    explorer.button("Compute the curves").scroll_into_view_if_needed()
    explorer.click("shares", last - 1e-3, 50.0)
    explorer.wait_for_view(f"h={last!r}")
    explorer.pick("Orbit")


def test_the_section_follows_the_map_and_a_click_on_it_starts_an_orbit(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link="?case=II&h=0.15&t_max=100&resolution=112&analysis=section")
    explorer.wait_for_data("section_dots", "data.x.length > 1000")
    expect(explorer.page.get_by_text("upward crossings of y = 0 by")).to_be_visible()
    explorer.click("section", 0.1, 0.05)
    explorer.wait_for_view("orbits=0.")


# The share of the pixels of a canvas on which something is painted.
_PAINTED = """canvas => {
  const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height)
  let count = 0
  for (let i = 3; i < data.length; i += 4) count += data[i] > 0
  return count / (data.length / 4)
}"""


def test_the_section_follows_the_slider_until_the_server_has_that_of_its_energy(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link="?case=II&h=0.15&t_max=100&resolution=112&analysis=section")
    explorer.wait_for_data("section_dots", "data.x.length > 1000")
    canvas = explorer.page.locator("canvas.live-section")
    expect(canvas).to_have_count(0)
    explorer.drag_energy_to(0.25, let_go=False)
    explorer.wait_for_preview(0.23)
    expect(canvas).to_have_attribute("data-energy", "0.23")
    explorer.page.wait_for_function(f"canvas => ({_PAINTED})(canvas) > 0.02", arg=canvas.element_handle())
    explorer.page.mouse.up()
    explorer.wait_for_view("h=0.23&")
    expect(explorer.text("at h = 0.23.")).to_be_visible()
    expect(canvas).to_have_count(0)


# Click the middle of the section that the browser paints; whether the address has an orbit.
_CLICK_SECTION = """canvas => {
  const {left, top, width, height} = canvas.getBoundingClientRect()
  canvas.dispatchEvent(new MouseEvent("click", {clientX: left + width / 2, clientY: top + height / 2}))
  return location.search.includes("orbits=")
}"""


def test_a_click_on_the_section_of_the_browser_starts_the_orbit_of_its_point(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link="?case=II&h=0.15&t_max=100&resolution=112&analysis=section&section_colours=density")
    explorer.wait_for_data("section_dots", "data.x.length > 1000")
    canvas = explorer.page.locator("canvas.live-section")
    # The mouse holds the slider.
    explorer.drag_energy_to(0.25, let_go=False)
    explorer.wait_for_preview(0.23)
    # The first click may come before the first point.
    explorer.page.wait_for_function(_CLICK_SECTION, arg=canvas.element_handle(), polling=1000)
    explorer.page.mouse.up()
    explorer.wait_for_view("h=0.23&", "orbits=")


# Note whether the browser has painted the section.
_NOTE_CANVAS = """() => {
  const view = [...Bokeh.index.all_views()].find(view => view.model.name === "section")
  const root = view.canvas_view.el.shadowRoot
  new MutationObserver(() => (window.wasLive ||= !!root.querySelector(".live-section"))).observe(root, {childList: true})
}"""


def test_the_section_shows_the_window_of_the_map(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link="?case=III&h=0.3&t_max=100&resolution=112&analysis=section&section_colours=fate")
    explorer.wait_for_data("section_dots", "data.x.length > 1000")
    expect(explorer.page.get_by_text("not escaped", exact=True)).to_be_visible()
    # The engine has started when the section follows the slider.
    canvas = explorer.page.locator("canvas.live-section")
    explorer.drag_energy_to(0.25, let_go=False)
    expect(canvas).to_have_count(1)
    explorer.page.mouse.up()
    expect(canvas).to_have_count(0)
    explorer.page.evaluate(_NOTE_CANVAS)
    explorer.turn_wheel("basins", 0.2, 0.0, -300)
    for picture in ("basins", "section"):
        explorer.wait_for_address_of(picture)
    low, high = explorer.ranges("section")[:2]
    assert high - low < 1.0
    explorer.wait_for_data("section_dots", f"data.x.filter(x => x > {low} && x < {high}).length > 500")
    assert explorer.page.evaluate("window.wasLive") is True
    explorer.radio("Density").check()
    explorer.wait_for_view("section_colours=density")
    expect(explorer.page.get_by_text("1 point in a cell")).to_be_visible()


def test_a_bounded_orbit_is_judged_by_three_indicators(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link="?case=I&h=0.05&t_max=10000&resolution=112&orbits=0.1,0.05")
    table = explorer.page.get_by_label("chaos indicators")
    names = ["SALI", "Lyapunov exponent", "Birkhoff digits of halves", "Birkhoff digits"]
    # The last row comes from a separate request.
    expect(table.locator("th")).to_contain_text(names)
    # SALI and the exponent see no chaos; averages that agree as on a torus are regular.
    expect(table.locator("b")).to_have_text(["no sign of chaos", "no sign of chaos", "regular", "regular"])
    explorer.wait_for_data("exponent_histories", "data.xs.length == 1 && data.ys[0].length > 100")
