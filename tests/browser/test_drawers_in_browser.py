"""The drawers of gallery, sharing and help open over the controls, one at a time."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import Locator, expect

from plots.links.presets import PRESETS, Preset
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

HEADINGS = {"Gallery": "Gallery", "Share": "Share and download", "Help": "Help"}


def heading(explorer: ExplorerPage, drawer: str) -> Locator:
    return explorer.page.get_by_role("heading", level=2, name=HEADINGS[drawer], exact=True)


def card(explorer: ExplorerPage, preset: Preset) -> Locator:
    return explorer.page.locator(f".gallery:not(.few) button[data-key='{preset.key}']")


def expect_open(explorer: ExplorerPage, drawer: str | None) -> None:
    for name in HEADINGS:
        expect(heading(explorer, name)).to_be_visible(visible=name == drawer)


def close(explorer: ExplorerPage, drawer: str) -> None:
    """Close a drawer, and wait until it is off the page. Clicks at its place would be lost before."""
    explorer.press(drawer)
    expect_open(explorer, None)


def test_at_most_one_drawer_is_open_until_it_is_closed(explorer: ExplorerPage) -> None:
    expect_open(explorer, None)
    for drawer in HEADINGS:
        explorer.press(drawer)
        expect_open(explorer, drawer)
    explorer.press("Help")
    expect_open(explorer, None)
    explorer.press("Help")
    explorer.press("Close")
    expect_open(explorer, None)


@pytest.mark.parametrize("drawer", HEADINGS)
def test_the_focus_moves_into_a_drawer_and_back(explorer: ExplorerPage, drawer: str) -> None:
    explorer.button(drawer).focus()
    explorer.page.keyboard.press("Enter")
    expect_open(explorer, drawer)
    expect(explorer.button("Close")).to_be_focused()
    explorer.page.keyboard.press("Escape")
    expect_open(explorer, None)
    expect(explorer.button(drawer)).to_be_focused()


def test_every_preset_has_a_card_and_pictures_are_loaded(explorer: ExplorerPage) -> None:
    explorer.press("Gallery")
    for preset in PRESETS:
        expect(card(explorer, preset)).to_contain_text(preset.title)
    picture = card(explorer, PRESETS[0]).locator("img")
    explorer.page.wait_for_function("picture => picture.naturalWidth == 160", arg=picture.element_handle())
    close(explorer, "Gallery")


def test_the_gallery_is_searched(explorer: ExplorerPage) -> None:
    explorer.press("Gallery")
    cards = explorer.page.locator(".gallery:not(.few) button")
    expect(cards).to_have_count(len(PRESETS))
    explorer.page.get_by_role("searchbox", name="Search the gallery").fill("sticky orbit")
    expect(cards.filter(visible=True).first).to_contain_text("sticky")
    assert cards.filter(visible=True).count() < 5
    explorer.page.get_by_role("searchbox", name="Search the gallery").fill("")
    expect(cards.filter(visible=True)).to_have_count(len(PRESETS))


def test_the_gallery_of_a_phone_shows_four_whole_cards(open_explorer: Callable[..., ExplorerPage]) -> None:
    phone = open_explorer(390, 844, QUICK, touch=True)
    phone.press("Gallery")
    fourth = card(phone, PRESETS[3])
    expect(fourth).to_be_in_viewport(ratio=1)
    # Nothing covers the card.
    box = fourth.bounding_box()
    assert box is not None
    lowest = [box["x"] + box["width"] / 2, box["y"] + box["height"] - 2]
    assert fourth.evaluate("(card, [x, y]) => card.getRootNode().elementFromPoint(x, y) === card", lowest)


def test_the_equations_are_those_of_the_system(explorer: ExplorerPage) -> None:
    explorer.press("Help")
    expect(explorer.text("Equations: Case I")).to_be_visible()
    expect(explorer.page.locator("math").first).to_be_visible()
    close(explorer, "Help")
    explorer.pick("III")
    explorer.press("Help")
    expect(explorer.text("Equations: Case III")).to_be_visible()
    close(explorer, "Help")


def test_escape_closes_a_drawer_from_a_box_in_it(explorer: ExplorerPage) -> None:
    explorer.press("Other …")
    box = explorer.page.locator(".formula-box textarea")
    expect(box).to_be_focused()
    explorer.page.keyboard.press("Escape")
    expect(box).to_have_count(0)


@pytest.mark.parametrize("touch", [False, True])
def test_the_energy_and_the_maps_stay_in_view_beside_a_drawer(open_explorer: Callable[..., ExplorerPage], touch: bool) -> None:
    first, *others = [(420, 850), (375, 667)] if touch else [(1280, 720), (1024, 768), (768, 1024)]
    explorer = open_explorer(*first, QUICK, touch=touch)
    explorer.press("Other …")
    expect(explorer.page.locator(".formula-box textarea")).to_be_visible()
    assert_beside_a_drawer(explorer)
    for width, height in others:
        explorer.page.set_viewport_size({"width": width, "height": height})
        explorer.page.wait_for_function(
            "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))"
        )
        assert_beside_a_drawer(explorer)


# Adds up the layout shifts from now on, in `window.shifts`.
_SHIFTS = """() => {
    window.shifts = 0
    const add = list => list.getEntries().forEach(entry => (window.shifts += entry.value))
    new PerformanceObserver(add).observe({type: "layout-shift"})
}"""


@pytest.mark.slow
@pytest.mark.parametrize("size", [(420, 850), (768, 1024)])
def test_nothing_moves_when_a_drawer_opens_or_closes(open_explorer: Callable[..., ExplorerPage], size: tuple[int, int]) -> None:
    explorer = open_explorer(*size, QUICK)
    # The thumb of the slider of the energy is higher once the slider has its picture.
    explorer.page.locator(".rail > [data-pictured]").wait_for()
    explorer.page.evaluate(_SHIFTS)
    explorer.press("Share")
    expect(heading(explorer, "Share")).to_be_visible()
    explorer.press("Close")
    expect_open(explorer, None)
    assert explorer.page.evaluate("shifts") == 0


def assert_beside_a_drawer(explorer: ExplorerPage) -> None:
    drawer = explorer.page.locator(".drawer").bounding_box()
    slider = explorer.page.get_by_role("slider", name="Energy h", exact=True).bounding_box()
    assert drawer is not None
    assert slider is not None
    is_above, is_below = slider["y"] + slider["height"] <= drawer["y"], slider["y"] >= drawer["y"] + drawer["height"]
    assert is_above or is_below or slider["x"] + slider["width"] <= drawer["x"]
    centre = explorer.point("basins", 0.0, 0.0)
    in_drawer = "([x, y]) => Boolean(document.elementFromPoint(x, y).closest('.drawer'))"
    assert centre[1] < drawer["y"] or not explorer.page.evaluate(in_drawer, centre)
