"""The browser computes the section only where the chart has the axes of a slice, and until the server's chart is complete."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.browser.browser_system import make_browser_system
from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.analysis.live_section import LiveSection
from engine import CASES, Execution, MapSpec, Plane, compute_returns, read_section


@pytest.mark.parametrize(("text", "columns"), [("y = 0.1 down", [0, 2]), ("x = 0", [1, 3]), ("px = 0 both", [0, 1])])
def test_the_chart_of_a_section_with_a_slice_is_computed_in_the_browser(text: str, columns: list[int]) -> None:
    live = LiveSection(ViewState(section=read_section(text)), ShownResults())
    assert live.slice is not None
    assert live.slice["sectionColumns"] == columns


@pytest.mark.parametrize("text", ["angle = 30°", "pericentre about (0.1, 0)", "x + px = 0"])
def test_charts_with_other_axes_are_left_to_the_server(text: str) -> None:
    assert LiveSection(ViewState(section=read_section(text)), ShownResults()).slice is None


def test_the_energy_is_that_of_a_complete_chart() -> None:
    state, results = ViewState(), ShownResults()
    live = LiveSection(state, results)
    assert live.energy is None
    whole = compute_returns(MapSpec(state.potential, Plane.X_PX, 0.15, (3, 3), t_max=10.0), 2, execution=Execution())
    results.studies = {"section": replace(whole, complete=False)}
    assert live.energy is None
    results.studies = {"section": whole}
    assert live.energy == 0.15
    results.studies = {}
    assert live.energy is None


def test_the_window_of_the_slice_is_tabulated_for_the_browser() -> None:
    section = read_section("y = 0.1 down")
    live = LiveSection(ViewState(section=section), ShownResults())
    system = make_browser_system(CASES["III"], 0.3, 0.4, section, execution=Execution())
    (x_low, x_high, *_), *_ = system.windows[live.plane]["windows"]
    expected = MapSpec(CASES["III"], section.slice_of_starts, 0.3).find_window()
    assert (x_low, x_high) == pytest.approx((expected.x_low, expected.x_high), rel=0.02)


def test_the_colours_are_those_of_the_orbits() -> None:
    state = ViewState()
    live = LiveSection(state, ShownResults())
    for name in state.param.palette.objects:
        state.palette = name
        assert live.colours == list(state.colours.orbits)
