from __future__ import annotations

import pytest

from engine.wording import format_count, format_decimals, format_number


@pytest.mark.parametrize(("count", "text"), [(0, "0 boxes"), (1, "1 box"), (2, "2 boxes")])
def test_the_noun_agrees_with_the_count(count: int, text: str) -> None:
    assert format_count(count, "box", "boxes") == text


def test_the_default_plural_ends_in_s() -> None:
    assert format_count(3, "upward crossing") == "3 upward crossings"


@pytest.mark.parametrize(
    ("value", "text"), [(-2.2, "−2.2"), (42.16, "42.16"), (1e-7, "1e−07"), (float("inf"), "∞"), (-float("inf"), "−∞")]
)
def test_numbers_have_typographic_signs(value: float, text: str) -> None:
    assert format_number(value) == text


@pytest.mark.parametrize(("value", "text"), [(0.3123, "0.31"), (-0.3, "−0.30"), (-0.001, "0.00")])
def test_decimals_are_fixed_and_zero_has_no_sign(value: float, text: str) -> None:
    assert format_decimals(value, 2) == text
