"""From a polynomial potential to the source text of its Taylor kernels.

Along an orbit every quantity is a power series in time, and the series of a product is a Cauchy product. With
ẍ = −V_x, ÿ = −V_y and V a polynomial, coefficient k + 2 of x and y follows from coefficients 0 … k of the monomials in
V_x and V_y (Jorba & Zou 2005, Experimental Mathematics 14, 99). Written out flat, one statement a coefficient, inside
one loop over orbits, that recurrence has neither branch nor call and the compiler turns all of it into vector code.

Four functions come out for each potential, every one a loop over lanes `i`:

``step``     one step of each orbit, its size chosen from the last coefficients, with the tests that tell whether
             anything worth a closer look may have happened within it;
``glide``    one step of a given size, summing weighted squares of x and y on the way;
``jets``     the coefficients themselves: the dense output of a step;
``tangent``  a deviation vector carried over a given time: the same recurrence, linearised.

The source depends on the structure of V alone, that is on which exponents occur and on a few facts about the coefficients
that save work (`find_difference`, `crossings_can_hide`). Its coefficients come at run time, in a table that is every
function's first argument, so that potentials which differ in numbers only share their compiled code.
"""

from __future__ import annotations

import functools
import math
import re
from collections.abc import Iterable, Mapping, Sequence

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

ORDER = 19
"""Order of the series. With TOLERANCE the cheapest tried that keeps energy well within 1e-11 over 1e5 time units."""

TOLERANCE = 3e-15
"""What the last coefficients of a step's series, times the 16th power of the step, come to."""

# What the third coefficient from the end counts in the step rule, found with ORDER and TOLERANCE in `benchmarks/steps.py`.
_EARLIER_WEIGHT = 0.3

LONGEST_STEP = 1.0
"""Steps near rest or of nearly linear motion stop growing here, well within reach of the series."""

REACH = 3.0
"""Where no orbit inside the exits of a well of size 1 gets to within a step: y oscillates at its fastest within this disc."""

# Coefficients that ask for steps too short to move the clock at any t_max; an orbit with these, or with NaN, has failed.
_BROKEN_DOWN = 1e90

HIDDEN, GATE, OVERSHOOT = 1, 2, 4
"""Flags of a step: crossings of y = 0 may hide in it; its end is past an exit's gate; it ends beyond the horizon."""

Terms = tuple[tuple[int, int, float], ...]

Origins = Mapping[Monomial, tuple[Monomial, int]]
"""A derivative of V: for each of its monomials, the term of V that it comes from and the whole number that it has gained."""


class _Table:
    """The numbers that the source leaves open. What is the same multiple of the same coefficient of V has one entry."""

    def __init__(self, terms: Polynomial) -> None:
        self._terms = terms
        self._entries: dict[tuple[Monomial, float, float], float] = {}
        self._names: dict[tuple[Monomial, float, float], str] = {}

    def name(self, term: Monomial, multiple: float, factor: float = 1.0) -> str:
        """The local variable that holds factor · multiple · (the coefficient of a term of V)."""
        key = (term, multiple, factor)
        if key not in self._entries:
            self._names[key] = f"c{len(self._entries)}_"
            self._entries[key] = factor * (self._terms[term] * multiple)
        return self._names[key]

    def values(self) -> np.ndarray:
        """(m,) every entry, in order; read-only."""
        values = np.array(list(self._entries.values()), dtype=float)
        values.flags.writeable = False
        return values

    def differentiated(self, *axes: int) -> Origins:
        """Where the monomials of ∂^n V / ∂(axes) come from."""
        origins = {term: (term, 1) for term in self._terms}
        for axis in axes:
            gained = {m: (term, multiple * m[axis]) for m, (term, multiple) in origins.items() if m[axis]}
            origins = {(i - (axis == 0), j - (axis == 1)): origin for (i, j), origin in gained.items()}
        return origins

    def evaluated(self, origins: Origins) -> dict[Monomial, float]:
        """A derivative with its coefficients."""
        return {m: multiple * self._terms[term] for m, (term, multiple) in origins.items()}


def _series(monomial: Monomial) -> str:
    """The stem of the names that hold the coefficients of a monomial's series."""
    return {X: "x", Y: "y"}.get(monomial, f"x{monomial[0]}y{monomial[1]}_")


def _sum_of_products(pairs: list[tuple[str, str]], subtracted: Sequence[tuple[str, str]] = ()) -> str:
    """a·b + c·d + … − e·f − …, nested so that each addition contracts into a multiply-add."""
    text = "*".join(pairs[0])
    for left, right in pairs[1:]:
        text = f"({text} + {left}*{right})"
    for left, right in subtracted:
        text = f"({text} - {left}*{right})"
    return text


def _cauchy(left: str, right: str, k: int) -> str:
    """Coefficient k of the product of two series, or of half a square; the newest last, since the rest can start earlier."""
    if left == right:
        return _sum_of_products(_half_square(left, k))
    order = sorted(range(k + 1), key=lambda j: max(j, k - j))
    return _sum_of_products([(f"{left}{j}", f"{right}{k - j}") for j in order])


def _half_square(factor: str, k: int) -> list[tuple[str, str]]:
    pairs = [(f"{factor}{j}", f"{factor}{k - j}") for j in reversed(range((k + 1) // 2))]
    middle = [(f"(0.5*{factor}{k // 2})", f"{factor}{k // 2}")] if k % 2 == 0 else []
    return [*middle, *pairs]


def _linear_combination(table: _Table, origins: Origins, scales: Mapping[Monomial, float], k: int, factor: float) -> str:
    """factor · (coefficient k of the series of a derivative of V).

    Low degrees last: a sum of two products contracts into the product that comes first, and the linear term is known earliest.
    """
    parts = [
        table.name(term, multiple / scales[m], factor) + (f"*{_series(m)}{k}" if sum(m) else "")
        for m, (term, multiple) in reversed(list(origins.items()))
        if sum(m) > 0 or k == 0
    ]
    return " + ".join(parts) or "0.0"


def _recurrence(table: _Table, products: list[Product], also: Sequence[Origins] = ()) -> list[str]:
    """Statements for x0 … x_ORDER, y0 … y_ORDER and the products that they, and the derivatives `also`, need."""
    vx, vy = table.differentiated(0), table.differentiated(1)
    lines: list[str] = []
    scales = find_scales(products)
    difference = find_difference(products, [table.evaluated(origins) for origins in (vx, vy, *also)])
    if difference is not None:
        one, other = difference
        products = [p for p in products if p not in difference]
        vx, vy = ({m: origin for m, origin in force.items() if m != other.monomial} for force in (vx, vy))
    for k in range(ORDER - 1):
        lines += [f"{_series(p.monomial)}{k} = {_cauchy(_series(p.left), _series(p.right), k)}" for p in products]
        if difference is not None:
            halves = (_half_square(_series(p.left), k) for p in difference)
            lines.append(f"{_series(one.monomial)}{k} = {_sum_of_products(*halves)}")
        factor = -1.0 / ((k + 1) * (k + 2))
        lines += [
            f"{name}{k + 2} = {_linear_combination(table, force, scales, k, factor)}" for name, force in (("x", vx), ("y", vy))
        ]
    return lines


def _step_size() -> list[str]:
    """The h whose 16th power times a norm of the last coefficients is the tolerance: no call, no square root, no branch.

    Three orders of both coordinates, so that a coefficient that happens to vanish leaves no step too long. The bits of a
    double, read as an integer, are its binary logarithm but for a piecewise linear mantissa, and a shift by four divides
    that by 16: h comes out up to 6 % too long, the same on every machine. NaN marks an orbit that has broken down.
    """
    one = 1023 << 52
    last, before, earlier = (f"(abs(x{k}) + abs(y{k}))" for k in (ORDER, ORDER - 1, ORDER - 2))
    return [
        f"size = {last} + {before} + {_EARLIER_WEIGHT!r}*{earlier}",
        "bits = bits_of(size*(1.0/tolerance))",
        f"h = double_of({one + one // 16} - (bits >> 4))",
        f"h = h if h < {LONGEST_STEP!r} else {LONGEST_STEP!r}",
        f"h = h if size < {_BROKEN_DOWN!r} else np.nan",
    ]


def _horner(name: str, value: str, slope: str) -> list[str]:
    """A series and its time derivative at h."""
    lines = [f"{value} = {name}{ORDER}", f"{slope} = {name}{ORDER}", f"{value} = {value}*h + {name}{ORDER - 1}"]
    for k in reversed(range(ORDER - 1)):
        lines += [f"{slope} = {slope}*h + {value}", f"{value} = {value}*h + {name}{k}"]
    return lines


def crossings_can_hide(terms: Polynomial, reach: float = REACH) -> bool:
    """Can a step hold two crossings of y = 0, which the signs at its ends do not show?

    Where V is even in y, ÿ = −g(x, y) y. With g below (π/h)² two zeros of y are further than h apart, by Sturm's comparison
    with the oscillator of that frequency. Terms of g that are nowhere positive cannot raise it.
    """
    force = derivative(terms, 1)
    if any(j % 2 == 0 for _, j in force):
        return True
    bound = sum(abs(c) * reach ** (i + j - 1) for (i, j), c in force.items() if c > 0 or i % 2 == 1)
    return bound >= (math.pi / LONGEST_STEP) ** 2


def _hidden_crossings() -> list[str]:
    """The test of a step for crossings of y = 0 that may hide in it, where they can.

    bound = ½ Σ_{k≥2} |y_k| (2h)^k is at least h · max|ẏ − ẏ(0)|, and at least twice the distance of y from its chord.
    So none hide where ẏ keeps its sign (|ẏ(0)| h > bound), nor where both ends lie on one side, further off than bound/2.
    """
    lines = ["twice = h + h", f"bound = abs(y{ORDER})"]
    lines += [f"bound = bound*twice + abs(y{k})" for k in reversed(range(2, ORDER))]
    return [
        *lines,
        "bound = bound*twice*h",
        "near = abs(y0)",
        "far = abs(yh)",
        "near = near if near < far else far",
        f"hidden = 0 if abs(y1)*h > bound else (0 if (y0*yh > 0.0 and near > 0.5*bound) else {HIDDEN})",
    ]


def _gates(channels: int) -> list[str]:
    """Is the end of the step past any exit's gate: the line across a channel that its exit curve lies beyond?"""
    test = "gate = {flag} if g{k}x*xh + g{k}y*yh > g{k} else gate"
    return ["gate = 0", *(test.format(flag=GATE, k=k) for k in range(channels))]


def _entries(body: Iterable[str]) -> list[str]:
    """Statements that take the entries that `body` names out of the table."""
    used = {int(n) for n in re.findall(r"\bc(\d+)_\b", "\n".join(body))}
    return [f"c{n}_ = table[{n}]" for n in sorted(used)]


def _split(statement: str) -> tuple[str, str]:
    left, right = re.split(r" \+?= ", statement, maxsplit=1)
    return left, right


_Statements = Sequence[str]


def _function(
    name: str, arguments: str, reads: _Statements, body: _Statements, writes: _Statements, before: _Statements = ()
) -> str:
    """A loop over lanes: each reads its numbers, computes in straight lines, writes."""
    body = [*_entries(body), *body]
    made = {_split(line)[0] for line in body}
    named = [n for line in body for n in re.findall(r"(?<![\w.])[a-z]\w*\b(?![(.])", _split(line)[1])]
    taken = list(dict.fromkeys(n for n in named if n not in made and n not in _WORDS))
    given = list(dict.fromkeys(n for line in writes for n in re.findall(r"\b[a-z]\w*\b", _split(line)[1]) if n in made))
    lines = ["", "", "@straight_line", f"def _{name}({', '.join(taken)}):"]
    lines += [f"    {line}" for line in (*body, f"return ({', '.join(given)},)")]
    lines += ["", "", "@kernel", f"def {name}(coefficients, n, {arguments}):"]
    # Read in the loop, each would be checked against all that the loop writes; past some 100 checks nothing is vector code.
    lines += [f"    {line}" for line in ("table = read_table(coefficients)", *before, "for i in range(n):")]
    lines += [f"        {line}" for line in (*reads, f"({', '.join(given)},) = _{name}({', '.join(taken)})", *writes)]
    return "\n".join(lines) + "\n"


# What an expression of straight lines may name beside its numbers.
_WORDS = frozenset({"if", "else", "and", "np"})

_START = ("x0 = x[i]", "y0 = y[i]", "x1 = px[i]", "y1 = py[i]")


def _step(recurrence: list[str], hidden: list[str], channels: int) -> str:
    body = [
        *recurrence,
        *_step_size(),
        *_horner("x", "xh", "pxh"),
        *_horner("y", "yh", "pyh"),
        *hidden,
        *_gates(channels),
        "th = t0 + h",
        f"late = 0 if th <= horizon else {OVERSHOOT}",
        "flagged = hidden + gate + late",
        "upward = 1 if ((y0 < 0.0 and yh >= 0.0) and flagged == 0) else 0",
    ]
    writes = [
        "crossed[i] += upward",
        "flag[i] = flagged",
        "h_taken[i] = h",
        "x_new[i] = xh",
        "y_new[i] = yh",
        "px_new[i] = pxh",
        "py_new[i] = pyh",
        "t_new[i] = th",
    ]
    arguments = "tolerance, horizon, gates, x, y, px, py, t, x_new, y_new, px_new, py_new, t_new, h_taken, flag, crossed"
    gates = [f"g{k}{w} = gates[{k}, {c}]" for k in range(channels) for c, w in enumerate(("x", "y", ""))]
    return _function("step", arguments, [*_START, "t0 = t[i]"], body, writes, gates)


def _glide(recurrence: list[str]) -> str:
    body = [
        *recurrence,
        *_horner("x", "xh", "pxh"),
        *_horner("y", "yh", "pyh"),
    ]
    writes = [
        "x_square[i] += weight*(x0*x0)",
        "y_square[i] += weight*(y0*y0)",
        "x[i] = xh",
        "y[i] = yh",
        "px[i] = pxh",
        "py[i] = pyh",
    ]
    return _function("glide", "h, weight, x, y, px, py, x_square, y_square", _START, body, writes)


def _jets(recurrence: list[str]) -> str:
    stores = [f"{name}_jet[{k}, i] = {name}{k}" for name in "xy" for k in range(ORDER + 1)]
    return _function("jets", "x, y, px, py, x_jet, y_jet", _START, recurrence, stores)


def _tangent(table: _Table) -> str:
    """Variational equations ẅ = −(Hessian of V along the orbit) w, with w = (δx, δy, δpx, δpy); eq. 4 of Zotos (2014)."""
    hessian = {name: table.differentiated(*axes) for name, axes in (("hxx", (0, 0)), ("hxy", (0, 1)), ("hyy", (1, 1)))}
    forces = {"u": (("hxx", "u"), ("hxy", "v")), "v": (("hxy", "u"), ("hyy", "v"))}
    needed = (table.differentiated(0), table.differentiated(1), *hessian.values())
    products = plan_products(frozenset(m for origins in needed for m in origins))
    scales = find_scales(products)
    reads = [*_START, "u0 = wx[i]", "v0 = wy[i]", "u1 = wpx[i]", "v1 = wpy[i]", "h = duration[i]"]
    body = _recurrence(table, products, tuple(hessian.values()))
    for k in range(ORDER - 1):
        body += [f"{name}{k} = {_linear_combination(table, origins, scales, k, -1.0)}" for name, origins in hessian.items()]
        for name, pairs in forces.items():
            parts = [_cauchy(h, w, k) for h, w in pairs if hessian[h]]
            body.append(f"{name}{k + 2} = ({' + '.join(parts) or '0.0'})*({1.0 / ((k + 1) * (k + 2))!r})")
    body += [*_horner("u", "uh", "wpx_new"), *_horner("v", "vh", "wpy_new")]
    writes = ["wx[i] = uh", "wy[i] = vh", "wpx[i] = wpx_new", "wpy[i] = wpy_new"]
    return _function("tangent", "duration, x, y, px, py, wx, wy, wpx, wpy", reads, body, writes)


def _potential_value(table: _Table, terms: Iterable[Monomial]) -> str:
    """V itself, at one point."""
    body = " + ".join("*".join([table.name((i, j), 1.0), *["x"] * i, *["y"] * j]) for i, j in terms) or "0.0"
    entries = re.sub(r"\bc(\d+)_", r"coefficients[\1]", body)
    return f"\n\n@kernel\ndef potential_value(coefficients, x, y):\n    return {entries}\n"


def generate_source(terms: Terms, channels: int, reach: float = REACH) -> str:
    """The source of ``step``, ``glide``, ``jets``, ``tangent`` and ``potential_value`` for the structure of one potential.

    Parameters
    ----------
    terms
        ((i, j, c), …) of V = Σ c x^i y^j, in any order.
    channels
        How many gates ``step`` tests.
    reach
        How far from the origin orbits get, above 0.

    Returns
    -------
    Python source that needs ``np``, ``kernel``, ``straight_line`` and ``table_reader`` in its namespace.
    The first argument of each function is the table of
    `tabulate_coefficients`; no coefficient of V stands in the text.
    """
    return _generate(terms, channels, reach)[0]


def tabulate_coefficients(terms: Terms) -> np.ndarray:
    """(m,) what the functions of `generate_source` take as their first argument, for a potential of these terms; read-only."""
    return _generate(terms, 0)[1]


@functools.lru_cache(maxsize=64)
def _generate(terms: Terms, channels: int, reach: float = REACH) -> tuple[str, np.ndarray]:
    # One order for all who write the same potential.
    polynomial = {(i, j): c for i, j, c in sorted(terms, key=lambda term: (term[0] + term[1], -term[0]))}
    table = _Table(polynomial)
    recurrence = _recurrence(table, plan_products(frozenset({*table.differentiated(0), *table.differentiated(1)})))
    hidden = _hidden_crossings() if crossings_can_hide(polynomial, reach) else ["hidden = 0"]
    functions = [
        _step(recurrence, hidden, channels),
        _glide(recurrence),
        _jets(recurrence),
        _tangent(table),
        _potential_value(table, polynomial),
    ]
    values = table.values()
    return f"\n\nread_table = table_reader({values.size})\n" + "".join(functions), values
