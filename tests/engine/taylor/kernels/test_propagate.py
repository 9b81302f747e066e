"""The loop around the step: no crossing hides, no exit is missed, and nothing depends on lanes, order or budget."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, Plane, Potential, start_states
from engine.dynamics.fates import Fate
from engine.dynamics.lyapunov_orbits import exit_curves, exit_gates
from engine.taylor.bound_kernels import load_kernels
from engine.taylor.source.recurrence import HIDDEN, ORDER, OVERSHOOT, TOLERANCE

# Not even in y: orbits can turn anywhere, so y = 0 can be grazed.
ODD = Potential("odd", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 0.3), (0, 3, -0.2), (4, 1, 0.11), (1, 1, 0.07)))


def single_steps(potential: Potential, states: np.ndarray, horizon: float = np.inf) -> tuple[np.ndarray, ...]:
    n = len(states)
    new, h, flag, crossed = np.empty((5, n)), np.empty(n), np.zeros(n, np.int64), np.zeros(n, np.int64)
    gates = np.tile([0.0, 0.0, np.inf], (potential.channels, 1))
    kernels = load_kernels(potential.terms, potential.channels)
    kernels.step(n, TOLERANCE, horizon, gates, *states.T.copy(), np.zeros(n), *new, h, flag, crossed)
    return new, h, flag, crossed


def sampled_y(potential: Potential, states: np.ndarray, h: np.ndarray) -> np.ndarray:
    """(n, 2001) y over each step."""
    jets = np.empty((2, ORDER + 1, len(states)))
    load_kernels(potential.terms, potential.channels).jets(len(states), *states.T.copy(), *jets)
    tau = np.linspace(0, 1, 2001) * h[:, None]
    return sum(jets[1, k][:, None] * tau**k for k in range(ORDER + 1))


@pytest.mark.parametrize("potential", [ODD, CASES["II"]], ids=["odd", "II"])
def test_a_step_without_the_flag_hides_no_crossing(potential: Potential) -> None:
    rng = np.random.default_rng(11)
    states = rng.uniform(-0.6, 0.6, (2000, 4))
    # Half of the steps start close to y = 0 and almost along it, where hidden crossings live.
    states[::2, 1] *= 1e-2
    states[::2, 3] *= 3e-2
    _, h, flag, crossed = single_steps(potential, states)
    y = sampled_y(potential, states, h)
    upward = np.sum((y[:, :-1] < 0) & (y[:, 1:] >= 0), axis=1)
    plain = flag & HIDDEN == 0
    assert plain.sum() > 500
    np.testing.assert_array_equal(crossed[plain], upward[plain])


def test_some_steps_do_hide_crossings() -> None:
    # Otherwise the test above would hold for a step that never flags anything.
    states = np.random.default_rng(12).uniform(-0.6, 0.6, (2000, 4)) * [1, 1e-2, 1, 3e-2]
    new, h, flag, _ = single_steps(ODD, states)
    y = sampled_y(ODD, states, h)
    upward = np.sum((y[:, :-1] < 0) & (y[:, 1:] >= 0), axis=1)
    by_signs = (states[:, 1] < 0) & (new[1] >= 0)
    hiding = upward != by_signs
    assert hiding.sum() >= 10
    assert np.all(flag[hiding] & HIDDEN)


def test_a_step_past_the_horizon_says_so() -> None:
    states = np.random.default_rng(1).uniform(-0.4, 0.4, (16, 4))
    h = single_steps(CASES["I"], states)[1]
    flags = single_steps(CASES["I"], states, horizon=float(np.median(h)))[2]
    np.testing.assert_array_equal(flags & OVERSHOOT != 0, h > np.median(h))


class Run:
    """A list of orbits of case III at h = 0.4 in the arrays that `advance` changes."""

    def __init__(self, count: int) -> None:
        x, px = np.random.default_rng(2).uniform(-0.4, 0.4, (2, count))
        self.potential, self.energy = CASES["III"], 0.4
        self.state = start_states(self.potential, Plane.X_PX, self.energy, x, px)
        assert np.isfinite(self.state).all()
        self.t = np.zeros(count)
        self.crossings, self.last_crossings = np.zeros((2, count), np.int64)
        self.fate = np.full(count, Fate.NOT_COMPUTED, np.int8)
        self.waiting = np.ones(count, np.uint8)

    def advance(
        self,
        todo: np.ndarray,
        horizon: float,
        *,
        final: bool = True,
        lanes: int = 64,
        budget: int = 10**9,
    ) -> int:
        curves = exit_curves(self.potential, self.energy)[None]
        kernels = load_kernels(self.potential.terms, self.potential.channels)
        return int(
            kernels.advance(
                todo, horizon, final, TOLERANCE, budget, lanes, exit_gates(curves), curves, np.zeros(self.t.size, np.int64),
                self.state, self.t, self.crossings, self.last_crossings, self.fate, self.waiting,
            )
        )  # fmt: skip

    def assert_equals(self, other: Run) -> None:
        for name in ("state", "t", "crossings", "last_crossings", "fate", "waiting"):
            np.testing.assert_array_equal(getattr(self, name), getattr(other, name), err_msg=name)


@pytest.fixture(scope="module")
def reference() -> Run:
    run = Run(150)
    run.advance(np.arange(150), 60.0)
    assert {0, 1, 2, 3, 4} == set(run.fate.tolist())
    return run


@pytest.mark.parametrize("lanes", [16, 32, 48, 64, 128, 512])
def test_lanes_make_no_difference(reference: Run, lanes: int) -> None:
    run = Run(150)
    run.advance(np.arange(150), 60.0, lanes=lanes)
    run.assert_equals(reference)


def test_order_makes_no_difference(reference: Run) -> None:
    run = Run(150)
    run.advance(np.random.default_rng(0).permutation(150), 60.0)
    run.assert_equals(reference)


@pytest.mark.parametrize("budget", [1, 97, 5000])
def test_budget_makes_no_difference(reference: Run, budget: int) -> None:
    run = Run(150)
    while run.waiting.any():
        assert run.advance(np.flatnonzero(run.waiting), 60.0, budget=budget) > 0
    run.assert_equals(reference)


def test_horizons_on_the_way_make_no_difference(reference: Run) -> None:
    run = Run(150)
    for horizon in (0.001, 7.0, 7.1, 33.3):
        run.waiting[run.fate == Fate.NOT_COMPUTED] = 1
        run.advance(np.flatnonzero(run.waiting), horizon, final=False)
        assert Fate.BOUNDED not in run.fate
    run.waiting[run.fate == Fate.NOT_COMPUTED] = 1
    run.advance(np.flatnonzero(run.waiting), 60.0)
    run.assert_equals(reference)


def test_orbits_not_asked_for_are_left_alone(reference: Run) -> None:
    run, untouched = Run(150), Run(150)
    run.advance(np.arange(0, 150, 2), 60.0)
    np.testing.assert_array_equal(run.state[1::2], untouched.state[1::2])
    np.testing.assert_array_equal(run.state[::2], reference.state[::2])


def test_an_orbit_that_breaks_down_has_failed_and_its_neighbours_do_not_notice() -> None:
    run, others = Run(20), Run(20)
    run.state[3, 2] = np.nan
    run.advance(np.arange(20), 20.0)
    others.advance(np.arange(20), 20.0)
    assert run.fate[3] == Fate.FAILED
    np.testing.assert_array_equal(np.delete(run.state, 3, axis=0), np.delete(others.state, 3, axis=0))


@pytest.mark.parametrize("after", [0.0, 1e-9, 1e-3, 0.2])
def test_an_exit_has_the_same_time_to_the_bit_however_soon_after_it_t_max_is(reference: Run, after: float) -> None:
    for orbit in np.flatnonzero(reference.fate > 0)[:40]:
        run = Run(150)
        run.advance(np.array([orbit]), reference.t[orbit] + after)
        assert (run.fate[orbit], run.t[orbit]) == (reference.fate[orbit], reference.t[orbit])


@pytest.mark.parametrize("before", [1e-9, 1e-3, 0.2])
def test_an_orbit_is_bounded_until_just_before_it_leaves(reference: Run, before: float) -> None:
    for orbit in np.flatnonzero(reference.fate > 0)[:40]:
        run = Run(150)
        run.advance(np.array([orbit]), reference.t[orbit] - before)
        assert run.fate[orbit] == Fate.BOUNDED
