"""Numbers in formulas are written as short fractions."""

from __future__ import annotations

from fractions import Fraction

import pytest

from engine.expressions.text import short_fraction


@pytest.mark.parametrize("text", ["0", "1/2", "3/4", "121/8", "1/3", "1/120", "10/81"])
def test_short_fractions_stay_fractions(text: str) -> None:
    assert short_fraction(float(Fraction(text)), 0.0) == Fraction(text)


def test_a_fraction_is_as_close_as_the_tolerance() -> None:
    assert short_fraction(1.0 / 3.0 + 1e-9, 1e-10) is None
    assert short_fraction(1.0 / 3.0 + 1e-9, 1e-8) == Fraction(1, 3)
