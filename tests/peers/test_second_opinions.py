"""Fates, escape times and crossings of random orbits compared with two independent integrators.

An orbit is robust if the channel and the crossings computed by the other integrator do not change after a shift of the start by
1e-11 and, for DOP853, with a coarser tolerance. It is steady if its escape time also changes by less than 1e-7. Other orbits are
too chaotic to be compared.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from types import ModuleType

import numpy as np
import pytest

from engine import CASES, Fate, Outcomes, Plane, classify_orbits, default_window, start_states
from tests.peers import dop853, taylor_heyoka
from tests.peers.dop853 import PeerOutcomes
from tests.peers.exit_lines import exit_lines

T_MAX = 60.0
STARTS = 20
SHIFT = np.array([1e-11, 0.0, 0.0, 0.0])
ENERGIES = {"I": (0.13, 0.2, 0.5), "II": (0.17, 0.22, 0.5), "III": (0.26, 0.35, 0.6, 1.0)}
SETS = [(name, energy) for name in CASES for energy in ENERGIES[name]]
PLANES = (Plane.X_Y, Plane.X_PX)
COARSER = {dop853: 1e-11}


@dataclass(frozen=True)
class Comparison:
    """Outcomes by the engine and by another integrator for the same starts, and which of them are robust and steady."""

    engine: Outcomes
    peer: PeerOutcomes
    robust: np.ndarray
    steady: np.ndarray


@cache
def starts_of(name: str, energy: float) -> np.ndarray:
    """Random interior starts on both planes, selected with the independent description of the exits in `exit_lines`."""
    return np.concatenate([_interior_starts(name, energy, plane) for plane in PLANES])


def _interior_starts(name: str, energy: float, plane: Plane) -> np.ndarray:
    potential, rng = CASES[name], np.random.default_rng(int(1000 * energy))
    window = default_window(potential, plane, energy)
    x = rng.uniform(window.x_low, window.x_high, 400)
    ordinate = rng.uniform(window.ordinate_low, window.ordinate_high, 400)
    states = start_states(potential, plane, energy, x, ordinate)
    states = states[np.isfinite(states).all(axis=1)]
    past = [line.past(states[:, 0], states[:, 1]) > 0 for line in exit_lines(potential, energy)]
    return states[~np.any(past, axis=0)][:STARTS]


@cache
def comparison(peer: ModuleType, name: str, energy: float) -> Comparison:
    potential, states, lines = CASES[name], starts_of(name, energy), exit_lines(CASES[name], energy)
    # Together, as DOP853 integrates all orbits as one system.
    both = peer.classify(potential, lines, np.concatenate([states, states + SHIFT]), T_MAX)
    reference, shifted = (
        PeerOutcomes(both.fate[half], both.escape_time[half], both.crossings[half])
        for half in (slice(None, len(states)), slice(len(states), None))
    )
    coarser = [peer.classify(potential, lines, states, T_MAX, COARSER[peer])] if peer in COARSER else []
    robust, steady_time = np.ones((2, len(states)), bool)
    for other in (shifted, *coarser):
        moved = np.abs(other.escape_time - reference.escape_time)
        robust &= (other.fate == reference.fate) & (other.crossings == reference.crossings)
        steady_time &= (reference.fate == 0) | (moved < 1e-7)
    return Comparison(classify_orbits(potential, energy, states, T_MAX), reference, robust, robust & steady_time)


PEERS = {"dop853": dop853, "heyoka": taylor_heyoka}
# DOP853, whose comparisons take longest, at one energy of each case; the other energies in exhaustive runs.
SHORT = {"dop853": (("I", 0.2), ("II", 0.22), ("III", 0.35)), "heyoka": tuple(SETS)}

each_set = pytest.mark.parametrize(("name", "energy"), SETS)
each_comparison = pytest.mark.parametrize(
    ("peer", "name", "energy"),
    [
        pytest.param(
            PEERS[peer], *one, id=f"{peer}-{one[0]}-{one[1]}", marks=() if one in SHORT[peer] else pytest.mark.exhaustive
        )
        for peer in PEERS
        for one in SETS
    ],
)


@each_comparison
def test_channels_agree(peer: ModuleType, name: str, energy: float) -> None:
    c = comparison(peer, name, energy)
    np.testing.assert_array_equal(c.engine.fate[c.robust], c.peer.fate[c.robust])


@each_comparison
def test_crossings_agree_for_escaping_and_bounded_orbits(peer: ModuleType, name: str, energy: float) -> None:
    c = comparison(peer, name, energy)
    np.testing.assert_array_equal(c.engine.crossings[c.robust], c.peer.crossings[c.robust])


@each_comparison
def test_escape_times_agree(peer: ModuleType, name: str, energy: float) -> None:
    c = comparison(peer, name, energy)
    left = c.steady & (c.peer.fate > 0)
    np.testing.assert_allclose(c.engine.escape_time[left], c.peer.escape_time[left], rtol=0, atol=1e-6)


# The following tests check that the comparisons above include enough orbits.


@each_comparison
def test_most_orbits_are_robust(peer: ModuleType, name: str, energy: float) -> None:
    assert comparison(peer, name, energy).robust.mean() > 0.9


def test_most_orbits_are_steady() -> None:
    assert np.mean([comparison(taylor_heyoka, *one).steady.mean() for one in SETS]) > 0.9


def test_many_robust_orbits_escape_and_many_are_bounded() -> None:
    comparisons = [comparison(taylor_heyoka, *one) for one in SETS]
    assert sum(int(np.sum(c.robust & (c.peer.fate > 0))) for c in comparisons) > 175
    assert sum(int(np.sum(c.robust & (c.peer.fate == 0))) for c in comparisons) > 75


@pytest.mark.parametrize("name", CASES)
def test_robust_orbits_use_every_channel(name: str) -> None:
    used = {int(k) for one in SETS if one[0] == name for c in [comparison(taylor_heyoka, *one)] for k in c.peer.fate[c.robust]}
    assert used == set(range(CASES[name].channels + 1))


@pytest.mark.parametrize("plane", PLANES)
@each_set
def test_outside_starts_lie_beyond_a_lyapunov_orbit(name: str, energy: float, plane: Plane) -> None:
    potential, window = CASES[name], default_window(CASES[name], plane, energy)
    x, ordinate = (
        np.random.default_rng(6).uniform([window.x_low, window.ordinate_low], [window.x_high, window.ordinate_high], (1000, 2)).T
    )
    states = start_states(potential, plane, energy, x, ordinate)
    states = states[np.isfinite(states).all(axis=1)]
    past = np.array([line.past(states[:, 0], states[:, 1]) for line in exit_lines(potential, energy)])
    # Within 1e-6 of the curve the two descriptions may differ.
    clear = np.abs(past).min(axis=0) > 1e-6
    fate = classify_orbits(potential, energy, states, 1e-9).fate
    np.testing.assert_array_equal((fate == Fate.OUTSIDE)[clear], (past > 0).any(axis=0)[clear])
