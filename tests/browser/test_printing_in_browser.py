"""The page is printed on one sheet: its address, its system, its pictures and its results, without controls."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.conftest import QUICK
from tests.browser.explorer_page import ExplorerPage

_WIDTHS = """names => [...Bokeh.index.all_views()].filter(view => names.includes(view.model.name))
    .map(view => view.el.getBoundingClientRect().width)"""
_PRINTED = "() => dispatchEvent(new Event('beforeprint'))"


@pytest.fixture
def printable(open_explorer: Callable[..., ExplorerPage]) -> ExplorerPage:
    """Return a page of its own, because a page does not know when a print ends that is only simulated."""
    return open_explorer(link=QUICK)


def test_a_print_has_the_pictures_in_their_size_and_no_controls(printable: ExplorerPage) -> None:
    explorer = printable
    page = explorer.page
    explorer.pick("Statistics")
    expect(explorer.text("Interior starts in the whole view")).to_be_visible()
    pictures = ["well", "basins", "times", "crossings"]
    widths = page.evaluate(_WIDTHS, pictures)
    page.evaluate(_PRINTED)
    # The width of A4.
    page.set_viewport_size({"width": 794, "height": 1123})
    page.emulate_media(media="print")
    for text in ("2 exits above", "✓ t =", "Energy h", "Interior starts in the whole view"):
        expect(explorer.text(text)).to_be_visible()
    address = page.evaluate("getComputedStyle(document.querySelector('.frame-header'), '::after').content")
    assert page.url in address
    for name in ("Gallery", "▶ Play", "Other …"):
        expect(explorer.button(name)).to_be_hidden()
    expect(explorer.radio("Statistics")).to_be_hidden()
    assert page.evaluate(_WIDTHS, pictures) == pytest.approx(widths, abs=1.0)


def test_a_print_fills_one_sheet(printable: ExplorerPage) -> None:
    expect(printable.text("Views to begin with")).to_be_visible()
    printed = printable.page.pdf(prefer_css_page_size=True)
    assert len(re.findall(rb"/Type\s*/Page\b", printed)) == 1
