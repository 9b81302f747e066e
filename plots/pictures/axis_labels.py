"""Label the ticks of axes. Where plain numbers would be too long, labels are distances from one tick."""

from __future__ import annotations

import math
from decimal import Decimal
from typing import NamedTuple

from engine.foundations.wording import format_number

# Smallest number of ticks of an axis.
_FEWEST_TICKS = 3
FINEST_PLAIN_STEP = -4
"""Ticks closer than 10 to this power have distances from the middle tick as labels, because plain labels would overlap."""


class Axis(NamedTuple):
    """Name of an axis, and position and label of each tick."""

    name: str
    ticks: list[tuple[float, str]]


class Offset(NamedTuple):
    """A number near the middle of an axis and a power of ten. Labels are distances from the number, in units of the power."""

    base: Decimal
    exponent: int

    def describe(self, name: str) -> str:
        """Return the name of the axis, an expression such as (x − 0.5) / 10⁻⁶."""
        distance = f"({name} {'−' if self.base > 0 else '+'} {abs(self.base):f})" if self.base else name
        return f"{distance} / {format_number(10.0**self.exponent)}"

    def explain(self, name: str) -> str:
        """Return the value of a coordinate as a sum with its label for an ellipsis, such as x = 0.5 + … × 10⁻⁶."""
        base = f"{self.base:f} + ".replace("-", "−") if self.base else ""
        return f"{name} = {base}… × {format_number(10.0**self.exponent)}"


def find_offset(low: float, high: float, finest: int = FINEST_PLAIN_STEP) -> Offset | None:
    """Return the offset of an axis between two numbers; None if its ticks are at least 10 to the power `finest` apart."""
    step = _step(low, high)
    exponent = step.adjusted()
    if exponent >= finest:
        return None
    ticks = _multiples(low, high, step)
    return Offset(ticks[len(ticks) // 2], exponent)


def label_axis(name: str, low: float, high: float) -> Axis:
    """Return three to eight ticks between two numbers, at multiples of 1, 2 or 5 · 10^k, with exact labels.

    If `find_offset` returns an offset, the labels are distances from the offset, and the name of the axis contains the offset.
    """
    values = _multiples(low, high, _step(low, high))
    offset = find_offset(low, high)
    if offset is None:
        labels = [f"{value:f}" for value in values]
    else:
        labels = [f"{(value - offset.base).scaleb(-offset.exponent):f}" for value in values]
        name = offset.describe(name)
    return Axis(name, [(float(value), label.replace("-", "−")) for value, label in zip(values, labels, strict=True)])


def _step(low: float, high: float) -> Decimal:
    """Return the distance between neighbouring ticks, exact so that labels have no rounding errors."""
    largest_step = (high - low) / _FEWEST_TICKS
    exponent = math.floor(math.log10(largest_step))
    mantissa = next((m for m in (5, 2) if m * 10.0**exponent <= largest_step), 1)
    return Decimal(mantissa).scaleb(exponent)


def _multiples(low: float, high: float, step: Decimal) -> list[Decimal]:
    return [number * step for number in range(math.ceil(Decimal(low) / step), math.floor(Decimal(high) / step) + 1)]
