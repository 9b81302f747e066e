"""Accessibility: colours, themes, keys, touch, the tour, help texts, names of widgets, and the page as a table."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import expect

from tests.browser.explorer_page import ExplorerPage


def test_the_colours_can_be_changed(explorer: ExplorerPage) -> None:
    explorer.choose("Colours", "colour-blind safe")
    explorer.page.wait_for_url(re.compile("palette=safe"))
    explorer.page.wait_for_function(
        """() => Bokeh.documents[0].get_model_by_name('basins').renderers
            .find(r => r.data_source.name == 'maps').glyph.color_mapper.palette.length > 0"""
    )
    expect(explorer.page.locator("span[style*='#009e73']").first).to_be_visible()


LIGHT_LINES = """() => Bokeh.documents[0].get_model_by_name('basins').renderers
    .some(r => r.data_source.name == 'zero_velocity_curve' && r.glyph.line_color.value == '#e6e6e6')"""
TITLE_COLOUR = """() => {
    const view = [...Bokeh.index.all_views()].find(view => view.model.name == 'basins')
    return getComputedStyle(view.el).getPropertyValue('--bk-text-color').trim()
}"""


def luminance(explorer: ExplorerPage) -> float:
    """Mean of the background's red, green and blue, 0 to 255."""
    colour = explorer.page.evaluate("() => getComputedStyle(document.body).backgroundColor")
    return sum(map(int, re.findall(r"\d+", colour)[:3])) / 3


def test_the_dark_theme_has_light_lines_and_titles_and_is_stored(explorer: ExplorerPage) -> None:
    assert luminance(explorer) > 200
    explorer.press("Dark theme")
    explorer.page.wait_for_function(LIGHT_LINES)
    assert luminance(explorer) < 50
    assert explorer.page.evaluate(TITLE_COLOUR) == "#eceff3"
    explorer.page.reload()
    explorer.wait_until_complete()
    explorer.page.wait_for_function(LIGHT_LINES)
    assert luminance(explorer) < 50
    explorer.press("Dark theme")
    explorer.page.wait_for_function(f"() => !({LIGHT_LINES})()")
    assert luminance(explorer) > 200
    assert explorer.page.evaluate(TITLE_COLOUR) == "#1b2027"


def test_a_dark_system_gives_a_dark_page(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(theme="dark")
    assert luminance(explorer) < 50
    expect(explorer.page.get_by_role("button", name="Dark theme")).to_have_attribute("aria-pressed", "true")


@pytest.fixture(scope="module")
def everything_open(open_for_all: Callable[..., ExplorerPage]) -> ExplorerPage:
    explorer = open_for_all(link="?t_max=1000&orbits=0.1,0.2&statistics=yes&measures=yes&energies=yes")
    explorer.press("Share")
    return explorer


@pytest.mark.parametrize(
    ("role", "name"),
    [
        ("radiogroup", "Case"), ("radiogroup", "Plane"), ("radio", "III"), ("group", "Energy h"), ("textbox", "Exact h"),
        ("combobox", "t_max"), ("combobox", "Resolution"), ("combobox", "Colours"), ("group", "Analyses"),
        ("checkbox", "Pixels to trust"), ("button", "Play"), ("button", "Pause"), ("button", "Next frame"),
        ("button", "Previous frame"), ("group", "Time along the orbits"), ("button", "Copy link"),
    ],
)  # fmt: skip
def test_widgets_have_accessible_names(everything_open: ExplorerPage, role: Any, name: str) -> None:
    expect(everything_open.page.get_by_role(role, name=name, exact=True)).to_have_count(1)


def test_a_button_in_focus_can_be_pressed_with_the_keyboard(shared: ExplorerPage) -> None:
    shared.page.get_by_role("button", name="Gallery", exact=True).focus()
    card = shared.page.get_by_role("toolbar").first
    shared.page.keyboard.press("Enter")
    expect(card).to_be_visible()
    shared.page.keyboard.press("Space")
    expect(card).not_to_be_visible()


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


def test_keys_zoom_and_go_back_and_home(explorer: ExplorerPage) -> None:
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
    explorer.pick("III")
    explorer.wait_for_new_pixels()
    explorer.page.keyboard.press("Escape")
    expect(explorer.text("Stopped:")).to_be_visible()


def test_keys_in_a_number_box_are_no_shortcuts(explorer: ExplorerPage) -> None:
    box = explorer.page.get_by_label("Exact h", exact=True).first
    box.focus()
    explorer.page.keyboard.press("h")
    explorer.page.keyboard.press("ArrowLeft")
    explorer.page.wait_for_timeout(500)
    assert "window=" not in explorer.page.url


def test_a_tap_on_a_phone_integrates_an_orbit(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(420, 2400, touch=True)
    explorer.page.touchscreen.tap(*explorer.point("basins", 0.1, 0.05))
    expect(explorer.text("Escaped through channel 1")).to_be_visible()


def test_on_a_phone_pictures_do_not_overlap(open_explorer: Callable[..., ExplorerPage]) -> None:
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


def test_the_tour_starts_at_the_first_visit_only(open_explorer: Callable[..., ExplorerPage]) -> None:
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


def test_every_picture_has_a_help_text(everything_open: ExplorerPage) -> None:
    summaries = everything_open.page.get_by_text("What is this?")
    expect(summaries).to_have_count(16)
    summaries.nth(1).click()
    expect(everything_open.text("the exit channel through which its orbit escapes")).to_be_visible()


def test_the_equations_are_those_of_the_case(explorer: ExplorerPage) -> None:
    explorer.text("Equations: Case I").click()
    expect(explorer.page.locator("math").first).to_be_visible()
    explorer.pick("III")
    expect(explorer.text("Equations: Case III")).to_be_visible()


def test_the_page_can_be_read_as_a_table(for_orbits: ExplorerPage) -> None:
    for_orbits.click("basins", 0.1, 0.05)
    expect(for_orbits.text("Escaped through channel 1")).to_be_visible()
    for_orbits.text("This page as a table").click()
    table = for_orbits.page.get_by_role("table", name="What is shown")
    for text in (
        "Case I",
        "½(x² + y²) − xy²",
        "energy h",
        "escape through channel 1",
        "median escape time",
        "Escaped through channel 1",
    ):
        expect(table).to_contain_text(text)
