"""Orbits, several at once: marked, compared, played."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

_WATCH_SHIFTS = """() => {
    window.shifts = 0
    // What moves at once when a button is pressed is no surprise, as the browsers' measure has it.
    const add = list => list.getEntries().forEach(entry => window.shifts += entry.hadRecentInput ? 0 : entry.value)
    new PerformanceObserver(add).observe({type: "layout-shift"})
}"""
PARTS = ("orbit-list", "verdict", "player", "interval", "sali", "exponent", "r2", "separation")

STARTS = [(0.1, 0.05), (0.2, 0.1), (-0.2, 0.1), (0.1, -0.2), (0.0, 0.3)]


@pytest.fixture(scope="module")
def shared(open_for_all: Callable[..., ExplorerPage]) -> ExplorerPage:
    return open_for_all(link=QUICK)


def click_all(explorer: ExplorerPage, starts: list[tuple[float, float]]) -> None:
    for place, (x, px) in enumerate(starts):
        explorer.click("basins", x, px)
        explorer.wait_for_data("starts", f"data.x.length == {place + 1}")


def test_another_orbit_can_be_chosen_and_removed(for_orbits: ExplorerPage) -> None:
    click_all(for_orbits, STARTS[:2])
    for_orbits.page.get_by_role("radio", name=re.compile("^1: ")).check()
    for_orbits.page.wait_for_url(lambda url: "look=" not in url)
    for_orbits.press("Remove")
    for_orbits.wait_for_data("starts", "data.x.length == 1")
    for_orbits.press("Clear all")
    for_orbits.wait_for_data("starts", "data.x.length == 0")
    expect(for_orbits.text("Click a map")).to_be_visible()


def test_a_time_moves_along_path_sali_and_r2_together(for_orbits: ExplorerPage) -> None:
    for_orbits.click("basins", 0.1, 0.05)
    expect(for_orbits.text("Escaped through")).to_be_visible()
    for_orbits.page.get_by_role("slider", name="Time along the orbits").press("ArrowRight")
    for_orbits.wait_for_data("points", "data.x.length == 1")
    first = for_orbits.model_data("points")
    for_orbits.press("Play the orbits")
    for_orbits.wait_for_data("points", f"data.x.length == 1 && data.x[0] != {first['x'][0]!r}")
    spans = for_orbits.page.evaluate(
        """() => ['sali', 'r2'].map(name => Bokeh.documents[0].get_model_by_name(name).center
            .filter(m => m.type == 'Span' && m.dimension == 'height').map(m => [m.visible, m.location]))"""
    )
    assert spans[0] == spans[1]
    assert spans[0][0][0] is True
    assert spans[0][0][1] > 0


def places(explorer: ExplorerPage) -> dict[str, object]:
    """Places and sizes of the parts of the inspector, which must all be on the page."""
    found = {part: explorer.page.locator(f".{part}").first.bounding_box() for part in PARTS}
    assert None not in found.values()
    return dict(found)


def test_nothing_moves_with_further_orbits_messages_and_the_player(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(height=1000, link=f"{QUICK}&orbits=0.1,0.05")
    explorer.wait_for_data("r2_histories", "data.xs.length == 1")
    explorer.page.evaluate("() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))")
    before = places(explorer)
    explorer.page.evaluate(_WATCH_SHIFTS)
    explorer.page.get_by_role("slider", name="Time along the orbits").press("ArrowRight")
    explorer.click("basins", *STARTS[1])
    explorer.wait_for_data("r2_histories", "data.xs.length == 2")
    expect(explorer.page.get_by_role("radio", name=re.compile("2: .* at t"))).to_have_count(1)
    assert places(explorer) == before
    explorer.press("Find divergent start")
    expect(explorer.text("The divergent start is")).to_be_visible()
    explorer.wait_for_data("separation_source", "data.t.length > 100")
    assert explorer.page.evaluate("window.shifts") == 0


def test_messages_end_with_what_they_were_about(for_orbits: ExplorerPage) -> None:
    for_orbits.open_fold("Type a start")
    for_orbits.type_number("px", "nothing")
    expect(for_orbits.text("Type a number into both boxes first.")).to_be_visible()
    for_orbits.click("basins", 0.1, 0.05)
    expect(for_orbits.text("Type a number into both boxes first.")).to_have_count(0)
    for_orbits.press("Find divergent start")
    expect(for_orbits.text("The divergent start is")).to_be_visible()
    for_orbits.press("Remove")
    expect(for_orbits.text("The divergent start is")).to_have_count(0)


def test_an_interval_drawn_over_a_history_is_shown_by_path_curves_and_player(for_orbits: ExplorerPage) -> None:
    for_orbits.click("basins", 0.05, 0.02)
    expect(for_orbits.text("Escaped through")).to_be_visible()
    for_orbits.page.locator(".r2").first.scroll_into_view_if_needed()
    whole = for_orbits.ranges("r2")
    for_orbits.drag("r2", (0.2 * whole[1], 0.1), (0.4 * whole[1], 0.1))
    expect(for_orbits.button("Whole orbit")).to_be_visible()
    begin, end = for_orbits.ranges("r2")[:2]
    assert (begin, end) == pytest.approx((0.2 * whole[1], 0.4 * whole[1]), rel=0.05)
    times = for_orbits.model_data("r2_histories")["xs"][0]
    assert begin <= times[0] < times[-1] <= end
    for_orbits.press("Whole orbit")
    for_orbits.page.wait_for_function("end => Bokeh.documents[0].get_model_by_name('r2').x_range.end == end", arg=whole[1])
