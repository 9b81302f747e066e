"""No part of the page has content beyond its box, in windows of any width, also with letters of twice the usual size."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import suppress

import pytest
from playwright.sync_api import Browser, Page
from playwright.sync_api import TimeoutError as PlaywrightTimeout

from tests.browser.conftest import QUICK
from tests.conftest import TIMEOUT_MS

WIDTHS = ((1600, 1000), (1280, 720), (1024, 768), (768, 1024), (420, 860), (860, 420))
LETTERS = (16, 32)
"""Sizes of letters in the settings of the browser, in pixels; the first is usual."""

LINKS = {
    "case I": QUICK,
    "deep": "?case=I&plane=x_px&h=0.19&t_max=1000&resolution=112&window=0.1149126434,0.1149126436,0.0001,0.0003",
    "closed exit": "?V=0.5(x^2%2By^2)%2B1.2x^2y-y^3/3&t_max=100&resolution=112",
    "statistics": "?case=Hill&t_max=100&resolution=112&analysis=statistics",
    "measures": "?case=III&plane=x_px&h=0.45&t_max=1000&resolution=112&analysis=measures",
    "rotating frame": "?case=Earth-Moon&plane=x,y&fix=beta=-1.5707963267948966&h=-1.095&t_max=100&resolution=112",
    "layers": "?case=III&plane=x_px&h=0.3&t_max=100&resolution=112&regularity=yes&origins=yes&descriptor=yes",
}

# Texts of the parts that hide or cut some of their content, and whether the page is wider than the window.
_CUT = """() => {
    const cut = document.documentElement.scrollWidth > innerWidth ? ["the page is wider than the window"] : []
    const walk = root => {
        for (const node of root.querySelectorAll("*")) {
            if (node.shadowRoot) walk(node.shadowRoot)
            const {overflowX, overflowY, clipPath, visibility} = getComputedStyle(node)
            if (!node.textContent.trim() || !node.offsetWidth || clipPath != "none" || visibility == "hidden") continue
            if (node.matches("select, .frame")) continue
            const beyond = [[overflowX, node.scrollWidth - node.clientWidth], [overflowY, node.scrollHeight - node.clientHeight]]
            if (beyond.some(([overflow, pixels]) => ["hidden", "clip"].includes(overflow) && pixels > 1)) {
                cut.push(`${node.tagName}.${node.className}: ${node.textContent.trim().slice(0, 80)}`)
            }
        }
    }
    walk(document)
    return cut
}"""
# The first frame of the map is on the page.
_SHOWN = "window.Bokeh?.documents[0]?.get_model_by_name('maps')?.data.fate?.[0].shape?.[0] > 1"

SETTLING_MS = 10_000
"""Longest time in which the parts of the page get their places in a window of another size."""


@pytest.fixture(scope="module", params=LETTERS, ids=lambda size: f"letters of {size}")
def reader(request: pytest.FixtureRequest, chromium: Browser, chromium_path: str) -> Iterator[Browser]:
    settings = f"--blink-settings=defaultFontSize={request.param}"
    with chromium.browser_type.launch(executable_path=chromium_path, args=["--no-sandbox", settings]) as browser:
        yield browser


def cut_parts(reader: Browser, address: str) -> dict[str, list[str]]:
    """Return the parts that are cut, for each width at which there are any."""
    page: Page = reader.new_page(viewport={"width": 1600, "height": 1000})
    page.set_default_timeout(TIMEOUT_MS)
    page.goto(address)
    page.wait_for_function(_SHOWN)
    found = {}
    for width, height in WIDTHS:
        page.set_viewport_size({"width": width, "height": height})
        with suppress(PlaywrightTimeout):
            page.wait_for_function(f"innerWidth === {width} && !({_CUT})().length", timeout=SETTLING_MS)
        found[f"{width} × {height}"] = page.evaluate(_CUT)
    page.close()
    return {size: parts for size, parts in found.items() if parts}


@pytest.mark.parametrize("name", LINKS)
def test_no_content_is_cut(reader: Browser, server: str, name: str) -> None:
    assert cut_parts(reader, server + LINKS[name]) == {}


# Whether the frame of the basins is a square inside the window, beside the slider of the energy.
_WHOLE_PICTURE = """() => {
    const views = [...Bokeh.index.all_views()], view = views.find(each => each.model.name === "basins")
    const {left, right, bottom} = view.canvas_view.el.getBoundingClientRect(), {width, height} = view.frame.bbox
    const slider = views.find(each => each.model.css_classes?.includes("energy")).el.getBoundingClientRect()
    const isWhole = left >= 0 && bottom <= innerHeight && right <= slider.left + 8
    return isWhole && Math.abs(width - height) <= 1 && width > 0.35 * innerHeight
}"""


def test_the_picture_is_whole_on_a_phone_that_lies_on_its_side(reader: Browser, server: str) -> None:
    page: Page = reader.new_page(viewport={"width": 844, "height": 390}, has_touch=True)
    page.goto(server + QUICK)
    page.wait_for_function(_SHOWN)
    page.wait_for_function(_WHOLE_PICTURE, timeout=SETTLING_MS)
    page.close()
