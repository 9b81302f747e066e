"""What callers give, read in one way: as it is meant, or refused with a ValueError that names it.

A value of a type of which no number can be made is refused like one out of its range.
"""

from __future__ import annotations

import numbers
import operator
import reprlib
from typing import Any

import numpy as np

LARGEST_NUMBER = 1e9
"""Most that an energy, a coordinate or a momentum may be in magnitude: far beyond all exits, and no power of it overflows."""

LONGEST_TIME = 1e8
"""Largest t_max; at this time the rounding of t itself reaches 1e-8."""


def shown(value: Any) -> str:
    """A value as an error shows it: however long it is, in a few words."""
    return reprlib.repr(value)


def read_number(name: str, value: Any, what: str = "a finite number") -> float:
    """One real number, up to `LARGEST_NUMBER` in magnitude."""
    real = isinstance(value, numbers.Real)
    # Compared before it is converted: an integer may be too large for a float.
    if not real or not -LARGEST_NUMBER <= value <= LARGEST_NUMBER:
        raise ValueError(f"{name}={shown(value)}: must be {what}, at most {LARGEST_NUMBER:g} in magnitude")
    return float(value)


def read_count(name: str, value: Any, least: int, most: int) -> int:
    """A whole number from `least` to `most`."""
    try:
        count = operator.index(value)
    except TypeError:
        count = least - 1
    if not least <= count <= most:
        raise ValueError(f"{name}={shown(value)}: must be an integer from {least} to {most}")
    return count


def read_array(name: str, value: Any, *, keep_type: bool = False) -> np.ndarray:
    """An array, of floats unless it keeps its type; shape and range are up to the caller."""
    try:
        array: np.ndarray = np.asarray(value, dtype=None if keep_type else float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name}={shown(value)}: must be numbers, as many in each row") from None
    return array


def read_integers(name: str, value: Any) -> np.ndarray:
    """An array of integers; an empty one may be of any type."""
    array = read_array(name, value, keep_type=True)
    if array.size and array.dtype.kind not in "iu":
        raise ValueError(f"{name}={shown(value)}: must be integers")
    return array.astype(np.int64)


def read_t_max(t_max: float, longest: float = LONGEST_TIME) -> float:
    """`t_max` as a float; ValueError unless 0 < t_max ≤ longest."""
    given: Any = t_max
    # Compared as it is: an integer may be too large for a float.
    if not (isinstance(given, (int, float, np.number)) and 0 < given <= longest):
        raise ValueError(f"t_max={shown(t_max)}: must be above 0 and at most {longest:g}")
    return float(t_max)


def read_state(name: str, state: Any) -> np.ndarray:
    """The state as four floats; ValueError, with this name, unless it is four finite numbers."""
    start = read_array(name, state)
    if start.shape != (4,) or not np.all(np.abs(start) <= LARGEST_NUMBER):
        raise ValueError(f"{name}={shown(state)}: must be four finite numbers x, y, px, py of at most {LARGEST_NUMBER:g}")
    return start
