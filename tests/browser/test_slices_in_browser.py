"""Slices that are chosen by their axes, in Chromium."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from engine import CASES, Coordinate, MapSpec, Slice, compute_map
from plots.pictures.image_columns import map_columns
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage


@pytest.fixture
def explorer(open_explorer: Callable[..., ExplorerPage]) -> ExplorerPage:
    return open_explorer(link=QUICK)


def test_a_launch_angle_is_chosen_as_an_axis(explorer: ExplorerPage) -> None:
    explorer.press("Axes …")
    explorer.page.get_by_label("Vertical axis").select_option(label="θ")
    explorer.wait_for_view("plane=x,theta")
    expect(explorer.page.get_by_role("button", name="(x, θ) …")).to_be_visible()
    explorer.wait_until_complete()
    found = compute_map(MapSpec(CASES["I"], Slice(Coordinate.X, Coordinate.THETA), 0.19, (112, 112), t_max=100.0))
    np.testing.assert_array_equal(explorer.column("fate"), map_columns(found)["fate"][0])
