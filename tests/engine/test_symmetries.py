"""Orbits and maps have the symmetries of their potentials."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, MapSpec, Plane, classify_orbits, compute_map, start_states


def swapped(fate: np.ndarray, pairs: dict[int, int]) -> np.ndarray:
    out = fate.copy()
    for one, other in pairs.items():
        out[fate == one], out[fate == other] = other, one
    return out


def starts(plane: Plane, energy: float) -> np.ndarray:
    x, ordinate = np.random.default_rng(6).uniform(-0.5, 0.5, (2, 3000))
    states = start_states(CASES["III"], plane, energy, x, ordinate)
    return states[np.isfinite(states).all(axis=1)]


# V has only even powers: sign changes are exact in floating point, and the exits are exact images of each other.
def test_mirror_images_of_case_3_have_bit_identical_outcomes() -> None:
    plane, energy = Plane.X_Y, 0.5
    states = starts(plane, energy)
    one = classify_orbits(CASES["III"], energy, states, 100.0)
    other = classify_orbits(CASES["III"], energy, states * [-1.0, 1.0, -1.0, 1.0], 100.0)
    np.testing.assert_array_equal(one.fate, swapped(other.fate, {1: 2, 3: 4}))
    np.testing.assert_array_equal(one.escape_time, other.escape_time)
    np.testing.assert_array_equal(one.crossings, other.crossings)


@pytest.mark.parametrize("resolution", [(60, 60), (61, 61), (60, 61)])
@pytest.mark.parametrize("plane", Plane)
def test_mirrored_half_of_a_map_agrees_with_single_orbits(plane: Plane, resolution: tuple[int, int]) -> None:
    energy = (0.5, 1.0) if plane is Plane.X_H else 0.5
    result = compute_map(MapSpec(CASES["III"], plane, energy, resolution, None, t_max=100.0))
    row = int(np.argmax(np.sum(result.fate >= 1, axis=1)))
    x, ordinate = result.x, np.full(result.x.size, result.ordinate[row])
    h = float(result.ordinate[row]) if plane is Plane.X_H else 0.5
    states = start_states(CASES["III"], plane, h, x, ordinate)
    escaped = (result.fate[row] >= 1) & np.isfinite(states).all(axis=1)
    outcome = classify_orbits(CASES["III"], h, states[escaped], 100.0)
    assert escaped.sum() > 10
    np.testing.assert_array_equal(outcome.fate, result.fate[row][escaped])
    np.testing.assert_array_equal(outcome.escape_time, result.escape_time[row][escaped])
    np.testing.assert_array_equal(outcome.crossings, result.crossings[row][escaped])


def outcomes_of(name: str, energy: float, states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    outcome = classify_orbits(CASES[name], energy, states, 60.0)
    return outcome.fate.astype(int), outcome.escape_time


@pytest.fixture(params=[("I", 0.2), ("II", 0.5), ("III", 0.5)], ids=str)
def random_starts(request: pytest.FixtureRequest) -> tuple[str, float, np.ndarray]:
    """Return case, energy, and random starts in the interior with random directions."""
    name, energy = request.param
    x, y, angle = np.random.default_rng(8).uniform([-0.4, -0.4, 0], [0.4, 0.4, 2 * np.pi], (200, 3)).T
    speed = np.sqrt(2 * (energy - CASES[name].value(x, y)))
    return name, energy, np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])


def assert_same_outcomes(name: str, energy: float, states: np.ndarray, images: np.ndarray, image_of: dict[int, int]) -> None:
    fate, time = outcomes_of(name, energy, states)
    image_fate, image_time = outcomes_of(name, energy, images)
    # Rounding errors differ between the images, so only early escapes have equal outcomes.
    early = (fate >= 1) & (time < 30)
    assert early.mean() > 0.3
    np.testing.assert_array_equal(image_fate[early], [image_of[k] for k in fate[early]])
    np.testing.assert_allclose(image_time[early], time[early], rtol=1e-6)


def test_mirror_images_in_the_x_axis_have_mirrored_outcomes(random_starts: tuple[str, float, np.ndarray]) -> None:
    name, energy, states = random_starts
    image_of = {"I": {1: 2, 2: 1}, "II": {1: 1, 2: 3, 3: 2}, "III": {1: 4, 2: 3, 3: 2, 4: 1}}[name]
    assert_same_outcomes(name, energy, states, states * [1, -1, 1, -1], image_of)


def test_rotating_case_2_by_120_degrees_rotates_the_outcomes() -> None:
    energy = 0.5
    x, y, angle = np.random.default_rng(9).uniform([-0.3, -0.3, 0], [0.3, 0.3, 2 * np.pi], (200, 3)).T
    speed = np.sqrt(2 * (energy - CASES["II"].value(x, y)))
    states = np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])
    cos, sin = np.cos(2 * np.pi / 3), np.sin(2 * np.pi / 3)
    rotation = np.kron(np.eye(2), np.array([[cos, -sin], [sin, cos]]))
    assert_same_outcomes("II", energy, states, states @ rotation.T, {1: 2, 2: 3, 3: 1})
