"""Write expressions as MathML, with fractions for negative powers and √ for square roots."""

from __future__ import annotations

from engine.expressions.nodes import Coordinate as CoordinateNode
from engine.expressions.nodes import Expression, Function, Product, Sum
from plots.texts.mathml_elements import COEFFICIENT_DIGITS, digits, number, op, row, var


def signed_parts(expression: Expression, shown: int = COEFFICIENT_DIGITS) -> list[str]:
    """Return the terms of a sum, each preceded by its sign; `shown` significant digits of coefficients that are decimals."""
    total = expression if isinstance(expression, Sum) else Sum(0.0, ((expression, 1.0),))
    parts = [_signed(c, part, shown) for part, c in total.terms]
    if total.constant or not parts:
        parts.append(op("−" if total.constant < 0.0 else "+") + number(abs(total.constant), shown))
    return parts


def _signed(coefficient: float, part: Expression, shown: int) -> str:
    factors = part.factors if isinstance(part, Product) else ((part, 1.0),)
    factors = tuple(sorted(factors, key=lambda factor: _factor_order(factor[0])))
    numerator = "".join(_write_power(base, exponent, shown) for base, exponent in factors if exponent > 0.0)
    denominator = "".join(_write_power(base, -exponent, shown) for base, exponent in factors if exponent < 0.0)
    magnitude = "" if abs(coefficient) == 1.0 and numerator else number(abs(coefficient), shown)
    fraction = f"<mfrac>{row(magnitude + numerator)}{row(denominator)}</mfrac>" if denominator else magnitude + numerator
    return op("−" if coefficient < 0.0 else "+") + fraction


def _factor_order(base: Expression) -> int:
    """Return the sort key of a factor. Coordinates come first, functions last."""
    return 0 if isinstance(base, CoordinateNode) else 2 if isinstance(base, Function) else 1


def _write_power(base: Expression, exponent: float, shown: int) -> str:
    match base:
        case CoordinateNode(axis):
            written = var("xy"[axis])
        case Function(name, argument):
            written = row(var(name) + _bracketed(argument, shown))
        case _:
            written = row(_bracketed(base, shown))
    if exponent == 1.0:
        return written
    if exponent == 0.5:
        return row(op("√") + written)
    power = digits(int(exponent)) if exponent == int(exponent) else number(exponent)
    return f"<msup>{written}{power}</msup>"


def _bracketed(expression: Expression, shown: int) -> str:
    parts = "".join(signed_parts(expression, shown)).removeprefix(op("+"))
    return "<mo stretchy='false'>(</mo>" + row(parts) + "<mo stretchy='false'>)</mo>"
