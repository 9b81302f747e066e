"""The page has themes, accessible names of widgets, keys, and a first view that invites to other views."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any, cast

import pytest
from playwright.sync_api import expect

from app.views.panels.browser_events import KEYS
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

# Whether all zero-velocity curves, and the numbers of the exits, are light: red, the highest byte, is above 200.
LIGHT_LINES = """() => [...Bokeh.index.all_views()]
    .filter(view => ['zero_velocity_curve', 'channel_numbers'].includes(view.model.data_source?.name))
    .every(({glyph}) => (glyph.line_color ?? glyph.text_color).value >>> 24 > 200)"""
CROSSHAIR_COLOURS = """() => [...new Set([...Bokeh.index.all_views()]
    .filter(view => view.model.type == 'Span')
    .map(view => view.visuals.line.get_line_color()))]"""
TITLE_COLOUR = """() => {
    const view = [...Bokeh.index.all_views()].find(view => view.model.name == 'basins')
    return getComputedStyle(view.el).getPropertyValue('--bk-text-color').trim()
}"""


def luminance(explorer: ExplorerPage) -> float:
    """Return the mean of the background's red, green and blue, 0 to 255."""
    colour = explorer.page.evaluate("() => getComputedStyle(document.body).backgroundColor")
    return sum(map(int, re.findall(r"\d+", colour)[:3])) / 3


@pytest.mark.slow
def test_the_dark_theme_has_light_lines_and_titles_and_is_stored(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link=QUICK)
    assert luminance(explorer) > 200
    # The colours change without an answer of the server, which can take seconds.
    assert explorer.page.evaluate(f"""async () => {{
        document.getElementById('theme').click()
        await new Promise(requestAnimationFrame)
        return ({LIGHT_LINES})()
    }}""")
    assert luminance(explorer) < 50
    assert explorer.page.evaluate(TITLE_COLOUR) == "rgb(236, 239, 243)"
    assert explorer.page.evaluate(CROSSHAIR_COLOURS) == ["rgb(236, 239, 243)"]
    explorer.page.reload()
    explorer.wait_until_complete()
    explorer.page.wait_for_function(LIGHT_LINES)
    assert luminance(explorer) < 50
    explorer.press("Dark theme")
    explorer.page.wait_for_function(f"() => !({LIGHT_LINES})()")
    assert luminance(explorer) > 200
    assert explorer.page.evaluate(TITLE_COLOUR) == "rgb(27, 32, 39)"


def test_the_page_follows_the_theme_of_the_system_until_the_user_chooses_one(
    open_explorer: Callable[..., ExplorerPage],
) -> None:
    explorer = open_explorer(link=QUICK, theme="dark")
    chosen = explorer.page.get_by_role("button", name="Dark theme")
    assert luminance(explorer) < 50
    expect(chosen).to_have_attribute("aria-pressed", "true")
    explorer.page.emulate_media(color_scheme="light")
    expect(chosen).to_have_attribute("aria-pressed", "false")
    assert luminance(explorer) > 200
    explorer.press("Dark theme")
    explorer.page.emulate_media(color_scheme="dark")
    explorer.page.emulate_media(color_scheme="light")
    expect(chosen).to_have_attribute("aria-pressed", "true")


NAMES = {
    "radiogroup": ["Case", "Plane", "Drag over a map to", "Analysis", "Orbits"],
    "radio": ["III"],
    "slider": ["Energy h", "Time along the orbits"],
    "spinbutton": ["Exact h"],
    "combobox": ["t_max", "Resolution", "Colours"],
    "checkbox": ["Pixels to trust"],
    "textbox": ["x", "px"],
    "button": ["Play the orbits", "Copy link", "Dark theme", "About: Basins of escape"],
}


def test_widgets_have_accessible_names(explorer: ExplorerPage) -> None:
    explorer.click("basins", 0.1, 0.05)
    explorer.open_fold("Quality and colours")
    explorer.open_fold("Type a start")
    explorer.press("Share")
    for role, names in NAMES.items():
        for name in names:
            expect(explorer.page.get_by_role(cast("Any", role), name=name, exact=True)).to_have_count(1)
    explorer.press("Close")


def test_a_picture_in_focus_has_its_name_and_leaves_the_arrows_to_the_page(explorer: ExplorerPage) -> None:
    explorer.page.get_by_role("group", name="Basins of escape", exact=True).locator(".bk-events").focus()
    expect(explorer.page.get_by_role("img", name="Basins of escape", exact=True)).to_be_focused()
    explorer.page.keyboard.press("ArrowRight")
    explorer.wait_for_view("window=")


def test_arrows_move_the_window(explorer: ExplorerPage) -> None:
    before = explorer.ranges("basins")
    explorer.page.keyboard.press("ArrowLeft")
    explorer.wait_for_view("window=")
    explorer.page.wait_for_function(
        "x => Math.abs(Bokeh.documents[0].get_model_by_name('basins').x_range.start - x) < 1e-9",
        arg=before[0] - 0.25 * (before[1] - before[0]),
    )


def test_keys_in_a_number_box_are_no_shortcuts(explorer: ExplorerPage) -> None:
    explorer.page.get_by_label("Exact h", exact=True).focus()
    explorer.page.keyboard.press("ArrowLeft")
    # Outside of the box the same key moves the window, once.
    explorer.button("Gallery").focus()
    explorer.page.keyboard.press("ArrowUp")
    explorer.wait_for_view("window=")
    assert explorer.page.evaluate("history.state.entry") == 1


def test_enter_sets_an_orbit_in_the_middle_of_the_maps(explorer: ExplorerPage) -> None:
    x_low, x_high, low, high = explorer.ranges("basins")
    # Take the focus from any button, which Enter would press.
    explorer.page.get_by_role("heading", level=1).click()
    explorer.page.keyboard.press("Enter")
    explorer.wait_for_data("starts", "data.x.length == 1")
    starts = explorer.model_data("starts")
    assert abs(starts["x"][0] - 0.5 * (x_low + x_high)) < 0.01 * (x_high - x_low)
    assert abs(starts["y"][0] - 0.5 * (low + high)) < 0.01 * (high - low)


def test_enter_on_a_button_sets_no_orbit(explorer: ExplorerPage) -> None:
    explorer.button("Gallery").focus()
    explorer.page.keyboard.press("Enter")
    expect(explorer.button("Close")).to_be_visible()
    explorer.press("Close")
    assert not explorer.model_data("starts").get("x")


@pytest.mark.slow
def test_the_first_view_invites_to_the_tour_and_six_others(explorer: ExplorerPage) -> None:
    card = explorer.page.get_by_role("button", name="A sticky orbit")
    expect(explorer.page.locator("[role=toolbar] button")).to_have_count(7)
    card.click()
    explorer.wait_for_view("case=III", "orbits=")
    expect(card).to_be_hidden()
    explorer.press("Clear all")
    expect(card).to_be_visible()


def test_the_keys_are_listed_in_the_help(explorer: ExplorerPage) -> None:
    explorer.page.keyboard.press("?")
    for action in KEYS.values():
        expect(explorer.page.get_by_role("definition").filter(has_text=action).first).to_be_visible()
    explorer.page.keyboard.press("Escape")
    expect(explorer.page.get_by_role("definition")).to_have_count(0)
