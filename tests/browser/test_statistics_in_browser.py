"""Statistics are those of the whole view or of a box."""

from __future__ import annotations

import pytest
from playwright.sync_api import expect

from engine import CASES, EscapeMap, MapSpec, Plane, Window, compute_map, compute_statistics
from engine.foundations.wording import format_share
from tests.browser.explorer_page import ExplorerPage

# Screen position of the foot of the highest bar of a chart.
_BAR = """name => {
    for (const view of Bokeh.index.all_views()) {
        if (view.model.type !== 'Figure' || !view.model.elements.some(one => one.html?.includes(`help-${name}`))) continue
        const renderer = view.model.renderers.at(-1)
        view.el.scrollIntoView({block: "center"})
        const box = view.canvas_view.el.getBoundingClientRect()
        const {data} = renderer.data_source
        const tall = values => [...values].indexOf(Math.max(...values))
        const bar = tall(data.top)
        const x = 0.5 * (data.left[bar] + data.right[bar])
        return [box.left + view.frame.x_scale.compute(x), box.top + view.frame.bbox.bottom - 8]
    }
}"""


@pytest.fixture(scope="module")
def counted() -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (112, 112), t_max=100.0))


def test_a_box_opens_the_statistics_and_can_be_removed(explorer: ExplorerPage, counted: EscapeMap) -> None:
    expect(explorer.page.get_by_role("table", name="statistics")).to_have_count(0)
    explorer.set_drag("Count")
    explorer.drag("basins", (-0.3, -0.2), (0.1, 0.4))
    expect(explorer.radio("Statistics")).to_be_checked()
    expect(explorer.text("Interior starts in the box drawn on the maps")).to_be_visible()
    box = {edge: values[0] for edge, values in explorer.model_data("box").items()}
    assert list(box.values()) == pytest.approx([-0.3, 0.1, -0.2, 0.4], abs=0.01)
    statistics = compute_statistics(counted, Window(box["left"], box["right"], box["bottom"], box["top"]))
    expect(explorer.page.get_by_role("table", name="statistics")).to_contain_text(format_share(statistics.shares[1], 2))
    explorer.press("Count the whole view")
    expect(explorer.text("Interior starts in the whole view")).to_be_visible()
    assert explorer.model_data("box")["left"] == []
    explorer.set_drag("Move")


@pytest.mark.parametrize(
    ("chart", "texts"),
    [("histogram", ("starts", "escape", "from t =")), ("probabilities", ("crossings", "of the orbits still inside"))],
)
def test_bars_have_texts(explorer: ExplorerPage, chart: str, texts: tuple[str, ...]) -> None:
    explorer.pick("Statistics")
    explorer.page.wait_for_function(_BAR, arg=chart)
    expect(explorer.page.get_by_role("table", name="statistics")).to_contain_text("interior starts")
    x, y = explorer.page.evaluate(_BAR, chart)
    explorer.page.mouse.move(x - 2, y)
    explorer.page.mouse.move(x, y)
    for text in texts:
        expect(explorer.page.locator(".bk-Tooltip").get_by_text(text).first).to_be_visible()
