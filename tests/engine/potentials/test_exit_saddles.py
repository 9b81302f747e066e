from __future__ import annotations

import numpy as np
import pytest

from engine.potentials import exit_saddles
from engine.potentials.formula_parser import parse_formula
from engine.potentials.validation_report import review_potential

# One saddle is at (-0.007, 1897), in a valley whose curvature is 10^11 times the one along it.
NARROW_VALLEY = "x^2/2 + y^2/2 - x^3/3 + 0.047*x*y^3 - 0.012*x^6 - 0.183*x^3*y^4 + 0.082*x^4*y - 0.084*x^2*y^2 + 0.184*x*y^2"


def test_a_saddle_at_the_end_of_a_long_narrow_valley_is_an_exit() -> None:
    potential = parse_formula(NARROW_VALLEY)
    valley = potential.saddles[np.argmax(potential.saddles[:, 1])]
    assert valley[1] == pytest.approx(1896.55543)
    # Along the bottom of the valley, where V_x = 0, V rises from the well to the saddle.
    y = np.linspace(1.0, valley[1], 1000)
    x = np.zeros_like(y)
    for _ in range(50):
        x -= potential.gradient(x, y)[0] / potential.hessian(x, y)[0]
    assert (np.diff(potential.value(x, y)) > 0.0).all()


def test_a_saddle_between_two_other_wells_is_no_exit() -> None:
    # Along y = 0 minima at x = 0, 2 and 4, saddles at x = 1 and 3.
    potential = parse_formula("y²/2 + 12x² − 50x³/3 + 35x⁴/4 − 2x⁵ + x⁶/6")
    leads_out = exit_saddles.leads_out_of_well(potential.slopes, potential.hessian, potential.critical_points)
    np.testing.assert_allclose(potential.critical_points[leads_out], [[1.0, 0.0]])


def test_descents_that_take_too_many_steps_are_a_refusal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exit_saddles, "_MOST_STEPS", 100)
    refusal = review_potential(parse_formula("x²/2 + y²/2 − 0.9876xy²")).refusal
    assert refusal is not None
    assert "steepest descent" in refusal
