"""Numbers and counts in sentences."""

from __future__ import annotations

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def format_count(count: int, singular: str, plural: str = "") -> str:
    """A count and its noun, such as "1 box" or "3 boxes"; without `plural`, the noun takes an "s"."""
    return f"{format_whole(count)} {singular if count == 1 else plural or f'{singular}s'}"


def format_whole(value: float) -> str:
    """A number rounded to a whole one, with spaces between groups of three digits, such as "100 000"."""
    return f"{round(value):,}".replace(",", " ")


def format_time(t: float, digits: int = 6) -> str:
    """A time to `digits` significant digits, or all digits of its whole part, with spaces between groups of three of these."""
    if t == round(t) or abs(t) >= 10.0**digits:
        return format_whole(t)
    return f"{t:,.{digits}g}".replace(",", " ")


def format_number(value: float, digits: int = 4) -> str:
    """A number to `digits` significant digits, with typographic minus and infinity signs, such as "1.9 × 10⁻¹²"."""
    return _typeset(f"{value:.{digits}g}")


def format_decimals(value: float, decimals: int) -> str:
    """A number to `decimals` decimals, with a typographic minus sign and without a negative zero."""
    return _typeset(f"{round(value, decimals) + 0.0:.{decimals}f}")


def _typeset(text: str) -> str:
    mantissa, _, exponent = text.partition("e")
    number = mantissa.replace("-", "−").replace("inf", "∞")
    if not exponent:
        return number
    power = f"10{str(int(exponent)).translate(_SUPERSCRIPTS)}"
    return power if number == "1" else f"{number} × {power}"
