"""Intervals that contain all values of an expression on boxes, for proofs that it vanishes nowhere in a box, or once.

In interval arithmetic (Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis) each operation of a graph is replaced by
one on lower and upper ends, widened by its rounding error. The functions of NumPy are taken to be right to four units in the last
place. Where an expression is not defined on a part of a box, the intervals contain its values on the rest.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.expressions.graph import Graph, Node

# Relative and absolute widening by which the rounding error of an operation is covered.
_RELATIVE, _ABSOLUTE = 4.0 * 2.0**-52, 1e-300
# Beyond it the place of an angle in its period is not known well enough.
_LARGEST_ANGLE = 1e8


@dataclass(frozen=True)
class Interval:
    """Lower and upper ends (n,) for n boxes."""

    low: np.ndarray
    high: np.ndarray

    @property
    def size(self) -> np.ndarray:
        """(n,) the largest magnitude."""
        return np.maximum(np.abs(self.low), np.abs(self.high))

    def excludes_zero(self) -> np.ndarray:
        """(n,) whether 0 lies outside."""
        excluded: np.ndarray = (self.low > 0.0) | (self.high < 0.0)
        return excluded


@dataclass(frozen=True)
class Enclosure:
    """What is known of expressions on n boxes.

    Attributes
    ----------
    values
        An interval for each expression.
    defined
        (n,) whether all are defined and bounded on the whole box.
    nowhere
        (n,) whether one is defined nowhere in the box.
    """

    values: list[Interval]
    defined: np.ndarray
    nowhere: np.ndarray


def enclose(graph: Graph, numbers: Sequence[float], x: Interval, y: Interval) -> Enclosure:
    """Intervals of the expressions of a graph on boxes x × y."""
    found: list[Interval] = []
    nowhere, defined = np.zeros(x.low.shape, bool), np.ones(x.low.shape, bool)
    with np.errstate(all="ignore"):
        for node in graph.nodes:
            found.append(_widened(node, found, numbers, x, y))
            if node.kind in ("power", "log"):
                base = found[node.operands[0]]
                nowhere |= base.high < 0.0 if _needs_positive(node) else (base.low == 0.0) & (base.high == 0.0)
                defined &= (base.low > 0.0) | (base.high < 0.0) & (not _needs_positive(node))
    values = [found[place] for place in graph.results]
    for value in values:
        defined &= np.isfinite(value.low) & np.isfinite(value.high)
    return Enclosure(values, defined & ~nowhere, nowhere)


def _needs_positive(node: Node) -> bool:
    return node.kind == "log" or node.exponent != int(node.exponent)


def _widened(node: Node, found: list[Interval], numbers: Sequence[float], x: Interval, y: Interval) -> Interval:
    if node.kind in ("x", "y"):
        return x if node.kind == "x" else y
    # The second operand of a sine is a later node, which is not needed.
    operands = [found[place] for place in node.operands if place < len(found)]
    if node.kind in ("sum", "shift"):
        return _sum(node, operands, numbers, x)
    match node.kind:
        case "product":
            low, high = _square(operands[0]) if node.operands[0] == node.operands[1] else _product(*operands)
        case "power":
            low, high = _power(operands[0], node.exponent)
        case "exp":
            low, high = np.exp(operands[0].low), np.exp(operands[0].high)
        case "log":
            low, high = np.log(np.maximum(operands[0].low, 0.0)), np.log(np.maximum(operands[0].high, 0.0))
        case "sin":
            low, high = _sine(operands[0], 0.0)
        case _:
            low, high = _sine(operands[0], 0.5 * np.pi)
    low, high = np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)
    return Interval(low - _RELATIVE * np.abs(low) - _ABSOLUTE, high + _RELATIVE * np.abs(high) + _ABSOLUTE)


def _sum(node: Node, operands: list[Interval], numbers: Sequence[float], x: Interval) -> Interval:
    coefficients = (
        [numbers[place] for place in node.numbers] if node.kind == "sum" else [1.0, *(numbers[k] for k in node.numbers)]
    )
    low = high = np.full(x.low.shape, coefficients[-1] if len(coefficients) > len(operands) else 0.0)
    size = np.abs(low)
    for c, operand in zip(coefficients, operands, strict=False):
        first, last = (operand.low, operand.high) if c >= 0.0 else (operand.high, operand.low)
        low, high, size = low + c * first, high + c * last, size + abs(c) * operand.size
    error = _RELATIVE * len(operands) * size + _ABSOLUTE
    low, high = low - error, high + error
    return Interval(np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high))


def _product(one: Interval, other: Interval) -> tuple[np.ndarray, np.ndarray]:
    # A side that is 0 times one that is infinite gives NaN, for which the whole line is taken.
    products = np.array([a * b for a in (one.low, one.high) for b in (other.low, other.high)])
    return products.min(axis=0), products.max(axis=0)


def _square(base: Interval) -> tuple[np.ndarray, np.ndarray]:
    least = np.where((base.low <= 0.0) & (base.high >= 0.0), 0.0, np.minimum(np.abs(base.low), np.abs(base.high)))
    return least**2, base.size**2


def _power(base: Interval, exponent: float) -> tuple[np.ndarray, np.ndarray]:
    """A power that is not an integer, where the base is not negative, or −1."""
    if exponent == -1.0:
        across = (base.low < 0.0) & (base.high > 0.0)
        # An end that is 0 is approached from within.
        low, high = 1.0 / np.where(base.high == 0.0, -0.0, base.high), 1.0 / np.where(base.low == 0.0, 0.0, base.low)
        return np.where(across, -np.inf, low), np.where(across, np.inf, high)
    ends = np.maximum(base.low, 0.0) ** exponent, np.maximum(base.high, 0.0) ** exponent
    return (ends[0], ends[1]) if exponent > 0.0 else (ends[1], ends[0])


def _sine(angle: Interval, shift: float) -> tuple[np.ndarray, np.ndarray]:
    """sin(angle + shift)."""
    first, last = angle.low + shift, angle.high + shift
    margin = _RELATIVE * (np.abs(first) + np.abs(last) + 1.0)
    ends = np.sin(first) - margin, np.sin(first) + margin, np.sin(last) - margin, np.sin(last) + margin
    unknown = ~(np.maximum(np.abs(first), np.abs(last)) < _LARGEST_ANGLE)
    # Whether 2πk + π/2, where the sine is 1, or 2πk − π/2, where it is −1, lies in between.
    crest, trough = (
        np.floor((last + margin - at) / (2.0 * np.pi)) > np.floor((first - margin - at) / (2.0 * np.pi))
        for at in (0.5 * np.pi, -0.5 * np.pi)
    )
    low = np.where(unknown | trough, -1.0, np.minimum(ends[0], ends[2]))
    high = np.where(unknown | crest, 1.0, np.maximum(ends[1], ends[3]))
    return low, high
