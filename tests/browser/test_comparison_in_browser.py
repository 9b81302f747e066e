"""Two views are compared in the browser, and the pixels that differ are shown."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from engine import CASES, MapSpec, Plane, compute_map
from plots.pictures.image_columns import difference_column, map_columns
from plots.pictures.palette import DIFFERENCES, rgba
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

# Whether a canvas of the preview has more than 1000 pixels in the colour of different outcomes.
_DIFFERENCE_IN_PREVIEW = """colour => {
    const inside = root => [...root.querySelectorAll("*")].flatMap(one => [one, ...within(one.shadowRoot)])
    const within = root => root ? inside(root) : []
    const canvases = inside(document).filter(one => one.dataset?.energy && one.style.display != "none")
    return canvases.some(canvas => {
        const {data} = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height)
        let found = 0
        for (let k = 0; k < data.length; k += 4) found += colour.every((part, j) => data[k + j] === part)
        return found > 1000
    })
}"""


def test_another_energy_is_compared_with_the_view_that_was_kept(explorer: ExplorerPage) -> None:
    explorer.page.get_by_role("checkbox", name="Compare with this view", exact=True).click()
    explorer.wait_for_data("compared_map", "data.fate[0].length > 1")
    explorer.page.wait_for_url("**with_h=0.19**")
    explorer.type_number("Exact h", "0.3")
    explorer.wait_for_data("maps", "data.complete[0] && data.energy[0] == 0.3 && data.difference[0].length > 1")
    x, y, dw, dh = (explorer.column(name) for name in ("x", "y", "dw", "dh"))
    specs = [MapSpec(CASES["I"], Plane.X_PX, h, (112, 112), (x, x + dw, y, y + dh), t_max=100.0) for h in (0.3, 0.19)]
    expected = difference_column(*(map_columns(compute_map(spec)) for spec in specs))["difference"][0]
    # The sentence appears when both maps are complete.
    expect(explorer.text("starts have different outcomes")).to_be_visible()
    np.testing.assert_array_equal(explorer.column("difference"), expected)
    # The subscript of px in the legend is below the letter.
    legend = explorer.page.locator(".foot.legend span", has_text="h = 0.19")
    middles = [
        part.evaluate("part => { const {top, bottom} = part.getBoundingClientRect(); return top + bottom }")
        for part in (legend, legend.locator("sub"))
    ]
    assert middles[1] > middles[0] + 4.0
    explorer.press("Swap the views")
    explorer.page.wait_for_url("**with_h=0.3**")
    explorer.wait_for_data("maps", "data.complete[0] && data.energy[0] == 0.19 && data.difference[0].length > 1")
    np.testing.assert_array_equal(explorer.column("difference") == 6, expected == 6)


def test_an_energy_that_is_typed_before_the_server_has_kept_the_view_is_compared_too(explorer: ExplorerPage) -> None:
    explorer.page.get_by_role("checkbox", name="Compare with this view", exact=True).click()
    explorer.type_number("Exact h", "0.25")
    explorer.wait_for_data("maps", "data.complete[0] && data.energy[0] == 0.25 && data.difference[0].length > 1")
    # Both views are in the window of the kept view, which is smaller than that of all starts at the new energy.
    assert explorer.ranges("basins") == pytest.approx(explorer.window_of_pixels())


@pytest.mark.slow
def test_the_comparison_follows_the_slider_without_the_server(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link=f"{QUICK}&with_case=I&with_plane=x_px&with_h=0.19")
    explorer.wait_for_data("maps", "data.difference[0].length > 1")
    explorer.drag_energy_to(0.5, let_go=False)
    explorer.page.wait_for_function(_DIFFERENCE_IN_PREVIEW, arg=rgba([DIFFERENCES[1].colour])[0].tolist())
    explorer.page.mouse.up()
