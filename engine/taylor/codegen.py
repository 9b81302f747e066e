"""From a polynomial potential to the source text of its Taylor kernels.

Along an orbit every quantity is a power series in time, and the series of a product is a Cauchy product. With
ẍ = −V_x, ÿ = −V_y and V a polynomial, coefficient k + 2 of x and y follows from coefficients 0 … k of the monomials in
V_x and V_y (Jorba & Zou 2005, Experimental Mathematics 14, 99). Written out flat, one statement a coefficient, inside
one loop over orbits, that recurrence has neither branch nor call and the compiler turns all of it into vector code.

Three functions come out for each potential, every one a loop over lanes `i`:

``step``     one step of each orbit, its size chosen from the last two coefficients, with the tests that tell whether
             anything worth a closer look may have happened within it;
``jets``     the coefficients themselves: the dense output of a step;
``tangent``  a deviation vector carried over a given time: the same recurrence, linearised.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

ORDER = 18
"""Order of the series. With TOLERANCE the cheapest tried that keeps energy well within 1e-11 over 1e5 time units."""

TOLERANCE = 1e-16
"""Size aimed at for the last terms of a step's series."""

LONGEST_STEP = 1.0
"""Steps near rest or of nearly linear motion stop growing here, well within reach of the series."""

HIDDEN, GATE, OVERSHOOT = 1, 2, 4
"""Flags of a step: crossings of y = 0 may hide in it; its end is past an exit's gate; it ends beyond the horizon."""

Monomial = tuple[int, int]
Polynomial = Mapping[Monomial, float]
Terms = tuple[tuple[int, int, float], ...]

_X, _Y = (1, 0), (0, 1)


@dataclass(frozen=True)
class _Product:
    """One Cauchy product: the series of `monomial` from the series of two factors already known."""

    monomial: Monomial
    left: Monomial
    right: Monomial


def derivative(terms: Polynomial, axis: int) -> dict[Monomial, float]:
    """The terms of ∂/∂x (axis 0) or ∂/∂y (axis 1)."""
    if axis == 0:
        return {(i - 1, j): i * c for (i, j), c in terms.items() if i}
    return {(i, j - 1): j * c for (i, j), c in terms.items() if j}


def plan_products(needed: set[Monomial]) -> list[_Product]:
    """A short list of Cauchy products that yields every needed monomial; a square counts half, as it costs half."""
    known = {_X, _Y}
    plan: list[_Product] = []
    for monomial in sorted(needed, key=lambda m: (sum(m), m)):
        if sum(monomial) < 2:
            continue
        for product in _cheapest(monomial, frozenset(known))[1]:
            known.add(product.monomial)
            plan.append(product)
    return plan


def _cheapest(monomial: Monomial, known: frozenset[Monomial]) -> tuple[float, list[_Product]]:
    if monomial in known:
        return 0.0, []
    best: tuple[float, list[_Product]] = (float("inf"), [])
    for left in ((a, b) for a in range(monomial[0] + 1) for b in range(monomial[1] + 1)):
        right = (monomial[0] - left[0], monomial[1] - left[1])
        if left < right or sum(right) == 0:
            continue
        cost_left, plan_left = _cheapest(left, known)
        cost_right, plan_right = _cheapest(right, known | {p.monomial for p in plan_left})
        cost = cost_left + cost_right + (0.5 if left == right else 1.0)
        if cost < best[0]:
            best = cost, [*plan_left, *plan_right, _Product(monomial, left, right)]
    return best


def _series(monomial: Monomial) -> str:
    """The stem of the names that hold the coefficients of a monomial's series."""
    return {_X: "x", _Y: "y"}.get(monomial, f"x{monomial[0]}y{monomial[1]}_")


def _sum_of_products(pairs: list[tuple[str, str]]) -> str:
    """a·b + c·d + …, nested so that each addition contracts into a multiply-add."""
    text = "*".join(pairs[0])
    for left, right in pairs[1:]:
        text = f"({text} + {left}*{right})"
    return text


def _cauchy(left: str, right: str, k: int) -> str:
    """Coefficient k of the product of two series; the newest coefficients last, since the rest can start earlier."""
    if left == right:
        pairs = [(f"{left}{j}", f"{left}{k - j}") for j in reversed(range((k + 1) // 2))]
        middle = f"{left}{k // 2}*{left}{k // 2}"
        if not pairs:
            return middle
        doubled = f"2.0*({_sum_of_products(pairs)})"
        return f"{doubled} + {middle}" if k % 2 == 0 else doubled
    order = sorted(range(k + 1), key=lambda j: max(j, k - j))
    return _sum_of_products([(f"{left}{j}", f"{right}{k - j}") for j in order])


def _linear_combination(polynomial: Polynomial, k: int, factor: float) -> str:
    """factor · (coefficient k of the polynomial's series)."""
    parts = [
        f"({factor * c!r})" if sum(m) == 0 else f"({factor * c!r})*{_series(m)}{k}"
        for m, c in polynomial.items()
        if sum(m) > 0 or k == 0
    ]
    return " + ".join(parts) or "0.0"


def _recurrence(vx: Polynomial, vy: Polynomial, products: list[_Product]) -> list[str]:
    """Statements for x0 … x_ORDER, y0 … y_ORDER and the products they need."""
    lines = ["x0 = x[i]", "y0 = y[i]", "x1 = px[i]", "y1 = py[i]"]
    for k in range(ORDER - 1):
        lines += [f"{_series(p.monomial)}{k} = {_cauchy(_series(p.left), _series(p.right), k)}" for p in products]
        factor = -1.0 / ((k + 1) * (k + 2))
        lines += [f"{name}{k + 2} = {_linear_combination(force, k, factor)}" for name, force in (("x", vx), ("y", vy))]
    return lines


def _step_size() -> list[str]:
    """h with h^16 · max(|last two coefficients|) = tolerance; the 16th root as four square roots, which vectorise."""
    lines = [f"largest = abs(x{ORDER})"]
    for name in (f"x{ORDER - 1}", f"y{ORDER}", f"y{ORDER - 1}"):
        lines += [f"size = abs({name})", "largest = size if size > largest else largest"]
    return [
        *lines,
        "h = math.sqrt(math.sqrt(math.sqrt(math.sqrt(tolerance / largest))))",
        f"h = h if h < {LONGEST_STEP!r} else {LONGEST_STEP!r}",
    ]


def _horner(name: str, value: str, slope: str) -> list[str]:
    """A series and its time derivative at h."""
    lines = [f"{value} = {name}{ORDER}", f"{slope} = {name}{ORDER}", f"{value} = {value}*h + {name}{ORDER - 1}"]
    for k in reversed(range(ORDER - 1)):
        lines += [f"{slope} = {slope}*h + {value}", f"{value} = {value}*h + {name}{k}"]
    return lines


def _hidden_crossings() -> list[str]:
    """Can the step hold crossings of y = 0 that the signs at its ends do not show?

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


def _step(recurrence: list[str], channels: int) -> str:
    body = [
        *recurrence,
        *_step_size(),
        *_horner("x", "xh", "pxh"),
        *_horner("y", "yh", "pyh"),
        *_hidden_crossings(),
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
    body = [*_recurrence(vx, vy, products), "u0 = wx[i]", "v0 = wy[i]", "u1 = wpx[i]", "v1 = wpy[i]"]
    for k in range(ORDER - 1):
        body += [f"{name}{k} = {_linear_combination(polynomial, k, -1.0)}" for name, polynomial in hessian.items()]
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
    """The source of ``step``, ``jets``, ``tangent`` and ``potential_value`` for one potential.

    Parameters
    ----------
    terms
        ((i, j, c), …) of V = Σ c x^i y^j.
    channels
        How many gates ``step`` tests.

    Returns
    -------
    Python source that needs ``math`` and ``kernel`` in its namespace.
    """
    polynomial = {(i, j): c for i, j, c in terms}
    vx, vy = derivative(polynomial, 0), derivative(polynomial, 1)
    recurrence = _recurrence(vx, vy, plan_products({*vx, *vy}))
    return _step(recurrence, channels) + _jets(recurrence) + _tangent(polynomial) + _potential_value(polynomial)
