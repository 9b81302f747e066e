"""Texts about potentials and orbits agree with what is shown."""

from __future__ import annotations

import re
import urllib.parse
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.browser.explorer_page import ExplorerPage

pytestmark = pytest.mark.browser

OpenExplorer = Callable[..., ExplorerPage]

# Case I with its well at (1, 0).
WELL_ELSEWHERE = "((x-1)^2 + y^2)/2 - (x-1)y^2"
SMALL = "resolution=112&t_max=1000"


@pytest.mark.slow
def test_a_refused_potential_stays_in_the_box_and_its_well_can_be_used(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=f"?case=I&h=0.25&{SMALL}")
    explorer.press("Other …")
    box = explorer.page.get_by_label("V(x, y) =")
    box.fill(WELL_ELSEWHERE)
    box.press("Enter")
    expect(explorer.text("There is no well at the origin")).to_be_visible()
    expect(explorer.text("The maps still show Case I")).to_be_visible()
    expect(explorer.page.get_by_role("cell", name="(1, 0)", exact=True)).to_be_visible()
    expect(box).to_have_value(WELL_ELSEWHERE)
    box.press("End")
    box.type(" +")
    expect(explorer.text("the formula ends where")).to_be_visible()
    expect(explorer.page.get_by_role("cell", name="(1, 0)", exact=True)).to_have_count(0)
    box.fill(WELL_ELSEWHERE)
    explorer.press("Use this well")
    expect(box).to_have_value(f"{WELL_ELSEWHERE}; well (1, 0)")
    expect(explorer.text("The maps still show")).to_have_count(0)
    explorer.page.wait_for_url(re.compile("case=typed"))


@pytest.mark.slow
def test_a_text_beyond_the_limit_is_refused_and_not_cut(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=f"?case=I&h=0.25&{SMALL}")
    explorer.press("Other …")
    box, text = explorer.page.get_by_label("V(x, y) ="), "r^2/2 - " + " - ".join(["x y^2"] * 100)
    box.fill(text)
    expect(explorer.text(f"the text has {len(text)} characters; at most 500 characters are allowed")).to_be_visible()
    expect(box).to_have_value(text)


@pytest.mark.slow
def test_the_controls_name_the_parameters_and_their_formula(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=f"?case=I&omega_1=1.46&h=0.25&{SMALL}")
    expect(explorer.text("V = 1.0658x² + y²/2 − xy²")).to_be_visible()
    expect(explorer.text("Case I with ω1 = 1.46")).to_be_visible()


@pytest.mark.slow
def test_the_verdict_on_a_short_orbit_is_that_of_its_indicators(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link="?case=II&plane=x_h&orbits=0.3,0.05&t_max=100&resolution=112")
    expect(
        explorer.text("undecided whether regular or chaotic, with 15 upward crossings of y = 0 until t = 100.")
    ).to_be_visible()
    expect(explorer.page.get_by_label("chaos indicators").get_by_text("undecided")).to_have_count(4)


@pytest.mark.slow
def test_the_evidence_of_a_torus_stands_in_the_verdict(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link="?case=I&h=0.14&orbits=-0.3,0.0;-0.305,0.0&t_max=1e4&resolution=112")
    expect(
        explorer.text("and probably for ever (evidence: its averages converge as on an invariant torus), regular")
    ).to_be_visible()
    expect(explorer.page.get_by_role("radio", name="bounded until t = 10 000, regular")).to_have_count(2)


@pytest.mark.slow
def test_a_link_restores_the_box_and_says_what_to_do_about_a_problem(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link="?case=I&h=0.25&t_max=7&resolution=1.12e2&box=-0.1,0.2,-0.05,0.3&analysis=statistics")
    expect(explorer.text("Ignored t_max=7: choose 100, 1 000, 10 000, 100 000 or 1 000 000.")).to_be_visible()
    expect(explorer.text("Interior starts in the box drawn on the maps")).to_be_visible()
    assert explorer.model_data("box")["left"] == [-0.1]
    explorer.press("Count the whole view")
    explorer.page.wait_for_function("!location.search.includes('box=')")
    query = urllib.parse.parse_qs(urllib.parse.urlsplit(explorer.page.url).query)
    assert (query["resolution"], query["analysis"]) == (["112"], ["statistics"])
