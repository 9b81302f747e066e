"""Formulas of a system as MathML, derived from the terms of its potential."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from html import escape
from math import isqrt
from xml.etree import ElementTree

from engine import Potential

# Numbers this close to a fraction with a small denominator, or to the square root of one, are shown as such.
_ROUNDING = 1e-10
_LARGEST_DENOMINATOR = 100
_COORDINATE_DIGITS, _COEFFICIENT_DIGITS = 4, 12

_SPOKEN = {"+": "plus", "−": "minus", "=": "equals", "∂": "partial", "˙": "dot", "¨": "double dot"}
_POWERS = {"2": "squared", "3": "cubed"}


def equations(potential: Potential) -> str:
    """HTML list of Hamiltonian, potential, equations of motion, energy integral, escape energy and saddles."""
    rows = {
        "Hamiltonian": [_var("H") + _op("=") + _energy(_momentum_squared("x"), _momentum_squared("y"))],
        "Potential": [_potential(potential)],
        "Equations of motion": [_motion("x", potential.derivative(1, 0)), _motion("y", potential.derivative(0, 1))],
        "Energy integral": [_energy(_raised(_above("x", "˙"), 2), _raised(_above("y", "˙"), 2)) + _op("=") + _var("h")],
        **_exits(potential),
    }
    style = "font-size:17px;margin:2px 0 8px 12px;display:flex;flex-wrap:wrap;align-items:center;gap:4px 28px;overflow-x:auto"
    body = "".join(f"<dt>{name}</dt><dd style='{style}'>{''.join(map(_math, row))}</dd>" for name, row in rows.items())
    return f"<dl style='margin:0;font-size:13px;color:inherit'>{body}</dl>"


def potential_formula(potential: Potential) -> str:
    """MathML of V(x, y) = …"""
    return _math(_potential(potential))


def _potential(potential: Potential) -> str:
    return _V_AT_POINT + _op("=") + _polynomial({(i, j): c for i, j, c in potential.terms})


def _exits(potential: Potential) -> dict[str, list[str]]:
    """Escape energy, and saddles in the order of the channels; empty if there are no channels."""
    if not potential.channels:
        return {}
    escape_energy = f"<msub>{_var('h')}<mtext>esc</mtext></msub>" + _op("=") + _number(potential.escape_energy)
    points = (_op("(") + _number(x) + _op(",") + _number(y) + _op(")") for x, y in potential.saddles)
    saddles = [f"<mtext>channel {k}:\u00a0</mtext>{point}" for k, point in enumerate(points, start=1)]
    return {"Escape energy": [escape_energy], "Saddles (x, y) of the potential": saddles}


def _motion(axis: str, slope: Mapping[tuple[int, int], float]) -> str:
    """Acceleration = −∂V/∂axis, with the derivative written out."""
    partial = f"<mfrac>{_row(_op('∂') + _var('V'))}{_row(_op('∂') + _var(axis))}</mfrac>"
    force = _polynomial({powers: -c for powers, c in slope.items()})
    return _above(axis, "¨") + _op("=") + _row(_op("−") + partial) + _op("=") + force


def _energy(first: str, second: str) -> str:
    """½(first + second) + V(x, y)."""
    squares = _op("(") + first + _op("+") + second + _op(")")
    return _number(0.5) + squares + _op("+") + _V_AT_POINT


def _polynomial(terms: Mapping[tuple[int, int], float]) -> str:
    """Σ c x^i y^j, in the order of the terms."""
    text = "".join(_signed(c, _raised(_var("x"), i) + _raised(_var("y"), j)) for (i, j), c in terms.items())
    return _row(text.removeprefix(_op("+"))) if text else _number(0.0)


def _signed(coefficient: float, monomial: str) -> str:
    size = abs(coefficient)
    factor = "" if size == 1.0 and monomial else _number(size, _COEFFICIENT_DIGITS)
    return _op("−" if coefficient < 0.0 else "+") + factor + monomial


def _number(value: float, digits: int = _COORDINATE_DIGITS) -> str:
    """Fraction, square root of a fraction, or decimal number."""
    if value < 0.0:
        return _row(_op("−") + _number(-value, digits))
    for power in (1, 2):
        exact = Fraction(value**power).limit_denominator(_LARGEST_DENOMINATOR)
        if abs(float(exact) - value**power) <= _ROUNDING and (exact or not value):
            numerator, denominator = (_root(n) if power == 2 else _digits(n) for n in exact.as_integer_ratio())
            return numerator if denominator == _digits(1) else f"<mfrac>{numerator}{denominator}</mfrac>"
    return _digits(f"{value:.{digits}g}")


def _root(number: int) -> str:
    """Square root of an integer, with square factors taken out."""
    outside = max(k for k in range(1, isqrt(number) + 1) if number % k**2 == 0)
    inside = number // outside**2
    if inside == 1:
        return _digits(outside)
    # Some browsers do not draw the sign of <msqrt> without a mathematical font.
    return _digits(f"√{inside}" if outside == 1 else f"{outside}√{inside}")


def _math(formula: str) -> str:
    words = escape(_words(ElementTree.fromstring(f"<math>{formula}</math>")))
    return f'<math display="block" alttext="{words}" aria-label="{words}">{formula}</math>'


def _words(node: ElementTree.Element) -> str:
    """Text of a formula for screen readers."""
    parts = [_words(child) for child in node]
    if node.tag == "mfrac":
        return "/".join(parts) if all(part.isdecimal() for part in parts) else " over ".join(parts)
    if node.tag == "msup":
        return f"{parts[0]} {_POWERS.get(parts[1], f'to the power of {parts[1]}')}"
    if node.tag in ("msub", "msubsup"):
        return " ".join((parts[0], "sub", parts[1], *(_POWERS[power] for power in parts[2:])))
    text = (node.text or "").strip().replace("√", " square root of ").strip()
    return " ".join([_SPOKEN.get(text, text), *parts]).strip()


def _var(name: str) -> str:
    return f"<mi>{name}</mi>"


def _op(sign: str) -> str:
    return f"<mo>{sign}</mo>"


def _digits(number: int | str) -> str:
    return f"<mn>{number}</mn>"


def _row(formula: str) -> str:
    """Group a formula, so that a sign at its start is unary."""
    return f"<mrow>{formula}</mrow>"


def _raised(base: str, power: int) -> str:
    return "" if power == 0 else base if power == 1 else f"<msup>{base}{_digits(power)}</msup>"


def _above(name: str, dots: str) -> str:
    return f"<mover accent='true'>{_var(name)}{_op(dots)}</mover>"


def _momentum_squared(axis: str) -> str:
    return f"<msubsup>{_var('p')}{_var(axis)}{_digits(2)}</msubsup>"


_V_AT_POINT = _var("V") + _op("(") + _var("x") + _op(",") + _var("y") + _op(")")
