"""Statistics of the whole view and of a box."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from app.views.components.numbers import percent
from engine import CASES, EscapeMap, MapSpec, Plane, Window, compute_map, compute_statistics
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage


@pytest.fixture(scope="module")
def opened(open_for_all: Callable[..., ExplorerPage]) -> ExplorerPage:
    return open_for_all(link=f"{QUICK}&analysis=statistics")


@pytest.fixture(scope="module")
def counted() -> EscapeMap:
    return compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (112, 112), t_max=100.0))


def test_the_statistics_are_those_of_the_map(explorer: ExplorerPage, counted: EscapeMap) -> None:
    statistics = compute_statistics(counted)
    table = explorer.page.get_by_role("table", name="statistics")
    expect(table).to_contain_text("Interior starts in the whole view")
    for text in (percent(statistics.shares[1], 2), percent(statistics.direct_share, 2), f"{statistics.median_escape_time:.4g}"):
        expect(table).to_contain_text(text)


def test_a_box_opens_the_statistics_and_can_be_removed(explorer: ExplorerPage, counted: EscapeMap) -> None:
    expect(explorer.button("Count the whole view")).to_be_hidden()
    explorer.pick("Orbit")
    expect(explorer.page.get_by_role("table", name="statistics")).to_have_count(0)
    explorer.set_drag("Count")
    explorer.drag("basins", (-0.3, -0.2), (0.1, 0.4))
    expect(explorer.radio("Statistics")).to_be_checked()
    expect(explorer.text("Interior starts in the box drawn on the maps")).to_be_visible()
    box = {edge: values[0] for edge, values in explorer.model_data("box").items()}
    assert list(box.values()) == pytest.approx([-0.3, 0.1, -0.2, 0.4], abs=0.01)
    statistics = compute_statistics(counted, Window(box["left"], box["right"], box["bottom"], box["top"]))
    expect(explorer.page.get_by_role("table", name="statistics")).to_contain_text(percent(statistics.shares[1], 2))
    explorer.press("Count the whole view")
    expect(explorer.text("Interior starts in the whole view")).to_be_visible()
    assert explorer.model_data("box")["left"] == []
    explorer.set_drag("Move")
