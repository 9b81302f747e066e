"""Orbits of given starts are classified, whatever their energies, and also if there is no such orbit."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, POTENTIALS, Fate, Plane, Potential, classify_orbits, sample_orbits, sample_starts, start_states

ENERGIES = (0.3, 0.36, 0.45)


def starts_of(potential: Potential, energies: tuple[float, ...]) -> list[np.ndarray]:
    return [sample_starts(potential, energy, 40, rng=1) for energy in energies]


@pytest.mark.parametrize("name", ["III", "Hill"])
def test_starts_of_several_energies_have_the_outcomes_of_each_energy(name: str) -> None:
    potential = POTENTIALS[name]
    energies = tuple(potential.escape_energy * factor for factor in (0.99, 0.9)) if name == "Hill" else ENERGIES
    parts = starts_of(potential, energies)
    together = classify_orbits(potential, None, np.concatenate(parts), t_max=100.0)
    assert (together.fate > 0).any()
    for number, (energy, states) in enumerate(zip(energies, parts, strict=True)):
        alone = classify_orbits(potential, energy, states, t_max=100.0)
        rows = slice(40 * number, 40 * (number + 1))
        np.testing.assert_array_equal(together.fate[rows], alone.fate)
        np.testing.assert_allclose(together.escape_time[rows], alone.escape_time, rtol=1e-6)


def test_each_start_has_the_exits_of_its_own_energy() -> None:
    states = np.concatenate(starts_of(CASES["III"], ENERGIES))
    outcomes = classify_orbits(CASES["III"], None, states, t_max=50.0)
    sampled = sample_orbits(CASES["III"], states, [0.0, 50.0])
    np.testing.assert_array_equal(outcomes.fate, sampled.fate)
    np.testing.assert_allclose(outcomes.escape_time, sampled.escape_time, rtol=1e-6)


@pytest.mark.parametrize("energy", [None, 0.45])
def test_starts_without_an_orbit_are_forbidden(energy: float | None) -> None:
    states = start_states(CASES["III"], Plane.X_PX, 0.45, [0.0, 0.9, 0.1], [0.3, 0.5, 0.0])
    assert np.isnan(states[1]).any()
    outcomes = classify_orbits(CASES["III"], energy, states, t_max=200.0)
    assert outcomes.fate[1] == Fate.FORBIDDEN
    assert np.isnan(outcomes.escape_time[1])
    np.testing.assert_array_equal(outcomes.fate[::2], classify_orbits(CASES["III"], 0.45, states[::2], t_max=200.0).fate)


def test_only_forbidden_starts_need_no_exits() -> None:
    states = np.array([[0.9, 0.0, 0.5, np.nan]])
    assert classify_orbits(CASES["III"], None, states).fate.tolist() == [Fate.FORBIDDEN]


def test_a_place_that_is_not_a_number_is_refused() -> None:
    with pytest.raises(ValueError, match=r"^states: row 0 has a number that is not finite"):
        classify_orbits(CASES["III"], None, [[np.nan, 0.0, 0.1, 0.1]])
