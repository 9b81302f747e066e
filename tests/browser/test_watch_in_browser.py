"""Many orbits leave the well in the browser. They can be played forward and backward, and moved to a time."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from engine import CASES, Plane, classify_orbits, sample_starts
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

OpenExplorer = Callable[..., ExplorerPage]
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
