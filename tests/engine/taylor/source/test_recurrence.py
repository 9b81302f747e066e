"""The generated kernels as numerical objects: series, order, tangent flow, energy."""

from __future__ import annotations

import ast
import platform
import re

import heyoka as hy
import numpy as np
import pytest
import sympy
from numba import njit

from engine import CASES, Fate, Potential, classify_orbits, start_states
from engine.dynamics.planes import Plane
from engine.potentials.catalogue import channel_family
from engine.taylor.bound_kernels import load_kernels
from engine.taylor.jit.function_pointers import SIGNATURES
from engine.taylor.source.recurrence import ORDER, TOLERANCE, crossings_can_hide, generate_source, tabulate_coefficients
from tests.peers import taylor_heyoka

# One potential beyond the paper's: odd in both coordinates, of degree 5, with a term in neither force's pattern.
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


def flowed(potential: Potential, states: np.ndarray, h: float) -> np.ndarray:
    """(n, 4) states a time h later, by the series."""
    jets = jets_of(potential, states)
    powers = h ** np.arange(ORDER + 1)[:, None]
    slopes = np.arange(1, ORDER + 1)[:, None] * powers[:-1]
    x, y = (jets * powers).sum(axis=1)
    px, py = (jets[:, 1:] * slopes).sum(axis=1)
    return np.column_stack([x, y, px, py])


def transition_matrix(potential: Potential, state: np.ndarray, h: float) -> np.ndarray:
    deviations = np.eye(4)
    position = [np.full(4, value) for value in state]
    load_kernels(potential.terms, potential.channels).tangent(4, np.full(4, h), *position, *deviations)
    return deviations


@each_potential
def test_series_are_heyokas(name: str) -> None:
    for state, mine in zip(some_states(6), np.moveaxis(jets_of(POTENTIALS[name], some_states(6)), -1, 0), strict=True):
        theirs = taylor_heyoka.taylor_coefficients(POTENTIALS[name], state)[:, : ORDER + 1]
        np.testing.assert_allclose(mine, theirs, rtol=1e-12, atol=1e-13 * np.abs(theirs).max())


@each_potential
def test_series_obey_the_equations_of_motion(name: str) -> None:
    """(k+1)(k+2) x_(k+2) = −[t^k] V_x by exact polynomial arithmetic; only the newest coefficient is judged at each k."""
    potential, t = POTENTIALS[name], sympy.Symbol("t")
    jets = jets_of(potential, some_states(1))[:, :, 0]
    x, y = (sympy.Poly([sympy.Rational(float(c)) for c in axis[::-1]], t) for axis in jets)
    for axis, table in enumerate((potential.derivative(1, 0), potential.derivative(0, 1))):
        force = sum((sympy.Rational(c) * x**i * y**j for (i, j), c in table.items()), sympy.Poly(0, t)).all_coeffs()[::-1]
        expected = np.array([-float(c) for c in force[: ORDER - 1]])
        mine = np.arange(1, ORDER) * np.arange(2, ORDER + 1) * jets[axis, 2:]
        np.testing.assert_allclose(mine, expected, rtol=1e-12, atol=1e-13 * np.abs(expected).max())


@each_potential
def test_local_error_falls_with_one_power_more_than_the_order(name: str) -> None:
    states = some_states(5)
    # Long enough for the error to stand clear of rounding, short enough for its first term to rule.
    lengths = np.array([0.8, 1.0, 1.2])
    truth = hy.taylor_adaptive(taylor_heyoka.equations(POTENTIALS[name]), [0.0] * 4, tol=1e-18)
    errors = np.empty((len(states), lengths.size))
    for n, state in enumerate(states):
        for k, h in enumerate(lengths):
            truth.time, truth.state[:] = 0.0, state
            for end in np.linspace(0, h, 5)[1:]:
                truth.propagate_until(end)
            errors[n, k] = np.abs(flowed(POTENTIALS[name], state[None], h)[0, :2] - truth.state[:2]).max()
    measurable = (errors > 1e-14).all(axis=1)
    assert measurable.sum() >= 2
    slopes = np.log(errors[measurable, -1] / errors[measurable, 0]) / np.log(lengths[-1] / lengths[0])
    assert np.median(slopes) == pytest.approx(ORDER + 1, abs=1.0)


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
def test_tangent_flow_carries_the_velocity_along(name: str) -> None:
    """(ẋ, ṗ) is itself a deviation: the flow maps the phase velocity at the start to that at the end."""

    def phase_velocity(s: np.ndarray) -> np.ndarray:
        vx, vy = POTENTIALS[name].gradient(s[0], s[1])
        return np.array([s[2], s[3], -vx, -vy])

    for state in some_states(5):
        end = flowed(POTENTIALS[name], state[None], 0.2)[0]
        moved = transition_matrix(POTENTIALS[name], state, 0.2) @ phase_velocity(state)
        np.testing.assert_allclose(moved, phase_velocity(end), atol=1e-12)


@each_potential
def test_a_step_ends_where_its_series_does(name: str) -> None:
    potential, n = POTENTIALS[name], 16
    states = some_states(n)
    new, h, flag, crossed = np.empty((5, n)), np.empty(n), np.zeros(n, np.int64), np.zeros(n, np.int64)
    gates = np.tile([0.0, 0.0, np.inf], (potential.channels, 1))
    kernels = load_kernels(potential.terms, potential.channels)
    kernels.step(n, TOLERANCE, np.inf, gates, *states.T.copy(), np.zeros(n), *new, h, flag, crossed)
    expected = np.concatenate([flowed(potential, state[None], length) for state, length in zip(states, h, strict=True)])
    np.testing.assert_allclose(new[:4].T, expected, rtol=0, atol=1e-14)


@pytest.mark.slow
@pytest.mark.parametrize(("name", "energy"), [("I", 0.12), ("II", 0.16), ("III", 0.24), ("III", 0.26)])
def test_energy_is_kept_to_1e_11_over_1e5_time_units(name: str, energy: float) -> None:
    x, px = np.random.default_rng(5).uniform(-0.45, 0.45, (2, 40))
    states = start_states(CASES[name], Plane.X_PX, energy, x, px)
    outcome = classify_orbits(CASES[name], energy, states[np.isfinite(states).all(axis=1)], t_max=1e5)
    bounded = outcome.fate == Fate.BOUNDED
    assert bounded.sum() >= 24
    assert outcome.energy_error[bounded].max() <= 1e-11


@pytest.mark.parametrize("terms", [(), ((0, 0, 1.0),), ((1, 0, 2.0),), ((2, 0, 0.5),), ((6, 3, -1.0),)])
def test_any_polynomial_becomes_valid_source(terms: tuple) -> None:
    names = [node.name for node in ast.parse(generate_source(terms, 0)).body if isinstance(node, ast.FunctionDef)]
    assert [name for name in names if not name.startswith("_")] == ["step", "glide", "jets", "tangent", "potential_value"]


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
def test_gliding_is_the_flow_at_a_fixed_step(name: str) -> None:
    n, h = 16, 0.25
    potential, states = POTENTIALS[name], some_states(n)
    gliding, squares = states.T.copy(), np.zeros((2, n))
    load_kernels(potential.terms, potential.channels).glide(n, h, 2.0, *gliding, *squares)
    np.testing.assert_allclose(gliding.T, flowed(potential, states, h), rtol=0, atol=1e-14)
    np.testing.assert_array_equal(squares.T, 2.0 * states[:, :2] ** 2)


@pytest.mark.parametrize("exponent", range(-12, 13, 3))
def test_the_step_is_the_sixteenth_root_to_within_6_percent(exponent: int) -> None:

    potential, n = POTENTIALS["odd"], 16
    states = np.repeat(some_states(1) * 1.5, n, axis=0)
    x, y = jets_of(potential, states)[:, :, 0]
    size = sum(w * (abs(x[-k]) + abs(y[-k])) for k, w in ((1, 1.0), (2, 1.0), (3, 0.3)))
    tolerance = 10.0**exponent * TOLERANCE
    new, h, flag, crossed = np.empty((5, n)), np.empty(n), np.zeros(n, np.int64), np.zeros(n, np.int64)
    gates = np.tile([0.0, 0.0, np.inf], (potential.channels, 1))
    step = load_kernels(potential.terms, potential.channels).step
    step(n, tolerance, np.inf, gates, *states.T.copy(), np.zeros(n), *new, h, flag, crossed)
    exact = min((tolerance / size) ** (1 / 16), 1.0)
    assert 0.999 * exact <= h[0] <= 1.065 * exact


def test_squares_that_enter_as_their_difference_become_one_series() -> None:
    step = generate_source(CASES["II"].terms, 0).split("def glide")[0]
    assert ("x2y0_0 = " in step) != ("x0y2_0 = " in step)


def test_a_difference_is_one_whatever_its_strength() -> None:
    for strength in np.linspace(0.1, 2.0, 20):
        source = generate_source((*CASES["II"].terms[:2], (3, 0, -strength / 3), (1, 2, strength)), 3)
        step = source.split("def glide")[0]
        assert ("x2y0_0 = " in step) != ("x0y2_0 = " in step)


def test_other_coefficients_or_another_order_of_terms_are_the_same_source() -> None:
    (i, j, c), *rest = CASES["III"].terms
    assert generate_source((*rest, (i, j, 1.3 * c)), 4) == generate_source(CASES["III"].terms, 4)


def test_the_table_is_not_to_be_written_to() -> None:
    assert not tabulate_coefficients(CASES["I"].terms).flags.writeable


def test_squares_that_enter_on_their_own_do_not() -> None:
    # V_x holds x², V_y holds y²: no difference anywhere.
    source = generate_source(((2, 0, 0.5), (0, 2, 0.5), (3, 0, 0.1), (0, 3, 0.2)), 0)
    assert "x2y0_0 = " in source
    assert "x0y2_0 = " in source


@pytest.mark.skipif(platform.machine() != "x86_64", reason="reads the assembly of x86-64")
@pytest.mark.parametrize("name", [*CASES, "5", "8"])
def test_a_step_is_vector_code_throughout(name: str) -> None:
    """One library call, or one branch, in the loop and the compiler gives up: every product is then scalar."""
    potential = channel_family(int(name)) if name.isdigit() else CASES[name]
    # Compiled here: what comes from the cache cannot be inspected.
    step = njit(error_model="numpy", fastmath={"contract"})(
        load_kernels(potential.terms, potential.channels).step.function.py_func
    )
    step.compile(SIGNATURES["step"])
    assembly = "".join(step.inspect_asm().values())
    packed, scalar = (len(re.findall(rf"\bv(?:fn?m|mul)\w*{kind}\b", assembly)) for kind in ("pd", "sd"))
    assert packed > 300
    # The remainder of a loop that is no whole number of vectors is there too, and never runs.
    assert packed >= scalar
    assert "sqrt" not in assembly
    assert "call" not in assembly.split("vfm", 1)[1].rsplit("vfm", 1)[0]
