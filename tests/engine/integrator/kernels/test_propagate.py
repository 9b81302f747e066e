"""Propagation of orbits: no crossing or exit is missed, and results do not depend on the order or the budget."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, Plane, Potential, start_states
from engine.exits.exit_rows import exit_curves
from engine.exits.exit_shapes import exit_gates
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.kernels.propagate import NO_TRACE, Exits, Orbits
from engine.integrator.source.recurrence import LANES, ROWS, TOLERANCE
from engine.integrator.source.series import ORDER, Setting
from engine.integrator.source.step_flags import HIDDEN
from engine.propagation.fates import Fate

# A potential that is not even in y, so orbits can turn anywhere and can graze y = 0.
ODD = Potential("odd", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 0.3), (0, 3, -0.2), (4, 1, 0.11), (1, 1, 0.07)))

POTENTIAL, ENERGY = CASES["III"], 0.4


def single_steps(potential: Potential, states: np.ndarray, horizon: float = np.inf) -> tuple[np.ndarray, ...]:
    """Return states, times and step sizes after a step, of shape (6, n), and its flags and crossings, each of shape (n,)."""
    gates = np.tile([0.0, 0.0, np.inf], (potential.channels, 1))
    kernels = load_kernels(potential.terms, Setting(potential.channels))
    parts = []
    for part in np.split(states, range(LANES, len(states), LANES)):
        now, new, counts = np.zeros((ROWS, LANES)), np.zeros((ROWS, LANES)), np.zeros((2, LANES), np.int64)
        now[:4, : len(part)] = part.T
        kernels.step(LANES, TOLERANCE, horizon, gates, now, new, *counts)
        parts.append(np.vstack([new, counts])[:, : len(part)])
    result = np.hstack(parts)
    return result[:6], result[-2].astype(int), result[-1].astype(int)


def sampled_y(potential: Potential, states: np.ndarray, h: np.ndarray) -> np.ndarray:
    """Return y over each step, of shape (n, 2001)."""
    jets = np.empty((2, ORDER + 1, len(states)))
    load_kernels(potential.terms, Setting(potential.channels)).jets(len(states), *states.T.copy(), *jets)
    tau = np.linspace(0, 1, 2001) * h[:, None]
    return sum(jets[1, k][:, None] * tau**k for k in range(ORDER + 1))


@pytest.mark.parametrize("potential", [ODD, CASES["II"]], ids=["odd", "II"])
def test_a_step_without_the_flag_hides_no_crossing(potential: Potential) -> None:
    rng = np.random.default_rng(11)
    states = rng.uniform(-0.6, 0.6, (2000, 4))
    # Half of the steps start close and almost parallel to y = 0, where a step can hide crossings.
    states[::2, 1] *= 1e-2
    states[::2, 3] *= 3e-2
    new, flag, crossed = single_steps(potential, states)
    y = sampled_y(potential, states, new[5])
    upward = np.sum((y[:, :-1] < 0) & (y[:, 1:] >= 0), axis=1)
    plain = flag & HIDDEN == 0
    assert plain.sum() > 500
    np.testing.assert_array_equal(crossed[plain], upward[plain])


def test_some_steps_do_hide_crossings() -> None:
    # Without such steps the test above would prove nothing.
    states = np.random.default_rng(12).uniform(-0.6, 0.6, (2000, 4)) * [1, 1e-2, 1, 3e-2]
    new, flag, _ = single_steps(ODD, states)
    y = sampled_y(ODD, states, new[5])
    upward = np.sum((y[:, :-1] < 0) & (y[:, 1:] >= 0), axis=1)
    by_signs = (states[:, 1] < 0) & (new[1] >= 0)
    hiding = upward != by_signs
    assert hiding.sum() >= 10
    assert np.all(flag[hiding] & HIDDEN)


def start_orbits(count: int) -> Orbits:
    """Return orbits of case III at energy 0.4."""
    x, px = np.random.default_rng(2).uniform(-0.4, 0.4, (2, count))
    state = start_states(POTENTIAL, Plane.X_PX, ENERGY, x, px)
    assert np.isfinite(state).all()
    crossings, last_crossings = np.zeros((2, count), np.int64)
    fate, pending = np.full(count, Fate.NOT_COMPUTED, np.int8), np.ones(count, np.uint8)
    return Orbits(state, np.zeros(count), crossings, last_crossings, fate, pending, np.zeros((count, 2)))


def propagate(
    orbits: Orbits, todo: np.ndarray, horizon: float, *, final: bool = True, budget: int = 10**9, least: int = 0
) -> int:
    curves = exit_curves(POTENTIAL, ENERGY)[None]
    exits = Exits(exit_gates(curves), curves, np.zeros(orbits.t.size, np.int64))
    kernels = load_kernels(POTENTIAL.terms, Setting(POTENTIAL.channels))
    return int(kernels.propagate(todo, horizon, final, TOLERANCE, budget, least, exits, orbits, NO_TRACE))


def assert_equal(orbits: Orbits, expected: Orbits) -> None:
    for name in Orbits._fields:
        np.testing.assert_array_equal(getattr(orbits, name), getattr(expected, name), err_msg=name)


@pytest.fixture(scope="module")
def reference() -> Orbits:
    orbits = start_orbits(150)
    propagate(orbits, np.arange(150), 60.0)
    assert {0, 1, 2, 3, 4} == set(orbits.fate.tolist())
    return orbits


@pytest.mark.parametrize("count", [7, 65])
def test_number_of_orbits_makes_no_difference(reference: Orbits, count: int) -> None:
    orbits = start_orbits(150)
    for begin in range(0, 150, count):
        propagate(orbits, np.arange(begin, min(begin + count, 150)), 60.0)
    assert_equal(orbits, reference)


@pytest.mark.parametrize("least", [8, 150])
def test_orbits_that_do_not_fill_the_lanes_are_continued_later(reference: Orbits, least: int) -> None:
    orbits = start_orbits(150)
    propagate(orbits, np.arange(150), 60.0, least=least)
    left = np.flatnonzero(orbits.pending)
    assert left.size < least
    propagate(orbits, left, 60.0)
    assert_equal(orbits, reference)


@pytest.mark.parametrize("budget", [97])
def test_budget_makes_no_difference(reference: Orbits, budget: int) -> None:
    orbits = start_orbits(150)
    while orbits.pending.any():
        assert propagate(orbits, np.flatnonzero(orbits.pending), 60.0, budget=budget) > 0
    assert_equal(orbits, reference)


def test_intermediate_horizons_make_no_difference(reference: Orbits) -> None:
    orbits = start_orbits(150)
    for horizon in (0.001, 7.0, 7.1, 33.3):
        orbits.pending[orbits.fate == Fate.NOT_COMPUTED] = 1
        propagate(orbits, np.flatnonzero(orbits.pending), horizon, final=False)
        assert Fate.BOUNDED not in orbits.fate
    orbits.pending[orbits.fate == Fate.NOT_COMPUTED] = 1
    propagate(orbits, np.flatnonzero(orbits.pending), 60.0)
    assert_equal(orbits, reference)


def test_an_orbit_with_nan_fails_and_does_not_affect_others() -> None:
    orbits, others = start_orbits(20), start_orbits(20)
    orbits.state[3, 2] = np.nan
    propagate(orbits, np.arange(20), 20.0)
    propagate(others, np.arange(20), 20.0)
    assert orbits.fate[3] == Fate.FAILED
    np.testing.assert_array_equal(np.delete(orbits.state, 3, axis=0), np.delete(others.state, 3, axis=0))


@pytest.mark.parametrize("after", [0.0, 1e-3])
def test_escape_time_does_not_depend_on_t_max(reference: Orbits, after: float) -> None:
    for orbit in np.flatnonzero(reference.fate > 0)[:40]:
        orbits = start_orbits(150)
        propagate(orbits, np.array([orbit]), reference.t[orbit] + after)
        assert (orbits.fate[orbit], orbits.t[orbit]) == (reference.fate[orbit], reference.t[orbit])


def test_an_orbit_is_bounded_if_t_max_is_before_its_escape_time(reference: Orbits) -> None:
    before = 1e-9
    for orbit in np.flatnonzero(reference.fate > 0)[:40]:
        orbits = start_orbits(150)
        propagate(orbits, np.array([orbit]), reference.t[orbit] - before)
        assert orbits.fate[orbit] == Fate.BOUNDED
