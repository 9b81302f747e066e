"""Series in time as lists of results of a straight-line program, their order, and their products."""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from engine.integrator.source.section_numbers import SectionForm
from engine.integrator.source.straight_line import StraightLine, Value

ORDER = 19
"""Order of the series; with `TOLERANCE` it is the fastest choice with an energy error well below 1e-11 over 1e5 time units."""

LONGEST_STEP = 1.0
"""Longest step, in units of the well, at which all series converge. Near rest, the tolerance would allow longer steps."""

ROTATION = "rotation"
"""Key of the entry 2Ω of the table."""

Series = Sequence[Value]
"""The coefficients of a series in time, from order 0."""

Hessian = Mapping[tuple[int, int], tuple[Callable[[int], Value], bool]]
"""{axes: (coefficient, is_nonzero)} for the axes (0, 0), (0, 1) and (1, 1) of the second derivatives of −V. `coefficient` is a
function of k, to be called for each k in turn, that returns coefficient k of the series of the derivative. `is_nonzero` is False
if the derivative is zero everywhere."""

PointFunctions = Mapping[str, Callable[[StraightLine], Mapping[str, Value]]]
"""{name: function}; each function appends operations to a program with inputs x and y, and returns the results by name."""

NO_REMAINDERS: Mapping[str, Value] = MappingProxyType({})
"""The remainders of steps that carry none."""


class Setting(NamedTuple):
    """The facts besides V on which the generated code depends.

    Attributes
    ----------
    channels
        Number of exits over saddles.
    sides
        For each circle at which orbits end: −1 if they end inside it, 1 if they end outside.
    rotates
        Whether the frame rotates.
    section
        The kind of the form that vanishes on the surface of section; None for y = 0, crossed upward.
    """

    channels: int = 0
    sides: tuple[int, ...] = ()
    rotates: bool = False
    section: SectionForm | None = None

    @property
    def needs_whole_steps(self) -> bool:
        """Whether an orbit can cross and recross an exit within a step. Exits over saddles in a frame at rest exclude this."""
        return bool(self.sides) or self.rotates


def total(program: StraightLine, terms: Iterator[Value]) -> Value:
    """Return the sum from left to right; each term is computed just before it is added. Without terms, the sum is 0.0."""
    first = next(terms, None)
    return program.constant(0.0) if first is None else functools.reduce(operator.add, terms, first)


def add_coriolis(program: StraightLine, x: list[Value], y: list[Value]) -> None:
    """Add 2Ωẏ and −2Ωẋ, integrated twice, to the last coefficients of the series of x and y, which lack these terms."""
    k = len(x) - 1
    # 2Ω ẏ contributes 2Ω (k − 1) y_(k − 1) / (k (k − 1)) to x_k.
    factor = program.entry(ROTATION) * (1.0 / k)
    x[k], y[k] = x[k] + factor * y[k - 1], y[k] - factor * x[k - 1]


def sum_of_products(pairs: Iterable[tuple[Value, Value]]) -> Value:
    """Return a·b + c·d + …, nested so that each addition contracts into a multiply-add."""
    return functools.reduce(operator.add, (left * right for left, right in pairs))


def cauchy(left: Series, right: Series, k: int) -> Value:
    """Return coefficient k of the product of two series, or of half the square of a series; the newest terms come last."""
    if left is right:
        return sum_of_products(half_square(left, k))
    return sum_of_products([*inner_pairs(left, right, k), (left[0], right[k]), *([(left[k], right[0])] if k else [])])


def inner_pairs(left: Series, right: Series, k: int) -> Iterator[tuple[Value, Value]]:
    """Yield the factors of coefficient k of the product of two series, without the first and last terms, the newest last."""
    yield from ((left[j], right[k - j]) for j in sorted(range(1, k), key=lambda j: max(j, k - j)))


def half_square(series: Series, k: int) -> Iterator[tuple[Value, Value]]:
    """Yield the factors of the products whose sum is coefficient k of half the square of a series."""
    if k % 2 == 0:
        yield 0.5 * series[k // 2], series[k // 2]
    yield from ((series[j], series[k - j]) for j in reversed(range((k + 1) // 2)))
