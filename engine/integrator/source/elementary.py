"""exp, log, sin, cos and real powers of a value of a straight-line program, written in operations of the program.

A call of a library function in each lane would prevent vectorisation. Vector libraries round differently from scalar functions,
so results would depend on the lane. The functions here reduce the argument by exact multiples of log 2 or π/2 and evaluate
polynomials, without branches: the operations are the same in each lane and in WebAssembly. Relative errors are below 1e-15; those
of `power_of` with an exponent a that is not a multiple of ½ are |a log u| times as large. NaN or an infinite result marks an
argument outside the domain, and a step from there fails.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from fractions import Fraction
from types import MappingProxyType

from engine.integrator.source.straight_line import Value, where

_PI = Fraction("3.14159265358979323846264338327950288419716939937510582097494459")
_LN_2 = Fraction("0.69314718055994530941723212145817656807550013436025525412068")

# The sum of this number and a number below 2^51 in magnitude is rounded to an integer, which the bits of the sum contain.
_ROUND = 1.5 * 2.0**52
# Bits of this number, as an integer.
_ROUND_BITS = 0x4338000000000000
# Bits of doubles, as integers: one unit of the exponent, the number 1.0, and the number √½.
_EXPONENT = 1 << 52
_ONE_BITS = 1023 << 52
_ROOT_HALF_BITS = 0x3FE6A09E667F3BCD

# Largest argument of exp. This argument replaces larger ones, because no orbit reaches such a force.
_LARGEST_EXPONENT = 700.0
# Smallest normal double, for log.
_SMALLEST_NORMAL = 2.0**-1022
# Largest argument of sin and cos, in radians. Larger multiples of π/2 have too many bits to be exact.
_LARGEST_ANGLE = 1e6
# Number of bits of each part of a number, except the last part.
_HIGH_BITS = 30


def _split(value: Fraction, count: int) -> list[float]:
    """Split a number into `count` doubles. All but the last have few bits, so that their products with integers are exact."""
    parts = []
    for _ in range(count - 1):
        _, exponent = math.frexp(float(value))
        unit = Fraction(2) ** (exponent - _HIGH_BITS)
        parts.append(float(round(value / unit) * unit))
        value -= Fraction(parts[-1])
    return [*parts, float(value)]


_LN_2_PARTS, _HALF_PI_PARTS = _split(_LN_2, 2), _split(_PI / 2, 3)

# Coefficients of polynomials, the highest first.

# exp r for |r| ≤ log 2 / 2.
_EXP = [1.0 / math.factorial(k) for k in range(14, -1, -1)]
# sin r / r in r² for |r| ≤ π/4.
_SIN = [(-1.0) ** k / math.factorial(2 * k + 1) for k in range(8, -1, -1)]
# cos r in r² for |r| ≤ π/4.
_COS = [(-1.0) ** k / math.factorial(2 * k) for k in range(9, -1, -1)]
# (atanh s / s − 1) / s² in s² for |s| ≤ (√2 − 1)/(√2 + 1).
_ATANH = [1.0 / (2 * k + 3) for k in range(10, -1, -1)]


def exp_of(u: Value) -> Value:
    """Return exp u = 2^n exp r with |r| ≤ log 2 / 2; beyond ±700, the value at ±700."""
    u = where(u < _LARGEST_EXPONENT, u, _LARGEST_EXPONENT)
    u = where(u > -_LARGEST_EXPONENT, u, -_LARGEST_EXPONENT)
    n, bits = _nearest_integer(u * (1.0 / math.log(2.0)))
    r = _reduce(u, n, _LN_2_PARTS)
    return u.program.apply("double_of", u.program.apply("bits_of", _polynomial(_EXP, r)) + bits * _EXPONENT)


def log_of(u: Value) -> Value:
    """Return log u; NaN below the smallest normal number.

    With u = 2^n m and √½ ≤ m < √2, log u = n log 2 + 2 atanh s, where s = (m − 1)/(m + 1).
    """
    program = u.program
    bits = program.apply("bits_of", u)
    exponent = ((bits + (_ONE_BITS - _ROOT_HALF_BITS)) >> 52) - 1023
    m = program.apply("double_of", bits - exponent * _EXPONENT)
    n = program.apply("double_of", exponent + _ROUND_BITS) - _ROUND
    s = program.apply("/", m - 1.0, m + 1.0)
    square = s * s
    high, low = _LN_2_PARTS
    result = n * high + ((s + s) * (square * _polynomial(_ATANH, square)) + n * low + (s + s))
    return where(u >= _SMALLEST_NORMAL, result, math.nan)


def sin_of(u: Value) -> Value:
    """Return sin u; NaN for |u| > 1e6."""
    return _sine_of_sum(u, 0)


def cos_of(u: Value) -> Value:
    """Return cos u; NaN for |u| > 1e6."""
    return _sine_of_sum(u, 1)


def _sine_of_sum(u: Value, quarters: int) -> Value:
    """Return sin(u + quarters π/2); NaN for |u| > 1e6."""
    n, bits = _nearest_integer(u * (2.0 / math.pi))
    r = _reduce(u, n, _HALF_PI_PARTS)
    square = r * r
    quarter = bits + quarters
    half = quarter >> 1
    sine, cosine = r * _polynomial(_SIN, square), _polynomial(_COS, square)
    value = where((quarter - half * 2).equals(0), sine, cosine)
    value = where((half - (half >> 1) * 2).equals(0), value, -1.0 * value)
    return where(abs(u) <= _LARGEST_ANGLE, value, math.nan)


def power_of(u: Value, exponent: float) -> Value:
    """Return u^a: by products and a square root if 2a is an integer, otherwise as exp(a log u), which is NaN for u ≤ 0."""
    if 2.0 * exponent != int(2.0 * exponent):
        return exp_of(exponent * log_of(u))
    remaining = int(abs(exponent))
    factors = [u.program.apply("sqrt", u)] if abs(exponent) != remaining else []
    square = u
    while remaining:
        if remaining % 2:
            factors.append(square)
        remaining //= 2
        square = square * square if remaining else square
    result = factors[0]
    for factor in factors[1:]:
        result = result * factor
    return 1.0 / result if exponent < 0.0 else result


FUNCTIONS: Mapping[str, Callable[[Value], Value]] = MappingProxyType({"exp": exp_of, "log": log_of, "sin": sin_of, "cos": cos_of})
"""The functions of expressions as operations of a program."""


def _nearest_integer(u: Value) -> tuple[Value, Value]:
    """Return the integer nearest to u as a double and as an integer."""
    shifted = u + _ROUND
    return shifted - _ROUND, u.program.apply("bits_of", shifted) - _ROUND_BITS


def _reduce(u: Value, n: Value, parts: list[float]) -> Value:
    """Return u minus n times the sum of `parts`, part by part."""
    for part in parts:
        u = u - n * part
    return u


def _polynomial(coefficients: list[float], u: Value) -> Value:
    """Return a polynomial in u with two or more coefficients, the highest first."""
    result = coefficients[1] + u * coefficients[0]
    for c in coefficients[2:]:
        result = c + u * result
    return result
