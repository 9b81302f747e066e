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
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from engine.taylor.products import Monomial, Polynomial, Product, X, Y, derivative, find_difference, find_scales, plan_products

ORDER = 19
"""Order of the series. With TOLERANCE the cheapest tried that keeps energy well within 1e-11 over 1e5 time units."""

TOLERANCE = 3e-15
"""What the last coefficients of a step's series, times the 16th power of the step, come to."""

# What the third coefficient from the end counts in the step rule, found with ORDER and TOLERANCE in `benchmarks/steps.py`.
_EARLIER_WEIGHT = 0.3

LONGEST_STEP = 1.0
"""Steps near rest or of nearly linear motion stop growing here, well within reach of the series."""

# Where no orbit inside the exits gets to within a step: the bound on how fast y oscillates is taken over this disc.
_FURTHEST = 3.0

# Coefficients that ask for steps too short to move the clock at any t_max; an orbit with these, or with NaN, has failed.
_BROKEN_DOWN = 1e90

HIDDEN, GATE, OVERSHOOT = 1, 2, 4
"""Flags of a step: crossings of y = 0 may hide in it; its end is past an exit's gate; it ends beyond the horizon."""

Terms = tuple[tuple[int, int, float], ...]


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


def _linear_combination(polynomial: Polynomial, scales: Mapping[Monomial, float], k: int, factor: float) -> str:
    """factor · (coefficient k of the polynomial's series)."""
    parts = [
        f"({factor * c!r})" if sum(m) == 0 else f"({factor * c / scales[m]!r})*{_series(m)}{k}"
        for m, c in polynomial.items()
        if sum(m) > 0 or k == 0
    ]
    return " + ".join(parts) or "0.0"


def _recurrence(vx: Polynomial, vy: Polynomial, products: list[Product], also: Sequence[Polynomial] = ()) -> list[str]:
    """Statements for x0 … x_ORDER, y0 … y_ORDER and the products that they, and the polynomials `also`, need."""
    lines = ["x0 = x[i]", "y0 = y[i]", "x1 = px[i]", "y1 = py[i]"]
    scales = find_scales(products)
    difference = find_difference(products, (vx, vy, *also))
    if difference is not None:
        one, other = difference
        products = [p for p in products if p not in difference]
        vx, vy = ({m: c for m, c in force.items() if m != other.monomial} for force in (vx, vy))
    for k in range(ORDER - 1):
        lines += [f"{_series(p.monomial)}{k} = {_cauchy(_series(p.left), _series(p.right), k)}" for p in products]
        if difference is not None:
            halves = (_half_square(_series(p.left), k) for p in difference)
            lines.append(f"{_series(one.monomial)}{k} = {_sum_of_products(*halves)}")
        factor = -1.0 / ((k + 1) * (k + 2))
        lines += [f"{name}{k + 2} = {_linear_combination(force, scales, k, factor)}" for name, force in (("x", vx), ("y", vy))]
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
        "bits = np.float64(size*(1.0/tolerance)).view(np.int64)",
        f"h = np.int64({one + one // 16} - (bits >> 4)).view(np.float64)",
        f"h = h if h < {LONGEST_STEP!r} else {LONGEST_STEP!r}",
        f"h = h if size < {_BROKEN_DOWN!r} else np.nan",
    ]


def _horner(name: str, value: str, slope: str) -> list[str]:
    """A series and its time derivative at h."""
    lines = [f"{value} = {name}{ORDER}", f"{slope} = {name}{ORDER}", f"{value} = {value}*h + {name}{ORDER - 1}"]
    for k in reversed(range(ORDER - 1)):
        lines += [f"{slope} = {slope}*h + {value}", f"{value} = {value}*h + {name}{k}"]
    return lines


def crossings_can_hide(terms: Polynomial) -> bool:
    """Can a step hold two crossings of y = 0, which the signs at its ends do not show?

    Where V is even in y, ÿ = −g(x, y) y. With g below (π/h)² two zeros of y are further than h apart, by Sturm's comparison
    with the oscillator of that frequency. Terms of g that are nowhere positive cannot raise it.
    """
    force = derivative(terms, 1)
    if any(j % 2 == 0 for _, j in force):
        return True
    bound = sum(abs(c) * _FURTHEST ** (i + j - 1) for (i, j), c in force.items() if c > 0 or i % 2 == 1)
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
    test = "gate = {flag} if gates[{k}, 0]*xh + gates[{k}, 1]*yh > gates[{k}, 2] else gate"
    return ["gate = 0", *(test.format(flag=GATE, k=k) for k in range(channels))]


def _function(signature: str, body: list[str]) -> str:
    lines = ["", "", "@kernel", f"def {signature}:", "    for i in range(n):"]
    return "\n".join([*lines, *(f"        {line}" for line in body)]) + "\n"


def _step(recurrence: list[str], hidden: list[str], channels: int) -> str:
    body = [
        *recurrence,
        *_step_size(),
        *_horner("x", "xh", "pxh"),
        *_horner("y", "yh", "pyh"),
        *hidden,
        *_gates(channels),
        "th = t[i] + h",
        f"late = 0 if th <= horizon else {OVERSHOOT}",
        "flagged = hidden + gate + late",
        "crossed[i] += 1 if (y0 < 0.0 and yh >= 0.0 and flagged == 0) else 0",
        "flag[i] = flagged",
        "h_taken[i] = h",
        "x_new[i] = xh",
        "y_new[i] = yh",
        "px_new[i] = pxh",
        "py_new[i] = pyh",
        "t_new[i] = th",
    ]
    arguments = "n, tolerance, horizon, gates, x, y, px, py, t, x_new, y_new, px_new, py_new, t_new, h_taken, flag, crossed"
    return _function(f"step({arguments})", body)


def _glide(recurrence: list[str]) -> str:
    body = [
        *recurrence,
        *_horner("x", "xh", "pxh"),
        *_horner("y", "yh", "pyh"),
        "x_square[i] += weight*(x0*x0)",
        "y_square[i] += weight*(y0*y0)",
        "x[i] = xh",
        "y[i] = yh",
        "px[i] = pxh",
        "py[i] = pyh",
    ]
    return _function("glide(n, h, weight, x, y, px, py, x_square, y_square)", body)


def _jets(recurrence: list[str]) -> str:
    stores = [f"{name}_jet[{k}, i] = {name}{k}" for name in "xy" for k in range(ORDER + 1)]
    return _function("jets(n, x, y, px, py, x_jet, y_jet)", [*recurrence, *stores])


def _tangent(terms: Polynomial) -> str:
    """Variational equations ẅ = −(Hessian of V along the orbit) w, with w = (δx, δy, δpx, δpy); eq. 4 of Zotos (2014)."""
    vx, vy = derivative(terms, 0), derivative(terms, 1)
    hessian = {"hxx": derivative(vx, 0), "hxy": derivative(vx, 1), "hyy": derivative(vy, 1)}
    forces = {"u": (("hxx", "u"), ("hxy", "v")), "v": (("hxy", "u"), ("hyy", "v"))}
    polynomials = (vx, vy, *hessian.values())
    products = plan_products({m for polynomial in polynomials for m in polynomial})
    scales = find_scales(products)
    body = [*_recurrence(vx, vy, products, tuple(hessian.values())), "u0 = wx[i]", "v0 = wy[i]", "u1 = wpx[i]", "v1 = wpy[i]"]
    for k in range(ORDER - 1):
        body += [f"{name}{k} = {_linear_combination(polynomial, scales, k, -1.0)}" for name, polynomial in hessian.items()]
        for name, pairs in forces.items():
            parts = [_cauchy(h, w, k) for h, w in pairs if hessian[h]]
            body.append(f"{name}{k + 2} = ({' + '.join(parts) or '0.0'})*({1.0 / ((k + 1) * (k + 2))!r})")
    body += ["h = duration[i]", *_horner("u", "uh", "wpx_new"), *_horner("v", "vh", "wpy_new")]
    body += ["wx[i] = uh", "wy[i] = vh", "wpx[i] = wpx_new", "wpy[i] = wpy_new"]
    return _function("tangent(n, duration, x, y, px, py, wx, wy, wpx, wpy)", body)


def _potential_value(terms: Polynomial) -> str:
    """V itself, at one point."""
    factors = [[repr(c), *["x"] * i, *["y"] * j] for (i, j), c in terms.items()]
    body = " + ".join("*".join(factor) for factor in factors) or "0.0"
    return f"\n\n@kernel\ndef potential_value(x, y):\n    return {body}\n"


def generate_source(terms: Terms, channels: int) -> str:
    """The source of ``step``, ``glide``, ``jets``, ``tangent`` and ``potential_value`` for one potential.

    Parameters
    ----------
    terms
        ((i, j, c), …) of V = Σ c x^i y^j.
    channels
        How many gates ``step`` tests.

    Returns
    -------
    Python source that needs ``np`` and ``kernel`` in its namespace.
    """
    polynomial = {(i, j): c for i, j, c in terms}
    vx, vy = derivative(polynomial, 0), derivative(polynomial, 1)
    recurrence = _recurrence(vx, vy, plan_products({*vx, *vy}))
    hidden = _hidden_crossings() if crossings_can_hide(polynomial) else ["hidden = 0"]
    return "".join(
        [
            _step(recurrence, hidden, channels),
            _glide(recurrence),
            _jets(recurrence),
            _tangent(polynomial),
            _potential_value(polynomial),
        ]
    )
