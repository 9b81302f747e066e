"""Address, widgets and view state agree when the server changes widgets in quick succession."""

from __future__ import annotations

import re
import urllib.parse
from collections.abc import Callable

from playwright.sync_api import expect

from app.state.presets import PRESETS
from app.views.components.analysis_toggles import LABELS
from tests.browser.explorer_page import ExplorerPage

ANALYSES = "?trust=yes&manifolds=yes&origins=yes&resolution=113&t_max=1000"
# Two messages as the server sends them, the second one when the button has been drawn and before it can answer.
_DISABLE_AGAIN = """async label => {
    const model = [...Bokeh.documents[0]._all_models.values()].find(model => model.label === label)
    const set = value => Bokeh.documents[0].apply_json_patch(
        {events: [{kind: "ModelChanged", model: {id: model.id}, attr: "disabled", new: value}]})
    set(false)
    await new Promise(resolve => requestAnimationFrame(resolve))
    set(true)
    await new Promise(resolve => setTimeout(resolve, 300))
    return model.disabled
}"""


def on_in_the_address(explorer: ExplorerPage) -> set[str]:
    query = urllib.parse.parse_qs(urllib.parse.urlsplit(explorer.page.url).query)
    return {name for name in LABELS if query.get(name) == ["yes"]}


def expect_switches(explorer: ExplorerPage, on: set[str]) -> None:
    for name, label in LABELS.items():
        expect(explorer.page.get_by_label(label, exact=True)).to_be_checked(checked=name in on)


def test_a_widget_keeps_the_last_state_that_the_server_sets(shared: ExplorerPage) -> None:
    button = shared.page.get_by_role("button", name="Find its twin")
    expect(button).to_be_disabled()
    assert shared.page.evaluate(_DISABLE_AGAIN, "Find its twin") is True
    expect(button).to_be_disabled()


def test_a_button_is_enabled_shortly_after_it_was_disabled(for_orbits: ExplorerPage) -> None:
    for _ in range(3):
        for_orbits.click("basins", 0.1, 0.05)
        expect(for_orbits.page.get_by_role("button", name="Clear all")).to_be_enabled()
        for_orbits.press("Clear all")
        for_orbits.click("basins", 0.1, 0.05)
        expect(for_orbits.page.get_by_role("button", name="Next frame")).to_be_enabled()
        for_orbits.press("Clear all")
        expect(for_orbits.page.get_by_role("button", name="Next frame")).to_be_hidden()


def test_switches_follow_the_state_after_a_gallery_entry(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link=ANALYSES)
    expect_switches(explorer, {"trust", "manifolds", "origins"})
    preset = next(preset for preset in PRESETS if preset.case == "III" and preset.window is not None)
    explorer.press("Gallery")
    explorer.page.get_by_role("button", name=re.compile(re.escape(preset.title))).first.click()
    explorer.page.wait_for_url(re.compile(f"case=III.*h={re.escape(repr(preset.energy))}.*window="))
    explorer.page.wait_for_timeout(1000)
    expect(explorer.radio("III")).to_be_checked()
    expect_switches(explorer, on_in_the_address(explorer))
    expect(explorer.page.get_by_label("Exact h", exact=True)).to_have_value(repr(preset.energy))


def test_a_switch_can_be_changed_right_after_the_server_has_set_it(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link=ANALYSES)
    explorer.page.get_by_label(LABELS["trust"], exact=True).click()
    explorer.page.wait_for_url(lambda address: "trust=yes" not in address)
    expect_switches(explorer, {"manifolds", "origins"})
    assert on_in_the_address(explorer) == {"manifolds", "origins"}
