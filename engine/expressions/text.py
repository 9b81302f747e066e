"""Expressions as plain text, which the parser of formulas can read."""

from __future__ import annotations

from fractions import Fraction

from engine.expressions.nodes import Coordinate, Expression, Function, as_sum, factors_of, powers_of
from engine.foundations.wording import typeset_number

_TO_SUPERSCRIPT = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
# Largest denominator of a number that is written as a fraction.
_LARGEST_DENOMINATOR = 1000
# Largest denominator of a fraction whose decimals are finite: ½, ¼, ⅛, but 0.55125 in place of 441/800.
_LARGEST_OF_DECIMALS = 8


def short_fraction(value: float, tolerance: float) -> Fraction | None:
    """Return the fraction to be written in place of a number of at least 0; None if a decimal number is clearer.

    Fractions have denominators up to 1000, or up to 8 if their decimal expansion is finite. `tolerance` is the largest error.
    """
    fraction = Fraction(value).limit_denominator(_LARGEST_DENOMINATOR)
    is_decimal = 10**9 % fraction.denominator == 0
    if abs(float(fraction) - value) > tolerance or (is_decimal and fraction.denominator > _LARGEST_OF_DECIMALS):
        return None
    return fraction


def write_expression(expression: Expression, digits: int | None = None) -> str:
    """Return an expression as text, such as "x²/2 + y²/2 − x²y exp(−y²)".

    digits: number of significant digits; None for as many as the parser needs to read the numbers exactly.
    """
    total = as_sum(expression)
    parts: list[tuple[float, str]] = [(c, _term(part, abs(c), digits)) for part, c in total.terms]
    if total.constant or not parts:
        parts.append((total.constant, monomial_term(0, 0, abs(total.constant), digits)))
    return join_signed(parts)


def join_signed(parts: list[tuple[float, str]]) -> str:
    """Return a sum as text, given the texts of its terms, each with a number whose sign precedes the text."""
    text = ""
    for c, part in parts:
        sign = ("−" if c < 0 else "") if not text else (" − " if c < 0 else " + ")
        text += sign + part
    return text


def _term(part: Expression, magnitude: float, digits: int | None) -> str:
    """Return a positive multiple of a term. The number precedes functions, so that the parser reads the number exactly."""
    powers = powers_of(part)
    if powers is not None:
        return monomial_term(*powers, magnitude, digits)
    numerator, denominator = write_ratio(magnitude, digits)
    ratio = numerator if denominator == "1" else f"{numerator}/{denominator}"
    return _product(part, digits) if ratio == "1" else f"{ratio} {_product(part, digits)}"


def monomial_term(i: int, j: int, magnitude: float, digits: int | None) -> str:
    """Return a positive multiple of x^i y^j, such as "2x²/3"."""
    numerator, denominator = write_ratio(magnitude, digits)
    powers = monomial(i, j)
    factor = "" if numerator == "1" and powers else numerator
    return f"{factor}{powers}{f'/{denominator}' if denominator != '1' else ''}"


def monomial(i: int, j: int) -> str:
    """Return x^i y^j as text, such as "x²y"; empty for a constant."""
    return "".join(write_power(name, exponent) for name, exponent in (("x", i), ("y", j)) if exponent)


def write_ratio(magnitude: float, digits: int | None) -> tuple[str, str]:
    """Return the numerator and the denominator of a number, as a `short_fraction` or as decimals over 1."""
    fraction = short_fraction(magnitude, 0.0 if digits is None else 5.0 * 10.0**-digits * magnitude)
    if fraction is not None:
        return str(fraction.numerator), str(fraction.denominator)
    return typeset_number(repr(float(magnitude)) if digits is None else f"{magnitude:.{digits}g}", times="·"), "1"


def write_power(name: str, exponent: float) -> str:
    """Return a power of a base called `name` as text, with superscripts if the exponent is an integer."""
    if exponent == 1.0:
        return name
    if exponent == int(exponent):
        return name + str(int(exponent)).translate(_TO_SUPERSCRIPT)
    return f"{name}^({_write_exponent(exponent)})"


def _product(expression: Expression, digits: int | None) -> str:
    """Return a product, or its only factor, as text: coordinates first, then brackets, then functions."""
    text = ""
    for base, exponent in sorted(factors_of(expression), key=lambda factor: _rank(factor[0])):
        space = " " if text and isinstance(base, Function) else ""
        text += f"{space}{_factor(base, exponent, digits)}"
    return text


def _rank(base: Expression) -> int:
    """Return the rank of a factor in the text of a product."""
    return 0 if isinstance(base, Coordinate) else 2 if isinstance(base, Function) else 1


def _factor(base: Expression, exponent: float, digits: int | None) -> str:
    match base:
        case Coordinate(axis):
            return write_power("xy"[axis], exponent)
        case Function(name, argument):
            function = f"{name}({write_expression(argument, digits)})"
            return function if exponent == 1.0 else write_power(f"({function})", exponent)
    return write_power(f"({write_expression(base, digits)})", exponent)


def _write_exponent(exponent: float) -> str:
    numerator, denominator = write_ratio(abs(exponent), None)
    sign = "−" if exponent < 0.0 else ""
    return f"{sign}{numerator}{f'/{denominator}' if denominator != '1' else ''}"
