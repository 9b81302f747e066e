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
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from engine.taylor.source.cauchy_products import (
    Monomial,
    Polynomial,
    Product,
    X,
    Y,
    derivative,
    find_difference,
    find_scales,
    plan_products,
)
from engine.taylor.source.expressions import (
    TABLE,
    Assignment,
    Expression,
    StraightLine,
    constant,
    entry,
    operation,
    total,
    variable,
)

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

HIDDEN, GATE, OVERSHOOT = 1, 2, 4
"""Flags of a step: it may hide crossings of y = 0; it ends past the gate of an exit; it ends after the horizon."""

Terms = tuple[tuple[int, int, float], ...]

Derivative = Mapping[Monomial, tuple[Monomial, float]]
"""A derivative of V: for each of its monomials the term of V that it comes from, and the factor from differentiating it."""


# Derivatives of V with respect to x (0) and y (1): those in the equations of motion, and in the variational equations too.
_GRADIENT = ((0,), (1,))
_GRADIENT_AND_HESSIAN = (*_GRADIENT, (0, 0), (0, 1), (1, 1))


class GeneratedFunction(NamedTuple):
    """A kernel as Python source, and the straight-line program that it calls."""

    name: str
    program: StraightLine
    kernel: str


@dataclass(frozen=True, eq=False)
class GeneratedCode:
    """The generated functions of all potentials of one structure.

    Attributes
    ----------
    functions
        ``step``, ``fixed_step``, ``jets``, ``tangent`` and ``potential_value``. Their kernels refer to ``kernel``,
        ``read_table`` and the names of the programs.
    entries
        (term, multiple, factor) of each entry of the table: factor · multiple · (the coefficient of the term).
    """

    functions: tuple[GeneratedFunction, ...]
    entries: tuple[tuple[Monomial, float, float], ...]

    @functools.cached_property
    def source(self) -> str:
        """All programs and kernels as text."""
        return "\n\n".join(f"{function.program}\n\n{function.kernel}" for function in self.functions)

    def tabulate(self, terms: Terms) -> np.ndarray:
        """(m,) the table of a potential, which every function takes as its first argument; read-only."""
        polynomial = _sorted(terms)
        table = np.array([factor * (polynomial[term] * multiple) for term, multiple, factor in self.entries], dtype=float)
        table.flags.writeable = False
        return table


class _Table:
    """Collects the multiples of coefficients of V that generated code reads at run time, each once."""

    def __init__(self) -> None:
        self.entries: dict[tuple[Monomial, float, float], int] = {}

    def entry(self, term: Monomial, multiple: float, factor: float = 1.0) -> Expression:
        """factor · multiple · (the coefficient of a term of V)."""
        return entry(self.entries.setdefault((term, multiple, factor), len(self.entries)))


def _derivative(monomials: Iterable[Monomial], axes: Sequence[int]) -> Derivative:
    """The derivative of V with respect to each of `axes` in turn."""
    factors: Polynomial = dict.fromkeys(monomials, 1)
    for axis in axes:
        factors = derivative(factors, axis)
    return {(i, j): ((i + axes.count(0), j + axes.count(1)), factor) for (i, j), factor in factors.items()}


@functools.cache
def _plan(monomials: tuple[Monomial, ...], derivatives: tuple[tuple[int, ...], ...]) -> tuple[Product, ...]:
    """The products from which the series of some derivatives of V are formed."""
    return tuple(plan_products(frozenset(m for axes in derivatives for m in _derivative(monomials, axes))))


def _find_difference(polynomial: Polynomial, derivatives: tuple[tuple[int, ...], ...]) -> tuple[Product, Product] | None:
    """Two squares of which only the difference enters some derivatives of V."""
    derived = [_derivative(polynomial, axes) for axes in derivatives]
    values = [{m: factor * polynomial[term] for m, (term, factor) in each.items()} for each in derived]
    return find_difference(_plan(tuple(polynomial), derivatives), values)


def _stem(monomial: Monomial) -> str:
    """Name of a monomial's series: the variables that hold its coefficients are this name and the order."""
    return {X: "x", Y: "y"}.get(monomial, f"x{monomial[0]}y{monomial[1]}_")


def _coefficient(series: str, k: int) -> Expression:
    return variable(f"{series}{k}")


_Factors = tuple[Expression, Expression]


def _sum_of_products(pairs: Sequence[_Factors], subtracted: Sequence[_Factors] = ()) -> Expression:
    """a·b + c·d + … − e·f − …, nested so that each addition contracts into a multiply-add."""
    result = total(left * right for left, right in pairs)
    for left, right in subtracted:
        result = result - left * right
    return result


def _cauchy(left: str, right: str, k: int) -> Expression:
    """Coefficient k of the product of two series, or of half a square; the newest last, since the rest can start earlier."""
    if left == right:
        return _sum_of_products(_half_square(left, k))
    order = sorted(range(k + 1), key=lambda j: max(j, k - j))
    return _sum_of_products([(_coefficient(left, j), _coefficient(right, k - j)) for j in order])


def _half_square(factor: str, k: int) -> list[_Factors]:
    pairs: list[_Factors] = [(_coefficient(factor, j), _coefficient(factor, k - j)) for j in reversed(range((k + 1) // 2))]
    middle = _coefficient(factor, k // 2)
    return pairs if k % 2 else [(0.5 * middle, middle), *pairs]


def _linear_combination(
    table: _Table, derived: Derivative, scales: Mapping[Monomial, float], k: int, factor: float
) -> Expression:
    """factor · (coefficient k of the series of a derivative of V).

    Low degrees last: a sum of two products contracts into the product that comes first, and the linear term is known earliest.
    """
    parts: list[Expression] = []
    for m, (term, multiple) in reversed(list(derived.items())):
        if sum(m) > 0:
            parts.append(table.entry(term, multiple / scales[m], factor) * _coefficient(_stem(m), k))
        elif k == 0:
            parts.append(table.entry(term, multiple / scales[m], factor))
    return total(parts)


def _recurrence(
    table: _Table, monomials: Iterable[Monomial], products: Sequence[Product], difference: tuple[Product, Product] | None
) -> list[Assignment]:
    """Assignments to x0 … x_ORDER, y0 … y_ORDER and the series of `products`, of which one may serve for a difference."""
    forces = {"x": _derivative(monomials, (0,)), "y": _derivative(monomials, (1,))}
    scales = find_scales(products)
    if difference is not None:
        one, other = difference
        products = [p for p in products if p not in difference]
        forces = {name: {m: origin for m, origin in force.items() if m != other.monomial} for name, force in forces.items()}
    body: list[Assignment] = []
    for k in range(ORDER - 1):
        body += [Assignment(f"{_stem(p.monomial)}{k}", _cauchy(_stem(p.left), _stem(p.right), k)) for p in products]
        if difference is not None:
            halves = (_half_square(_stem(p.left), k) for p in difference)
            body.append(Assignment(f"{_stem(one.monomial)}{k}", _sum_of_products(*halves)))
        factor = -1.0 / ((k + 1) * (k + 2))
        body += [
            Assignment(f"{name}{k + 2}", _linear_combination(table, force, scales, k, factor)) for name, force in forces.items()
        ]
    return body


def _step_size() -> list[Assignment]:
    """The h whose 16th power times a norm of the last coefficients is the tolerance, without call, square root or branch.

    The norm contains three orders of both coordinates, so that a step is not too long when one coefficient happens to vanish.
    The bits of a double, read as an integer, are its binary logarithm with a piecewise linear mantissa, and a shift by four
    divides that by 16: h is up to 6 % too long, the same on every machine. NaN marks an orbit that has broken down.
    """
    one = 1023 << 52
    last, before, earlier = (abs(_coefficient("x", k)) + abs(_coefficient("y", k)) for k in (ORDER, ORDER - 1, ORDER - 2))
    norm, bits, h = variable("norm"), variable("bits"), variable("h")
    return [
        Assignment("norm", last + before + _EARLIER_WEIGHT * earlier),
        Assignment("bits", operation("bits_of", norm * (1.0 / variable("tolerance")))),
        Assignment("h", operation("double_of", (one + one // 16) - (bits >> 4))),
        Assignment("h", operation("where", h < LONGEST_STEP, h, LONGEST_STEP)),
        Assignment("h", operation("where", norm < _LARGEST_NORM, h, math.nan)),
    ]


def _horner(series: str, value: str, slope: str) -> list[Assignment]:
    """Assignments to the value and the time derivative of a series at h."""
    h, at_h, slope_at_h = variable("h"), variable(value), variable(slope)
    last = _coefficient(series, ORDER)
    body = [Assignment(value, last), Assignment(slope, last), Assignment(value, at_h * h + _coefficient(series, ORDER - 1))]
    for k in reversed(range(ORDER - 1)):
        body += [Assignment(slope, slope_at_h * h + at_h), Assignment(value, at_h * h + _coefficient(series, k))]
    return body


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


def _hidden_crossings() -> list[Assignment]:
    """The test of a step for hidden crossings of y = 0, for potentials where there can be any.

    bound = ½ Σ_{k≥2} |y_k| (2h)^k is at least h · max|ẏ − ẏ(0)|, and at least twice the distance of y from its chord.
    So none hide where ẏ keeps its sign (|ẏ(0)| h > bound), nor where both ends lie on one side, further off than bound/2.
    """
    h, twice, bound, near, far = map(variable, ("h", "twice", "bound", "near", "far"))
    start, slope, end = _coefficient("y", 0), _coefficient("y", 1), variable("yh")
    body = [Assignment("twice", h + h), Assignment("bound", abs(_coefficient("y", ORDER)))]
    body += [Assignment("bound", bound * twice + abs(_coefficient("y", k))) for k in reversed(range(2, ORDER))]
    one_side = (start * end > 0.0) & (near > 0.5 * bound)
    return [
        *body,
        Assignment("bound", bound * twice * h),
        Assignment("near", abs(start)),
        Assignment("far", abs(end)),
        Assignment("near", operation("where", near < far, near, far)),
        Assignment("hidden", operation("where", abs(slope) * h > bound, 0, operation("where", one_side, 0, HIDDEN))),
    ]


def _gates(channels: int) -> list[Assignment]:
    """Whether a step ends past the gate of any exit: a line across the channel on the inner side of its exit curve."""
    body = [Assignment("gate", constant(0))]
    for k in range(channels):
        x, y, offset = (variable(f"g{k}{name}") for name in ("x", "y", ""))
        past = x * variable("xh") + y * variable("yh") > offset
        body.append(Assignment("gate", operation("where", past, GATE, variable("gate"))))
    return body


_START = {"x0": "x[i]", "y0": "y[i]", "x1": "px[i]", "y1": "py[i]"}


def _lane_loop(
    name: str,
    arguments: str,
    reads: Mapping[str, str],
    body: Sequence[Assignment],
    writes: Mapping[str, str],
    constants: Mapping[str, str] | None = None,
) -> GeneratedFunction:
    """A kernel with a loop over lanes that reads variables from arrays, runs a straight-line program and writes its results.

    `reads` and `constants` are {variable: source}, `writes` is {left-hand side with its operator: source}. Constants are read
    before the loop: read in it, each would be checked for overlap with every array that the loop writes, and beyond some 100
    checks nothing is vectorised.
    """
    assigned = {assignment.target for assignment in body}
    program = StraightLine(f"_{name}", tuple(body), tuple(source for source in writes.values() if source in assigned))
    constants = {TABLE: "read_table(coefficients)", **(constants or {})}
    lines = [
        "@kernel",
        f"def {name}(coefficients, n, {arguments}):",
        *(f"    {name} = {source}" for name, source in constants.items()),
        "    for i in range(n):",
        *(f"        {name} = {source}" for name, source in reads.items()),
        f"        ({', '.join(program.results)},) = {program.name}({', '.join(program.parameters)})",
        *(f"        {target} {source}" for target, source in writes.items()),
    ]
    return GeneratedFunction(name, program, "\n".join(lines) + "\n")


def _step(recurrence: list[Assignment], hidden: list[Assignment], channels: int) -> GeneratedFunction:
    flagged, start, end = variable("flagged"), _coefficient("y", 0), variable("yh")
    upward = (start < 0.0) & (end >= 0.0) & operation("==", flagged, 0)
    body = [
        *recurrence,
        *_step_size(),
        *_horner("x", "xh", "pxh"),
        *_horner("y", "yh", "pyh"),
        *hidden,
        *_gates(channels),
        Assignment("th", variable("t0") + variable("h")),
        Assignment("late", operation("where", variable("th") <= variable("horizon"), 0, OVERSHOOT)),
        Assignment("flagged", variable("hidden") + variable("gate") + variable("late")),
        Assignment("upward", operation("where", upward, 1, 0)),
    ]
    writes = {
        "crossed[i] +=": "upward",
        "flag[i] =": "flagged",
        "h_taken[i] =": "h",
        "x_new[i] =": "xh",
        "y_new[i] =": "yh",
        "px_new[i] =": "pxh",
        "py_new[i] =": "pyh",
        "t_new[i] =": "th",
    }
    arguments = "tolerance, horizon, gates, x, y, px, py, t, x_new, y_new, px_new, py_new, t_new, h_taken, flag, crossed"
    gates = {f"g{k}{name}": f"gates[{k}, {column}]" for k in range(channels) for column, name in enumerate(("x", "y", ""))}
    return _lane_loop("step", arguments, {**_START, "t0": "t[i]"}, body, writes, gates)


def _fixed_step(recurrence: list[Assignment]) -> GeneratedFunction:
    body = [*recurrence, *_horner("x", "xh", "pxh"), *_horner("y", "yh", "pyh")]
    writes = {
        "x_sum[i] +=": "weight*(x0*x0)",
        "y_sum[i] +=": "weight*(y0*y0)",
        "x[i] =": "xh",
        "y[i] =": "yh",
        "px[i] =": "pxh",
        "py[i] =": "pyh",
    }
    return _lane_loop("fixed_step", "h, weight, x, y, px, py, x_sum, y_sum", _START, body, writes)


def _jets(recurrence: list[Assignment]) -> GeneratedFunction:
    writes = {f"{name}_jet[{k}, i] =": f"{name}{k}" for name in "xy" for k in range(ORDER + 1)}
    return _lane_loop("jets", "x, y, px, py, x_jet, y_jet", _START, recurrence, writes)


def _tangent(table: _Table, monomials: tuple[Monomial, ...], difference: tuple[Product, Product] | None) -> GeneratedFunction:
    """Variational equations ẅ = −(Hessian of V along the orbit) w, with w = (δx, δy, δpx, δpy); eq. 4 of Zotos (2014)."""
    hessian = {name: _derivative(monomials, axes) for name, axes in (("hxx", (0, 0)), ("hxy", (0, 1)), ("hyy", (1, 1)))}
    forces = {"u": (("hxx", "u"), ("hxy", "v")), "v": (("hxy", "u"), ("hyy", "v"))}
    products = _plan(monomials, _GRADIENT_AND_HESSIAN)
    scales = find_scales(products)
    reads = {**_START, "u0": "wx[i]", "v0": "wy[i]", "u1": "wpx[i]", "v1": "wpy[i]", "h": "duration[i]"}
    body = _recurrence(table, monomials, products, difference)
    for k in range(ORDER - 1):
        body += [Assignment(f"{h}{k}", _linear_combination(table, hessian[h], scales, k, -1.0)) for h in hessian]
        for w, pairs in forces.items():
            force = total(_cauchy(h, v, k) for h, v in pairs if hessian[h])
            body.append(Assignment(f"{w}{k + 2}", force * (1.0 / ((k + 1) * (k + 2)))))
    body += [*_horner("u", "uh", "puh"), *_horner("v", "vh", "pvh")]
    writes = {"wx[i] =": "uh", "wy[i] =": "vh", "wpx[i] =": "puh", "wpy[i] =": "pvh"}
    return _lane_loop("tangent", "duration, x, y, px, py, wx, wy, wpx, wpy", reads, body, writes)


def _potential_value(table: _Table, terms: Iterable[Monomial]) -> GeneratedFunction:
    """V at one point."""
    x, y = variable("x"), variable("y")
    value = total(math.prod([x] * i + [y] * j, start=table.entry((i, j), 1.0)) for i, j in terms)
    program = StraightLine("_potential_value", (Assignment("value", value),), ("value",))
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
    return _generate(tuple(polynomial), channels, crossings_can_hide(polynomial, reach), *differences)


def _sorted(terms: Terms) -> dict[Monomial, float]:
    """The terms by degree, so that the order in which they are given does not matter."""
    return {(i, j): c for i, j, c in sorted(terms, key=lambda term: (term[0] + term[1], -term[0]))}


@functools.cache
def _generate(
    monomials: tuple[Monomial, ...],
    channels: int,
    can_hide: bool,
    difference: tuple[Product, Product] | None,
    tangent_difference: tuple[Product, Product] | None,
) -> GeneratedCode:
    table = _Table()
    recurrence = _recurrence(table, monomials, _plan(monomials, _GRADIENT), difference)
    hidden = _hidden_crossings() if can_hide else [Assignment("hidden", constant(0))]
    functions = (
        _step(recurrence, hidden, channels),
        _fixed_step(recurrence),
        _jets(recurrence),
        _tangent(table, monomials, tangent_difference),
        _potential_value(table, monomials),
    )
    return GeneratedCode(functions, tuple(table.entries))
