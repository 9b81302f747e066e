"""What the symmetry of each potential demands of whole maps."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, EscapeMap, Fate, MapSpec, Plane, classify_orbits, compute_map

BOX = (-1.1, 1.1, -1.1, 1.1)


def turned_by_half(a: np.ndarray) -> np.ndarray:
    return a[::-1, ::-1]


def swapped(fate: np.ndarray, pairs: dict[int, int]) -> np.ndarray:
    out = fate.copy()
    for one, other in pairs.items():
        out[fate == one], out[fate == other] = other, one
    return out


# Even powers only: a change of both signs leaves every product unchanged in floating point, so the maps agree exactly.
@pytest.mark.parametrize("resolution", [(60, 60), (61, 61), (60, 61), (225, 224)])
@pytest.mark.parametrize("energy", [0.3, 0.5])
def test_case_3_on_x_px_maps_onto_itself_with_channels_swapped(resolution: tuple[int, int], energy: float) -> None:
    result = compute_map(MapSpec(CASES["III"], Plane.X_PX, energy, resolution, BOX, t_max=100.0))
    np.testing.assert_array_equal(result.fate, swapped(turned_by_half(result.fate), {1: 2, 3: 4}))


@pytest.mark.parametrize("resolution", [(60, 60), (61, 61)])
def test_case_3_on_x_px_keeps_crossings_and_all_but_the_last_digits_of_times(resolution: tuple[int, int]) -> None:
    result = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.5, resolution, BOX, t_max=100.0))
    np.testing.assert_array_equal(result.crossings, turned_by_half(result.crossings))
    # The exits are found one by one, so their curves are mirror images up to rounding.
    np.testing.assert_allclose(result.escape_time, turned_by_half(result.escape_time), rtol=1e-9)


@pytest.mark.parametrize("energy", [0.3, 0.8])
def test_case_3_on_x_y_is_its_own_mirror_image_with_channels_swapped(energy: float) -> None:
    result = compute_map(MapSpec(CASES["III"], Plane.X_Y, energy, (61, 60), BOX, t_max=100.0))
    np.testing.assert_array_equal(result.fate, swapped(result.fate[:, ::-1], {1: 2, 3: 4}))


def outcomes_of(name: str, energy: float, states: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    outcome = classify_orbits(CASES[name], energy, states, 60.0)
    return outcome.fate.astype(int), outcome.escape_time


@pytest.fixture(params=[("I", 0.2), ("I", 0.5), ("II", 0.22), ("II", 0.5), ("III", 0.5)], ids=str)
def any_direction(request: pytest.FixtureRequest) -> tuple[str, float, np.ndarray]:
    """Starts anywhere inside, in any direction."""
    name, energy = request.param
    x, y, angle = np.random.default_rng(8).uniform([-0.4, -0.4, 0], [0.4, 0.4, 2 * np.pi], (200, 3)).T
    speed = np.sqrt(2 * (energy - CASES[name].value(x, y)))
    return name, energy, np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])


def assert_images_fare_alike(name: str, energy: float, states: np.ndarray, images: np.ndarray, image_of: dict[int, int]) -> None:
    fate, time = outcomes_of(name, energy, states)
    image_fate, image_time = outcomes_of(name, energy, images)
    # Rounding differs between the images: an orbit that wanders may end elsewhere, one that leaves soon may not.
    soon = (fate >= 1) & (time < 30)
    assert soon.mean() > 0.3
    np.testing.assert_array_equal(image_fate[soon], [image_of[k] for k in fate[soon]])
    np.testing.assert_allclose(image_time[soon], time[soon], rtol=1e-6)


def test_mirrored_in_the_x_axis(any_direction: tuple[str, float, np.ndarray]) -> None:
    name, energy, states = any_direction
    image_of = {"I": {1: 2, 2: 1}, "II": {1: 1, 2: 3, 3: 2}, "III": {1: 4, 2: 3, 3: 2, 4: 1}}[name]
    assert_images_fare_alike(name, energy, states, states * [1, -1, 1, -1], image_of)


@pytest.mark.parametrize("energy", [0.22, 0.5])
def test_case_2_turned_by_a_third(energy: float) -> None:
    x, y, angle = np.random.default_rng(9).uniform([-0.3, -0.3, 0], [0.3, 0.3, 2 * np.pi], (200, 3)).T
    speed = np.sqrt(2 * (energy - CASES["II"].value(x, y)))
    states = np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])
    cos, sin = np.cos(2 * np.pi / 3), np.sin(2 * np.pi / 3)
    turn = np.kron(np.eye(2), np.array([[cos, -sin], [sin, cos]]))
    assert_images_fare_alike("II", energy, states, states @ turn.T, {1: 2, 2: 3, 3: 1})


def test_fate_codes_below_one_have_no_mirror_image() -> None:
    codes = np.array([int(fate) for fate in Fate])
    np.testing.assert_array_equal(swapped(codes, {1: 2}), codes)


def test_case_3_shares_come_in_pairs() -> None:
    def shares(result: EscapeMap) -> dict[int, float]:
        return result.fractions()

    share = shares(compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.4, (101, 101), t_max=500.0)))
    assert (share[1], share[3]) == (share[2], share[4])
