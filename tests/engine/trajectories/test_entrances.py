"""Orbits that enter through the exits are distributed as the flux, and stay inside for volume over flux on average."""

from __future__ import annotations

import math

import numpy as np
import pytest

from engine import (
    CASES,
    POTENTIALS,
    Fate,
    Potential,
    classify_orbits,
    compute_flux,
    find_lyapunov_orbits,
    sample_entrances,
    sample_starts,
)
from engine.exits.interior import find_outside_channels

COUNT = 4000
# Standard errors by which a mean or a share may be off: the probability of a false alarm is 6e-7 for each.
LARGEST_DEVIATION = 5.0
# A well without islands, so that orbits pass all of the volume.
OPEN = [(CASES["III"], 0.6), (POTENTIALS["HH"], 0.3)]
UNEQUAL = Potential("unequal", ((2, 0, 0.5), (0, 2, 0.6), (1, 2, -1.0), (3, 0, 0.3)))


def times_inside(potential: Potential, energy: float, states: np.ndarray, t_max: float) -> np.ndarray:
    """Return the times until orbits leave, of shape (n,), or t_max for orbits that stay."""
    return np.fmin(classify_orbits(potential, energy, states, t_max).escape_time, t_max)


@pytest.mark.parametrize(("potential", "energy"), OPEN)
def test_the_mean_time_inside_is_volume_over_flux(potential: Potential, energy: float) -> None:
    times = times_inside(potential, energy, sample_entrances(potential, energy, COUNT, rng=3), 1e4)
    error = float(times.std()) / math.sqrt(COUNT)
    assert float(times.mean()) == pytest.approx(compute_flux(potential, energy).mean_passage_time, abs=LARGEST_DEVIATION * error)


def test_orbits_that_enter_pass_the_volume_that_drains() -> None:
    """The mean time of entering orbits inside, until t_max, is volume over flux times the share of all starts that leave by then.

    Some orbits are still inside at t_max, and islands take much of the volume.
    """
    potential, energy, t_max = CASES["III"], 0.3, 1000.0
    starts, entrances = (draw(potential, energy, 5 * COUNT, rng=1) for draw in (sample_starts, sample_entrances))
    times = times_inside(potential, energy, entrances, t_max)
    leave = classify_orbits(potential, energy, starts, t_max).fate > Fate.BOUNDED
    whole = compute_flux(potential, energy).mean_passage_time
    error = math.hypot(float(times.std()), whole * float(leave.std())) / math.sqrt(5 * COUNT)
    assert (times == t_max).any()
    assert float(times.mean()) == pytest.approx(whole * float(leave.mean()), abs=LARGEST_DEVIATION * error)


@pytest.mark.parametrize(("potential", "energy"), [*OPEN, (UNEQUAL, 1.2 * UNEQUAL.escape_energy)])
def test_entrances_are_inside_and_go_inward(potential: Potential, energy: float) -> None:
    states = sample_entrances(potential, energy, 500, rng=2)
    np.testing.assert_allclose(potential.energy(states), energy, rtol=0, atol=1e-14)
    for duration, outside in ((1e-4, False), (-1e-4, True)):
        x, y = (states[:, :2] + duration * states[:, 2:]).T.copy()
        beyond = find_outside_channels(potential, energy, x, y) > 0
        # Orbits that move almost along the exit are still on it, so not all are beyond.
        assert (beyond == outside).mean() > 0.9


def test_each_exit_has_its_share_of_the_flux() -> None:
    energy = 1.2 * UNEQUAL.escape_energy
    flux = compute_flux(UNEQUAL, energy)
    states = sample_entrances(UNEQUAL, energy, 20_000, rng=4)
    middles = [orbit.half_path[50] for orbit in find_lyapunov_orbits(UNEQUAL, energy)]
    nearest = np.argmin([np.hypot(*(states[:, :2] - middle).T) for middle in middles], axis=0)
    counts = np.bincount(nearest, minlength=flux.shares.size)
    np.testing.assert_allclose(counts / counts.sum(), flux.shares, atol=LARGEST_DEVIATION * 0.5 / math.sqrt(20_000))
