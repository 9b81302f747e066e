"""Operations on pairs of doubles against exact fractions."""

from __future__ import annotations

import functools
from collections.abc import Callable
from fractions import Fraction

import mpmath
import numpy as np
import pytest
from numba import njit

from engine.taylor.jit.double_double import VECTOR, lanes_of_pairs
from engine.taylor.source.deep_step import pair_of
from engine.taylor.source.straight_line import StraightLine, Value, where

COUNT = 4000
BOUNDS = {"+": 4e-32, "-": 4e-32, "*": 4e-32, "/": 1e-31, "sqrt": 1e-31, "abs": 0.0}


def run(append: Callable[[Value, Value], Value], pairs: np.ndarray) -> np.ndarray:
    """(2, n) results of a program with two inputs, (4, n)."""
    program = StraightLine("program", {})
    program.results = [append(program.input("x"), program.input("y")).index]
    call, results = lanes_of_pairs(program), np.zeros((2, pairs.shape[1]))

    def kernel(table, lanes, results):
        for i in range(0, lanes.shape[1], VECTOR):
            call(table, lanes, results, i)

    njit(kernel)(np.zeros(0), pairs, results)
    return results


@functools.cache
def some_pairs() -> np.ndarray:
    """(4, n) two numbers of 106 bits each, of any sign and of similar or different size."""
    rng = np.random.default_rng(3)
    high = rng.uniform(-1.0, 1.0, (2, COUNT)) * 2.0 ** rng.integers(-20, 20, (2, COUNT))
    low = high * rng.uniform(-0.5, 0.5, (2, COUNT)) * 2.0**-53
    return np.ascontiguousarray(np.array([high[0], low[0], high[1], low[1]]))


def exact(rows: np.ndarray) -> list[Fraction]:
    return [Fraction(high) + Fraction(low) for high, low in rows.T.tolist()]


def expected(symbol: str, x: Fraction, y: Fraction) -> Fraction:
    if symbol == "sqrt":
        with mpmath.workdps(60):
            root = mpmath.sqrt(mpmath.mpf(x.numerator) / x.denominator)
            return Fraction(mpmath.nstr(root, 55))
    return {"+": x.__add__, "-": x.__sub__, "*": x.__mul__, "/": x.__truediv__, "abs": lambda _: abs(x)}[symbol](y)


@pytest.mark.parametrize("symbol", BOUNDS)
def test_relative_errors_are_those_of_about_106_bits(symbol: str) -> None:
    pairs = np.abs(some_pairs()) if symbol == "sqrt" else some_pairs()
    found = exact(run(lambda x, y: x.program.apply(symbol, x, *([] if symbol in ("sqrt", "abs") else [y])), pairs))
    wanted = [expected(symbol, x, y) for x, y in zip(exact(pairs[:2]), exact(pairs[2:]), strict=True)]
    worst = max(float(abs(one - other) / abs(other)) for one, other in zip(found, wanted, strict=True))
    assert worst <= BOUNDS[symbol]


def test_sums_that_cancel_keep_what_is_left() -> None:
    pairs = some_pairs().copy()
    pairs[2:] = -pairs[:2]
    pairs[3] += 2.0**-104 * pairs[0]
    found, (x, y) = exact(run(lambda x, y: x + y, pairs)), (exact(pairs[:2]), exact(pairs[2:]))
    assert found == [one + other for one, other in zip(x, y, strict=True)]


@pytest.mark.parametrize("symbol", ["<", "<=", ">", ">=", "=="])
def test_numbers_with_equal_high_parts_are_compared_by_their_low_parts(symbol: str) -> None:
    pairs = some_pairs().copy()
    pairs[2, ::2], pairs[3, ::4] = pairs[0, ::2], pairs[1, ::4]
    pairs[2, ::4] = pairs[0, ::4]
    chosen = run(lambda x, y: where(x.program.apply(symbol, x, y), 1.0, 2.0), pairs)[0]
    compare = {"<": "__lt__", "<=": "__le__", ">": "__gt__", ">=": "__ge__", "==": "__eq__"}[symbol]
    truths = [getattr(x, compare)(y) for x, y in zip(exact(pairs[:2]), exact(pairs[2:]), strict=True)]
    assert chosen.tolist() == [1.0 if truth else 2.0 for truth in truths]


def test_a_pair_has_32_digits() -> None:
    high, low = pair_of(Fraction(1, 3))
    assert abs(Fraction(high) + Fraction(low) - Fraction(1, 3)) < Fraction(1, 10**32)
