"""Several orbits are marked, compared and played."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import expect

from plots.pictures.palette import DEFAULT_COLOURS
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

# Records the elements that move on the screen from now on, with the time and the upper edge of each move.
_WATCH_SHIFTS = """() => {
    window.shifts = []
    const place = ({x, y, width, height}) => [x, y, width, height].map(Math.round).join(" ")
    const describe = ({node, previousRect, currentRect}) =>
        `${node?.className || node?.nodeName}: from ${place(previousRect)} to ${place(currentRect)}`
    const top = ({previousRect, currentRect}) =>
        Math.min(...[previousRect, currentRect].filter(({width}) => width > 0).map(({y}) => y))
    const add = list => list.getEntries().forEach(entry =>
        window.shifts.push(...entry.sources.map(source => ({time: entry.startTime, top: top(source), text: describe(source)}))))
    new PerformanceObserver(add).observe({type: "layout-shift"})
}"""
_PAINTED = "() => new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(performance.now()))))"
_SHIFTS = "([since, bottom]) => window.shifts.filter(({time, top}) => time > since && top < bottom).map(({text}) => text)"
# Counts the frames that the page asks for, apart from those of this test.
_COUNT_FRAMES = """() => {
    const ask = window.requestAnimationFrame.bind(window)
    Object.assign(window, {frames: 0, framesBefore: -1})
    window.requestAnimationFrame = paint => { window.frames++; return ask(paint) }
}"""
# Whether the page has asked for no frame since the last call.
_IS_AT_REST = "() => { const before = window.framesBefore; window.framesBefore = window.frames; return before === window.frames }"
_BETWEEN_CALLS_MS = 1000
# Classes of the parts of the inspector.
PARTS = ("orbit-list", "verdict", "player", "sali", "exponent", "r2")

STARTS = [(0.1, 0.05), (0.2, 0.1), (-0.2, 0.1), (0.1, -0.2), (0.0, 0.3)]


def click_all(explorer: ExplorerPage, starts: list[tuple[float, float]]) -> None:
    for place, (x, px) in enumerate(starts):
        explorer.click("basins", x, px)
        explorer.wait_for_data("starts", f"data.x.length == {place + 1}")


def test_another_orbit_can_be_chosen_and_removed(explorer: ExplorerPage) -> None:
    click_all(explorer, STARTS[:2])
    # The server confirms the choice, so the button may be checked a moment after the click.
    first = explorer.page.get_by_role("radio", name=re.compile("^1: "))
    first.click()
    expect(first).to_be_checked()
    explorer.page.wait_for_url(lambda url: "look=" not in url)
    explorer.press("Remove")
    explorer.wait_for_data("starts", "data.x.length == 1")
    explorer.press("Clear all")
    explorer.wait_for_data("starts", "data.x.length == 0")
    expect(explorer.text("Click a map")).to_be_visible()


def test_the_inspector_is_hidden_while_there_are_no_orbits(explorer: ExplorerPage) -> None:
    parts = [explorer.page.locator(f".{part}").first for part in PARTS]
    explorer.click("basins", 0.1, 0.05)
    for part in parts:
        expect(part).to_be_visible()
    explorer.press("Clear all")
    for part in parts:
        expect(part).to_be_hidden()
    explorer.click("basins", 0.2, 0.1)
    expect(explorer.text("Escapes through")).to_be_visible()
    for part in parts:
        expect(part).to_be_visible()
    drawn = "name => Bokeh.documents[0].get_model_by_name(name).renderers.some(one => one.data_source.data.xs.length === 1)"
    assert all(explorer.page.evaluate(drawn, name) for name in ("sali", "exponent", "r2"))


def test_a_time_moves_along_path_sali_and_r2_together(explorer: ExplorerPage) -> None:
    explorer.click("basins", 0.1, 0.05)
    expect(explorer.text("Escapes through")).to_be_visible()
    explorer.page.get_by_role("slider", name="Time along the orbits").press("ArrowRight")
    explorer.wait_for_data("points", "data.x.length == 1")
    first = explorer.model_data("points")
    explorer.press("Play the orbits")
    explorer.wait_for_data("points", f"data.x.length == 1 && data.x[0] != {first['x'][0]!r}")
    spans = explorer.page.evaluate(
        """() => ['sali', 'r2'].map(name => Bokeh.documents[0].get_model_by_name(name).center
            .filter(m => m.type == 'Span' && m.dimension == 'height').map(m => [m.visible, m.location]))"""
    )
    assert spans[0] == spans[1]
    assert spans[0][0][0] is True
    assert spans[0][0][1] > 0


def places(explorer: ExplorerPage) -> dict[str, Any]:
    """Return places and sizes of the parts of the inspector, which must all be on the page."""
    found = {part: explorer.page.locator(f".{part}").first.bounding_box() for part in PARTS}
    assert None not in found.values()
    return dict(found)


def test_nothing_moves_with_further_orbits_messages_and_the_player(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(height=1000, link=f"{QUICK}&orbits=0.1,0.05")
    explorer.wait_for_data("r2_histories", "data.xs.length == 1")
    # The thumb of the slider of the energy is higher once the slider has its picture.
    explorer.page.locator(".rail > [data-pictured]").wait_for()
    begin = explorer.page.evaluate(_PAINTED)
    before = places(explorer)
    # The chart of the distance of two orbits opens below the histories, so only what is below them may move.
    end_of_histories = before["r2"]["y"] + before["r2"]["height"]
    explorer.page.evaluate(_WATCH_SHIFTS)
    explorer.page.get_by_role("slider", name="Time along the orbits").press("ArrowRight")
    explorer.click("basins", *STARTS[1])
    explorer.wait_for_data("r2_histories", "data.xs.length == 2")
    expect(explorer.page.get_by_role("radio", name=re.compile("2: .* at t"))).to_have_count(1)
    assert places(explorer) == before
    explorer.page.evaluate(_PAINTED)
    assert explorer.page.evaluate(_SHIFTS, [begin, end_of_histories]) == []
    explorer.press("Add this neighbour")
    explorer.wait_for_data("r2_histories", "data.xs.length == 3")
    explorer.wait_for_data("separation_source", "data.t.length > 100")
    explorer.page.evaluate(_PAINTED)
    assert explorer.page.evaluate(_SHIFTS, [begin, end_of_histories]) == []


def ends_of_line(explorer: ExplorerPage) -> list[float]:
    """Return the coordinates on the screen of both ends of the line from a start to its orbit."""
    line = explorer.page.locator(".start-line line")
    expect(line).to_be_visible()
    return [float(line.get_attribute(name) or "nan") for name in ("x1", "y1", "x2", "y2")]


def places_of_orbit(explorer: ExplorerPage) -> list[float]:
    """Return the coordinates on the screen of the only start on the basins and of the point of its orbit in the well."""
    places = [(picture, explorer.model_data(source)) for picture, source in (("basins", "starts"), ("well", "points"))]
    return [coordinate for picture, data in places for coordinate in explorer.point(picture, data["x"][0], data["y"][0])]


def wait_until_at_rest(explorer: ExplorerPage) -> None:
    """Wait until the page asks for no frames."""
    explorer.page.evaluate(_COUNT_FRAMES)
    explorer.page.wait_for_function(_IS_AT_REST, polling=_BETWEEN_CALLS_MS)


def test_a_page_with_an_orbit_at_rest_asks_for_no_frames_and_its_line_follows_pictures_that_move(explorer: ExplorerPage) -> None:
    explorer.click("basins", 0.1, 0.05)
    explorer.wait_for_data("paths", "data.xs.length == 1")
    wait_until_at_rest(explorer)
    before = ends_of_line(explorer)
    explorer.page.set_viewport_size({"width": 1280, "height": 720})
    wait_until_at_rest(explorer)
    assert ends_of_line(explorer) != before
    assert ends_of_line(explorer) == pytest.approx(places_of_orbit(explorer), abs=1.0)


def test_a_line_joins_the_chosen_start_with_its_orbit_and_the_path_has_the_colour_of_its_exit(explorer: ExplorerPage) -> None:
    explorer.click("basins", 0.1, 0.05)
    explorer.wait_for_data("paths", "data.xs.length == 1")
    assert ends_of_line(explorer) == pytest.approx(places_of_orbit(explorer), abs=1.0)
    assert explorer.model_data("paths")["colour"] == [DEFAULT_COLOURS.channels[0]]


def test_messages_disappear_with_their_subject(explorer: ExplorerPage) -> None:
    explorer.open_fold("Type a start")
    explorer.type_number("px", "nothing")
    expect(explorer.text("Type a number into both boxes first.")).to_be_visible()
    explorer.click("basins", 0.1, 0.05)
    expect(explorer.text("Type a number into both boxes first.")).to_have_count(0)
    explorer.press("Nearest periodic orbit")
    expect(explorer.text("no periodic orbit")).to_be_visible()
    explorer.press("Remove")
    expect(explorer.text("no periodic orbit")).to_have_count(0)


def test_an_interval_drawn_over_a_history_is_shown_by_path_curves_and_player(explorer: ExplorerPage) -> None:
    explorer.click("basins", 0.05, 0.02)
    explorer.wait_for_data("r2_histories", "data.xs.length == 1")
    explorer.page.locator(".r2").first.scroll_into_view_if_needed()
    whole = explorer.ranges("r2")
    explorer.drag("r2", (0.2 * whole[1], 0.1), (0.4 * whole[1], 0.1))
    expect(explorer.button("Whole orbit")).to_be_visible()
    begin, end = explorer.ranges("r2")[:2]
    assert (begin, end) == pytest.approx((0.2 * whole[1], 0.4 * whole[1]), rel=0.05)
    times = explorer.model_data("r2_histories")["xs"][0]
    assert begin <= times[0] < times[-1] <= end
    explorer.press("Whole orbit")
    explorer.page.wait_for_function("end => Bokeh.documents[0].get_model_by_name('r2').x_range.end == end", arg=whole[1])


def test_the_nearest_periodic_orbit_is_added_and_described(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link=QUICK.replace("h=0.19", "h=0.14&orbits=-0.3,0.02"))
    explorer.press("Nearest periodic orbit")
    expect(explorer.text("Periodic orbit, stable, T = 6.22505, a = 0.58323, 1 return to y = 0.")).to_be_visible()
    expect(explorer.page.get_by_role("radio", name=re.compile("^2: .*: periodic, stable"))).to_be_checked()
    expect(explorer.text("Searching for the nearest periodic orbit")).to_have_count(0)
