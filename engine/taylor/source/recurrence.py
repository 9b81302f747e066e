"""From a polynomial potential to straight-line programs for its Taylor kernels.

Along an orbit every quantity is a power series in time, and the series of a product is a Cauchy product. With
ẍ = −V_x, ÿ = −V_y and V a polynomial, coefficient k + 2 of x and y follows from coefficients 0 … k of the monomials in
V_x and V_y (Jorba & Zou 2005, Experimental Mathematics 14, 99). Written as one assignment per coefficient inside
one loop over orbits, this recurrence has neither branches nor calls, so the compiler vectorises all of it.

For each potential there are four functions with a loop over lanes `i`, and one for a single point:

``step``             one step of each orbit with a size chosen from the last coefficients, and flags for steps that may
                     contain an event;
``fixed_step``       one step of a given size, which also adds weighted x² and y² to sums;
``jets``             the coefficients of x and y: the dense output of a step;
``tangent``          propagates a deviation vector over a given time by the linearised recurrence;
``potential_value``  V at one point.

The code depends on the structure of V only, that is on its exponents and on a few facts about the coefficients
that save work (`find_difference`, `crossings_can_hide`). The coefficients are passed at run time in a table, every
function's first argument, so that potentials of the same structure share compiled code.
"""

from __future__ import annotations

import functools
import hashlib
import math
import operator
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

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
from engine.taylor.source.straight_line import TABLE, StraightLine, Value, where

ORDER = 19
"""Order of the series; with TOLERANCE the fastest tried that keeps the energy error well below 1e-11 over 1e5 time units."""

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

Entry = tuple[Monomial, float, float]
"""(term, multiple, factor): an entry of the table with the value factor · multiple · (the coefficient of a term of V)."""

# A derivative of V: for each of its monomials the term of V that it comes from, and the factor from differentiating it.
_Derivative = Mapping[Monomial, tuple[Monomial, float]]

# Derivatives of V with respect to x (0) and y (1): those in the equations of motion, and in the variational equations too.
_GRADIENT = ((0,), (1,))
_GRADIENT_AND_HESSIAN = (*_GRADIENT, (0, 0), (0, 1), (1, 1))


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
        The entries of the table, see `Entry`.
    """

    functions: tuple[GeneratedFunction, ...]
    entries: tuple[Entry, ...]

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

    def tabulate(self, terms: Terms) -> np.ndarray:
        """(m,) the table of a potential, which every function takes as its first argument; read-only."""
        polynomial = _sorted(terms)
        table = [factor * (polynomial[term] * multiple) for term, multiple, factor in self.entries]
        return read_only(np.array(table, dtype=float))


_Difference = tuple[Product, Product] | None


class _Structure(NamedTuple):
    """What generated code depends on; the differences are those of `_find_difference` without and with the Hessian."""

    monomials: tuple[Monomial, ...]
    channels: int
    can_hide: bool
    difference: _Difference
    tangent_difference: _Difference


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


_Series = Sequence[Value]


def _total(program: StraightLine, parts: Iterator[Value]) -> Value:
    """The sum from left to right, each part computed just before it is added; 0.0 for no parts."""
    first = next(parts, None)
    return program.constant(0.0) if first is None else functools.reduce(operator.add, parts, first)


def _sum_of_products(pairs: Iterable[tuple[Value, Value]]) -> Value:
    """a·b + c·d + …, nested so that each addition contracts into a multiply-add."""
    return functools.reduce(operator.add, (left * right for left, right in pairs))


def _cauchy(left: _Series, right: _Series, k: int) -> Value:
    """Coefficient k of the product of two series, or of half a square; the newest last, since the rest can start earlier."""
    if left is right:
        return _sum_of_products(_half_square(left, k))
    return _sum_of_products((left[j], right[k - j]) for j in sorted(range(k + 1), key=lambda j: max(j, k - j)))


def _half_square(series: _Series, k: int) -> Iterator[tuple[Value, Value]]:
    """The factors of the products whose sum is coefficient k of half the square of a series."""
    if k % 2 == 0:
        yield 0.5 * series[k // 2], series[k // 2]
    yield from ((series[j], series[k - j]) for j in reversed(range((k + 1) // 2)))


def _linear_combination(
    program: StraightLine,
    derived: _Derivative,
    series: Mapping[Monomial, _Series],
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

    return _total(program, (part(m) for m in reversed(list(derived)) if sum(m) > 0 or k == 0))


def _recurrence(
    program: StraightLine, monomials: tuple[Monomial, ...], products: Sequence[Product], difference: _Difference
) -> dict[Monomial, list[Value]]:
    """The series of x and y to ORDER and of `products`, where a difference of two squares is stored as the first of them."""
    series: dict[Monomial, list[Value]] = {
        X: [program.input("x0"), program.input("x1")],
        Y: [program.input("y0"), program.input("y1")],
        **{p.monomial: [] for p in products},
    }
    forces = {X: _derivative(monomials, (0,)), Y: _derivative(monomials, (1,))}
    scales = find_scales(products)
    if difference is not None:
        one, other = difference
        products = [p for p in products if p not in difference]
        forces = {axis: {m: origin for m, origin in force.items() if m != other.monomial} for axis, force in forces.items()}
    for k in range(ORDER - 1):
        for p in products:
            series[p.monomial].append(_cauchy(series[p.left], series[p.right], k))
        if difference is not None:
            subtracted = (left * right for left, right in _half_square(series[other.left], k))
            square = _cauchy(series[one.left], series[one.left], k)
            series[one.monomial].append(functools.reduce(operator.sub, subtracted, square))
        for axis, force in forces.items():
            series[axis].append(_linear_combination(program, force, series, scales, k, -1.0 / ((k + 1) * (k + 2))))
    return series


def _orbit(program: StraightLine, structure: _Structure) -> dict[Monomial, list[Value]]:
    """The recurrence with the products for the equations of motion only."""
    return _recurrence(program, structure.monomials, _plan(structure.monomials, _GRADIENT), structure.difference)


def _step_size(program: StraightLine, x: _Series, y: _Series) -> Value:
    """The h whose 16th power times a norm of the last coefficients is the tolerance, without call, square root or branch.

    The norm contains three orders of both coordinates, so that a step is not too long when one coefficient happens to vanish.
    The bits of a double, read as an integer, are its binary logarithm with a piecewise linear mantissa, and a shift by four
    divides that by 16: h is up to 6 % too long, the same on every machine. NaN marks an orbit that has broken down.
    """
    one = 1023 << 52
    last, before, earlier = (abs(x[k]) + abs(y[k]) for k in (ORDER, ORDER - 1, ORDER - 2))
    norm = last + before + _EARLIER_WEIGHT * earlier
    bits = program.apply("bits_of", norm * (1.0 / program.input("tolerance")))
    h = program.apply("double_of", (one + one // 16) - (bits >> 4))
    h = where(h < LONGEST_STEP, h, LONGEST_STEP)
    return where(norm < _LARGEST_NORM, h, math.nan)


def _horner(series: _Series, h: Value) -> tuple[Value, Value]:
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


def _hidden_crossings(y: _Series, end: Value, h: Value) -> Value:
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


def _step(structure: _Structure, table: dict[Entry, int]) -> GeneratedFunction:
    program = StraightLine("_step", table)
    series = _orbit(program, structure)
    x, y = series[X], series[Y]
    h = _step_size(program, x, y)
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


def _fixed_step(structure: _Structure, table: dict[Entry, int]) -> GeneratedFunction:
    program = StraightLine("_fixed_step", table)
    series = _orbit(program, structure)
    h = program.input("h")
    x_end, px_end = _horner(series[X], h)
    y_end, py_end = _horner(series[Y], h)
    # The sums are left to the loop: within the program they make it up to a sixth slower.
    writes: dict[str, Value | str] = {
        "sums[0, i] +=": "weight*(x0*x0)",
        "sums[1, i] +=": "weight*(y0*y0)",
        **{f"state[{row}, i] =": value for row, value in enumerate((x_end, y_end, px_end, py_end))},
    }
    return _lane_loop(program, "h, weight, state, sums", _start_in("state"), writes, rows=("state", "sums"))


def _jets(structure: _Structure, table: dict[Entry, int]) -> GeneratedFunction:
    program = StraightLine("_jets", table)
    series = _orbit(program, structure)
    writes = {f"{name}_jet[{k}, i] =": series[axis][k] for name, axis in (("x", X), ("y", Y)) for k in range(ORDER + 1)}
    return _lane_loop(program, "x, y, px, py, x_jet, y_jet", _START, writes)


def _tangent(structure: _Structure, table: dict[Entry, int]) -> GeneratedFunction:
    """Variational equations ẅ = −(Hessian of V along the orbit) w, with w = (δx, δy, δpx, δpy); eq. 4 of Zotos (2014)."""
    program = StraightLine("_tangent", table)
    products = _plan(structure.monomials, _GRADIENT_AND_HESSIAN)
    scales = find_scales(products)
    series = _recurrence(program, structure.monomials, products, structure.tangent_difference)
    hessian = {axes: _derivative(structure.monomials, axes) for axes in ((0, 0), (0, 1), (1, 1))}
    second: dict[tuple[int, int], list[Value]] = {axes: [] for axes in hessian}
    u, v = ([program.input(f"{name}{k}") for k in (0, 1)] for name in "uv")
    for k in range(ORDER - 1):
        for axes, derived in hessian.items():
            second[axes].append(_linear_combination(program, derived, series, scales, k, -1.0))
        for w, row in ((u, ((0, 0), (0, 1))), (v, ((0, 1), (1, 1)))):
            parts = (_cauchy(second[axes], other, k) for axes, other in zip(row, (u, v), strict=True) if hessian[axes])
            w.append(_total(program, parts) * (1.0 / ((k + 1) * (k + 2))))
    h = program.input("h")
    (u_end, pu_end), (v_end, pv_end) = _horner(u, h), _horner(v, h)
    reads = {**_START, "u0": "wx[i]", "v0": "wy[i]", "u1": "wpx[i]", "v1": "wpy[i]", "h": "duration[i]"}
    writes = {"wx[i] =": u_end, "wy[i] =": v_end, "wpx[i] =": pu_end, "wpy[i] =": pv_end}
    return _lane_loop(program, "duration, x, y, px, py, wx, wy, wpx, wpy", reads, writes)


def _potential_value(structure: _Structure, table: dict[Entry, int]) -> GeneratedFunction:
    """V at one point."""
    program = StraightLine("_potential_value", table)
    x, y = program.input("x"), program.input("y")
    parts = (functools.reduce(operator.mul, [x] * i + [y] * j, program.entry(((i, j), 1.0, 1.0))) for i, j in structure.monomials)
    program.results = [_total(program, parts).index]
    lines = [
        "@kernel",
        "def potential_value(coefficients, x, y):",
        f"    {TABLE} = read_table(coefficients)",
        f"    (value,) = {program.name}({', '.join(program.parameters)})",
        "    return value",
    ]
    return GeneratedFunction("potential_value", program, "\n".join(lines) + "\n")


def generate_code(terms: Terms, channels: int, reach: float = REACH) -> GeneratedCode:
    """The generated functions for a potential, the same object for all potentials of the same structure.

    Parameters
    ----------
    terms
        ((i, j, c), …) of V = Σ c x^i y^j, in any order.
    channels
        How many gates ``step`` tests, 0 or more.
    reach
        Radius about the origin, above 0, that contains all orbits.
    """
    polynomial = _sorted(terms)
    differences = (_find_difference(polynomial, derivatives) for derivatives in (_GRADIENT, _GRADIENT_AND_HESSIAN))
    return _generate(_Structure(tuple(polynomial), channels, crossings_can_hide(polynomial, reach), *differences))


def _sorted(terms: Terms) -> dict[Monomial, float]:
    """The terms by degree, so that the order in which they are given does not matter."""
    return {(i, j): c for i, j, c in sorted(terms, key=lambda term: (term[0] + term[1], -term[0]))}


@functools.lru_cache(maxsize=_STRUCTURES)
def _generate(structure: _Structure) -> GeneratedCode:
    table: dict[Entry, int] = {}
    functions = tuple(generate(structure, table) for generate in (_step, _fixed_step, _jets, _tangent, _potential_value))
    return GeneratedCode(functions, tuple(table))
