"""Lyapunov orbits are mirror images of each other if the potential is symmetric, and so are the fates of orbits."""

from __future__ import annotations

import numpy as np
import pytest

from engine import LyapunovOrbit, Potential, classify_orbits, find_lyapunov_orbits, parse_formula
from engine.exits.lyapunov_orbits import UndefinedExitsError
from engine.systems.landscape.mirror_images import Signs, find_images
from tests.peers.symmetric_wells import VALLEYS, exchanged, random_symmetric_well

# Energies as multiples of the depth of the well.
FACTORS = (1.02, 1.6, 4.0, 12.0, 45.0)


def image_of(orbits: dict[int, LyapunovOrbit], orbit: LyapunovOrbit, signs: Signs) -> LyapunovOrbit:
    """Return the orbit across the mirror image of the channel of an orbit."""
    potential = orbit.potential
    image = 1 + int(find_images(potential.saddles, signs)[orbit.channel - 1])
    return orbits[int(potential.well.exit_numbers(orbit.energy)[image])]


def assert_symmetric(orbits: tuple[LyapunovOrbit, ...]) -> None:
    by_channel = {orbit.channel: orbit for orbit in orbits}
    for orbit in orbits:
        size = orbit.potential.units.length
        for signs in orbit.potential.well.mirrors:
            image = image_of(by_channel, orbit, signs)
            assert image.period == pytest.approx(orbit.period, rel=1e-9)
            expected = orbit.half_path * signs
            errors = [np.abs(path - image.half_path).max() for path in (expected, expected[::-1])]
            assert min(errors) <= 2e-9 * size


def assert_mirrored_fates(potential: Potential, energy: float, t_max: float) -> None:
    """Follow starts in the middle of the well, and their mirror images, up to t_max in units of the well."""
    x, y, angle = np.random.default_rng(5).uniform([-0.7, -0.7, 0.0], [0.7, 0.7, 2.0 * np.pi], (80, 3)).T
    x, y = x * potential.units.length, y * potential.units.length
    with np.errstate(invalid="ignore"):
        speed = np.sqrt(2.0 * (energy - potential.value(x, y)))
    starts = np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])
    starts = starts[np.isfinite(starts).all(axis=1)]
    fates = classify_orbits(potential, energy, starts, t_max * potential.units.time)
    for signs in potential.well.mirrors:
        images = classify_orbits(potential, energy, starts * [*signs, *signs], t_max * potential.units.time)
        channels = np.append(0, 1 + find_images(potential.saddles, signs))
        expected = np.where(fates.fate > 0, potential.well.exit_numbers(energy)[channels[np.maximum(fates.fate, 0)]], fates.fate)
        np.testing.assert_array_equal(images.fate, expected)
        np.testing.assert_allclose(images.escape_time, fates.escape_time, rtol=1e-6)


@pytest.mark.parametrize("seed", [0, 2, 3, 4, 7, 8, 11, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (5, 13))])
def test_exits_of_symmetric_wells_are_mirror_images_at_all_energies(seed: int) -> None:
    potential = random_symmetric_well(seed)
    found = 0
    for factor in FACTORS:
        try:
            orbits = find_lyapunov_orbits(potential, potential.well.energy_at(factor))
        except UndefinedExitsError:
            continue
        found += 1
        assert_symmetric(orbits)
    assert found >= 2


@pytest.mark.parametrize("seed", [0, 5, 8])
def test_mirrored_starts_in_symmetric_wells_have_mirrored_fates(seed: int) -> None:
    potential = random_symmetric_well(seed)
    assert_mirrored_fates(potential, potential.well.energy_at(1.6), t_max=8.0)


@pytest.mark.parametrize("formula", [VALLEYS, exchanged(VALLEYS)], ids=["even in y", "even in x"])
def test_exits_of_a_well_with_long_valleys_are_mirror_images(formula: str) -> None:
    potential = parse_formula(formula)
    orbits = find_lyapunov_orbits(potential, 14.0)
    assert len(orbits) == 8
    assert_symmetric(orbits)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("energy", "exits"), [(3.0, 2), (6.0, 4), (18.0, 10), (22.0, 10), (27.0, 12), (31.5, 14), (36.0, 14), (41.0, 16)]
)
def test_exits_far_from_a_well_are_mirror_images_and_so_are_fates(energy: float, exits: int) -> None:
    potential = parse_formula(VALLEYS)
    orbits = find_lyapunov_orbits(potential, energy)
    assert len(orbits) == exits
    assert_symmetric(orbits)
    assert_mirrored_fates(potential, energy, t_max=6.0)


@pytest.mark.slow
def test_a_start_beside_a_ridge_leaves_through_the_mirror_image_of_the_exit_of_its_image() -> None:
    potential, energy = parse_formula(VALLEYS), 36.0
    start = np.array([8.430145972, 0.198764901, -6.614175605, -0.888848863])
    outcomes = classify_orbits(potential, energy, np.array([start, start * [1.0, -1.0, 1.0, -1.0]]), 6.0)
    one, other = potential.saddles[outcomes.fate - 1]
    np.testing.assert_array_equal(one * [1.0, -1.0], other)
    np.testing.assert_allclose(*outcomes.escape_time, rtol=1e-9)
