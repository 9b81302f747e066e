"""The tour explains the page in five steps, beside what each step is about, and returns the focus when it ends."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import Locator, expect

from app.state.tour import TOUR, TOUR_TITLE, TourPart
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

# The boxes of the tour and of its frames, and the window: left, top, right and bottom.
_BOXES = """() => new Promise(requestAnimationFrame).then(() => new Promise(requestAnimationFrame)).then(() => {
    const boxes = selector => [...document.querySelectorAll(selector)].map(element => {
        const {left, top, right, bottom} = element.getBoundingClientRect()
        return [left, top, right, bottom]
    })
    return {tour: boxes(".tour")[0], frames: boxes(".tour-frame"), window: [0, 0, innerWidth, innerHeight]}
})"""


# Whether the only frame of the tour surrounds the frame of the basins.
_SURROUNDS_BASINS = """() => {
    const view = [...Bokeh.index.all_views()].find(view => view.model.name === "basins")
    const [canvas, {left, top, right, bottom}] = [view.canvas_view.el.getBoundingClientRect(), view.frame.bbox]
    const expected = {left: canvas.left + left, top: canvas.top + top, right: canvas.left + right, bottom: canvas.top + bottom}
    const frames = [...document.querySelectorAll(".tour-frame")].map(frame => frame.getBoundingClientRect())
    return frames.length === 1 && Object.entries(expected).every(([edge, place]) => Math.abs(frames[0][edge] - place) <= 1)
}"""


def tour(explorer: ExplorerPage, step: int) -> Locator:
    """Return the box of the tour while it shows a step, which is counted from 1."""
    return explorer.page.get_by_role("dialog", name=TOUR[step - 1].title).filter(has_text=f"{step} of {len(TOUR)}")


def begin_from_help(explorer: ExplorerPage) -> None:
    explorer.press("Help")
    explorer.press("Take the tour")
    expect(tour(explorer, 1)).to_be_visible()


def is_inside(inner: list[float], outer: list[float]) -> bool:
    return inner[0] >= outer[0] and inner[1] >= outer[1] and inner[2] <= outer[2] and inner[3] <= outer[3]


def overlap(one: list[float], other: list[float]) -> bool:
    return one[0] < other[2] and other[0] < one[2] and one[1] < other[3] and other[1] < one[3]


def assert_beside_what_it_is_about(explorer: ExplorerPage) -> None:
    places = explorer.page.evaluate(_BOXES)
    assert places["frames"]
    assert is_inside(places["tour"], places["window"])
    assert not any(overlap(places["tour"], frame) for frame in places["frames"])


@pytest.mark.parametrize(("width", "height"), [(420, 850), (768, 1024), (1280, 720), (1600, 1000)])
def test_the_tour_goes_forward_and_back_beside_what_each_step_is_about(
    open_explorer: Callable[..., ExplorerPage], width: int, height: int
) -> None:
    explorer = open_explorer(width, height, QUICK, touch=width < 900)
    begin_from_help(explorer)
    last = len(TOUR)
    turns = [*((step, "Next") for step in range(1, last)), *((step, "Back") for step in range(last, 1, -1))]
    for step, label in turns:
        expect(tour(explorer, step)).to_be_visible()
        assert_beside_what_it_is_about(explorer)
        explorer.press(label)
    expect(tour(explorer, 1)).to_be_visible()
    expect(explorer.button("Back")).to_be_disabled()
    for _ in range(1, last):
        explorer.press("Next")
    explorer.press("Done")
    expect(explorer.page.locator(".tour")).to_have_count(0)


def test_with_large_letters_the_tour_of_a_phone_leaves_the_slider_of_the_energy_free(
    open_explorer: Callable[..., ExplorerPage],
) -> None:
    explorer = open_explorer(390, 844, QUICK, touch=True)
    explorer.page.evaluate("document.documentElement.style.fontSize = '200%'")
    begin_from_help(explorer)
    step = next(k for k, each in enumerate(TOUR, 1) if each.about == (TourPart.ENERGY,))
    for _ in range(1, step):
        explorer.press("Next")
    expect(tour(explorer, step)).to_be_visible()
    assert_beside_what_it_is_about(explorer)


def test_frames_surround_the_pictures_of_a_step_and_follow_them(explorer: ExplorerPage) -> None:
    begin_from_help(explorer)
    assert TOUR[0].about == (TourPart.MAP,)
    for width in (1600, 1280):
        explorer.page.set_viewport_size({"width": width, "height": 900})
        # Bokeh and the frame follow the window in later turns of the browser.
        explorer.page.wait_for_function(_SURROUNDS_BASINS)
    explorer.page.keyboard.press("Escape")


def test_escape_ends_the_tour_alone_and_returns_the_focus(explorer: ExplorerPage) -> None:
    begin_from_help(explorer)
    expect(explorer.button("Next")).to_be_focused()
    # A click elsewhere does not end the tour.
    explorer.page.get_by_role("heading", level=1).click()
    explorer.page.keyboard.press("2")
    explorer.wait_for_view("focus=")
    expect(tour(explorer, 1)).to_be_visible()
    explorer.page.keyboard.press("Escape")
    expect(explorer.page.locator(".tour, .tour-frame")).to_have_count(0)
    expect(explorer.button("Help")).to_be_focused()
    assert "focus=" in explorer.page.url


def test_a_start_is_kept_during_the_tour_of_an_empty_page_which_then_ends_on_the_stage(explorer: ExplorerPage) -> None:
    explorer.page.get_by_role("button", name=TOUR_TITLE).click()
    expect(tour(explorer, 1)).to_be_visible()
    explorer.click("basins", 0.1, 0.05)
    explorer.wait_for_data("starts", "data.x.length == 1")
    expect(explorer.page.locator("button[data-key=tour]")).to_be_hidden()
    explorer.page.locator(".tour").get_by_role("button", name="Close").click()
    expect(explorer.page.locator(".tour, .tour-frame")).to_have_count(0)
    expect(explorer.page.locator("#stage")).to_be_focused()
