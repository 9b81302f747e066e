"""What every potential keeps to before anything is compiled for it."""

from __future__ import annotations

import numpy as np
import pytest
import sympy

from engine.potentials.formula_parser import parse_formula, write_formula
from engine.potentials.potential import Potential
from engine.potentials.validation_report import PointKind, review_potential
from tests.contracts.potentials import each_potential

X, Y = sympy.symbols("x y")
PLACES = np.random.default_rng(3).uniform(-1.2, 1.2, (2, 5))


def expression_of(potential: Potential) -> sympy.Expr:
    return sympy.Add(*(sympy.Float(c, 30) * X**i * Y**j for i, j, c in potential.terms))


@each_potential
def test_derivatives_are_those_of_sympy(potential: Potential) -> None:
    value = expression_of(potential)
    found = [*potential.gradient(*PLACES), *potential.hessian(*PLACES)]
    for variables, ours in zip(((X,), (Y,), (X, X), (X, Y), (Y, Y)), found, strict=True):
        theirs = [float(sympy.diff(value, *variables).subs({X: x, Y: y})) for x, y in PLACES.T]
        np.testing.assert_allclose(ours, theirs, rtol=1e-11, atol=1e-11)


@each_potential
def test_the_force_vanishes_at_every_critical_point(potential: Potential) -> None:
    points = potential.critical_points
    slopes = np.array(potential.gradient(*points.T))
    stiffness = np.abs(potential.hessian(*points.T)).max() * potential.length
    np.testing.assert_allclose(slopes, 0.0, atol=1e-12 * stiffness)


@each_potential
def test_every_channel_leads_over_a_saddle(potential: Potential) -> None:
    vxx, vxy, vyy = potential.hessian(*potential.saddles.T)
    assert np.all(vxx * vyy - vxy**2 < 0.0)


@each_potential
def test_downhill_from_a_saddle_one_side_leads_to_the_origin_and_the_other_does_not(potential: Potential) -> None:
    # A plain descent by small strides of a fixed length, which shares nothing with the engine's.
    stride = 0.01 * potential.length
    for channel, saddle in enumerate(potential.saddles, start=1):
        ends = []
        for side in (-3.0, 3.0):
            place = saddle + side * stride * potential.outward_direction(channel)
            for _ in range(400):
                slope = np.array(potential.gradient(*place))
                place = place - stride * slope / np.hypot(*slope)
            ends.append(np.hypot(*place) < 0.05 * potential.length)
        assert ends == [True, False]


@each_potential
def test_the_formula_reads_back_to_the_potential(potential: Potential) -> None:
    assert sorted(parse_formula(write_formula(potential)).terms) == sorted(potential.terms)


@each_potential
def test_the_review_tells_one_well_and_all_channels(potential: Potential) -> None:
    review = review_potential(potential)
    nearest = review.critical_points[0]
    assert (nearest.x, nearest.y, nearest.kind) == (0.0, 0.0, PointKind.MINIMUM)
    assert sorted(point.channel for point in review.critical_points if point.channel) == list(range(1, potential.channels + 1))


@each_potential
def test_declared_symmetries_hold(potential: Potential) -> None:
    review = review_potential(potential)
    x, y = PLACES
    value = potential.value(x, y)
    if review.mirror_in_x:
        np.testing.assert_array_equal(potential.value(-x, y), value)
    if review.mirror_in_y:
        np.testing.assert_array_equal(potential.value(x, -y), value)
    turn = 2.0 * np.pi / review.rotations
    turned = np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y
    np.testing.assert_allclose(potential.value(*turned), value, rtol=1e-12, atol=1e-12)


@each_potential
@pytest.mark.parametrize("parameters", [(1.2, 1.0, 0.8), (1.0, 1.1, 20.0), (0.9, 1.0, 0.05)])
def test_other_parameters_leave_the_well_and_the_lowest_exit(
    potential: Potential, parameters: tuple[float, float, float]
) -> None:
    changed = potential.with_parameters(*parameters)
    assert np.isfinite(changed.escape_energy)
    assert changed.escape_energy > changed.value(0.0, 0.0)
