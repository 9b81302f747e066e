"""Many orbits leave the well in the browser. They can be played forward and backward, and moved to a time."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import FloatRect, expect

from engine import CASES, Plane, classify_orbits, sample_starts
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

OpenExplorer = Callable[..., ExplorerPage]
LAUNCH = "Watch 1 000 leave"
PAUSE = "Pause"
# Digits are grouped by thin spaces.
_INSIDE = re.compile(r"inside: (\d+(?:\s\d{3})*) ")


def inside(explorer: ExplorerPage) -> int:
    text = explorer.page.get_by_role("cell", name="inside:").inner_text()
    found = _INSIDE.search(text)
    assert found is not None
    return int("".join(found.group(1).split()))


def move_time_to(explorer: ExplorerPage, share: float) -> None:
    explorer.page.get_by_label("Time of the orbits").fill(str(round(1000 * share)))


# Whether the browser has loaded a module.
_LOADED = "module => performance.getEntriesByType('resource').some(entry => entry.name.endsWith(`/${module}`))"


def test_the_player_is_loaded_on_request_and_the_well_drains(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=f"{QUICK}&watch=well,1000,1,-2")
    # The engine in the browser starts after the first map.
    explorer.page.wait_for_function(_LOADED, arg="worker.js")
    assert not explorer.page.evaluate(_LOADED, "watch.js")
    explorer.pick("Watch")
    expect(explorer.page.get_by_role("button", name="Watch them leave")).to_be_enabled()
    assert explorer.page.evaluate(_LOADED, "watch.js")
    play = explorer.page.get_by_role("button", name="Watch them leave")
    expect(play).to_be_enabled()
    assert inside(explorer) == 1000
    play.click()
    expect(explorer.page.get_by_role("button", name="Pause")).to_be_visible()
    expect(explorer.page.get_by_role("cell", name=re.compile(r"inside: [1-9]\d\d "))).to_be_visible()
    explorer.page.get_by_role("button", name="Pause").click()
    expect(play).to_be_visible()


@pytest.fixture(scope="module")
def watched(open_for_all: OpenExplorer) -> ExplorerPage:
    explorer = open_for_all(link=f"{QUICK}&analysis=watch&watch=well,5000,1,-2")
    expect(explorer.page.get_by_role("button", name="Watch them leave")).to_be_enabled()
    return explorer


def test_as_many_orbits_have_left_as_from_other_random_starts(watched: ExplorerPage) -> None:
    move_time_to(watched, 0.2)
    expect(watched.text("t = 20.0")).to_be_visible()
    fate = classify_orbits(CASES["I"], 0.19, sample_starts(CASES["I"], 0.19, 20000, rng=5), t_max=20.0).fate
    expected = float((fate <= 0).mean())
    # Six standard errors of the difference of 5 000 and 20 000 orbits.
    error = (expected * (1.0 - expected) * (1 / 5000 + 1 / 20000)) ** 0.5
    assert abs(inside(watched) / 5000 - expected) < 6.0 * error


def test_a_slice_of_several_energies_says_why_there_is_nothing_to_watch(explorer: ExplorerPage) -> None:
    explorer.pick("Watch")
    explorer.pick(Plane.X_H.title)
    expect(explorer.text("Choose a slice of one energy")).to_be_visible()
    expect(explorer.page.get_by_role("button", name="Watch them leave")).to_be_disabled()


def test_below_the_slider_no_result_of_an_earlier_energy_stays(explorer: ExplorerPage) -> None:
    explorer.pick("Watch")
    expect(explorer.page.get_by_role("cell", name="inside:")).to_be_visible()
    explorer.type_number("Exact h", "0.05")
    expect(explorer.text("Choose a slice of one energy")).to_be_visible()
    expect(explorer.page.get_by_role("cell", name="inside:")).to_be_hidden()
    expect(explorer.page.locator("canvas.survival")).to_be_hidden()


def test_the_results_are_in_a_small_window(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(1280, 720, f"{QUICK}&analysis=watch&watch=well,1000,1,-2")
    expect(explorer.page.get_by_role("button", name="Watch them leave")).to_be_enabled()
    for result in (explorer.page.locator("canvas.survival"), explorer.page.get_by_role("cell", name="exit 2:")):
        expect(result).to_be_in_viewport(ratio=1)


@pytest.mark.slow
def test_the_time_runs_backwards_until_all_are_inside_again(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=f"{QUICK}&analysis=watch&watch=well,1000,1,-2")
    play = explorer.page.get_by_role("button", name="Watch them leave")
    expect(play).to_be_enabled()
    move_time_to(explorer, 0.1)
    assert inside(explorer) < 1000
    explorer.page.get_by_label("Speed").select_option("backwards")
    play.click()
    expect(explorer.text("t = 0.0")).to_be_visible()
    expect(play).to_be_visible()
    assert inside(explorer) == 1000


# Whether a canvas lies exactly over the frame of the well.
_OVER_THE_WELL = """() => {
    const well = [...Bokeh.index.all_views()].find(view => view.model.name == 'well')
    const [canvas, {left, top, width, height}] = [well.canvas_view.el.getBoundingClientRect(), well.frame.bbox]
    const all = root => [...root.querySelectorAll('*')].flatMap(node => [node, ...(node.shadowRoot ? all(node.shadowRoot) : [])])
    const over = all(document).filter(node => node.tagName == 'CANVAS' && node.style.position == 'fixed')
    const painted = over.map(each => each.getBoundingClientRect())
    const near = (one, other) => Math.abs(one - other) < 1
    return painted.some(box => near(box.left, canvas.left + left) && near(box.top, canvas.top + top)
        && near(box.width, width) && near(box.height, height))
}"""


def test_the_orbits_stay_over_the_well_when_the_page_changes_its_size(watched: ExplorerPage) -> None:
    watched.page.wait_for_function(_OVER_THE_WELL)
    watched.page.set_viewport_size({"width": 1100, "height": 650})
    watched.page.wait_for_function(_OVER_THE_WELL)


def test_one_press_beside_the_basins_plays_the_orbits_and_the_key_pauses_them(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=f"{QUICK}&watch=well,1000,1,-2")
    explorer.press(LAUNCH)
    expect(explorer.radio("Watch")).to_be_checked()
    expect(explorer.page.get_by_role("cell", name=re.compile(r"inside: [1-9]\d\d "))).to_be_visible()
    expect(explorer.page.get_by_role("button", name=PAUSE)).to_be_focused()
    expect(explorer.button(LAUNCH)).to_have_count(0)
    explorer.page.keyboard.press("w")
    expect(explorer.page.get_by_role("button", name="Watch them leave")).to_be_visible()


def is_within(box: FloatRect | None, top: float, bottom: float) -> bool:
    return box is not None and box["y"] >= top and box["y"] + box["height"] <= bottom


@pytest.mark.parametrize(("width", "height", "letters"), [(390, 844, "100%"), (420, 860, "100%"), (420, 860, "200%")])
def test_on_a_phone_the_picture_and_a_line_of_the_player_are_seen_together(
    open_explorer: OpenExplorer, width: int, height: int, letters: str
) -> None:
    explorer = open_explorer(width, height, f"{QUICK}&analysis=watch&watch=well,1000,1,-2", touch=True)
    page = explorer.page
    page.evaluate("size => { document.documentElement.style.fontSize = size }", letters)
    play = page.get_by_role("button", name="Watch them leave")
    expect(play).to_be_enabled()
    play.tap()
    page.wait_for_function("() => scrollY === 0")
    pause, close = page.get_by_role("button", name=PAUSE), explorer.button("Close the player")
    controls = [pause, page.get_by_label("Time of the orbits"), page.locator(".watched > output"), close]
    picture = page.locator(".bk-Figure.well.picked").bounding_box()
    assert is_within(picture, 0, height)
    for control in controls:
        expect(control).to_be_in_viewport(ratio=1)
        assert is_within(control.bounding_box(), picture["y"] + picture["height"], height)
    page.wait_for_function(_OVER_THE_WELL)
    close.tap()
    expect(close).to_be_hidden()
    expect(explorer.radio("Basins")).to_be_checked()
    expect(explorer.button(LAUNCH)).to_be_visible()


# Shares of pixels in the colours of text and page, at the numbers of the exits on the canvas over the well.
_NUMBER_PIXELS = """() => {
    const view = [...Bokeh.index.all_views()].find(view => view.model.name == 'well')
    const all = root => [...root.querySelectorAll('*')].flatMap(node => [node, ...(node.shadowRoot ? all(node.shadowRoot) : [])])
    const {left, top} = view.canvas_view.el.getBoundingClientRect(), {bbox} = view.frame
    const canvas = all(document).find(node => node.tagName == 'CANVAS' && node.style.position == 'fixed'
        && Math.abs(node.getBoundingClientRect().left - left - bbox.left) < 1)
    const {data} = view.model.renderers.find(each => each.data_source.name == 'channel_numbers').data_source
    const pixels = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data, style = getComputedStyle(canvas)
    const colours = ['--ui-ink', '--ui-page'].map(name => style.getPropertyValue(name).match(/\\d+/g).join())
    return [...data.x].map((x, k) => {
        const [column, row] = [view.frame.x_scale.compute(x) - bbox.left, view.frame.y_scale.compute(data.y[k]) - bbox.top]
        const place = i => Math.round(column) + i % 10 - 5 + canvas.width * (Math.round(row) + Math.floor(i / 10) - 8)
        const near = Array.from({length: 160}, (_, i) => [...pixels.subarray(4 * place(i), 4 * place(i) + 3)].join())
        return colours.map(colour => near.filter(each => each == colour).length / 160)
    })
}"""


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_numbers_of_the_exits_are_readable_over_the_orbits(open_explorer: OpenExplorer, theme: str) -> None:
    link = f"{QUICK.replace('case=I', 'case=III').replace('h=0.19', 'h=0.47')}&analysis=watch&watch=well,20000,1,-2"
    explorer = open_explorer(link=link, theme=theme)
    expect(explorer.page.get_by_role("button", name="Watch them leave")).to_be_enabled()
    move_time_to(explorer, 0.02)
    explorer.page.wait_for_function(_OVER_THE_WELL)
    shares = explorer.page.evaluate(_NUMBER_PIXELS)
    assert len(shares) == 4
    assert all(ink > 0.1 and page > 0.2 for ink, page in shares), shares
