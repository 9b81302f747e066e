"""Generated programs of polynomials agree with power series that are multiplied term by term, without a plan of products.

The programs are run operation by operation, so that nothing is compiled.
"""

from __future__ import annotations

import operator

import numpy as np
import pytest

from engine.integrator.source.polynomial_recurrence import Terms
from engine.integrator.source.recurrence import find_structure, generate_code, outline_code
from engine.integrator.source.series import ORDER, Setting
from engine.integrator.source.straight_line import StraightLine
from tests.channel_family import channel_family

# Derivatives of V with respect to x and y, as numbers of differentiations.
GRADIENT, HESSIAN = ((1, 0), (0, 1)), ((2, 0), (1, 1), (0, 2))
DURATION = 0.1
_OPERATIONS = {"+": operator.add, "-": operator.sub, "*": operator.mul}


def run(program: StraightLine, inputs: dict[str, float], table: np.ndarray) -> np.ndarray:
    """Return the results of a program that adds and multiplies."""
    values: list[float] = []
    for symbol, operands in program.operations:
        match symbol:
            case "input":
                values.append(inputs[operands[0]])
            case "constant":
                values.append(operands[0])
            case "entry":
                values.append(table[operands[0]])
            case _:
                values.append(_OPERATIONS[symbol](*(values[k] for k in operands)))
    return np.array([values[k] for k in program.results])


def derivative_series(terms: Terms, orders: tuple[int, int], x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the series of a derivative of V, as long as the given series of x and y."""
    total = np.zeros(len(x))
    for *powers, c in terms:
        for k, order in enumerate(orders):
            for _ in range(order):
                c, powers[k] = c * powers[k], max(powers[k] - 1, 0)
        series = np.eye(1, len(x))[0]
        for factor in [x] * powers[0] + [y] * powers[1]:
            series = np.convolve(series, factor)[: len(x)]
        total += c * series
    return total


def plain_series(terms: Terms, start: np.ndarray, deviation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the series of x and y, and of a deviation in x and y, each of shape (2, ORDER + 1)."""
    orbit, tangent = np.zeros((2, ORDER + 1)), np.zeros((2, ORDER + 1))
    orbit[:, 0], orbit[:, 1], tangent[:, 0], tangent[:, 1] = start[:2], start[2:], deviation[:2], deviation[2:]
    for k in range(ORDER - 1):
        x, y = orbit[:, : k + 1]
        v_x, v_y = (derivative_series(terms, orders, x, y)[k] for orders in GRADIENT)
        v_xx, v_xy, v_yy = (derivative_series(terms, orders, x, y) for orders in HESSIAN)
        u, v = tangent[:, : k + 1]
        forces = [np.convolve(a, u)[k] + np.convolve(b, v)[k] for a, b in ((v_xx, v_xy), (v_xy, v_yy))]
        orbit[:, k + 2] = -np.array([v_x, v_y]) / ((k + 1) * (k + 2))
        tangent[:, k + 2] = -np.array(forces) / ((k + 1) * (k + 2))
    return orbit, tangent


def step_of(series: np.ndarray) -> np.ndarray:
    """Return the positions and their time derivatives after DURATION, of shape (4,)."""
    slopes = series[:, 1:] * np.arange(1, ORDER + 1)
    return np.concatenate([each @ DURATION ** np.arange(each.shape[1]) for each in (series, slopes)], axis=None)


def relative_error(computed: np.ndarray, expected: np.ndarray) -> float:
    return float(np.abs(computed - expected).max() / np.abs(expected).max())


def check(terms: Terms, rng: np.random.Generator) -> None:
    """Check the series of an orbit and one step of a deviation vector against plain evaluation."""
    structure = find_structure(terms, Setting())
    table = outline_code(structure).tabulate(terms)
    programs = {function.name: function.program for function in generate_code(structure).functions}
    start, deviation = rng.uniform(-0.6, 0.6, 4), rng.uniform(-1.0, 1.0, 4)
    inputs = dict(zip(("x0", "y0", "x1", "y1", "u0", "v0", "u1", "v1"), (*start, *deviation), strict=True), h=DURATION)
    orbit, tangent = plain_series(terms, start, deviation)
    jets = run(programs["jets"], inputs, table).reshape(2, ORDER + 1)
    assert relative_error(jets, orbit) < 1e-12, terms
    assert relative_error(run(programs["tangent"], inputs, table), step_of(tangent)) < 1e-12, terms


def random_terms(rng: np.random.Generator, degree: int) -> Terms:
    """Return up to eight terms of limited degree. In half of the cases, coefficients may be equal or opposite."""
    exponents = [(i, j) for i in range(13) for j in range(13) if 0 < i + j <= degree]
    chosen = rng.choice(exponents, min(len(exponents), int(rng.integers(1, 9))), replace=False)
    coefficients = rng.choice([-1.0, -0.5, 0.5, 1.0], len(chosen)) if rng.random() < 0.5 else rng.normal(size=len(chosen))
    return tuple((int(i), int(j), float(c)) for (i, j), c in zip(chosen, coefficients, strict=True))


def family_with_lower_terms(rng: np.random.Generator, n: int) -> Terms:
    """Return the terms of the family with n exits, plus up to three terms of lower degree."""
    terms = {(i, j): c for i, j, c in channel_family(n).terms}
    lower = [(i, j) for i in range(n) for j in range(n) if 2 < i + j < n]
    for i, j in rng.choice(lower, min(len(lower), int(rng.integers(1, 4))), replace=False) if lower else ():
        terms[int(i), int(j)] = float(rng.uniform(-0.05, 0.05))
    return tuple((i, j, c) for (i, j), c in terms.items())


def difference_of_squares(one: tuple[int, int], other: tuple[int, int]) -> Terms:
    """Return the terms of V with V_x = x + m² − n², for two monomials m and n."""
    (a, b), (c, d) = one, other
    return (2, 0, 0.5), (0, 2, 0.5), (2 * a + 1, 2 * b, 1 / (2 * a + 1)), (2 * c + 1, 2 * d, -1 / (2 * c + 1))


@pytest.mark.parametrize("degree", [3, 7])
def test_random_exponents_generate_the_equations_of_motion(degree: int) -> None:
    rng = np.random.default_rng(degree)
    for _ in range(3):
        check(random_terms(rng, degree), rng)


@pytest.mark.parametrize("n", [6])
def test_families_with_lower_terms_generate_the_equations_of_motion(n: int) -> None:
    rng = np.random.default_rng(n)
    for _ in range(2):
        check(family_with_lower_terms(rng, n), rng)


@pytest.mark.parametrize("other", [(1, 1), (3, 0)])
@pytest.mark.parametrize("one", [(1, 0), (0, 1)])
def test_differences_of_squares_generate_the_equations_of_motion(one: tuple, other: tuple) -> None:
    """The squares, such as y² and x⁴, have series of different scales."""
    check(difference_of_squares(one, other), np.random.default_rng(1))
