"""Intervals that contain all values of an expression on boxes, for proofs that a box contains no zero or exactly one.

In interval arithmetic (Moore, Kearfott & Cloud 2009, Introduction to Interval Analysis) each operation of a graph is replaced by
an operation on lower and upper ends, and the rounding error widens the result. The functions of NumPy are assumed to be accurate
to four units in the last place. If an expression is undefined on part of a box, the interval contains its values on the rest.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.expressions.evaluation import Operations, node_values
from engine.expressions.graph import Graph, Node

# Relative widening of an end by four units in the last place, which covers the rounding error of an operation.
_ROUNDING = 4.0 * 2.0**-52
# Absolute widening of an end, which covers underflow.
_UNDERFLOW = 1e-300
# Largest angle of a sine, in radians. For larger angles, the position within a period is not accurate enough.
_LARGEST_ANGLE = 1e8


@dataclass(frozen=True)
class Interval:
    """Lower and upper ends of the values on n boxes, each of shape (n,)."""

    low: np.ndarray
    high: np.ndarray

    @property
    def magnitude(self) -> np.ndarray:
        """The largest magnitudes, of shape (n,)."""
        return np.maximum(np.abs(self.low), np.abs(self.high))

    def excludes_zero(self) -> np.ndarray:
        """Return whether 0 lies outside each interval, of shape (n,)."""
        return (self.low > 0.0) | (self.high < 0.0)


@dataclass(frozen=True)
class Enclosure:
    """Values and domain of expressions on n boxes.

    Attributes
    ----------
    values
        An interval for each expression.
    defined_everywhere
        Whether all expressions are defined and bounded on the whole box, of shape (n,).
    defined_nowhere
        Whether at least one expression is undefined on the whole box, of shape (n,).
    """

    values: list[Interval]
    defined_everywhere: np.ndarray
    defined_nowhere: np.ndarray


def enclose(graph: Graph, numbers: Sequence[float], x: Interval, y: Interval) -> Enclosure:
    """Return intervals of the expressions of a graph on boxes x × y."""
    defined_nowhere = np.zeros(x.low.shape, bool)
    defined_everywhere = np.ones(x.low.shape, bool)
    with np.errstate(all="ignore"):
        intervals = node_values(graph, numbers, x, y, _OPERATIONS)
    for node in graph.nodes:
        if node.kind in ("power", "log"):
            base = intervals[node.operands[0]]
            if _needs_positive(node):
                defined_nowhere |= base.high < 0.0
                defined_everywhere &= base.low > 0.0
            else:
                defined_nowhere |= (base.low == 0.0) & (base.high == 0.0)
                defined_everywhere &= base.excludes_zero()
    # A constant has one interval for all boxes.
    results = [intervals[index] for index in graph.results]
    values = [Interval(*np.broadcast_arrays(result.low, result.high, x.low)[:2]) for result in results]
    for value in values:
        defined_everywhere &= np.isfinite(value.low) & np.isfinite(value.high)
    return Enclosure(values, defined_everywhere & ~defined_nowhere, defined_nowhere)


def _needs_positive(node: Node) -> bool:
    """Return whether a power or a logarithm is defined only for a positive base."""
    return node.kind == "log" or node.exponent != int(node.exponent)


Ends = tuple[np.ndarray, np.ndarray]
"""Lower and upper ends of the values on n boxes, each of shape (n,)."""


def _interval(ends: Ends) -> Interval:
    """Make an interval from its ends. An end that is NaN becomes infinite."""
    low, high = ends
    return Interval(np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high))


def _widen(operation: Callable[..., Ends]) -> Callable[..., Interval]:
    """Decorate an operation on intervals so that its result is widened by the rounding error."""

    @functools.wraps(operation)
    def widened(*operands: Any) -> Interval:
        interval = _interval(operation(*operands))
        low, high = interval.low, interval.high
        return Interval(low - _ROUNDING * np.abs(low) - _UNDERFLOW, high + _ROUNDING * np.abs(high) + _UNDERFLOW)

    return widened


def _linear(constant: float, coefficients: Sequence[float], operands: Sequence[Interval]) -> Interval:
    low = high = np.asarray(constant)
    magnitude = np.abs(low)
    for c, operand in zip(coefficients, operands, strict=True):
        first, last = (operand.low, operand.high) if c >= 0.0 else (operand.high, operand.low)
        low, high, magnitude = low + c * first, high + c * last, magnitude + abs(c) * operand.magnitude
    error = _ROUNDING * len(operands) * magnitude + _UNDERFLOW
    return _interval((low - error, high + error))


@_widen
def _product(one: Interval, other: Interval) -> Ends:
    if one is other:
        return _square(one)
    # The product of 0 and an infinite end is NaN, which `_interval` replaces by the whole line.
    products = np.array([a * b for a in (one.low, one.high) for b in (other.low, other.high)])
    return products.min(axis=0), products.max(axis=0)


def _square(base: Interval) -> Ends:
    least = np.where((base.low <= 0.0) & (base.high >= 0.0), 0.0, np.minimum(np.abs(base.low), np.abs(base.high)))
    return least**2, base.magnitude**2


@_widen
def _power(base: Interval, exponent: float) -> Ends:
    """Return the power −1, or a non-integer power of the nonnegative part of the base."""
    if exponent == -1.0:
        contains_zero = (base.low < 0.0) & (base.high > 0.0)
        # An end at 0 is approached from inside the interval, so its sign is the sign of the rest of the interval.
        low = 1.0 / np.where(base.high == 0.0, -0.0, base.high)
        high = 1.0 / np.where(base.low == 0.0, 0.0, base.low)
        return np.where(contains_zero, -np.inf, low), np.where(contains_zero, np.inf, high)
    power_of_low, power_of_high = np.maximum(base.low, 0.0) ** exponent, np.maximum(base.high, 0.0) ** exponent
    return (power_of_low, power_of_high) if exponent > 0.0 else (power_of_high, power_of_low)


@_widen
def _exp(exponent: Interval) -> Ends:
    return np.exp(exponent.low), np.exp(exponent.high)


@_widen
def _log(argument: Interval) -> Ends:
    return np.log(np.maximum(argument.low, 0.0)), np.log(np.maximum(argument.high, 0.0))


@_widen
def _sine(angle: Interval, shift: float = 0.0) -> Ends:
    """Return sin(angle + shift)."""
    first, last = angle.low + shift, angle.high + shift
    margin = _ROUNDING * (np.abs(first) + np.abs(last) + 1.0)
    # The comparison is also False for NaN.
    is_known = np.maximum(np.abs(first), np.abs(last)) < _LARGEST_ANGLE
    # Whether the interval contains a maximum of the sine, 2πk + π/2, or a minimum, 2πk − π/2.
    has_maximum, has_minimum = (
        np.floor((last + margin - extremum) / (2.0 * np.pi)) > np.floor((first - margin - extremum) / (2.0 * np.pi))
        for extremum in (0.5 * np.pi, -0.5 * np.pi)
    )
    low = np.where(~is_known | has_minimum, -1.0, np.minimum(np.sin(first) - margin, np.sin(last) - margin))
    high = np.where(~is_known | has_maximum, 1.0, np.maximum(np.sin(first) + margin, np.sin(last) + margin))
    return low, high


def _cosine(angle: Interval) -> Interval:
    return _sine(angle, 0.5 * np.pi)


_OPERATIONS = Operations[Interval](_linear, _product, _power, {"exp": _exp, "log": _log, "sin": _sine, "cos": _cosine})
