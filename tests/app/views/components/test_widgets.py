"""Tables are copied as tab-separated text, with numbers at full precision."""

from __future__ import annotations

from dataclasses import fields

import pytest

from app.job_clients.orbit_requests import StartOrbit
from app.state.view_state import ViewState
from app.views.analysis.basin_measures import BasinMeasuresView
from app.views.components.widgets import copy_button, number_rows
from app.views.orbits.orbit_controls import OrbitActions, OrbitControls
from engine import (
    CASES,
    MapSpec,
    Plane,
    compute_basin_entropy,
    compute_map,
    compute_wada_test,
    integrate_orbit,
)
from engine.trajectories.chaos_indicators import evaluate_indicators
from plots.pictures.orbit_curves import compute_orbit_curves


def test_rows_are_lines_and_cells_are_separated_by_tabs() -> None:
    copied: list[str] = []
    copy_button(lambda: [("a", "b"), *number_rows("c", {"d": 1 / 3, "e": 7})], copied.append).clicks += 1
    assert copied == ["a\tb\nc\td\t0.3333333333333333\nc\te\t7"]


@pytest.fixture
def copied() -> list[str]:
    return []


def test_an_orbit_is_copied_with_its_indicators(copied: list[str]) -> None:
    nothing = {field.name: lambda *_: None for field in fields(OrbitActions)}
    controls = OrbitControls(ViewState(), OrbitActions(**nothing | {"copy": copied.append}))
    controls.copy.clicks += 1
    orbit = integrate_orbit(CASES["I"], (0.1, 0.0, 0.05, 0.6), 50.0)
    controls.show([StartOrbit((0.1, 0.05), compute_orbit_curves(CASES["I"], orbit))], 0)
    controls.show_indicators(evaluate_indicators(orbit))
    controls.copy.clicks += 1
    assert copied[0] == ""
    rows = [line.split("\t") for line in copied[1].splitlines()]
    assert ["start", "px", "0.05"] in rows
    assert ["orbit", "energy", repr(orbit.energy)] in rows
    assert "SALI" in [row[0] for row in rows]
    assert {len(row) for row in rows} == {3}


def test_measures_of_the_shown_map_only_are_copied(copied: list[str]) -> None:
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (30, 30), t_max=100.0))
    entropy = compute_basin_entropy(frame)
    view = BasinMeasuresView(ViewState(), lambda name: None, copied.append)
    view.show("basin_entropy", entropy)
    view.show("wada", compute_wada_test(frame))
    view.copy.clicks += 1
    view.begin()
    view.copy.clicks += 1
    rows = [line.split("\t") for line in copied[0].splitlines()]
    assert ["Basin entropy", "s_b", repr(entropy.s_b)] in rows
    assert {row[0] for row in rows} == {"Basin entropy", "Wada distance"}
    assert copied[1] == ""
