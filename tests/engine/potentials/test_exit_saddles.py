"""Saddles that lead out of the well at the origin, and the maxima beside them."""

from __future__ import annotations

import numpy as np

from engine.potentials.exit_saddles import find_maxima_beside, leads_out_of_well
from engine.potentials.formula_parser import parse_formula
from engine.potentials.potential import Potential

# A ring-shaped valley around a hill, lowest at the origin; its highest point is a saddle with the origin below on both sides.
RING = parse_formula("((x − 1.1)² + y² − 1)² + 0.924x")
# Wells at x = 0, 2 and 4.
ROW = parse_formula("(x(x − 2)(x − 4))²/10 + y²")


def exits(potential: Potential) -> np.ndarray:
    """(n, 2) the saddles that lead out."""
    points = potential.critical_points
    return points[leads_out_of_well(potential.gradient, potential.hessian, points)]


def test_a_saddle_with_the_origin_below_on_both_sides_is_no_exit() -> None:
    assert exits(RING).size == 0


def test_a_saddle_between_two_other_wells_is_no_exit() -> None:
    np.testing.assert_allclose(exits(ROW), [[2.0 - 2.0 / np.sqrt(3.0), 0.0]], atol=1e-12)


def test_the_hill_lies_beside_the_saddle_behind_it() -> None:
    points = RING.critical_points
    hill, saddle = np.argsort(points[:, 0])[1:]
    beside = find_maxima_beside(RING.gradient, RING.hessian, points, np.array([saddle]))
    assert np.flatnonzero(beside).tolist() == [hill]
