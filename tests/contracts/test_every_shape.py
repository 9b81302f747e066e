"""Properties of every potential that need no compiled kernels."""

from __future__ import annotations

import numpy as np
import pytest

from engine.systems.potential import Potential
from engine.systems.review.potential_review import PointKind, review_potential
from tests.contracts.potentials import each_potential

PLACES = np.random.default_rng(3).uniform(-1.2, 1.2, (2, 5))


@each_potential
def test_descent_from_a_saddle_reaches_the_origin_on_one_side_only(potential: Potential) -> None:
    # Gradient descent with a fixed step length, independent of the implementation in the engine.
    stride = 0.01 * potential.units.length
    for channel, saddle in enumerate(potential.saddles, start=1):
        ends = []
        for side in (-3.0, 3.0):
            place = saddle + side * stride * potential.well.outward_directions[channel - 1]
            for _ in range(400):
                slope = np.array(potential.gradient(*place))
                place = place - stride * slope / np.hypot(*slope)
            ends.append(np.hypot(*place) < 0.05 * potential.units.length)
        assert ends == [True, False]


@each_potential
def test_review_has_the_well_and_all_channels(potential: Potential) -> None:
    review = review_potential(potential)
    nearest = review.critical_points[0]
    assert (nearest.x, nearest.y, nearest.kind) == (0.0, 0.0, PointKind.MINIMUM)
    assert sorted(point.channel for point in review.critical_points if point.channel) == list(range(1, potential.channels + 1))


@each_potential
def test_reported_symmetries_hold(potential: Potential) -> None:
    review = review_potential(potential)
    x, y = PLACES
    value = potential.value(x, y)
    if review.mirror_in_x:
        np.testing.assert_array_equal(potential.value(-x, y), value)
    if review.mirror_in_y:
        np.testing.assert_array_equal(potential.value(x, -y), value)
    angle = 2.0 * np.pi / review.rotations
    rotated = np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y
    np.testing.assert_allclose(potential.value(*rotated), value, rtol=1e-12, atol=1e-12)


@each_potential
@pytest.mark.parametrize("parameters", [(1.2, 1.0, 0.8), (0.9, 1.0, 0.05)])
def test_escape_energy_stays_finite_for_other_parameters(potential: Potential, parameters: tuple[float, float, float]) -> None:
    changed = potential.with_parameters(*parameters)
    assert np.isfinite(changed.escape_energy)
    assert changed.escape_energy > changed.value(0.0, 0.0)
