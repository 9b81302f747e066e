"""Percentages as the page writes them."""

from __future__ import annotations

from app.views.components.numbers import percent, percent_range


def test_percentages() -> None:
    assert (percent(0.0333), percent(0.5, 0), percent(1.0, 2)) == ("3.3 %", "50 %", "100.00 %")


def test_a_range_of_percentages() -> None:
    assert percent_range(0.0321, 0.034) == "3.21 to 3.40 %"
