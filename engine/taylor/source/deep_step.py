"""The step of orbits in double-double arithmetic: the recurrence of a polynomial V, to a higher order and a smaller tolerance."""

from __future__ import annotations

import functools
from fractions import Fraction
from typing import Any

import numpy as np

from engine.results.arrays import read_only
from engine.taylor.source.cauchy_products import Monomial
from engine.taylor.source.polynomial_recurrence import PolynomialStructure, crossings_can_hide
from engine.taylor.source.recurrence import GeneratedCode, GeneratedFunction, horner, step_size
from engine.taylor.source.series import Setting
from engine.taylor.source.straight_line import StraightLine

DEEP_ORDER = 35
"""Order of the series: steps are about as long as those in double precision."""

DEEP_TOLERANCE = 1e-32
"""Norm of the last coefficients of a step's series times the 32nd power of the step size: smaller ones change nothing."""

# Cached structures, 3 MB each.
_STRUCTURES = 8

_KERNEL = """@kernel
def deep_step(coefficients, n, now, new):
    for i in range(0, n, {vector}):
        _deep_step(coefficients, now, new, i)
"""


@functools.lru_cache(maxsize=_STRUCTURES)
def generate_deep_step(coefficients: tuple[tuple[Monomial, Fraction], ...], vector: int) -> tuple[GeneratedCode, np.ndarray]:
    """The function ``deep_step`` of a potential in a frame at rest, for `vector` lanes at a time, and its table of pairs.

    Rows of `now` are pairs x, px, y, py and the tolerance; those of `new` x, px, y, py and the size of the step, then the
    coefficients of x and of y. coefficients: (((i, j), c), …) of V = Σ c x^i y^j. Squares are not joined (`find_difference`), as
    coefficients that are equal to rounding differ here.
    """
    terms, table = dict(coefficients), dict[Any, int]()
    can_hide = crossings_can_hide({powers: float(c) for powers, c in coefficients})
    structure = PolynomialStructure(tuple(terms), Setting(), can_hide, None, None)
    program = StraightLine("_deep_step", table)
    x, y = structure.orbit(program, order=DEEP_ORDER)
    h = step_size(program, x, y, structure)
    program.results = [value.index for value in (*horner(x, h), *horner(y, h), h, *x, *y)]
    function = GeneratedFunction("deep_step", program, _KERNEL.format(vector=vector))
    numbers = [part for value in structure.tabulate_exactly(terms, list(table)) for part in pair_of(value)]
    return GeneratedCode((function,), tuple(table), structure), read_only(np.array(numbers))


def pair_of(value: Fraction) -> tuple[float, float]:
    """A number as the sum of two doubles, to about 32 digits."""
    high = float(value)
    return high, float(value - Fraction(high))
