"""Checks of arguments: each function returns the value as a plain type, or raises a ValueError that names the parameter.

A value of a wrong type raises a ValueError too, like one out of range.
"""

from __future__ import annotations

import numbers
import operator
import reprlib
from typing import Any

import numpy as np

LARGEST_NUMBER = 1e9
"""Largest magnitude of an energy, a coordinate or a momentum: far beyond all exits, and its powers do not overflow."""

LONGEST_TIME = 1e8
"""Largest t_max; at this time the rounding error of t itself reaches 1e-8."""


def short_repr(value: Any) -> str:
    """`repr` of a value, shortened for an error message."""
    return reprlib.repr(value)


def checked_number(name: str, value: Any, requirement: str = "a finite number") -> float:
    """A real number of at most `LARGEST_NUMBER` in magnitude, as a float; the error says "must be <requirement>"."""
    is_real = isinstance(value, numbers.Real)
    # Compared before conversion: an integer may be too large for a float.
    if not is_real or not -LARGEST_NUMBER <= value <= LARGEST_NUMBER:
        raise ValueError(f"{name}={short_repr(value)}: must be {requirement}, at most {LARGEST_NUMBER:g} in magnitude")
    return float(value)


def checked_count(name: str, value: Any, least: int, most: int) -> int:
    """An integer from `least` to `most`."""
    try:
        count = operator.index(value)
    except TypeError:
        count = least - 1
    if not least <= count <= most:
        raise ValueError(f"{name}={short_repr(value)}: must be an integer from {least} to {most}")
    return count


def checked_array(name: str, value: Any, *, keep_type: bool = False) -> np.ndarray:
    """An array of floats, or of its own type with `keep_type`; shape and range are not checked."""
    try:
        array: np.ndarray = np.asarray(value, dtype=None if keep_type else float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name}={short_repr(value)}: must be an array of numbers with rows of equal length") from None
    return array


def checked_integers(name: str, value: Any) -> np.ndarray:
    """An array of int64; an empty one may be of any type."""
    array = checked_array(name, value, keep_type=True)
    if array.size and array.dtype.kind not in "iu":
        raise ValueError(f"{name}={short_repr(value)}: must be integers")
    return array.astype(np.int64)


def checked_t_max(t_max: float, longest: float = LONGEST_TIME) -> float:
    """`t_max` as a float, 0 < t_max ≤ longest."""
    given: Any = t_max
    # Compared before conversion: an integer may be too large for a float.
    if not (isinstance(given, (int, float, np.number)) and 0 < given <= longest):
        raise ValueError(f"t_max={short_repr(t_max)}: must be above 0 and at most {longest:g}")
    return float(t_max)


def checked_state(name: str, state: Any) -> np.ndarray:
    """(4,) floats x, y, px, py of at most `LARGEST_NUMBER` in magnitude."""
    array = checked_array(name, state)
    if array.shape != (4,) or not np.all(np.abs(array) <= LARGEST_NUMBER):
        limit = f"at most {LARGEST_NUMBER:g} in magnitude"
        raise ValueError(f"{name}={short_repr(state)}: must be four finite numbers x, y, px, py, {limit}")
    return array
