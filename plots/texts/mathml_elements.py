"""Write parts of formulas as MathML."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from math import isqrt

from engine.expressions.text import short_fraction

# Largest distance of a number, or of its square, from a short fraction by which it is written.
_ROUNDING = 1e-10
# Largest number that is written as a fraction. Any larger double is close to some short fraction.
_LARGEST_FRACTION = 1e6
# Largest square of a number that is written as a root. It also limits the factors that are tried.
_LARGEST_SQUARE = 1e4

COORDINATE_DIGITS = 4
"""Significant digits of coordinates that are decimal numbers."""

COEFFICIENT_DIGITS = 12
"""Significant digits of coefficients that are decimal numbers."""


def number(value: float, shown: int = COORDINATE_DIGITS) -> str:
    """Return a number as a fraction, the square root of a fraction, or a decimal number with `shown` significant digits."""
    if value < 0.0:
        return row(op("−") + number(-value, shown))
    fraction, square = _as_fraction(value, _LARGEST_FRACTION), _as_fraction(value * value, _LARGEST_SQUARE)
    if fraction is not None:
        return _write_fraction(fraction, digits)
    # The square of a small number can be rounded to 0.
    if square:
        return _write_fraction(square, _root)
    return _decimal(f"{value:.{shown}g}")


def _decimal(written: str) -> str:
    """Return a decimal number such as "1.5e-05" with a power of ten."""
    mantissa, _, exponent = written.partition("e")
    if not exponent:
        return digits(written)
    sign = op("−") if int(exponent) < 0 else ""
    power = f"<msup>{digits(10)}{row(sign + digits(abs(int(exponent))))}</msup>"
    return power if mantissa == "1" else digits(mantissa) + op("·") + power


def _as_fraction(value: float, largest: float) -> Fraction | None:
    """Return the fraction to be written in place of a number up to `largest`; None if a decimal number is clearer."""
    fraction = short_fraction(value, _ROUNDING) if value <= largest else None
    # A small number that is not 0 is not written as 0.
    return fraction if fraction or not value else None


def _write_fraction(fraction: Fraction, write: Callable[[int], str]) -> str:
    """Return a fraction, or an integer, whose numerator and denominator are written by a function."""
    numerator, denominator = map(write, fraction.as_integer_ratio())
    return numerator if denominator == digits(1) else f"<mfrac>{numerator}{denominator}</mfrac>"


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
