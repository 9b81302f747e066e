"""Generated kernels: series, order of the integrator, tangent flow, energy, step size, generated source, machine code."""

from __future__ import annotations

import platform
import re

import heyoka as hy
import numpy as np
import pytest
import sympy
from numba import njit

from engine import CASES, Fate, Potential, classify_orbits, start_states
from engine.potentials.known_potentials import channel_family
from engine.slices.planes import Plane
from engine.taylor.bound_kernels import load_kernels
from engine.taylor.jit.function_pointers import SIGNATURES
from engine.taylor.source.polynomial_recurrence import crossings_can_hide
from engine.taylor.source.recurrence import LANES, ROWS, TOLERANCE, generate_code
from engine.taylor.source.series import ORDER
from tests.peers import taylor_heyoka

# A potential that is not in the paper: odd in both coordinates and of degree 5.
ODD = Potential("odd", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 0.3), (0, 3, -0.2), (4, 1, 0.11), (1, 1, 0.07)))
POTENTIALS = {**CASES, "odd": ODD}
each_potential = pytest.mark.parametrize("name", POTENTIALS)
SYMPLECTIC = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.eye(2), np.zeros((2, 2))]])


def some_states(count: int) -> np.ndarray:
    return np.random.default_rng(7).uniform(-0.6, 0.6, (count, 4))


def jets_of(potential: Potential, states: np.ndarray) -> np.ndarray:
    """(2, ORDER + 1, n) coefficients of x and y."""
    jets = np.empty((2, ORDER + 1, len(states)))
    load_kernels(potential.terms, potential.channels).jets(len(states), *states.T.copy(), *jets)
    return jets


def flowed(potential: Potential, states: np.ndarray, h: float, order: int = ORDER) -> np.ndarray:
    """(n, 4) states a time h later, by the series up to an order."""
    jets = jets_of(potential, states)[:, : order + 1]
    powers = h ** np.arange(order + 1)[:, None]
    slopes = np.arange(1, order + 1)[:, None] * powers[:-1]
    x, y = (jets * powers).sum(axis=1)
    px, py = (jets[:, 1:] * slopes).sum(axis=1)
    return np.column_stack([x, y, px, py])


def stepped(potential: Potential, states: np.ndarray, tolerance: float, count: int = LANES) -> np.ndarray:
    """(ROWS, LANES) states, times and step sizes after one step of the first `count` states (LANES, 4); 0 for the others."""
    now, new, counts = np.zeros((ROWS, LANES)), np.zeros((ROWS, LANES)), np.zeros((2, LANES), np.int64)
    now[:4] = states.T
    gates = np.tile([0.0, 0.0, np.inf], (potential.channels, 1))
    load_kernels(potential.terms, potential.channels).step(count, tolerance, np.inf, gates, now, new, *counts)
    return new


def transition_matrix(potential: Potential, state: np.ndarray, h: float) -> np.ndarray:
    deviations = np.eye(4)
    position = [np.full(4, value) for value in state]
    load_kernels(potential.terms, potential.channels).tangent(4, np.full(4, h), *position, *deviations)
    return deviations


@each_potential
def test_series_equal_those_of_heyoka(name: str) -> None:
    for state, series in zip(some_states(6), np.moveaxis(jets_of(POTENTIALS[name], some_states(6)), -1, 0), strict=True):
        expected = taylor_heyoka.taylor_coefficients(POTENTIALS[name], state)[:, : ORDER + 1]
        np.testing.assert_allclose(series, expected, rtol=1e-12, atol=1e-13 * np.abs(expected).max())


@each_potential
def test_series_obey_the_equations_of_motion(name: str) -> None:
    """(k+1)(k+2) x_(k+2) = −[t^k] V_x, with the right-hand side in exact arithmetic from the computed coefficients up to k."""
    potential, t = POTENTIALS[name], sympy.Symbol("t")
    jets = jets_of(potential, some_states(1))[:, :, 0]
    x, y = (sympy.Poly([sympy.Rational(float(c)) for c in axis[::-1]], t) for axis in jets)
    for axis, table in enumerate(potential.form.slopes):
        force = sum((sympy.Rational(c) * x**i * y**j for (i, j), c in table.items()), sympy.Poly(0, t)).all_coeffs()[::-1]
        expected = np.array([-float(c) for c in force[: ORDER - 1]])
        accelerations = np.arange(1, ORDER) * np.arange(2, ORDER + 1) * jets[axis, 2:]
        np.testing.assert_allclose(accelerations, expected, rtol=1e-12, atol=1e-13 * np.abs(expected).max())


@pytest.mark.parametrize("order", [ORDER, ORDER - 1])
@each_potential
def test_local_error_is_of_one_order_more_than_the_series(name: str, order: int) -> None:
    """The series without its last coefficient must give one order less, so that the test can tell the two orders apart."""
    states = some_states(20)
    # Long enough for errors well above rounding, short enough for the first neglected term to dominate.
    lengths = np.array([0.8, 1.2])
    integrator = hy.taylor_adaptive(taylor_heyoka.equations(POTENTIALS[name]), [0.0] * 4, tol=1e-18)
    errors = np.empty((len(states), lengths.size))
    for n, state in enumerate(states):
        for k, h in enumerate(lengths):
            integrator.time, integrator.state[:] = 0.0, state
            for end in np.linspace(0, h, 5)[1:]:
                integrator.propagate_until(end)
            errors[n, k] = np.abs(flowed(POTENTIALS[name], state[None], h, order)[0, :2] - integrator.state[:2]).max()
    measurable = (errors > 1e-13).all(axis=1)
    assert measurable.sum() >= 15
    orders = np.log(errors[measurable, 1] / errors[measurable, 0]) / np.log(lengths[1] / lengths[0])
    assert np.median(orders) == pytest.approx(order + 1, abs=0.3)


@each_potential
def test_tangent_flow_is_the_derivative_of_the_flow(name: str) -> None:
    shift, h = 1e-5, 0.3
    for state in some_states(5):
        both_sides = state + shift * np.vstack([np.eye(4), -np.eye(4)])
        after = flowed(POTENTIALS[name], both_sides, h)
        differences = (after[:4] - after[4:]).T / (2 * shift)
        # Central differences err by shift² and by rounding / shift, both near 1e-10.
        np.testing.assert_allclose(transition_matrix(POTENTIALS[name], state, h), differences, atol=1e-8)


@each_potential
def test_tangent_flow_is_symplectic(name: str) -> None:
    for state in some_states(5):
        m = transition_matrix(POTENTIALS[name], state, 0.2)
        np.testing.assert_allclose(m.T @ SYMPLECTIC @ m, SYMPLECTIC, atol=1e-13)


@each_potential
def test_tangent_flow_maps_the_phase_velocity_at_the_start_to_that_at_the_end(name: str) -> None:
    def phase_velocity(s: np.ndarray) -> np.ndarray:
        vx, vy = POTENTIALS[name].gradient(s[0], s[1])
        return np.array([s[2], s[3], -vx, -vy])

    for state in some_states(5):
        end = flowed(POTENTIALS[name], state[None], 0.2)[0]
        moved = transition_matrix(POTENTIALS[name], state, 0.2) @ phase_velocity(state)
        np.testing.assert_allclose(moved, phase_velocity(end), atol=1e-12)


@each_potential
def test_a_step_ends_at_the_value_of_its_series(name: str) -> None:
    potential, states = POTENTIALS[name], some_states(LANES)
    ends = stepped(potential, states, TOLERANCE)
    expected = np.concatenate([flowed(potential, state[None], length) for state, length in zip(states, ends[5], strict=True)])
    np.testing.assert_allclose(ends[:4].T, expected, rtol=0, atol=1e-14)


def test_lanes_beyond_the_given_number_stay_unchanged() -> None:
    ends = stepped(POTENTIALS["odd"], some_states(LANES), TOLERANCE, count=8)
    assert ends[:6, :8].all()
    assert not ends[:, 8:].any()


def test_arrays_of_another_width_are_refused() -> None:
    potential = POTENTIALS["odd"]
    with pytest.raises(ValueError, match="must have 64 columns"):
        load_kernels(potential.terms, potential.channels).fixed_step(8, 0.1, 1.0, np.zeros((4, 8)), np.zeros((2, 8)))


@pytest.mark.parametrize(("name", "energy"), [("I", 0.12), ("II", 0.16), ("III", 0.24), ("III", 0.26)])
def test_energy_error_is_at_most_1e_11_over_1e5_time_units(name: str, energy: float) -> None:
    x, px = np.random.default_rng(5).uniform(-0.45, 0.45, (2, 40))
    states = start_states(CASES[name], Plane.X_PX, energy, x, px)
    outcome = classify_orbits(CASES[name], energy, states[np.isfinite(states).all(axis=1)], t_max=1e5)
    bounded = outcome.fate == Fate.BOUNDED
    assert bounded.sum() >= 24
    assert outcome.energy_error[bounded].max() <= 1e-11


@pytest.mark.parametrize("terms", [(), ((0, 0, 1.0),), ((1, 0, 2.0),), ((2, 0, 0.5),), ((6, 3, -1.0),)])
def test_generated_functions_compile_for_any_polynomial(terms: tuple) -> None:
    kernels = load_kernels(terms, 0)
    assert kernels.potential_value(0.5, 0.7) == pytest.approx(sum(c * 0.5**i * 0.7**j for i, j, c in terms))
    state, sums = some_states(LANES).T.copy(), np.zeros((2, LANES))
    kernels.fixed_step(LANES, 0.1, 1.0, state, sums)
    assert np.isfinite(state).all()


def test_a_potential_without_terms_has_straight_orbits() -> None:
    states, jets = some_states(16), np.empty((2, ORDER + 1, 16))
    load_kernels((), 0).jets(16, *states.T.copy(), *jets)
    np.testing.assert_array_equal(jets[:, :2].transpose(2, 1, 0).reshape(16, 4), states)
    assert not jets[:, 2:].any()


def test_crossings_cannot_hide_where_y_oscillates_slowly() -> None:
    assert not any(crossings_can_hide({(i, j): c for i, j, c in potential.terms}) for potential in CASES.values())


@pytest.mark.parametrize("terms", [{(0, 2): 0.5, (0, 3): 0.1}, {(0, 2): 5.0}, {(0, 2): 0.5, (2, 2): 1.0}])
def test_crossings_can_hide_where_y_may_turn_back_within_a_step(terms: dict) -> None:
    # Odd in y; faster than the longest step; faster far out.
    assert crossings_can_hide(terms)


@each_potential
def test_a_fixed_step_is_the_flow_and_adds_weighted_squares(name: str) -> None:
    h = 0.25
    potential, states = POTENTIALS[name], some_states(LANES)
    ends, sums = states.T.copy(), np.zeros((2, LANES))
    load_kernels(potential.terms, potential.channels).fixed_step(LANES, h, 2.0, ends, sums)
    np.testing.assert_allclose(ends.T, flowed(potential, states, h), rtol=0, atol=1e-14)
    np.testing.assert_array_equal(sums.T, 2.0 * states[:, :2] ** 2)


@pytest.mark.parametrize("exponent", range(-12, 13, 3))
def test_the_step_is_the_sixteenth_root_to_within_6_percent(exponent: int) -> None:
    potential = POTENTIALS["odd"]
    states = np.repeat(some_states(1) * 1.5, LANES, axis=0)
    x, y = jets_of(potential, states)[:, :, 0]
    norm = sum(w * (abs(x[-k]) + abs(y[-k])) for k, w in ((1, 1.0), (2, 1.0), (3, 0.3)))
    tolerance = 10.0**exponent * TOLERANCE
    h = stepped(potential, states, tolerance)[5, 0]
    exact = min((tolerance / norm) ** (1 / 16), 1.0)
    assert 0.999 * exact <= h <= 1.065 * exact


def count_products(terms: tuple) -> int:
    return sum(symbol == "*" for symbol, _ in generate_code(terms, 0).functions[0].program.operations)


def test_squares_that_enter_as_their_difference_become_one_series() -> None:
    for factor in np.linspace(0.1, 2.0, 20):
        # V_x contains factor · (y² − x²), or y² and x² with different coefficients.
        others = ((2, 0, 0.5), (0, 2, 0.5), (1, 2, factor))
        as_difference, separate = (count_products((*others, (3, 0, c))) for c in (-factor / 3, 0.1))
        # One product less in each of the orders 0 … ORDER − 2.
        assert as_difference == separate - (ORDER - 1)


def test_other_coefficients_or_another_order_of_terms_give_the_same_code() -> None:
    (i, j, c), *rest = CASES["III"].terms
    assert generate_code((*rest, (i, j, 1.3 * c)), 4) is generate_code(CASES["III"].terms, 4)


def test_table_of_coefficients_is_read_only() -> None:
    terms = CASES["I"].terms
    assert not generate_code(terms, 2).tabulate(terms).flags.writeable


@pytest.mark.skipif(platform.machine() != "x86_64", reason="reads the assembly of x86-64")
@pytest.mark.parametrize("name", ["I", "5", *(pytest.param(name, marks=pytest.mark.slow) for name in ("II", "III", "8"))])
def test_a_step_is_vectorised_throughout(name: str) -> None:
    """A single library call or branch in the loop would keep the compiler from vectorising it."""
    potential = channel_family(int(name)) if name.isdigit() else CASES[name]
    # Compiled anew, since code from the cache cannot be inspected.
    step = njit(error_model="numpy", fastmath={"contract"})(
        load_kernels(potential.terms, potential.channels).step.function.py_func
    )
    step.compile(SIGNATURES["step"])
    assembly = "".join(step.inspect_asm().values())
    packed, scalar = (len(re.findall(rf"\bv(?:fn?m|mul)\w*{kind}\b", assembly)) for kind in ("pd", "sd"))
    assert packed > 300
    # The scalar remainder of the loop, for numbers of lanes that are not multiples of the vector length, runs for single orbits.
    assert packed >= scalar
    assert "sqrt" not in assembly
    assert "call" not in assembly.split("vfm", 1)[1].rsplit("vfm", 1)[0]
