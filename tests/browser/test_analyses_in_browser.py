"""Analyses on the page: doubtful pixels, manifolds, origins, measures, curves against energy and verdicts."""

from __future__ import annotations

import re
from collections.abc import Callable

import numpy as np
import pytest
from playwright.sync_api import expect

from engine import (
    CASES,
    MapSpec,
    Plane,
    Regularity,
    Trust,
    compute_map,
    compute_origin_fates,
    compute_regularity,
    compute_trust,
)
from plots.sweep_panels import CURVE_PANELS
from tests.browser.explorer_page import ExplorerPage

OpenExplorer = Callable[..., ExplorerPage]
SPEC = MapSpec(CASES["II"], Plane.X_PX, 0.25, (112, 112), t_max=1e3)
VIEW = "?case=II&plane=x_px&h=0.25&t_max=1000&resolution=112"

CURVES = {"shares", *(panel.name for panel in CURVE_PANELS)}


@pytest.fixture(scope="module")
def opened(open_for_all: OpenExplorer) -> ExplorerPage:
    return open_for_all(link=VIEW)


def switch(explorer: ExplorerPage, label: str) -> None:
    explorer.page.get_by_label(label, exact=True).click()


@pytest.mark.slow
def test_doubtful_pixels_are_those_of_the_engine_and_follow_the_switch(explorer: ExplorerPage) -> None:
    switch(explorer, "Pixels to trust")
    expect(explorer.text("of the pixels inside are doubtful")).to_be_visible()
    expected = compute_trust(compute_map(SPEC)).trust == Trust.DOUBTFUL
    assert expected.any()
    # Results come in parts.
    explorer.wait_for_data(
        "doubts", f"data.doubt.length == 1 && data.doubt[0].filter(code => code > 0).length == {expected.sum()}"
    )
    switch(explorer, "Pixels to trust")
    explorer.wait_for_data("doubts", "data.doubt.length == 0")


@pytest.mark.slow
def test_manifolds_lie_on_the_section_and_follow_the_energy(explorer: ExplorerPage) -> None:
    switch(explorer, "Stable manifolds")
    explorer.wait_for_data("manifolds", "data.xs.length > 2")
    expect(explorer.text("Stable manifolds of the Lyapunov orbits")).to_be_visible()
    first = len(explorer.model_data("manifolds")["xs"])
    explorer.type_number("Exact h", "0.4")
    explorer.wait_for_data("manifolds", f"data.xs.length > 0 && data.xs.length != {first}")


@pytest.mark.slow
def test_origins_have_a_picture_and_a_key(explorer: ExplorerPage) -> None:
    switch(explorer, "Origin and exit")
    expect(explorer.text("Enters by (rows), leaves by (columns)")).to_be_visible()
    explorer.wait_for_data("maps", "data.passage[0].length > 1")
    passage, origins = explorer.column("passage"), compute_origin_fates(SPEC)
    same = (origins.origin == origins.fate) & (origins.fate == 1)
    assert len(set(passage[same].tolist())) == 1
    assert passage[same][0] not in passage[(origins.origin != 1) | (origins.fate != 1)]


@pytest.mark.slow
def test_regular_and_chaotic_orbits_can_be_distinguished(explorer: ExplorerPage) -> None:
    # An energy with bounded orbits of both kinds.
    explorer.pick("I")
    explorer.wait_for_view("case=I&", "h=0.19&")
    entry = explorer.page.get_by_text("bounded and chaotic")
    expect(entry).to_be_hidden()
    switch(explorer, "Regular or chaotic")
    expect(entry).to_be_visible()
    expect(explorer.text(re.compile(r"\d % of the bounded orbits are chaotic"))).to_be_visible()
    explorer.wait_for_data("maps", "data.character[0].length > 1")
    codes = explorer.column("character")
    shown = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (112, 112), t_max=1e3))
    chaotic = compute_regularity(shown).character == Regularity.CHAOTIC
    assert chaotic.any()
    assert len(set(codes[chaotic])) == 1
    switch(explorer, "Regular or chaotic")
    expect(entry).to_be_hidden()


def shown_figures(explorer: ExplorerPage) -> set[str]:
    """Names of the figures that are visible."""
    return set(
        explorer.page.evaluate(
            """() => [...Bokeh.index.all_views()].filter(view => view.model.type == "Figure" && view.el.offsetWidth > 0)
                .map(view => view.model.name)"""
        )
    )


@pytest.mark.slow
def test_basins_are_measured(explorer: ExplorerPage) -> None:
    explorer.pick("Measures")
    for text in ("Basin entropy", "Wada", "Escape law"):
        expect(explorer.text(text)).to_be_visible()
    explorer.wait_for_data("survival_steps", "data.t.length > 10")
    assert {"survival", "uncertainty"} & shown_figures(explorer) == {"survival"}
    explorer.press("Measure the uncertainty exponent")
    expect(explorer.text("α =")).to_be_visible(timeout=60_000)
    assert len(explorer.model_data("pairs")["share"]) > 5
    assert "uncertainty" in shown_figures(explorer)


@pytest.mark.slow
def test_curves_are_drawn_and_a_click_opens_a_map(explorer: ExplorerPage) -> None:
    explorer.pick("Against")
    expect(explorer.button("Compute the curves")).to_be_visible()
    assert not CURVES & shown_figures(explorer)
    explorer.press("Compute the curves")
    explorer.wait_for_data("curve_points", "data.value.length >= 3")
    explorer.button("Stop").last.click()
    expect(explorer.button("Compute the curves")).to_be_visible()
    assert shown_figures(explorer) >= CURVES
    points = explorer.model_data("curve_points")
    place = int(np.argmax(points["value"]))
    explorer.button("Compute the curves").scroll_into_view_if_needed()
    explorer.click("entropies", points["value"][place] - 1e-3, points["s_bb"][place])
    explorer.wait_for_view(f"h={points['value'][place]!r}")
    explorer.pick("Orbit")


def test_a_bounded_orbit_is_judged_by_three_indicators(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link="?case=I&h=0.05&t_max=10000&resolution=112&orbits=0.1,0.05")
    table = explorer.page.get_by_label("chaos indicators")
    names = ["SALI", "Lyapunov exponent", "Birkhoff digits of halves", "Birkhoff digits"]
    # The last row comes from a request of its own.
    expect(table.locator("th")).to_contain_text(names)
    # SALI and the exponent see no chaos; averages that agree as on a torus are regular.
    expect(table.locator("b")).to_have_text(["no sign of chaos", "no sign of chaos", "regular", "regular"])
    explorer.wait_for_data("exponent_histories", "data.xs.length == 1 && data.ys[0].length > 100")


@pytest.mark.slow
def test_a_link_sets_the_switches(open_explorer: OpenExplorer) -> None:
    explorer = open_explorer(link=VIEW + "&trust=yes&origins=yes&analysis=measures")
    for label, on in (("Pixels to trust", True), ("Origin and exit", True), ("Stable manifolds", False)):
        expect(explorer.page.get_by_label(label, exact=True)).to_be_checked(checked=on)
    expect(explorer.radio("Measures")).to_be_checked()
