"""Statistics of the whole view and of a box."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from app.views.components.numbers import percent
from engine import CASES, MapSpec, Plane, compute_map, compute_statistics
from tests.browser.explorer_page import ExplorerPage


@pytest.fixture(scope="module")
def shared(open_for_all: Callable[..., ExplorerPage]) -> ExplorerPage:
    return open_for_all(link="?statistics=yes")


def drag(explorer: ExplorerPage, begin: tuple[float, float], end: tuple[float, float]) -> None:
    explorer.page.mouse.move(*explorer.point("basins", *begin))
    explorer.page.mouse.down()
    explorer.page.mouse.move(*explorer.point("basins", *end), steps=5)
    explorer.page.mouse.up()


def choose_box_tool(explorer: ExplorerPage) -> None:
    explorer.page.evaluate(
        """() => {
            const {toolbar} = Bokeh.documents[0].get_model_by_name('basins')
            for (const tool of toolbar.tools) if (tool.type == 'BoxSelectTool') tool.active = true
        }"""
    )


def test_the_statistics_are_those_of_the_map(shared: ExplorerPage) -> None:
    statistics = compute_statistics(compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19)))
    table = shared.page.get_by_text("Interior starts in the whole view").locator("xpath=ancestor::table")
    expect(table).to_contain_text(percent(statistics.shares[1], 2))
    expect(table).to_contain_text(percent(statistics.direct_share, 2))
    expect(table).to_contain_text(f"{statistics.median_escape_time:.4g}")


def test_a_box_can_be_counted_and_removed(shared: ExplorerPage) -> None:
    choose_box_tool(shared)
    drag(shared, (-0.1, 0.2), (0.1, 0.4))
    expect(shared.text("Interior starts in the box drawn on the maps")).to_be_visible()
    box = shared.model_data("box")
    assert [box["left"][0], box["right"][0]] == [-0.1, 0.1] or abs(box["left"][0] + 0.1) < 0.01
    expect(shared.page.get_by_role("table", name="statistics")).to_contain_text("100.00 %")
    shared.press("Count the whole view")
    expect(shared.text("Interior starts in the whole view")).to_be_visible()
    assert shared.model_data("box")["left"] == []


def test_the_histogram_counts_every_escape(shared: ExplorerPage) -> None:
    statistics = compute_statistics(compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19)))
    tops = shared.page.evaluate(
        """() => {
            const sums = []
            for (const model of Bokeh.documents[0].all_models) if (model.type == 'Quad') {
                for (const r of Bokeh.documents[0].all_models)
                    if (r.type == 'GlyphRenderer' && r.glyph === model && r.data_source.data.top?.length == 40)
                        sums.push([...r.data_source.data.top].reduce((a, b) => a + b, 0))
            }
            return sums
        }"""
    )
    assert statistics.escaped in tops
