"""Before a new server has compiled anything, the browser shows maps of the catalogue and orbits, and follows the energy."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from playwright.sync_api import Browser, expect

from engine import CASES, Fate, MapSpec, Plane, Window, compute_map
from engine.foundations.cache_files import CACHE_VARIABLE
from plots.pictures.palette import OUTCOMES
from tests.browser.conftest import Watch
from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import PANEL, started_app
from tests.conftest import TIMEOUT_MS

HILL_ENERGY, ENERGY = -2.0, 0.35
HORIZON = 100.0
# Smallest share of the browser's escapes that are those of the library. Sensitive orbits differ.
LEAST_SHARE = 0.99


@pytest.fixture
def new(chromium: Browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[ExplorerPage]:
    """Yield the page of a server without compiled kernels, at a system that is no case of the paper."""
    folder = tmp_path_factory.mktemp("new")
    with started_app(folder / "log", *PANEL, variables={CACHE_VARIABLE: str(folder / "cache")}) as running:
        page = chromium.new_page(viewport={"width": 1600, "height": 1400})
        page.set_default_timeout(TIMEOUT_MS)
        watch = Watch(page)
        page.goto(f"{running.address}?case=Hill")
        yield ExplorerPage(page)
        assert watch.problems == []
        page.close()


def assert_preview(explorer: ExplorerPage, energy: float) -> None:
    """Check that the pictures are a preview at an energy, and not greyed out."""
    expect(explorer.text("Preview up to t =")).to_be_visible()
    explorer.wait_for_preview(energy)
    expect(explorer.page.locator(".maps .map").first).to_have_css("filter", "none")


def assert_pixels_of_case_three(explorer: ExplorerPage) -> None:
    """Compare the escapes of the finest preview with those of the library in the same window."""
    explorer.wait_for_preview(ENERGY, 224)
    fate = explorer.column("fate")
    window = Window(*explorer.window_of_pixels())
    expected = compute_map(MapSpec(CASES["III"], Plane.X_PX, ENERGY, (224, 224), window, HORIZON)).fate
    escaped = expected > 0
    assert np.count_nonzero(escaped) > 10_000
    assert np.mean(fate[escaped] - list(OUTCOMES).index(Fate.BOUNDED) == expected[escaped]) > LEAST_SHARE
    # The pictures show the whole window.
    np.testing.assert_allclose(explorer.ranges("basins"), explorer.window_of_pixels(), rtol=1e-12)
    well = explorer.ranges("well")
    assert well[1] == pytest.approx(MapSpec(CASES["III"], Plane.X_Y, ENERGY).find_window().x_high, rel=0.02)


def test_the_first_pictures_need_no_compiled_kernels(new: ExplorerPage) -> None:
    assert_preview(new, HILL_ENERGY)
    # The next system is shown as soon, in its own window.
    new.pick("III")
    assert_preview(new, ENERGY)
    assert_pixels_of_case_three(new)
    new.hover("basins", 0.1, 0.1)
    expect(new.page.locator(".orbit-card")).to_be_visible()
    new.drag_energy_to(0.5, let_go=False)
    new.wait_for_preview(0.6)
    new.page.mouse.up()


def test_the_map_of_a_new_system_is_not_greyed_out_after_its_preview(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link="?case=HH&t_max=100&resolution=112")
    expect(explorer.page.locator(".maps .map").first).to_have_css("filter", "none")
