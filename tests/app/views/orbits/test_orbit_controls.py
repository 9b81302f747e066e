"""The chosen orbit has a table of its chaos indicators."""

from __future__ import annotations

from dataclasses import fields

from app.state.view_state import ViewState
from app.views.orbits.orbit_controls import OrbitActions, OrbitControls
from engine import Coordinate, ParameterAxis, Slice
from engine.trajectories.chaos_indicators import IndicatorVerdict, Verdict


def test_indicators_with_the_same_verdict_share_its_sentence() -> None:
    controls = OrbitControls(ViewState(), OrbitActions(**{field.name: lambda *_: None for field in fields(OrbitActions)}))
    too_short = [IndicatorVerdict(name, 1.0, None, "The orbit is too short.") for name in ("SALI", "digits")]
    controls.show_indicators([IndicatorVerdict("exponent", 0.5, Verdict.CHAOTIC, "The exponent is positive."), *too_short])
    table = controls.indicators.object
    assert table.count("The orbit is too short.") == 1
    assert "no verdict" not in table
    assert table.count("<tr>") == table.count("</tr>") == 3
    assert table.index("<td rowspan=2>") < table.index("SALI") < table.index("digits")


def test_the_nearest_periodic_orbit_is_offered_where_the_starts_have_one_potential() -> None:
    state = ViewState()
    controls = OrbitControls(state, OrbitActions(**{field.name: lambda *_: None for field in fields(OrbitActions)}))
    assert controls.periodic_orbit.visible
    state.plane = Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, state.system))
    assert not controls.periodic_orbit.visible
