"""Downloads can be opened in other programs: figures, maps, the link and an image."""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from PIL import Image
from playwright.sync_api import expect

from engine import CASES, MapSpec, Plane, compute_map
from tests.browser.explorer_page import ExplorerPage

SMALL = "?case=III&plane=x_px&h=0.45&t_max=1000&resolution=112&orbits=0.1,0.2;0.1,-0.3"

# Size in bytes of the image in the clipboard, awaited for at most 3000 animation frames.
_SIZE_OF_COPIED_IMAGE = """async () => {
  for (let frames = 0; frames < 3000; frames++) {
    const [item] = await navigator.clipboard.read()
    if (item?.types.includes("image/png")) return (await item.getType("image/png")).size
    await new Promise(requestAnimationFrame)
  }
}"""


@pytest.fixture(scope="module")
def small(open_for_all: Callable[..., ExplorerPage]) -> ExplorerPage:
    explorer = open_for_all(link=SMALL)
    explorer.wait_for_data("paths", "data.xs.length == 2")
    explorer.press("Share")
    return explorer


def download_file(explorer: ExplorerPage, label: str) -> tuple[str, bytes]:
    with explorer.page.expect_download() as download:
        explorer.press(label)
    return download.value.suggested_filename, Path(download.value.path()).read_bytes()


def test_a_figure_can_be_downloaded_as_pdf_of_a_given_width(small: ExplorerPage) -> None:
    small.page.get_by_label("What to draw").select_option("Orbits")
    small.page.get_by_role("radiogroup", name="Format").get_by_label("PDF").check()
    width = small.page.get_by_label("Width, cm")
    width.fill("8.5")
    width.press("Enter")
    name, data = download_file(small, "Save figure")
    assert name.endswith(".pdf")
    box = re.search(rb"/MediaBox \[ ?0 0 ([0-9.]+)", data)
    assert box is not None
    assert float(box[1]) == pytest.approx(8.5 / 2.54 * 72.0, abs=0.01)


def test_a_poster_is_as_wide_as_a_sheet_at_300_pixels_per_inch(small: ExplorerPage) -> None:
    small.page.get_by_label("What to draw").select_option("Basins of escape")
    name, data = download_file(small, "Save poster")
    assert re.fullmatch(r"poster-.*basins-of-escape\.png", name)
    with Image.open(io.BytesIO(data)) as poster:
        assert poster.width == pytest.approx(29.7 / 2.54 * 300.0, abs=1.0)
        assert poster.info["dpi"] == pytest.approx((300.0, 300.0), abs=0.1)


def test_the_maps_can_be_downloaded_as_netcdf(small: ExplorerPage) -> None:
    name, data = download_file(small, "Maps (NetCDF)")
    assert name.endswith(".nc")
    expected = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.45, (112, 112), t_max=1e3))
    with xr.open_dataset(io.BytesIO(data), engine="h5netcdf") as dataset:
        np.testing.assert_array_equal(dataset["fate"], expected.fate)


def test_the_link_is_copied(small: ExplorerPage) -> None:
    small.press("Copy link")
    expect(small.text("Copied.")).to_be_visible()
    assert small.page.evaluate("() => navigator.clipboard.readText()") == small.page.url


def test_an_image_is_copied(small: ExplorerPage) -> None:
    small.press("Copy image")
    assert small.page.evaluate(_SIZE_OF_COPIED_IMAGE) > 10_000
