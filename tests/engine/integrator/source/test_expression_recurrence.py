"""Kernels of expressions have the right series, tangent flow, energy and steps, and vectorised machine code."""

from __future__ import annotations

import platform
import re

import mpmath
import numpy as np
import pytest
from numba import njit

from engine import Potential, parse_formula
from engine.expressions.calculus import derivative
from engine.expressions.nodes import Coordinate, Expression, Function, Product, Sum
from engine.integrator.bound_kernels import load_kernels
from engine.integrator.jit.function_types import SIGNATURES
from engine.integrator.source.recurrence import LANES, ROWS, SIZE_ROW, TOLERANCE
from engine.integrator.source.series import ORDER, Setting

# Together these formulas have all kinds of nodes.
TEXTS = (
    "½r² − x²y exp(−y²)",
    "−1/√(x² + 0.7y² + 0.3) + 0.2 x² y log(2 + x)",
    "½log(x² + y² + 0.6) − 0.1x³ cos(x + 2y)",
    "(x² + y² + 1)^0.7 − x² y /(1 + y²) + sin(x)³",
    "−1/√((x − 1.1)² + y²) − 0.3/√((x + 1.2)² + y²) + 0.1 exp((x + 0.3)(x − 0.2)) x",
)


def texts_of(fast: int) -> pytest.MarkDecorator:
    """Return the texts, of which the fast suite tests only the first `fast`, because compiling a kernel takes up to seconds."""
    return pytest.mark.parametrize(
        "text", [*TEXTS[:fast], *(pytest.param(text, marks=pytest.mark.slow) for text in TEXTS[fast:])]
    )


def states_of(count: int) -> np.ndarray:
    return np.random.default_rng(5).uniform(-0.4, 0.4, (count, 4))


def kernels_of(text: str):
    return load_kernels(parse_formula(text).form.definition, Setting(2))


def jets_of(text: str, states: np.ndarray) -> np.ndarray:
    jets = np.empty((2, ORDER + 1, len(states)))
    kernels_of(text).jets(len(states), *states.T.copy(), *jets)
    return jets


def exactly(expression: Expression, x: mpmath.mpf, y: mpmath.mpf) -> mpmath.mpf:
    match expression:
        case Coordinate(axis):
            return (x, y)[axis]
        case Sum(constant, terms):
            return constant + mpmath.fsum(mpmath.mpf(c) * exactly(part, x, y) for part, c in terms)
        case Product(factors):
            return mpmath.fprod(exactly(base, x, y) ** (int(n) if n == int(n) else mpmath.mpf(n)) for base, n in factors)
        case Function(name, argument):
            return getattr(mpmath, name)(exactly(argument, x, y))
    raise TypeError(expression)


@texts_of(fast=2)
def test_series_obey_the_equations_of_motion(text: str) -> None:
    """(k+1)(k+2) x_(k+2) = −[t^k] V_x along the computed path, with the derivatives of mpmath in 40 digits."""
    definition = parse_formula(text).form.definition
    assert isinstance(definition, Expression)
    with mpmath.workdps(40):
        x, y = ([mpmath.mpf(c) for c in series[::-1]] for series in jets_of(text, states_of(1))[:, :, 0].tolist())
        for axis, series in enumerate((x, y)):
            slope = derivative(definition, axis)
            taylor = mpmath.taylor(
                lambda t, slope=slope: exactly(slope, mpmath.polyval(x, t), mpmath.polyval(y, t)), 0, ORDER - 2
            )
            expected = [-c / ((k + 1) * (k + 2)) for k, c in enumerate(taylor)]
            computed = series[::-1][2:]
            np.testing.assert_allclose(np.array(computed, float), np.array(expected, float), rtol=2e-13, atol=1e-15)


@texts_of(fast=1)
def test_the_tangent_map_is_the_derivative_of_the_flow(text: str) -> None:
    assert_tangent_map(text)


@pytest.mark.parametrize("text", ["½x² + exp(y)", "x³/6 + exp(y)", "x sin(y)"])
def test_simple_second_derivatives_enter_the_tangent_map(text: str) -> None:
    """V_xx is 1, x or 0."""
    assert_tangent_map(text)


def assert_tangent_map(text: str) -> None:
    kernels, state, h, shift = kernels_of(text), states_of(1)[0], 0.2, 1e-5
    deviations = np.eye(4)
    kernels.tangent(4, np.full(4, h), *(np.full(4, value) for value in state), *deviations)
    starts, ends = np.zeros((2, ROWS, LANES))
    starts[:4, :8] = np.concatenate([state + shift * np.eye(4), state - shift * np.eye(4)]).T
    kernels.limited_step(8, np.inf, np.full(LANES, h), starts, ends)
    np.testing.assert_array_equal(ends[SIZE_ROW, :8], h)
    np.testing.assert_allclose(deviations, (ends[:4, :4] - ends[:4, 4:8]) / (2.0 * shift), atol=1e-8)


@texts_of(fast=2)
def test_values_and_slopes_agree_with_numpy(text: str) -> None:
    potential, kernels = parse_formula(text), kernels_of(text)
    for x, y in states_of(5)[:, :2].tolist():
        expected = (potential.value(x, y), *potential.gradient(x, y))
        np.testing.assert_allclose(kernels.potential_slopes(x, y), expected, rtol=1e-13, atol=1e-15)
        assert kernels.potential_value(x, y) == pytest.approx(expected[0], rel=1e-14)


@texts_of(fast=1)
def test_steps_do_not_depend_on_lanes(text: str) -> None:
    kernels, states = kernels_of(text), states_of(LANES)

    def stepped(rows: np.ndarray) -> np.ndarray:
        now, new, counts = np.zeros((ROWS, LANES)), np.zeros((ROWS, LANES)), np.zeros((2, LANES), np.int64)
        now[:4, : len(rows)] = rows.T
        kernels.step(len(rows), TOLERANCE, np.inf, np.tile([0.0, 0.0, np.inf], (2, 1)), now, new, *counts)
        return new[:, : len(rows)]

    together = stepped(states)
    np.testing.assert_array_equal(together[:, :23], stepped(states[:23]))
    np.testing.assert_array_equal(together, np.column_stack([stepped(states[k : k + 1]) for k in range(LANES)]))


@pytest.mark.parametrize("size", [1e-3])
def test_steps_around_a_body_shrink_as_its_periods(size: float) -> None:
    """By Kepler's third law, the step of the same orbit in another size is proportional to size^(3/2), to 6 % for each root."""
    states, kernels = np.tile([1.0, 0.2, 0.3, 0.8], (2, 1)), load_kernels(parse_formula("−1/r").form.definition, Setting())
    states[1] *= [size, size, size**-0.5, size**-0.5]
    now, new, counts = np.zeros((ROWS, LANES)), np.zeros((ROWS, LANES)), np.zeros((2, LANES), np.int64)
    now[:4, :2] = states.T
    kernels.step(2, TOLERANCE, np.inf, np.zeros((0, 3)), now, new, *counts)
    assert new[5, 1] / new[5, 0] == pytest.approx(size**1.5, rel=0.15)


def test_a_step_outside_the_domain_fails() -> None:
    potential = Potential("", parse_formula("½r² + (1 − x)^(3/2)").form)
    now, new, counts = np.zeros((ROWS, LANES)), np.zeros((ROWS, LANES)), np.zeros((2, LANES), np.int64)
    now[0, 0] = 2.0
    load_kernels(potential.form.definition, Setting()).step(1, TOLERANCE, np.inf, np.zeros((0, 3)), now, new, *counts)
    assert np.isnan(new[5, 0])


@pytest.mark.skipif(platform.machine() != "x86_64", reason="reads the assembly of x86-64")
@texts_of(fast=0)
def test_a_step_is_vectorised_throughout(text: str) -> None:
    step = njit(error_model="numpy", fastmath={"contract"})(kernels_of(text).step.function.py_func)
    step.compile(SIGNATURES["step"])
    assembly = "".join(step.inspect_asm().values())
    packed, scalar = (len(re.findall(rf"\bv(?:fn?m|mul)\w*{kind}\b", assembly)) for kind in ("pd", "sd"))
    assert packed >= 0.9 * scalar > 300
    assert "call" not in assembly.split("vfm", 1)[1].rsplit("vfm", 1)[0]
