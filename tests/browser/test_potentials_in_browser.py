"""The choice of potential."""

from __future__ import annotations

import urllib.parse
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from plots.palette import OUTCOMES
from tests.browser.explorer_page import ExplorerPage

pytestmark = pytest.mark.browser

# A coefficient that no other test uses; the kernels are those of the same terms.
WEAKER = "½(x² + y²) − 0.5xy²"


def test_a_typed_potential_is_reviewed_applied_and_written_to_the_link(explorer: ExplorerPage) -> None:
    explorer.press("Other …")
    box = explorer.page.get_by_label("V(x, y) =")
    box.fill("½(x² + y²) − x<y")
    expect(explorer.text("'<' is not understood")).to_be_visible()
    box.fill(WEAKER)
    expect(explorer.text("2 channels above the escape energy h = 0.5")).to_be_visible()
    box.press("Enter")
    explorer.wait_for_view("case=typed")
    query = urllib.parse.parse_qs(urllib.parse.urlsplit(explorer.page.url).query)
    assert (query["case"], query["V"]) == (["typed"], [WEAKER])
    explorer.press("Other …")
    expect(box).to_be_hidden()


def test_a_link_opens_a_potential_with_its_parameters(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link="?case=I&epsilon=0.5&h=0.75&resolution=112&t_max=100")
    expect(explorer.text("2 exit channels above h = 0.5")).to_be_visible()
    assert {1, 2} <= set((explorer.column("fate") - len(OUTCOMES) + 1).ravel().tolist())


def test_a_link_with_an_invalid_potential_gives_a_message_and_shows_case_one(open_explorer: Callable[..., ExplorerPage]) -> None:
    explorer = open_explorer(link="?t_max=100&V=" + urllib.parse.quote("x²y² <img src=x onerror=alert(1)>"))
    expect(explorer.page.get_by_role("alert")).to_contain_text("Ignored the potential in the link")
    expect(explorer.text("Case I")).to_be_visible()
