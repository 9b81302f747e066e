"""Generated kernels have the right series, tangent flow, energy and step size, and vectorised machine code."""

from __future__ import annotations

import platform
import re

import numpy as np
import pytest
from numba import njit

from engine import CASES, Fate, Potential, classify_orbits, start_states
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.jit.function_types import SIGNATURES
from engine.integrator.source.recurrence import LANES, ROWS, SIZE_ROW, TIME_ROW, TOLERANCE
from engine.integrator.source.series import ORDER, Setting
from engine.slices.planes import Plane
from tests.channel_family import channel_family
from tests.peers import taylor_heyoka

# A potential that is not in the paper: odd in both coordinates and of degree 5.
ODD = Potential("odd", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 0.3), (0, 3, -0.2), (4, 1, 0.11), (1, 1, 0.07)))
POTENTIALS = {"II": CASES["II"], "III": CASES["III"], "odd": ODD}
each_potential = pytest.mark.parametrize("name", POTENTIALS)


def some_states(count: int) -> np.ndarray:
    return np.random.default_rng(7).uniform(-0.6, 0.6, (count, 4))


def jets_of(potential: Potential, states: np.ndarray) -> np.ndarray:
    """Return the coefficients of x and y, of shape (2, ORDER + 1, n)."""
    jets = np.empty((2, ORDER + 1, len(states)))
    load_kernels(potential.terms, Setting(potential.channels)).jets(len(states), *states.T.copy(), *jets)
    return jets


def flowed(potential: Potential, states: np.ndarray, h: float) -> np.ndarray:
    """Return states a time h later, by the series, of shape (n, 4)."""
    jets = jets_of(potential, states)
    powers = h ** np.arange(ORDER + 1)[:, None]
    slopes = np.arange(1, ORDER + 1)[:, None] * powers[:-1]
    x, y = (jets * powers).sum(axis=1)
    px, py = (jets[:, 1:] * slopes).sum(axis=1)
    return np.column_stack([x, y, px, py])


def stepped(potential: Potential, states: np.ndarray, tolerance: float, count: int = LANES) -> np.ndarray:
    """Return states, times and step sizes after a step of the first `count` states, of shape (ROWS, LANES). Other lanes are 0."""
    now, new, counts = np.zeros((ROWS, LANES)), np.zeros((ROWS, LANES)), np.zeros((2, LANES), np.int64)
    now[:4] = states.T
    gates = np.tile([0.0, 0.0, np.inf], (potential.channels, 1))
    load_kernels(potential.terms, Setting(potential.channels)).step(count, tolerance, np.inf, gates, now, new, *counts)
    return new


def transition_matrix(potential: Potential, state: np.ndarray, h: float) -> np.ndarray:
    deviations = np.eye(4)
    position = [np.full(4, value) for value in state]
    load_kernels(potential.terms, Setting(potential.channels)).tangent(4, np.full(4, h), *position, *deviations)
    return deviations


@each_potential
def test_series_agree_with_heyoka(name: str) -> None:
    for state, series in zip(some_states(6), np.moveaxis(jets_of(POTENTIALS[name], some_states(6)), -1, 0), strict=True):
        expected = taylor_heyoka.taylor_coefficients(POTENTIALS[name], state)[:, : ORDER + 1]
        np.testing.assert_allclose(series, expected, rtol=1e-12, atol=1e-13 * np.abs(expected).max())


@each_potential
def test_tangent_flow_is_the_derivative_of_the_flow(name: str) -> None:
    shift, h = 1e-5, 0.3
    for state in some_states(5):
        both_sides = state + shift * np.vstack([np.eye(4), -np.eye(4)])
        after = flowed(POTENTIALS[name], both_sides, h)
        differences = (after[:4] - after[4:]).T / (2 * shift)
        # Central differences err by shift² and by rounding / shift, both near 1e-10.
        np.testing.assert_allclose(transition_matrix(POTENTIALS[name], state, h), differences, atol=1e-8)


@pytest.mark.parametrize(("name", "energy"), [("II", 0.16), ("III", 0.26)])
def test_energy_error_is_at_most_1e_11_over_1e5_time_units(name: str, energy: float) -> None:
    x, px = np.random.default_rng(5).uniform(-0.45, 0.45, (2, 40))
    states = start_states(CASES[name], Plane.X_PX, energy, x, px)
    outcome = classify_orbits(CASES[name], energy, states[np.isfinite(states).all(axis=1)], t_max=1e5)
    bounded = outcome.fate == Fate.BOUNDED
    assert bounded.sum() >= 24
    assert outcome.energy_error[bounded].max() <= 1e-11


@pytest.mark.parametrize("terms", [(), ((1, 0, 2.0),), ((6, 3, -1.0),)])
def test_generated_functions_compile_for_any_polynomial(terms: tuple) -> None:
    kernels = load_kernels(terms, Setting())
    assert kernels.potential_value(0.5, 0.7) == pytest.approx(sum(c * 0.5**i * 0.7**j for i, j, c in terms))
    now, new = np.zeros((2, ROWS, LANES))
    now[:4] = some_states(LANES).T
    kernels.limited_step(LANES, TOLERANCE, np.full(LANES, 0.1), now, new)
    assert np.isfinite(new).all()


def stepped_until(potential: Potential, states: np.ndarray, t: float, limits: np.ndarray) -> np.ndarray:
    """Return the lanes after a limited step of orbits at time t, of shape (ROWS, LANES)."""
    now, new = np.zeros((2, ROWS, LANES))
    now[:4], now[TIME_ROW] = states.T, t
    load_kernels(potential.terms, Setting(potential.channels)).limited_step(LANES, TOLERANCE, limits, now, new)
    return new


@each_potential
def test_a_step_that_is_cut_short_is_the_flow_until_its_limit(name: str) -> None:
    potential, states, limits = POTENTIALS[name], some_states(LANES), np.linspace(5.01, 5.2, LANES)
    ends = stepped_until(potential, states, 5.0, limits)
    np.testing.assert_array_equal(ends[TIME_ROW], limits)
    expected = [flowed(potential, state[None], h)[0] for state, h in zip(states, limits - 5.0, strict=True)]
    np.testing.assert_allclose(ends[:4].T, expected, rtol=0, atol=1e-14)


@each_potential
def test_a_step_before_its_limit_is_that_of_maps(name: str) -> None:
    states = some_states(LANES)
    found, expected = (
        stepped_until(POTENTIALS[name], states, 0.0, np.full(LANES, np.inf)),
        stepped(POTENTIALS[name], states, TOLERANCE),
    )
    np.testing.assert_allclose(found, expected, rtol=1e-12, atol=1e-13)


def test_an_orbit_at_its_limit_does_not_move() -> None:
    states = some_states(LANES)
    ends = stepped_until(ODD, states, 3.0, np.full(LANES, 3.0))
    np.testing.assert_array_equal(ends[:4].T, states)
    np.testing.assert_array_equal(ends[SIZE_ROW], 0.0)


@pytest.mark.parametrize("exponent", [-12, 0, 12])
def test_the_step_is_the_sixteenth_root_to_within_6_percent(exponent: int) -> None:
    potential = POTENTIALS["odd"]
    states = np.repeat(some_states(1) * 1.5, LANES, axis=0)
    x, y = jets_of(potential, states)[:, :, 0]
    norm = sum(w * (abs(x[-k]) + abs(y[-k])) for k, w in ((1, 1.0), (2, 1.0), (3, 0.3)))
    tolerance = 10.0**exponent * TOLERANCE
    h = stepped(potential, states, tolerance)[5, 0]
    exact = min((tolerance / norm) ** (1 / 16), 1.0)
    assert 0.999 * exact <= h <= 1.065 * exact


@pytest.mark.skipif(platform.machine() != "x86_64", reason="reads the assembly of x86-64")
@pytest.mark.parametrize("name", ["5", pytest.param("III", marks=pytest.mark.slow)])
def test_a_step_is_vectorised_throughout(name: str) -> None:
    """A single library call or branch in the loop would keep the compiler from vectorising it."""
    potential = channel_family(int(name)) if name.isdigit() else CASES[name]
    # Compile the step anew, because code from the cache cannot be inspected.
    step = njit(error_model="numpy", fastmath={"contract"})(
        load_kernels(potential.terms, Setting(potential.channels)).step.function.py_func
    )
    step.compile(SIGNATURES["step"])
    assembly = "".join(step.inspect_asm().values())
    packed, scalar = (len(re.findall(rf"\bv(?:fn?m|mul)\w*{kind}\b", assembly)) for kind in ("pd", "sd"))
    assert packed > 300
    # The scalar remainder of the loop, for numbers of lanes that are not multiples of the vector length, runs for single orbits.
    assert packed >= scalar
    assert "sqrt" not in assembly
    assert "call" not in assembly.split("vfm", 1)[1].rsplit("vfm", 1)[0]
