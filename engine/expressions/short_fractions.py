"""The choice of numbers that formulas show as fractions."""

from __future__ import annotations

from fractions import Fraction

_LARGEST_DENOMINATOR = 1000
# Numbers with a finite decimal expansion are written as fractions up to this denominator: ½, ¼, ⅛, but 0.55125, not 441/800.
_LARGEST_OF_DECIMALS = 8


def short_fraction(value: float, tolerance: float) -> Fraction | None:
    """Return the fraction shown in place of a number of at least 0; None if a decimal number is clearer.

    Fractions have denominators up to 1000, or up to 8 if their decimal expansion is finite. `tolerance` is the largest error.
    """
    fraction = Fraction(value).limit_denominator(_LARGEST_DENOMINATOR)
    is_decimal = 10**9 % fraction.denominator == 0
    if abs(float(fraction) - value) > tolerance or (is_decimal and fraction.denominator > _LARGEST_OF_DECIMALS):
        return None
    return fraction
