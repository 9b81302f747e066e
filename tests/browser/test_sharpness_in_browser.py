"""At rest, pictures get as many pixels as they have on the screen, and a gesture ends this."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from playwright.sync_api import Browser

from plots.layers.table import TITLES
from tests.browser.explorer_page import ExplorerPage
from tests.browser.served_app import PANEL, READY, started_app
from tests.conftest import TIMEOUT_MS

LINK = "?case=I&plane=x_px&h=0.3&t_max=100&resolution=112"
# Number of rows of the pixels on the page.
ROWS = "Bokeh.documents[0].get_model_by_name('maps').data.fate[0].shape[0]"


@pytest.fixture(scope="module")
def sharp_server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Yield the address of an app that draws maps with up to 450 pixels along a side."""
    variables = {"ESCAPE_EXPLORER_SHARPEST_RESOLUTION": "450"}
    with started_app(tmp_path_factory.mktemp("server") / "log", *PANEL, variables=variables) as running:
        running.output.wait_for(READY)
        yield running.address


@pytest.fixture
def explorer(chromium: Browser, sharp_server: str) -> Iterator[ExplorerPage]:
    """Yield a page whose pictures are narrower than 224 pixels, and narrower than 450 when they are enlarged."""
    context = chromium.new_context(viewport={"width": 1280, "height": 600})
    context.set_default_timeout(TIMEOUT_MS)
    page = ExplorerPage(context.new_page(), sharp_server + LINK)
    page.open()
    yield page
    context.close()


def test_maps_at_rest_get_the_pixels_of_their_frames_also_when_enlarged(explorer: ExplorerPage) -> None:
    explorer.page.wait_for_function(f"{ROWS} === 224")
    explorer.press(f"Enlarge, or show all: {TITLES['basins']}")
    explorer.page.wait_for_function(f"{ROWS} === 450")
    # The numbers and the controls are those of the chosen resolution.
    assert "resolution=112" in explorer.page.url
    pixels = explorer.column("fate")
    assert {value.shape for value in (pixels, explorer.column("escape_time"), explorer.column("crossings"))} == {(450, 450)}


def test_a_drag_replaces_the_pixels_which_come_back_at_rest(explorer: ExplorerPage) -> None:
    explorer.page.wait_for_function(f"{ROWS} === 224")
    explorer.drag_energy_to(0.6)
    explorer.wait_for_view("h=0.34&")
    explorer.page.wait_for_function(f"{ROWS} === 112")
    explorer.page.wait_for_function(f"{ROWS} === 224")
