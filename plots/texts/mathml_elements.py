"""Write parts of formulas as MathML."""

from __future__ import annotations

from math import isqrt

from engine.expressions.text import short_fraction

# Largest distance of a number, or of its square, from a short fraction by which it is written.
_ROUNDING = 1e-10
COORDINATE_DIGITS = 4
"""Significant digits of coordinates that are decimal numbers."""

COEFFICIENT_DIGITS = 12
"""Significant digits of coefficients that are decimal numbers."""


def number(value: float, shown: int = COORDINATE_DIGITS) -> str:
    """Return a number as a fraction, the square root of a fraction, or a decimal number with `shown` significant digits."""
    if value < 0.0:
        return row(op("−") + number(-value, shown))
    for power in (1, 2):
        exact = short_fraction(value**power, _ROUNDING)
        # A small number that is not 0 is not written as 0.
        if exact is not None and (exact or not value):
            numerator, denominator = (_root(n) if power == 2 else digits(n) for n in exact.as_integer_ratio())
            return numerator if denominator == digits(1) else f"<mfrac>{numerator}{denominator}</mfrac>"
    return digits(f"{value:.{shown}g}")


def _root(number: int) -> str:
    """Return the square root of an integer, with square factors taken out."""
    root_factor = max(k for k in range(1, isqrt(number) + 1) if number % k**2 == 0)
    radicand = number // root_factor**2
    if radicand == 1:
        return digits(root_factor)
    # Some browsers do not draw the sign of <msqrt> without a mathematical font.
    return digits(f"√{radicand}" if root_factor == 1 else f"{root_factor}√{radicand}")


def var(name: str) -> str:
    """Return a variable."""
    return f"<mi>{name}</mi>"


def op(sign: str) -> str:
    """Return an operator."""
    return f"<mo>{sign}</mo>"


def digits(written: int | str) -> str:
    """Return an element with the text of a number."""
    return f"<mn>{written}</mn>"


def row(formula: str) -> str:
    """Group a formula, so that a sign at its start is unary."""
    return f"<mrow>{formula}</mrow>"


def write_power(base: str, power: int) -> str:
    """Return a base to a power of at least 0; empty for the power 0."""
    return "" if power == 0 else base if power == 1 else f"<msup>{base}{digits(power)}</msup>"
