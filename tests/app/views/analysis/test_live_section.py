"""The browser computes the section only where the chart has the axes of a slice, and until the server's chart is complete."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import pytest

from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.analysis.live_section import LiveSection
from engine import CASES, Execution, MapSpec, Plane, compute_returns, read_section
from plots.browser.browser_system import make_browser_system
from plots.studies.section import COLOURS
from plots.studies.study import Changes
from tests.app.browser_messages import send


def at_once(function: Any) -> Any:
    """Run a function without a lock."""
    return function


def ignore(changes: Changes) -> None:
    """Change nothing."""


@pytest.mark.parametrize(("text", "columns"), [("y = 0.1 down", [0, 2]), ("x = 0", [1, 3]), ("px = 0 both", [0, 1])])
def test_the_chart_of_a_section_with_a_slice_is_computed_in_the_browser(text: str, columns: list[int]) -> None:
    live = LiveSection(ViewState(section=read_section(text)), ShownResults(), at_once, ignore)
    assert live.slice is not None
    assert live.slice["sectionColumns"] == columns


@pytest.mark.parametrize("text", ["angle = 30°", "pericentre about (0.1, 0)", "x + px = 0"])
def test_charts_with_other_axes_are_left_to_the_server(text: str) -> None:
    assert LiveSection(ViewState(section=read_section(text)), ShownResults(), at_once, ignore).slice is None


def test_the_energy_and_the_window_are_those_of_a_complete_chart() -> None:
    state, results = ViewState(), ShownResults()
    live = LiveSection(state, results, at_once, ignore)
    assert live.served is None
    spec = MapSpec(state.potential, Plane.X_PX, 0.15, (3, 3), (-0.1, 0.2, -0.3, 0.4), t_max=10.0)
    whole = compute_returns(spec, 2, execution=Execution())
    results.studies = {"section": replace(whole, complete=False)}
    assert live.served is None
    results.studies = {"section": whole}
    window = {"xLow": -0.1, "xHigh": 0.2, "ordinateLow": -0.3, "ordinateHigh": 0.4}
    assert live.served == {"energy": 0.15, "window": window, "section": "y = 0 up"}
    assert live.section == "y = 0 up"
    results.studies = {}
    assert live.served is None


def test_the_window_is_that_of_a_map_on_the_section() -> None:
    state = ViewState()
    live = LiveSection(state, ShownResults(), at_once, ignore)
    assert live.follows_window
    state.plane = Plane.X_Y
    assert not live.follows_window
    state.show_section(read_section("x = 0, px > 0"), with_slice=True)
    assert live.follows_window
    state.show_section(read_section("x - y = 0"), with_slice=True)
    assert not live.follows_window


def test_the_window_of_the_slice_is_tabulated_for_the_browser() -> None:
    section = read_section("y = 0.1 down")
    live = LiveSection(ViewState(section=section), ShownResults(), at_once, ignore)
    system = make_browser_system(CASES["III"], 0.3, 0.4, section, execution=Execution())
    (x_low, x_high, *_), *_ = system.to_dict()["windows"][live.plane]["windows"]
    expected = MapSpec(CASES["III"], section.slice_of_starts, 0.3).find_window()
    assert (x_low, x_high) == pytest.approx((expected.x_low, expected.x_high), rel=0.02)


def test_the_colours_are_those_of_the_orbits() -> None:
    state = ViewState()
    live = LiveSection(state, ShownResults(), at_once, ignore)
    for name in state.param.palette.objects:
        state.palette = name
        assert live.colouring["orbits"] == list(state.colours.orbits)
        assert live.colouring["inside"] == state.colours.bounded
    for choice in COLOURS.choices:
        state.settings = {**state.settings, COLOURS.name: choice}
        assert live.colouring["choice"] == choice


START = {"state": [0.1, 0.0, 0.2, (2 * (0.15 - float(CASES["I"].value(0.1, 0.0))) - 0.04) ** 0.5], "energy": 0.15}


def changes_of(message: Any) -> Mapping[str, Any]:
    """What the view is changed to when the browser sends a message."""
    found: list[Changes] = []
    send(LiveSection(ViewState(), ShownResults(), at_once, found.append), message)
    return found[0] if found else {}


def test_a_click_starts_the_orbit_of_its_point() -> None:
    changes = changes_of(START)
    assert (changes["plane"], changes["energy"]) == (Plane.X_PX, 0.15)
    assert changes["start"] == pytest.approx((0.1, 0.2), abs=1e-15)


@pytest.mark.parametrize(
    "message",
    [
        {},
        "state",
        {"state": 1.0, "energy": 0.15},
        START | {"state": [0.1, 0.0, 0.2]},
        START | {"state": [0.1, 0.0, 0.2, None]},
        START | {"state": [0.1, 0.0, 0.2, float("nan")]},
        START | {"state": [1e300, 0.0, 0.0, 0.0]},
        START | {"energy": "0.15"},
        START | {"energy": float("inf")},
        START | {"energy": 0.2},
        {"state": [0.0, 0.0, 0.0, 1000.0], "energy": 5e5},
        START | {"state": [0.1, 0.3, 0.2, 0.1]},
    ],
)
def test_other_messages_start_no_orbit(message: Any) -> None:
    assert changes_of(message) == {}
