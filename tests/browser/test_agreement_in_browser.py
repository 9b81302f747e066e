"""Address, widgets and view state agree after quick changes of widgets by the server."""

from __future__ import annotations

import urllib.parse
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from plots.layers.table import LAYERS
from tests.browser.explorer_page import ExplorerPage

LAYERS_ON = "?case=I&plane=x_px&h=0.19&t_max=100&resolution=112&trust=yes&judge=yes&origins=yes"
# Disable and enable a button with two messages as of the server: the second when the button is drawn, before the browser answers.
_ENABLE_AGAIN = """async label => {
    const model = [...Bokeh.documents[0].all_models].find(model => model.label === label)
    const set = value => Bokeh.documents[0].apply_json_patch(
        {events: [{kind: "ModelChanged", model: {id: model.id}, attr: "disabled", new: value}]})
    set(true)
    await new Promise(resolve => requestAnimationFrame(resolve))
    set(false)
}"""

# Choose a case while a message of the server with an older choice is on its way.
_CHOOSE_BEFORE_AN_OLDER_CHOICE = """radio => {
    const model = [...Bokeh.documents[0].all_models].find(model => `${model.labels}` === "I,II,III")
    radio.click()
    Bokeh.documents[0].apply_json_patch({events: [{kind: "ModelChanged", model: {id: model.id}, attr: "active", new: 0}]})
}"""


@pytest.fixture(scope="module")
def opened(open_for_all: Callable[..., ExplorerPage]) -> ExplorerPage:
    return open_for_all(link=LAYERS_ON)


def on_in_the_address(explorer: ExplorerPage) -> set[str]:
    query = urllib.parse.parse_qs(urllib.parse.urlsplit(explorer.page.url).query)
    return {name for name in LAYERS if query.get(name) == ["yes"]}


def expect_switches(explorer: ExplorerPage, on: set[str]) -> None:
    for name, layer in LAYERS.items():
        expect(explorer.page.get_by_role("checkbox", name=layer.title, exact=True)).to_be_checked(checked=name in on)


def test_a_widget_keeps_the_last_state_that_the_server_sets(explorer: ExplorerPage) -> None:
    explorer.page.evaluate(_ENABLE_AGAIN, "▶ Play")
    # If the browser had echoed a message, the server would have answered the echo before this choice.
    explorer.pick("II")
    explorer.wait_for_view("case=II&")
    expect(explorer.button("▶ Play")).to_be_enabled()


def test_the_last_choice_is_shown_even_if_an_older_choice_arrives_later(explorer: ExplorerPage) -> None:
    explorer.radio("III").evaluate(_CHOOSE_BEFORE_AN_OLDER_CHOICE)
    explorer.wait_for_view("case=III")
    expect(explorer.radio("III")).to_be_checked()


def test_a_switch_can_be_changed_right_after_the_server_has_set_it(explorer: ExplorerPage) -> None:
    explorer.page.get_by_role("checkbox", name=LAYERS["trust"].title, exact=True).click()
    explorer.page.wait_for_url(lambda address: "trust=yes" not in address)
    expect_switches(explorer, {"judge", "origins"})
    assert on_in_the_address(explorer) == {"judge", "origins"}
