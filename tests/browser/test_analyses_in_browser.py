"""Analyses on the page: doubtful pixels, manifolds, origins, measures, curves against energy and verdicts."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from engine import CASES, MapSpec, Plane, Trust, compute_map, compute_origin_fates, compute_trust
from tests.browser.explorer_page import ExplorerPage

OpenExplorer = Callable[..., ExplorerPage]
SPEC = MapSpec(CASES["II"], Plane.X_PX, 0.25, (113, 113), t_max=1e3)
VIEW = "?case=II&h=0.25&resolution=113&t_max=1000"


def switch(explorer: ExplorerPage, label: str) -> None:
    explorer.page.get_by_label(label, exact=True).click()


def test_doubtful_pixels_are_those_of_the_engine_and_follow_the_switch(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=VIEW)
    switch(explorer, "Pixels to trust")
    expect(explorer.text("of the pixels inside are doubtful")).to_be_visible()
    explorer.wait_for_data("doubts", "data.doubt.length == 1")
    marks = np.array(explorer.model_data("doubts")["doubt"]).ravel()
    expected = compute_trust(compute_map(SPEC)).trust == Trust.DOUBTFUL
    assert marks.sum() == expected.sum() > 0
    switch(explorer, "Pixels to trust")
    explorer.wait_for_data("doubts", "data.doubt.length == 0")


def test_manifolds_lie_on_the_section_and_follow_the_energy(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=VIEW + "&manifolds=yes")
    explorer.wait_for_data("manifolds", "data.xs.length > 2")
    expect(explorer.text("Stable manifolds of the Lyapunov orbits")).to_be_visible()
    first = len(explorer.model_data("manifolds")["xs"])
    explorer.type_number("Exact h", "0.4")
    explorer.page.wait_for_function(
        f"Bokeh.documents[0].get_model_by_name('manifolds').data.xs.length > 0"
        f" && Bokeh.documents[0].get_model_by_name('manifolds').data.xs.length != {first}"
    )


def test_origins_have_a_picture_and_a_key(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=VIEW)
    switch(explorer, "Origin and exit")
    expect(explorer.text("Enters by (rows), leaves by (columns)")).to_be_visible()
    explorer.page.wait_for_function("Bokeh.documents[0].get_model_by_name('maps').data.passage[0].length > 1")
    passage, origins = explorer.column("passage"), compute_origin_fates(SPEC)
    same = (origins.origin == origins.fate) & (origins.fate == 1)
    assert len(set(passage[same].tolist())) == 1
    assert passage[same][0] not in passage[(origins.origin != 1) | (origins.fate != 1)]


@pytest.mark.slow
def test_basins_are_measured(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=VIEW + "&measures=yes")
    for text in ("Basin entropy.", "Wada.", "Escape law."):
        expect(explorer.text(text)).to_be_visible()
    explorer.wait_for_data("survival_steps", "data.t.length > 10")
    explorer.press("Measure the uncertainty exponent")
    expect(explorer.text("α =")).to_be_visible(timeout=60_000)
    assert len(explorer.model_data("pairs")["share"]) > 5


@pytest.mark.slow
def test_curves_are_drawn_and_a_click_opens_a_map(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(height=2400, link=VIEW + "&energies=yes")
    explorer.press("Compute the curves")
    explorer.wait_for_data("energy_points", "data.h.length >= 3")
    explorer.page.get_by_role("button", name="Stop", exact=True).last.click()
    expect(explorer.page.get_by_role("button", name="Compute the curves")).to_be_visible()
    points = explorer.model_data("energy_points")
    place = int(np.argmax(points["h"]))
    explorer.page.get_by_role("button", name="Compute the curves").scroll_into_view_if_needed()
    explorer.forget_pixels()
    explorer.click("entropies", points["h"][place] - 1e-3, points["s_bb"][place])
    explorer.wait_for_new_pixels()
    expect(explorer.page.get_by_label("Exact h")).to_have_value(re.compile("^0.5"))


def test_a_bounded_orbit_is_judged_by_three_indicators(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link="?case=I&h=0.05&t_max=10000&resolution=113&orbits=0.1,0.05")
    table = explorer.page.get_by_label("chaos indicators")
    for name in ("SALI", "Lyapunov exponent", "Birkhoff digits"):
        expect(table).to_contain_text(name)
    expect(table).to_contain_text("agree to")
    assert table.inner_text().count("regular") >= 3
    explorer.wait_for_data("exponent_histories", "data.xs.length == 1 && data.ys[0].length > 100")


def test_a_link_sets_the_switches(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=VIEW + "&trust=yes&origins=yes")
    for label in ("Pixels to trust", "Origin and exit"):
        expect(explorer.page.get_by_label(label, exact=True)).to_be_checked()
    expect(explorer.page.get_by_label("Stable manifolds", exact=True)).not_to_be_checked()
