"""Numbers and times are written with groups of digits and typographic signs."""

from __future__ import annotations

import pytest

from engine.foundations.wording import (
    format_count,
    format_decimals,
    format_duration,
    format_number,
    format_point,
    format_share,
    format_share_range,
    format_time,
    format_whole,
)


@pytest.mark.parametrize(
    ("seconds", "text"), [(0.2, "1 s"), (41.0, "41 s"), (119.5, "120 s"), (121.0, "2 min"), (1241.0, "21 min")]
)
def test_durations_are_whole_seconds_or_minutes(seconds: float, text: str) -> None:
    assert format_duration(seconds) == text


@pytest.mark.parametrize(("value", "text"), [(999.0, "999"), (1e3, "1 000"), (123456.7, "123 457"), (1e6, "1 000 000")])
def test_whole_numbers_are_grouped(value: float, text: str) -> None:
    assert format_whole(value) == text
    assert format_count(round(value), "box", "boxes").startswith(text)


@pytest.mark.parametrize(
    ("t", "text"),
    [(0.01, "0.01"), (12.34567, "12.3457"), (100.0, "100"), (12345.678, "12 345.7"), (1e5, "100 000"), (1e7, "10 000 000")],
)
def test_times_are_grouped_and_never_in_exponent_notation(t: float, text: str) -> None:
    assert format_time(t) == text


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (-2.2, "−2.2"),
        (42.16, "42.16"),
        (1e-7, "10⁻⁷"),
        (-1.93e-12, "−1.93 × 10⁻¹²"),
        (2e12, "2 × 10¹²"),
        (float("inf"), "∞"),
        (-float("inf"), "−∞"),
    ],
)
def test_numbers_have_typographic_signs(value: float, text: str) -> None:
    assert format_number(value) == text


@pytest.mark.parametrize(("value", "text"), [(0.3123, "0.31"), (-0.3, "−0.30"), (-0.001, "0.00")])
def test_decimals_are_fixed_and_zero_has_no_sign(value: float, text: str) -> None:
    assert format_decimals(value, 2) == text


def test_percentages_have_a_unit_and_a_fixed_number_of_digits() -> None:
    assert (format_share(0.0333), format_share(0.5, 0), format_share(1.0, 2)) == ("3.3 %", "50 %", "100.00 %")


def test_a_range_of_percentages_has_one_sign() -> None:
    assert format_share_range(0.0321, 0.034) == "3.21 to 3.40 %"


def test_points_have_typographic_signs_and_six_digits_unless_others_are_asked_for() -> None:
    assert format_point(0.0, -0.38345812) == "(0, −0.383458)"
    assert format_point(-1.23456, 2.0, 3) == "(−1.23, 2)"
