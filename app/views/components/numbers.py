"""Percentages as the page writes them."""

from __future__ import annotations


def percent(share: float, decimals: int = 1) -> str:
    """A share between 0 and 1 as a percentage: 3.3 %."""
    return f"{100.0 * share:.{decimals}f} %"


def percent_range(low: float, high: float, decimals: int = 2) -> str:
    """Two shares between 0 and 1 as a range of percentages: 3.21 to 3.40 %."""
    return f"{100.0 * low:.{decimals}f} to {percent(high, decimals)}"
