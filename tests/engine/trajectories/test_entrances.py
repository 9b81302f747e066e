"""Orbits that enter through the exits: distributed as the flux, and inside for the mean time that volume and flux imply."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import CASES, POTENTIALS, Fate, Potential, classify_orbits, compute_flux, find_lyapunov_orbits, sample_entrances
from engine.exits.interior import find_outside_channels

COUNT = 4000
# Without islands, so that all of the volume is passed.
OPEN = [(CASES["I"], 0.4), (CASES["II"], 0.4), (CASES["III"], 0.6), (POTENTIALS["HH"], 0.3)]
UNEQUAL = Potential("unequal", ((2, 0, 0.5), (0, 2, 0.6), (1, 2, -1.0), (3, 0, 0.3)))


@pytest.mark.parametrize(("potential", "energy"), OPEN)
def test_the_mean_time_inside_is_volume_over_flux(potential: Potential, energy: float) -> None:
    times = classify_orbits(potential, energy, sample_entrances(potential, energy, COUNT, seed=3), 1e4).escape_time
    error = float(times.std()) / math.sqrt(COUNT)
    assert float(times.mean()) == pytest.approx(compute_flux(potential, energy).mean_passage_time, abs=4.0 * error)


def test_orbits_that_enter_do_not_pass_the_volume_of_islands() -> None:
    potential, energy = CASES["III"], 0.3
    outcomes = classify_orbits(potential, energy, sample_entrances(potential, energy, COUNT, seed=1), 1e5)
    assert (outcomes.fate != Fate.BOUNDED).all()
    assert outcomes.escape_time.mean() < 0.6 * compute_flux(potential, energy).mean_passage_time


@pytest.mark.parametrize(("potential", "energy"), [*OPEN, (UNEQUAL, 1.2 * UNEQUAL.escape_energy)])
def test_entrances_are_inside_and_go_inward(potential: Potential, energy: float) -> None:
    states = sample_entrances(potential, energy, 500, seed=2)
    np.testing.assert_allclose(potential.energy(states), energy, rtol=0, atol=1e-14)
    for duration, outside in ((1e-4, False), (-1e-4, True)):
        x, y = (states[:, :2] + duration * states[:, 2:]).T.copy()
        beyond = find_outside_channels(potential, energy, x, y) > 0
        # Those that move almost along the exit have hardly left it.
        assert (beyond == outside).mean() > 0.9


def test_each_exit_has_its_share_of_the_flux() -> None:
    energy = 1.2 * UNEQUAL.escape_energy
    flux = compute_flux(UNEQUAL, energy)
    states = sample_entrances(UNEQUAL, energy, 20_000, seed=4)
    middles = [orbit.half_path[50] for orbit in find_lyapunov_orbits(UNEQUAL, energy)]
    nearest = np.argmin([np.hypot(*(states[:, :2] - middle).T) for middle in middles], axis=0)
    counts = np.bincount(nearest, minlength=flux.shares.size)
    np.testing.assert_allclose(counts / counts.sum(), flux.shares, atol=4.0 * 0.5 / math.sqrt(20_000))


def test_equal_seeds_give_equal_states() -> None:
    first, again, other = (sample_entrances(CASES["I"], 0.2, 50, seed=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert (first != other).any()


def test_closed_exits_are_named() -> None:
    with pytest.raises(ValueError, match=r"energy=0.1: all exits are closed; must be above the escape energy 0.125"):
        sample_entrances(CASES["I"], 0.1, 10)
