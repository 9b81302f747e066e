"""Slices that are chosen by their axes, in Chromium."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from engine import CASES, Coordinate, MapSpec, ParameterAxis, Slice, System, compute_map
from plots.image_columns import map_columns
from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

ALONG = Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I")))


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


@pytest.mark.slow
def test_an_orbit_along_a_parameter_opens_the_plane_of_its_system(explorer: ExplorerPage) -> None:
    explorer.press("Axes …")
    explorer.page.get_by_label("Vertical axis").select_option(label="ε")
    explorer.wait_for_view("plane=x,epsilon=0.5:2.0")
    explorer.press("Close")
    explorer.wait_until_complete()
    explorer.click("basins", 0.1, 1.5)
    explorer.press("Open (x, px) at this ε")
    # The pixel of the click has ε = 1.4978.
    explorer.wait_for_view("plane=x_px", "epsilon=1.497", "orbits=")
