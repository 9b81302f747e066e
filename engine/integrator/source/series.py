"""Series in time as lists of results of a straight-line program, their order, and their products."""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, NamedTuple, Protocol

from engine.integrator.source.straight_line import StraightLine, Value

ORDER = 19
"""Order of the series; with `TOLERANCE` the fastest tried that keeps the energy error well below 1e-11 over 1e5 time units."""

LONGEST_STEP = 1.0
"""Upper limit of a step, for motion near rest or nearly linear in time; well within the convergence of the series."""

REACH = 3.0
"""Radius of a disc that contains all steps of orbits inside the exits of a well of size 1."""

ROTATION = "rotation"
"""The entry of the table with 2Ω."""

Series = Sequence[Value]

Hessian = Mapping[tuple[int, int], tuple[Callable[[int], Value], bool]]
"""{(0, 0), (0, 1), (1, 1): (coefficient k of the series of that second derivative of −V, whether it is not zero everywhere)}; the
coefficients are to be asked for in turn."""


PointFunctions = Mapping[str, Callable[[StraightLine], Mapping[str, Value]]]
"""{name of a function: what appends it to a program with the inputs x and y, and returns its results by their names}."""

NO_REMAINDERS: Mapping[str, Value] = MappingProxyType({})


class Setting(NamedTuple):
    """What the generated code depends on besides V.

    Attributes
    ----------
    channels
        How many exits over saddles there are.
    sides
        Of each circle at which orbits end, the side where they have ended: −1 within, 1 beyond it.
    rotates
        Whether the frame rotates.
    """

    channels: int = 0
    sides: tuple[int, ...] = ()
    rotates: bool = False

    @property
    def needs_whole_steps(self) -> bool:
        """Whether an orbit can pass an exit and return within a step; out of a well that does not rotate none returns."""
        return bool(self.sides) or self.rotates


class Structure(Hashable, Protocol):
    """What the generated code of a potential depends on; hashable. For polynomials and for expressions there is one each."""

    @property
    def setting(self) -> Setting:
        """What it depends on besides V."""

    @property
    def carries_remainders(self) -> bool:
        """Whether a step also takes and gives what rounding has dropped from x and y, as next to a body each digit counts."""

    @property
    def can_hide(self) -> bool:
        """Whether a step can contain two crossings of y = 0 that the signs of y at its ends do not show."""

    @property
    def has_many_scales(self) -> bool:
        """Whether frequencies may differ by much from place to place."""

    @property
    def largest_norm(self) -> float:
        """Norm of the last coefficients above which steps would be too short to change t; such an orbit fails, as with NaN."""

    def orbit(self, program: StraightLine, remainders: Mapping[str, Value] = NO_REMAINDERS) -> tuple[Series, Series]:
        """The series of x and y to `ORDER` from the inputs x0, x1, y0 and y1; remainders: what is to be added to x0 and y0."""

    def hessian(self, program: StraightLine) -> Hessian:
        """The second derivatives of −V along the orbit from these inputs."""

    def point_functions(self) -> PointFunctions:
        """Functions of one point."""

    def tabulate(self, definition: Any, entries: Sequence[Any]) -> list[float]:
        """The values of the entries of the table for a potential of this structure."""


def total(program: StraightLine, parts: Iterator[Value]) -> Value:
    """The sum from left to right, each part computed just before it is added; 0.0 for no parts."""
    first = next(parts, None)
    return program.constant(0.0) if first is None else functools.reduce(operator.add, parts, first)


def add_coriolis(program: StraightLine, x: list[Value], y: list[Value]) -> None:
    """Add 2Ωẏ and −2Ωẋ, integrated twice, to the last coefficients of the series of x and y, which do not contain them yet."""
    k = len(x) - 1
    twice = program.entry(ROTATION) * (1.0 / k)
    x[k], y[k] = x[k] + twice * y[k - 1], y[k] - twice * x[k - 1]


def sum_of_products(pairs: Iterable[tuple[Value, Value]]) -> Value:
    """a·b + c·d + …, nested so that each addition contracts into a multiply-add."""
    return functools.reduce(operator.add, (left * right for left, right in pairs))


def cauchy(left: Series, right: Series, k: int) -> Value:
    """Coefficient k of the product of two series, or of half a square; the newest last, since the rest can start earlier."""
    if left is right:
        return sum_of_products(half_square(left, k))
    return sum_of_products([*inner_pairs(left, right, k), (left[0], right[k]), *([(left[k], right[0])] if k else [])])


def inner_pairs(left: Series, right: Series, k: int) -> Iterator[tuple[Value, Value]]:
    """The factors of the products of coefficient k of a product of two series without the first and the last, the newest last."""
    yield from ((left[j], right[k - j]) for j in sorted(range(1, k), key=lambda j: max(j, k - j)))


def half_square(series: Series, k: int) -> Iterator[tuple[Value, Value]]:
    """The factors of the products whose sum is coefficient k of half the square of a series."""
    if k % 2 == 0:
        yield 0.5 * series[k // 2], series[k // 2]
    yield from ((series[j], series[k - j]) for j in reversed(range((k + 1) // 2)))
