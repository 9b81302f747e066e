"""Numbers as the page writes them."""

from __future__ import annotations

from engine.service import format_whole


def grouped(value: float) -> str:
    """A whole number with spaces between groups of three digits: 100 000."""
    return format_whole(value)


def percent(share: float, decimals: int = 1) -> str:
    """A share between 0 and 1 as a percentage: 3.3 %."""
    return f"{100.0 * share:.{decimals}f} %"
