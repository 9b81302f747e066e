"""A potential is typed, changed by sliders, and refused with a message."""

from __future__ import annotations

import re
import urllib.parse
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import Locator, expect

from engine import Fate, MapSpec, Plane, System, compute_map
from plots.pictures.palette import DEFAULT_COLOURS, OUTCOMES
from tests.browser.explorer_page import ExplorerPage

pytestmark = pytest.mark.browser

# A well of negative energies with a root, a function and a parameter.
PLUMMER = "−1/√(r² + c²) − 0.1 x²y exp(−y²) − 0.05 y³"
# A coefficient that no other test uses. The kernels are shared with potentials of the same terms.
WEAKER = "½(x² + y²) − 0.5xy²"


def open_box(explorer: ExplorerPage) -> Locator:
    """Return the box of the formula, with its drawer open."""
    explorer.press("Other …")
    box = explorer.page.get_by_label("V(x, y) =")
    expect(box).to_be_visible()
    return box


def linked(explorer: ExplorerPage, name: str) -> str | None:
    """Return a parameter of the address."""
    return dict(urllib.parse.parse_qsl(urllib.parse.urlsplit(explorer.page.url).query)).get(name)


def test_the_maps_follow_the_text_and_an_error_leaves_them(explorer: ExplorerPage) -> None:
    box = open_box(explorer)
    box.fill(WEAKER)
    explorer.wait_for_view("case=typed")
    expect(explorer.text("2 exits above h = 0.5")).to_be_visible()
    explorer.forget_pixels()
    box.press_sequentially("<y")
    expect(explorer.text("'<' is not understood")).to_be_visible()
    expect(explorer.text("The maps still show Typed potential: V = x²/2 + y²/2 − xy²/2")).to_be_visible()
    assert explorer.page.evaluate("Bokeh.documents[0].get_model_by_name('maps').data === window.before")
    assert linked(explorer, "V") == WEAKER
    explorer.press("Close")


def test_quick_steps_of_a_parameter_end_at_the_same_number_everywhere(explorer: ExplorerPage) -> None:
    open_box(explorer)
    rail = explorer.page.get_by_role("slider", name="ω₁", exact=True)
    rail.focus()
    for _ in range(13):
        rail.press("ArrowRight")
    explorer.wait_for_view("omega_1=1.13&")
    expect(rail).to_have_value("1.13")
    expect(explorer.page.get_by_label("ω₁, number")).to_have_value("1.13")
    expect(explorer.text("Case I with ω1 = 1.13")).to_be_visible()
    # A box takes numbers beyond its slider, up to a limit.
    box = explorer.page.get_by_label("ω₂, number")
    box.fill("2.5")
    box.press("Enter")
    explorer.wait_for_view("omega_2=2.5&")
    box.fill("77")
    box.press("Tab")
    expect(box).to_have_value("2.5")
    explorer.press("Close")


# Colours of the picture on a slider, at a place from 0 to 1, from the top.
STRIP = """(slider, place) => {
    const {width, height} = slider.previousElementSibling
    const context = new OffscreenCanvas(width, height).getContext('2d', {willReadFrequently: true})
    context.drawImage(slider.previousElementSibling, 0, 0)
    const {data} = context.getImageData(Math.floor(place * width), 0, 1, height)
    return Array.from({length: height}, (_, row) => [...data.subarray(4 * row, 4 * row + 4)])
}"""


def test_a_slider_shows_the_shares_of_the_outcomes_while_the_view_is_at_rest(explorer: ExplorerPage) -> None:
    open_box(explorer)
    slider = explorer.page.get_by_role("slider", name="ω₁", exact=True)
    # The slider that was moved last has the picture.
    slider.press("ArrowRight")
    explorer.wait_for_view("omega_1=1.01&")
    expect(slider).to_have_attribute("title", re.compile("^Shares of coarse maps against ω₁ at h = .*, t = 100;"))
    explorer.page.wait_for_function(
        f"slider => [0.1, 0.25, 0.5, 0.99].every(place => ({STRIP})(slider, place).every(colour => colour[3] > 0))",
        arg=slider.element_handle(),
    )
    # A value of which the strip has a column.
    place, low, high = 0.25, 0.2, 2.0
    potential = System("I").with_parameter("omega_1", low + place * (high - low)).potential
    energy = float(linked(explorer, "h") or "nan")
    fate = compute_map(MapSpec(potential, Plane.X_PX, energy, (24, 24), t_max=100.0)).fate
    allowed = fate[~np.isin(fate, (Fate.FORBIDDEN, Fate.OUTSIDE))]
    colours = [tuple(colour) for colour in slider.evaluate(STRIP, place)]
    for channel, colour in enumerate(DEFAULT_COLOURS.channels[:2], 1):
        share = colours.count((*bytes.fromhex(colour[1:]), 255)) / len(colours)
        assert share == pytest.approx(np.mean(allowed == channel), abs=1.0 / len(colours))
    # Another view has other shares.
    slider.press("ArrowRight")
    expect(slider).to_have_attribute("title", "")
    explorer.press("Close")


@pytest.mark.slow
def test_a_formula_with_functions_has_maps_orbits_and_a_slider(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link="?resolution=112&t_max=100&letters=c:0.6&V=" + urllib.parse.quote(PLUMMER))
    explorer.wait_until_done()
    expect(explorer.page.get_by_role("alert")).to_have_count(0)
    assert (explorer.column("fate") - len(OUTCOMES) + 1).max() >= 1
    left, right, low, high = explorer.ranges("basins")
    explorer.click("basins", 0.5 * (left + right) + 0.05 * (right - left), 0.5 * (low + high))
    explorer.page.wait_for_url(lambda address: "orbits=" in address)
    open_box(explorer)
    rail = explorer.page.get_by_role("slider", name="c", exact=True)
    rail.focus()
    rail.press("ArrowRight")
    explorer.wait_for_view("letters=c:0.61", "h=-0.")
    assert (explorer.column("fate") - len(OUTCOMES) + 1).max() >= 1
    explorer.press("Close")
