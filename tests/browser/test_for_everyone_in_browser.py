"""Colours, themes, keys, touch, the tour, explanations, and the page in words."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.explorer_page import ExplorerPage

DARK = "rgb(18, 18, 18)"


def test_the_colours_can_be_changed(explorer: ExplorerPage) -> None:
    explorer.choose("Colours", "colour-blind safe")
    explorer.page.wait_for_url(re.compile("palette=safe"))
    explorer.page.wait_for_function(
        """() => Bokeh.documents[0].get_model_by_name('basins').renderers
            .find(r => r.data_source.name == 'maps').glyph.color_mapper.palette.length > 0"""
    )
    expect(explorer.page.locator("span[style*='#009e73']").first).to_be_visible()


def test_a_dark_page_has_light_lines(explorer: ExplorerPage) -> None:
    explorer.page.get_by_label("Toggle theme").click()
    explorer.page.wait_for_function(
        """() => Bokeh.documents[0].get_model_by_name('basins').renderers
            .some(r => r.data_source.name == 'zero_velocity_curve' && r.glyph.line_color.value == '#e6e6e6')"""
    )
    background = explorer.page.evaluate("() => getComputedStyle(document.querySelector('main') ?? document.body).backgroundColor")
    assert background != "rgb(255, 255, 255)"


@pytest.mark.parametrize(("key", "moved"), [("ArrowRight", 1), ("ArrowLeft", -1)])
def test_arrows_move_the_window(explorer: ExplorerPage, key: str, moved: int) -> None:
    before = explorer.ranges("basins")
    explorer.page.keyboard.press(key)
    explorer.page.wait_for_url(re.compile("window="))
    explorer.wait_until_complete()
    step = 0.25 * (before[1] - before[0]) * moved
    explorer.page.wait_for_function(
        "x => Math.abs(Bokeh.documents[0].get_model_by_name('basins').x_range.start - x) < 1e-9", arg=before[0] + step
    )


def test_keys_zoom_and_lead_back_and_home(explorer: ExplorerPage) -> None:
    width = explorer.column("dw")
    explorer.page.keyboard.press("+")
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] < 0.6 * {width}")
    explorer.page.keyboard.press("+")
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] < 0.3 * {width}")
    explorer.page.keyboard.press("b")
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] > 0.4 * {width}")
    explorer.page.keyboard.press("h")
    explorer.wait_for_data("maps", f"data.complete[0] && data.dw[0] == {width}")


def test_escape_stops_the_map(explorer: ExplorerPage) -> None:
    explorer.choose("t_max", "1 000 000")
    explorer.wait_until_complete()
    explorer.forget_pixels()
    explorer.press("III")
    explorer.wait_for_new_pixels()
    explorer.page.keyboard.press("Escape")
    expect(explorer.text("Stopped:")).to_be_visible()


def test_keys_in_a_box_write_into_it(explorer: ExplorerPage) -> None:
    box = explorer.page.get_by_label("h exactly", exact=True).first
    box.focus()
    explorer.page.keyboard.press("h")
    explorer.page.keyboard.press("ArrowLeft")
    explorer.page.wait_for_timeout(500)
    assert "window=" not in explorer.page.url


def test_a_tap_on_a_phone_integrates_an_orbit(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(420, 2400, touch=True)
    explorer.page.touchscreen.tap(*explorer.point("basins", 0.1, 0.05))
    expect(explorer.text("Escaped through channel 1")).to_be_visible()


def test_on_a_phone_nothing_lies_over_anything_else(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(420, 800, "?case=I&h=0.25&orbits=0.1,0.05;0.2,0.1&measures=yes&energies=yes&origins=yes")
    explorer.page.wait_for_function("[...Bokeh.index.all_views()].some(view => view.model.name == 'separation')")
    boxes = explorer.page.evaluate(
        """names => names.map(name => {
            for (const view of Bokeh.index.all_views()) if (view.model.name == name) {
                const box = view.el.getBoundingClientRect()
                return [box.top, box.bottom]
            }
        })""",
        [
            *("curves", "basins", "times", "crossings", "origins", "path", "sali", "r2", "exponent", "separation"),
            *("uncertainty", "survival", "shares", "entropies", "exponents", "escapes"),
        ],
    )
    for above, below in itertools.pairwise(boxes):
        assert above[1] <= below[0] + 1


def test_a_first_visit_begins_with_the_tour_and_the_second_does_not(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(first_visit=True)
    tour = explorer.page.get_by_role("dialog")
    expect(tour).to_be_visible()
    explorer.page.get_by_role("button", name="Next").last.click()
    expect(tour).to_contain_text("2 of 7")
    explorer.page.get_by_role("button", name="Skip").click()
    expect(tour).not_to_be_visible()
    explorer.page.reload()
    explorer.wait_until_complete()
    expect(tour).not_to_be_visible()
    explorer.press("Tour")
    expect(tour).to_contain_text("1 of 7")
    explorer.page.keyboard.press("Escape")
    expect(tour).not_to_be_visible()


def test_every_picture_explains_itself(shared: ExplorerPage) -> None:
    summaries = shared.page.get_by_text("What is this?")
    assert summaries.count() >= 9
    summaries.nth(1).click()
    expect(shared.text("through which exit channel its orbit leaves")).to_be_visible()


def test_the_equations_are_those_of_the_case(explorer: ExplorerPage) -> None:
    explorer.text("Equations: Case I").click()
    expect(explorer.page.locator("math").first).to_be_visible()
    explorer.press("III")
    expect(explorer.text("Equations: Case III")).to_be_visible()


def test_the_page_can_be_read_as_a_table(for_orbits: ExplorerPage) -> None:
    for_orbits.click("basins", 0.1, 0.05)
    expect(for_orbits.text("Escaped through channel 1")).to_be_visible()
    for_orbits.text("This page as a table").click()
    table = for_orbits.page.get_by_role("table", name="What is shown")
    for words in (
        "Case I",
        "½(x² + y²) − xy²",
        "energy h",
        "leave through channel 1",
        "median escape time",
        "Escaped through channel 1",
    ):
        expect(table).to_contain_text(words)
