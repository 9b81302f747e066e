"""An indicator of chaos whose value is NaN or infinite decides nothing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, integrate_orbit
from engine.trajectories.chaos_indicators import Verdict, evaluate_indicators


@pytest.mark.parametrize("value", [np.nan, np.inf])
@pytest.mark.parametrize(("field", "name"), [("sali", "SALI"), ("lyapunov_exponent", "Lyapunov exponent")])
def test_a_value_that_is_not_finite_leaves_a_bounded_orbit_undecided(field: str, name: str, value: float) -> None:
    orbit = integrate_orbit(CASES["II"], (0.1, 0.0, 0.0, 0.3), 1000.0)
    unknown = replace(orbit, **{field: np.full(orbit.t.size, value)})
    (found,) = (each for each in evaluate_indicators(unknown) if each.name == name)
    assert found.conclusion is Verdict.UNDECIDED
    assert "not known" in found.sentence
