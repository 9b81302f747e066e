"""From a potential to straight-line programs for its Taylor kernels.

Along an orbit every quantity is a power series in time, and the series of a product is a Cauchy product. With
ẍ = −V_x, ÿ = −V_y and V a polynomial, coefficient k + 2 of x and y follows from coefficients 0 … k of the monomials in
V_x and V_y (Jorba & Zou 2005, Experimental Mathematics 14, 99). Written as one assignment per coefficient inside
one loop over orbits, this recurrence has neither branches nor calls, so the compiler vectorises all of it. Formulas with other
functions have the recurrences of `engine.taylor.source.expression_recurrence`; the functions below are the same for both.

For each potential there are four functions with a loop over lanes `i`, and one for a single point:

``step``             one step of each orbit with a size chosen from the last coefficients, and flags for steps that may
                     contain an event;
``fixed_step``       one step of a given size, which also adds weighted x² and y² to sums;
``jets``             the coefficients of x and y: the dense output of a step;
``tangent``          propagates a deviation vector over a given time by the linearised recurrence;
``potential_value``  V at one point; for expressions there is ``potential_slopes`` with V and its gradient, too.

The code depends on the structure of V only, that is on the graph of an expression, or on the exponents of a polynomial and on a
few facts about the coefficients that save work (`find_difference`, `crossings_can_hide`). The numbers are passed at run time in a
table, every function's first argument, so that potentials of the same structure share compiled code.
"""

from __future__ import annotations

import functools
import hashlib
import math
import operator
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from engine.expressions.nodes import Expression
from engine.polynomials import derivative
from engine.results.arrays import read_only
from engine.taylor.source.cauchy_products import (
    Monomial,
    Polynomial,
    Product,
    X,
    Y,
    find_difference,
    find_scales,
    plan_products,
)
from engine.taylor.source.expression_recurrence import structure_of_expression
from engine.taylor.source.series import ORDER, Hessian, PointFunctions, Series, Structure, cauchy, half_square, total
from engine.taylor.source.straight_line import TABLE, StraightLine, Value, where

TOLERANCE = 3e-15
"""Norm of the last coefficients of a step's series times the 16th power of the step size."""

# Weight of the third coefficient from the end in the step size, found together with ORDER and TOLERANCE by `benchmarks/steps.py`.
_EARLIER_WEIGHT = 0.3

LONGEST_STEP = 1.0
"""Upper limit of a step, for motion near rest or nearly linear in time; well within the convergence of the series."""

REACH = 3.0
"""Radius of a disc that contains all steps of orbits inside the exits of a well of size 1."""

# Norms of the last coefficients above this would give steps too short to change t; an orbit with these, or with NaN, has failed.
_LARGEST_NORM = 1e90

LANES = 64
"""Length of the rows of arrays with one column per orbit, of which a step computes the first ones."""

HIDDEN, GATE, OVERSHOOT = 1, 2, 4
"""Flags of a step: it may hide crossings of y = 0; it ends past the gate of an exit; it ends after the horizon."""

# Cached structures, 3 MB each with eight terms of degree 8.
_STRUCTURES = 32

Terms = tuple[tuple[int, int, float], ...]

Definition = Terms | Expression
"""What V is: ((i, j, c), …) of V = Σ c x^i y^j in any order, or an expression."""

Entry = tuple[Monomial, float, float]
"""(term, multiple, factor): an entry of the table with the value factor · multiple · (the coefficient of a term of V)."""

# A derivative of V: for each of its monomials the term of V that it comes from, and the factor from differentiating it.
_Derivative = Mapping[Monomial, tuple[Monomial, float]]

# Derivatives of V with respect to x (0) and y (1): those in the equations of motion, and in the variational equations too.
_GRADIENT, _HESSIAN = ((0,), (1,)), ((0, 0), (0, 1), (1, 1))
_GRADIENT_AND_HESSIAN = (*_GRADIENT, *_HESSIAN)


class GeneratedFunction(NamedTuple):
    """A kernel as Python source, and the straight-line program that it calls by the program's name.

    lane_inputs: the inputs of the program that differ from lane to lane, in order; the others are the same for all lanes.
    """

    name: str
    program: StraightLine
    kernel: str
    lane_inputs: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class GeneratedCode:
    """The generated functions of all potentials of one structure; equal if all programs and kernels are.

    Attributes
    ----------
    functions
        ``step``, ``fixed_step``, ``jets``, ``tangent`` and ``potential_value``. Besides the programs, their kernels refer to
        ``kernel`` and ``read_table``.
    entries
        The entries of the table, as its structure knows them.
    structure
        The structure of the potentials.
    """

    functions: tuple[GeneratedFunction, ...]
    entries: tuple[Any, ...]
    structure: Structure

    @functools.cached_property
    def digest(self) -> str:
        """A hash of all programs and kernels as text."""
        text = "\n\n".join(f"{function.program}\n\n{function.kernel}" for function in self.functions)
        return hashlib.sha256(text.encode()).hexdigest()

    @property
    def operations(self) -> int:
        """Number of operations of all programs."""
        return sum(len(function.program.operations) for function in self.functions)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, GeneratedCode) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    def tabulate(self, definition: Definition) -> np.ndarray:
        """(m,) the table of a potential, which every function takes as its first argument; read-only."""
        return read_only(np.array(self.structure.tabulate(definition, self.entries), dtype=float))


_Difference = tuple[Product, Product] | None


class _PolynomialStructure(NamedTuple):
    """What generated code depends on; the differences are those of `_find_difference` without and with the Hessian."""

    monomials: tuple[Monomial, ...]
    channels: int
    can_hide: bool
    difference: _Difference
    tangent_difference: _Difference

    @property
    def caution(self) -> float:
        """`TOLERANCE` is tuned to polynomials."""
        return 1.0

    def orbit(self, program: StraightLine) -> tuple[Series, Series]:
        """The recurrence with the products for the equations of motion only."""
        series = _recurrence(program, self.monomials, _plan(self.monomials, _GRADIENT), self.difference)
        return series[X], series[Y]

    def hessian(self, program: StraightLine) -> Hessian:
        """Each entry from the products for the variational equations, too."""
        products = _plan(self.monomials, _GRADIENT_AND_HESSIAN)
        scales = find_scales(products)
        series = _recurrence(program, self.monomials, products, self.tangent_difference)

        def entry(axes: tuple[int, int]) -> Callable[[int], Value]:
            derived = _formed_derivative(self.monomials, axes, self.tangent_difference)
            return lambda k: _linear_combination(program, derived, series, scales, k, -1.0)

        return {axes: (entry(axes), bool(_derivative(self.monomials, axes))) for axes in _HESSIAN}

    def point_functions(self) -> PointFunctions:
        """V alone."""
        return {"potential_value": lambda program: {"value": self._value(program)}}

    def _value(self, program: StraightLine) -> Value:
        x, y = program.input("x"), program.input("y")
        parts = (functools.reduce(operator.mul, [x] * i + [y] * j, program.entry(((i, j), 1.0, 1.0))) for i, j in self.monomials)
        return total(program, parts)

    def tabulate(self, terms: Any, entries: Sequence[Entry]) -> list[float]:
        """Multiples of the coefficients."""
        polynomial = _sorted(terms)
        return [factor * (polynomial[term] * multiple) for term, multiple, factor in entries]


def _derivative(monomials: Iterable[Monomial], axes: Sequence[int]) -> _Derivative:
    """The derivative of V with respect to each of `axes` in turn."""
    factors: Polynomial = dict.fromkeys(monomials, 1)
    for axis in axes:
        factors = derivative(factors, axis)
    return {(i, j): ((i + axes.count(0), j + axes.count(1)), factor) for (i, j), factor in factors.items()}


@functools.lru_cache(maxsize=2 * _STRUCTURES)
def _plan(monomials: tuple[Monomial, ...], derivatives: tuple[tuple[int, ...], ...]) -> tuple[Product, ...]:
    """The products from which the series of some derivatives of V are formed."""
    return tuple(plan_products(frozenset(m for axes in derivatives for m in _derivative(monomials, axes))))


def _find_difference(polynomial: Polynomial, derivatives: tuple[tuple[int, ...], ...]) -> _Difference:
    """Two squares of which only the difference enters some derivatives of V."""
    derived = [_derivative(polynomial, axes) for axes in derivatives]
    values = [{m: factor * polynomial[term] for m, (term, factor) in each.items()} for each in derived]
    return find_difference(_plan(tuple(polynomial), derivatives), values)


def _formed_derivative(monomials: Iterable[Monomial], axes: Sequence[int], difference: _Difference) -> _Derivative:
    """A derivative of V as a sum over the series that are formed: that of a difference stands for both squares."""
    contained = difference[1].monomial if difference is not None else None
    return {m: origin for m, origin in _derivative(monomials, axes).items() if m != contained}


def _linear_combination(
    program: StraightLine,
    derived: _Derivative,
    series: Mapping[Monomial, Series],
    scales: Mapping[Monomial, float],
    k: int,
    factor: float,
) -> Value:
    """factor · (coefficient k of the series of a derivative of V).

    Low degrees last: a sum of two products contracts into the product that comes first, and the linear term is known earliest.
    """

    def part(m: Monomial) -> Value:
        term, multiple = derived[m]
        entry = program.entry((term, multiple / scales[m], factor))
        return entry * series[m][k] if sum(m) > 0 else entry

    return total(program, (part(m) for m in reversed(list(derived)) if sum(m) > 0 or k == 0))


def _recurrence(
    program: StraightLine, monomials: tuple[Monomial, ...], products: Sequence[Product], difference: _Difference
) -> dict[Monomial, list[Value]]:
    """The series of x and y to ORDER and of `products`, where a difference of two squares is stored as the first of them."""
    series: dict[Monomial, list[Value]] = {
        X: [program.input("x0"), program.input("x1")],
        Y: [program.input("y0"), program.input("y1")],
        **{p.monomial: [] for p in products},
    }
    forces = {axis: _formed_derivative(monomials, axes, difference) for axis, axes in zip((X, Y), _GRADIENT, strict=True)}
    scales = find_scales(products)
    if difference is not None:
        one, other = difference
        products = [p for p in products if p not in difference]
    for k in range(ORDER - 1):
        for p in products:
            series[p.monomial].append(cauchy(series[p.left], series[p.right], k))
        if difference is not None:
            subtracted = (left * right for left, right in half_square(series[other.left], k))
            square = cauchy(series[one.left], series[one.left], k)
            series[one.monomial].append(functools.reduce(operator.sub, subtracted, square))
        for axis, force in forces.items():
            series[axis].append(_linear_combination(program, force, series, scales, k, -1.0 / ((k + 1) * (k + 2))))
    return series


def _step_size(program: StraightLine, x: Series, y: Series, caution: float) -> Value:
    """The h whose 16th power times a norm of the last coefficients is the tolerance, without call, square root or branch.

    The norm contains three orders of both coordinates, so that a step is not too long when one coefficient happens to vanish.
    The bits of a double, read as an integer, are its binary logarithm with a piecewise linear mantissa, and a shift by four
    divides that by 16: h is up to 6 % too long, the same on every machine. NaN marks an orbit that has broken down. The norm is
    multiplied by `caution`.
    """
    one = 1023 << 52
    last, before, earlier = (abs(x[k]) + abs(y[k]) for k in (ORDER, ORDER - 1, ORDER - 2))
    norm = last + before + _EARLIER_WEIGHT * earlier
    if caution != 1.0:
        norm = caution * norm
    bits = program.apply("bits_of", norm * (1.0 / program.input("tolerance")))
    h = program.apply("double_of", (one + one // 16) - (bits >> 4))
    h = where(h < LONGEST_STEP, h, LONGEST_STEP)
    return where(norm < _LARGEST_NORM, h, math.nan)


def _horner(series: Series, h: Value) -> tuple[Value, Value]:
    """The value and the time derivative of a series at h."""
    slope = series[ORDER]
    value = slope * h + series[ORDER - 1]
    for k in reversed(range(ORDER - 1)):
        slope = slope * h + value
        value = value * h + series[k]
    return value, slope


def crossings_can_hide(terms: Polynomial, reach: float = REACH) -> bool:
    """Whether a step can contain two crossings of y = 0 that the signs of y at its ends do not show.

    Where V is even in y, ÿ = −g(x, y) y. With g below (π/h)² two zeros of y are further than h apart, by Sturm's comparison
    with the oscillator of that frequency. Terms of g that are nowhere positive cannot raise it.
    """
    force = derivative(terms, 1)
    if any(j % 2 == 0 for _, j in force):
        return True
    bound = sum(abs(c) * reach ** (i + j - 1) for (i, j), c in force.items() if c > 0 or i % 2 == 1)
    return bound >= (math.pi / LONGEST_STEP) ** 2


def _hidden_crossings(y: Series, end: Value, h: Value) -> Value:
    """The test of a step for hidden crossings of y = 0, for potentials where there can be any: HIDDEN or 0.

    bound = ½ Σ_{k≥2} |y_k| (2h)^k is at least h · max|ẏ − ẏ(0)|, and at least twice the distance of y from its chord.
    So none hide where ẏ keeps its sign (|ẏ(0)| h > bound), nor where both ends lie on one side, further off than bound/2.
    """
    twice = h + h
    bound = abs(y[ORDER])
    for k in reversed(range(2, ORDER)):
        bound = bound * twice + abs(y[k])
    bound = bound * twice * h
    near, far = abs(y[0]), abs(end)
    near = where(near < far, near, far)
    return where(abs(y[1]) * h > bound, 0, where((y[0] * end > 0.0) & (near > 0.5 * bound), 0, HIDDEN))


def _lane_loop(
    program: StraightLine,
    arguments: str,
    reads: Mapping[str, str],
    writes: Mapping[str, Value | str],
    constants: Mapping[str, str] | None = None,
    rows: Sequence[str] = (),
) -> GeneratedFunction:
    """A kernel with a loop over lanes that reads inputs from arrays, runs a straight-line program and writes its results.

    reads, constants: {input: source}; writes: {left-hand side with its operator: value or source}. Constants are read before the
    loop: read in it, each would be checked for overlap with every array that the loop writes, and beyond some 100 checks nothing
    is vectorised. rows: the arrays whose rows have the length `LANES`. As this is a constant, the compiler knows that the rows do
    not overlap; the checks of separate arrays take as long as 16 lanes.
    """
    program.results = [value.index for value in writes.values() if isinstance(value, Value)]
    sources = {target: f"r{value.index}" if isinstance(value, Value) else value for target, value in writes.items()}
    name = program.name.removeprefix("_")
    lines = [
        "@kernel",
        f"def {name}(coefficients, n, {arguments}):",
        *(f"    if {each}.shape[1] != {LANES}: raise ValueError('{each}: must have {LANES} columns')" for each in rows),
        *(f"    {each} = {source}" for each, source in {TABLE: "read_table(coefficients)", **(constants or {})}.items()),
        "    for i in range(n):",
        *(f"        {each} = {source}" for each, source in reads.items()),
        f"        ({''.join(f'r{index}, ' for index in program.results)}) = {program.name}({', '.join(program.parameters)})",
        *(f"        {target} {source}" for target, source in sources.items()),
    ]
    return GeneratedFunction(name, program, "\n".join(lines) + "\n", tuple(reads))


_START = {"x0": "x[i]", "y0": "y[i]", "x1": "px[i]", "y1": "py[i]"}


def _start_in(lanes: str) -> dict[str, str]:
    """The inputs of the recurrence, read from the first rows of an array of lanes."""
    return {name: f"{lanes}[{row}, i]" for row, name in enumerate(_START)}


def _step(structure: Structure, table: dict[Any, int]) -> GeneratedFunction:
    program = StraightLine("_step", table)
    x, y = structure.orbit(program)
    h = _step_size(program, x, y, structure.caution)
    x_end, px_end = _horner(x, h)
    y_end, py_end = _horner(y, h)
    hidden = _hidden_crossings(y, y_end, h) if structure.can_hide else program.constant(0)
    gate, columns = program.constant(0), {"x": 0, "y": 1, "": 2}
    for k in range(structure.channels):
        g_x, g_y, g = (program.input(f"g{k}{name}") for name in columns)
        gate = where(g_x * x_end + g_y * y_end > g, GATE, gate)
    t_end = program.input("t0") + h
    flags = hidden + gate + where(t_end <= program.input("horizon"), 0, OVERSHOOT)
    writes = {
        "crossed[i] +=": where((y[0] < 0.0) & (y_end >= 0.0) & flags.equals(0), 1, 0),
        "flag[i] =": flags,
        **{f"new[{row}, i] =": value for row, value in enumerate((x_end, y_end, px_end, py_end, t_end, h))},
    }
    arguments = "tolerance, horizon, gates, now, new, flag, crossed"
    gates = {f"g{k}{name}": f"gates[{k}, {column}]" for k in range(structure.channels) for name, column in columns.items()}
    return _lane_loop(program, arguments, {**_start_in("now"), "t0": "now[4, i]"}, writes, gates, rows=("now", "new"))


def _fixed_step(structure: Structure, table: dict[Any, int]) -> GeneratedFunction:
    program = StraightLine("_fixed_step", table)
    x, y = structure.orbit(program)
    h = program.input("h")
    x_end, px_end = _horner(x, h)
    y_end, py_end = _horner(y, h)
    # The sums are left to the loop: within the program they make it up to a sixth slower.
    writes: dict[str, Value | str] = {
        "sums[0, i] +=": "weight*(x0*x0)",
        "sums[1, i] +=": "weight*(y0*y0)",
        **{f"state[{row}, i] =": value for row, value in enumerate((x_end, y_end, px_end, py_end))},
    }
    return _lane_loop(program, "h, weight, state, sums", _start_in("state"), writes, rows=("state", "sums"))


def _jets(structure: Structure, table: dict[Any, int]) -> GeneratedFunction:
    program = StraightLine("_jets", table)
    orbit = zip("xy", structure.orbit(program), strict=True)
    writes = {f"{name}_jet[{k}, i] =": series[k] for name, series in orbit for k in range(ORDER + 1)}
    return _lane_loop(program, "x, y, px, py, x_jet, y_jet", _START, writes)


def _tangent(structure: Structure, table: dict[Any, int]) -> GeneratedFunction:
    """Variational equations ẅ = −(Hessian of V along the orbit) w, with w = (δx, δy, δpx, δpy); eq. 4 of Zotos (2014)."""
    program = StraightLine("_tangent", table)
    hessian = structure.hessian(program)
    second: dict[tuple[int, int], list[Value]] = {axes: [] for axes in hessian}
    u, v = ([program.input(f"{name}{k}") for k in (0, 1)] for name in "uv")
    for k in range(ORDER - 1):
        for axes, (coefficient, _) in hessian.items():
            second[axes].append(coefficient(k))
        for w, row in ((u, ((0, 0), (0, 1))), (v, ((0, 1), (1, 1)))):
            parts = (cauchy(second[axes], other, k) for axes, other in zip(row, (u, v), strict=True) if hessian[axes][1])
            w.append(total(program, parts) * (1.0 / ((k + 1) * (k + 2))))
    h = program.input("h")
    (u_end, pu_end), (v_end, pv_end) = _horner(u, h), _horner(v, h)
    reads = {**_START, "u0": "wx[i]", "v0": "wy[i]", "u1": "wpx[i]", "v1": "wpy[i]", "h": "duration[i]"}
    writes = {"wx[i] =": u_end, "wy[i] =": v_end, "wpx[i] =": pu_end, "wpy[i] =": pv_end}
    return _lane_loop(program, "duration, x, y, px, py, wx, wy, wpx, wpy", reads, writes)


def _point_function(name: str, append: Callable[[StraightLine], Mapping[str, Value]], table: dict[Any, int]) -> GeneratedFunction:
    """A function of one point (x, y)."""
    program = StraightLine(f"_{name}", table)
    values = append(program)
    program.results = [value.index for value in values.values()]
    lines = [
        "@kernel",
        f"def {name}(coefficients, x, y):",
        f"    {TABLE} = read_table(coefficients)",
        f"    ({', '.join(values)},) = {program.name}({', '.join(program.parameters)})",
        f"    return {', '.join(values)}",
    ]
    return GeneratedFunction(name, program, "\n".join(lines) + "\n")


def generate_code(definition: Definition, channels: int, reach: float = REACH) -> GeneratedCode:
    """The generated functions for a potential, the same object for all potentials of the same structure.

    Parameters
    ----------
    definition
        ((i, j, c), …) of V = Σ c x^i y^j, in any order, or an expression.
    channels
        How many gates ``step`` tests, 0 or more.
    reach
        Radius about the origin, above 0, that contains all orbits.
    """
    return _generate(_find_structure(definition, channels, reach))


@functools.singledispatch
def _find_structure(definition: Any, channels: int, reach: float) -> Structure:
    raise TypeError(f"definition={definition!r}: must be terms or an expression")


@_find_structure.register(tuple)
def _of_polynomial(terms: Terms, channels: int, reach: float) -> Structure:
    polynomial = _sorted(terms)
    differences = (_find_difference(polynomial, derivatives) for derivatives in (_GRADIENT, _GRADIENT_AND_HESSIAN))
    return _PolynomialStructure(tuple(polynomial), channels, crossings_can_hide(polynomial, reach), *differences)


@_find_structure.register(Expression)
def _of_expression(expression: Expression, channels: int, _reach: float) -> Structure:
    return structure_of_expression(expression, channels)


def _sorted(terms: Terms) -> dict[Monomial, float]:
    """The terms by degree, so that the order in which they are given does not matter."""
    return {(i, j): c for i, j, c in sorted(terms, key=lambda term: (term[0] + term[1], -term[0]))}


@functools.lru_cache(maxsize=_STRUCTURES)
def _generate(structure: Structure) -> GeneratedCode:
    table: dict[Any, int] = {}
    functions = [
        *(generate(structure, table) for generate in (_step, _fixed_step, _jets, _tangent)),
        *(_point_function(name, append, table) for name, append in structure.point_functions().items()),
    ]
    return GeneratedCode(tuple(functions), tuple(table), structure)
