"""Rotating systems are symmetric under reflection with time reversal, and under rotation by π.

If Φ is even in y, (x, y, ẋ, ẏ, t) → (x, −y, −ẋ, ẏ, −t) maps orbits to orbits. If Φ is also even in x, so does
(x, y, ẋ, ẏ, t) → (−x, −y, −ẋ, −ẏ, t).
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from engine import MapSpec, Plane, System, classify_orbits, compute_map, sample_starts
from engine.systems.catalogue.rotating_systems import ROTATING_ENTRIES

ENERGIES = {
    "Copenhagen": -1.6,
    "Earth-Moon": -1.095,
    "Hill": -2.0,
    "Star cluster": -1.6,
    "Barred galaxy": -3200.0,
    "Logarithmic bar": -0.485,
    "Two Yukawa centres": -0.4,
    "Four hills": 0.05,
}
# Systems whose kernels take long to compile.
MARKS = {
    "Logarithmic bar": pytest.mark.slow,
    "Barred galaxy": pytest.mark.exhaustive,
    "Two Yukawa centres": pytest.mark.exhaustive,
}
DURATION, STARTS = 10.0, 200
REFLECTED, TURNED = np.array([1.0, -1.0, -1.0, 1.0]), -np.ones(4)
# Images of the fates under a reflection in the x axis, where they change.
REFLECTED_FATES = {"Four hills": np.array([0, 1, 4, 3, 2])}
# Images of the fates 1, 2, 3 under a rotation by π.
TURNED_FATES = np.array([0, 2, 1, 3])


def marked(name: str) -> Any:
    return pytest.param(name, marks=MARKS.get(name, ()))


@pytest.mark.parametrize("name", [marked(entry.name) for entry in ROTATING_ENTRIES])
def test_orbits_backward_are_reflected_orbits_forward(name: str) -> None:
    potential, energy = System(name).potential, ENERGIES[name]
    t_max = DURATION * potential.well.exact_time_unit
    starts = sample_starts(potential, energy, STARTS, rng=5)
    # Backward in time, an orbit is an orbit of the reversed system with the opposite velocity.
    backward = classify_orbits(potential.reversed_in_time, energy, starts * [1.0, 1.0, -1.0, -1.0], t_max)
    forward = classify_orbits(potential, energy, starts * REFLECTED, t_max)
    assert np.count_nonzero(forward.fate) > 0
    images = REFLECTED_FATES.get(name, np.arange(len(potential.outcomes) + 1))
    np.testing.assert_array_equal(backward.fate, images[forward.fate])
    np.testing.assert_allclose(backward.escape_time, forward.escape_time, rtol=1e-6, atol=1e-12)


@pytest.mark.parametrize("name", ["Copenhagen", "Star cluster", marked("Two Yukawa centres")])
def test_orbits_turned_by_half_a_circle_are_orbits(name: str) -> None:
    potential, energy = System(name).potential, ENERGIES[name]
    t_max = DURATION * potential.well.exact_time_unit
    starts = sample_starts(potential, energy, STARTS, rng=6)
    one, other = (classify_orbits(potential, energy, states, t_max) for states in (starts, starts * TURNED))
    np.testing.assert_array_equal(TURNED_FATES[one.fate], other.fate)
    np.testing.assert_allclose(one.escape_time, other.escape_time, rtol=1e-6, atol=1e-12)


# On (x, px), y = 0, py > 0, the reflected start of (x, px) is (x, −px).
@pytest.mark.parametrize("name", ["Copenhagen"])
def test_a_map_backward_is_the_reflected_map_forward(name: str) -> None:
    potential, energy = System(name).potential, ENERGIES[name]
    t_max = DURATION * potential.well.exact_time_unit
    spec = MapSpec(potential, Plane.X_PX, energy, (40, 40), t_max=t_max)
    forward = compute_map(spec)
    backward = compute_map(MapSpec(potential, Plane.X_PX, energy, (40, 40), spec.find_window(), t_max=t_max, backward=True))
    np.testing.assert_array_equal(backward.fate, forward.fate[::-1])
