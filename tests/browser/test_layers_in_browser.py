"""The text of a pixel under the mouse with all layers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from engine import CASES, MapSpec, Plane, Regularity, compute_map, compute_origin_fates, compute_regularity
from engine.foundations.wording import format_number
from engine.propagation.fates import describe_evidence
from tests.browser.explorer_page import ExplorerPage

OpenExplorer = Callable[..., ExplorerPage]
VIEW = "?case=III&h=0.28&resolution=112&t_max=1000"
SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.28, (112, 112), t_max=1e3)


def expect_tooltip(explorer: ExplorerPage, *texts: str) -> None:
    for text in texts:
        expect(explorer.page.locator(".bk-Tooltip").get_by_text(text).first).to_be_visible()


@pytest.mark.slow
def test_the_text_of_a_pixel_says_what_all_layers_know(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=f"{VIEW}&judge=yes&trust=yes&origins=yes")
    for column in ("trust", "passage"):
        explorer.page.wait_for_function(f"Bokeh.documents[0].get_model_by_name('maps').data.{column}[0].length > 1")
    frame = compute_map(SPEC)
    regularity, origins = compute_regularity(frame), compute_origin_fates(SPEC)
    explorer.page.wait_for_function(
        "regular => Bokeh.documents[0].get_model_by_name('maps').data.character[0].filter(code => code == 6).length == regular",
        arg=int(np.sum(regularity.character == Regularity.REGULAR)),
    )
    xs, ordinates = SPEC.pixel_centres()
    row, column = np.argwhere((origins.fate > 0) & (origins.origin > 0))[0]
    explorer.hover("characters", xs[column], ordinates[row])
    crossings = int(frame.crossings[row, column])
    expect_tooltip(
        explorer,
        f"escapes through exit {origins.fate[row, column]}",
        f"escape time {format_number(frame.escape_time[row, column])}",
        f"{crossings} upward crossing",
        f"entered through exit {origins.origin[row, column]}",
    )
    expect(explorer.page.locator(".bk-Tooltip").get_by_text("confirmed").or_(
        explorer.page.locator(".bk-Tooltip").get_by_text("not tested: like")).or_(
        explorer.page.locator(".bk-Tooltip").get_by_text("doubtful")).first).to_be_visible()  # fmt: skip
    row, column = np.argwhere(regularity.character == Regularity.REGULAR)[0]
    reason = describe_evidence(frame.evidence[row, column])
    explorer.hover("basins", xs[column], ordinates[row])
    expect_tooltip(explorer, "bounded", reason, "regular", "never entered: inside since −t_max")
    explorer.page.get_by_role("checkbox", name="Origin and exit", exact=True).uncheck()
    explorer.hover("basins", xs[column + 1], ordinates[row])
    explorer.hover("basins", xs[column], ordinates[row])
    expect(explorer.page.locator(".bk-Tooltip").get_by_text("never entered")).to_have_count(0)
