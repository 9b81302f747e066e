"""Checks of arguments: each function returns the value as a plain type, or raises a ValueError that names the parameter.

The error is a ValueError even for a value of a wrong type.
"""

from __future__ import annotations

import dataclasses
import functools
import inspect
import numbers
import operator
import os
import re
import reprlib
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

LARGEST_NUMBER = 1e9
"""Largest magnitude of an energy, a coordinate or a momentum: far beyond all exits, with powers that do not overflow."""

LARGEST_COEFFICIENT = 1e90
"""Largest magnitude of a coefficient; with a unit of length of 1e-6, terms of degree 12 have a factor of 1e72."""

LONGEST_TIME = 1e8
"""Largest t_max, in the time unit of the well if this unit exceeds 1. The rounding error of t is then up to 1e-8."""

type RandomNumbers = int | np.random.Generator | None
"""Where random numbers come from, as functions accept it (SPEC 7): a seed, a generator, or None for new numbers at each call."""

# Kinds of NumPy types that are not real numbers, but that NumPy converts to them: complex numbers and texts.
_NOT_REAL = "cSU"
# The largest legal seed and one more.
_SEEDS = 2**63
_LINE_BREAK = re.compile(r"\s*\n\s*")
# Descriptions of types in messages, by the name of the type.
_TYPE_NAMES = {
    "str": "text",
    "NoneType": "None",
    "Callable": "a function",
    "Iterable": "a sequence",
    "Mapping": "a mapping",
    "PathLike": "a path",
}


def short_repr(value: Any) -> str:
    """Return `repr` of a value on one line, shortened for an error message."""
    return _LINE_BREAK.sub(" ", reprlib.repr(value))


def checks_types[**P, T](**kinds: Any) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Decorate a function to raise a ValueError for arguments of wrong types; `kinds` are the legal types of parameters."""

    def decorate(function: Callable[P, T]) -> Callable[P, T]:
        positions = [(index, name) for index, name in enumerate(inspect.signature(function).parameters) if name in kinds]

        @functools.wraps(function)
        def call(*args: P.args, **kwargs: P.kwargs) -> T:
            for index, name in positions:
                if index < len(args):
                    check_type(name, args[index], kinds[name])
                elif name in kwargs:
                    check_type(name, kwargs[name], kinds[name])
            return function(*args, **kwargs)

        return call

    return decorate


def check_type(name: str, value: Any, kind: Any) -> None:
    """Raise a ValueError unless a value has a type, or one of several types."""
    if not isinstance(value, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        raise ValueError(f"{name}={short_repr(value)}: must be {' or '.join(map(_describe_type, kinds))}")


def checked_items[T](name: str, values: Iterable[T], kind: type[T]) -> tuple[T, ...]:
    """Return a sequence of values of type `kind` as a tuple; ValueError otherwise."""
    check_type(name, values, Iterable)
    items = tuple(values)
    for item in items:
        check_type(name, item, kind)
    return items


def _describe_type(kind: type) -> str:
    article = "an" if kind.__name__[0] in "AEIO" else "a"
    return _TYPE_NAMES.get(kind.__name__, f"{article} {kind.__name__}")


def replace_unchecked[T](instance: T, **values: Any) -> T:
    """Apply `dataclasses.replace` without the checks of a frozen dataclass, which are for values in the units of the user."""
    copy = object.__new__(type(instance))
    for field in dataclasses.fields(instance):  # type: ignore[arg-type]
        object.__setattr__(copy, field.name, values.get(field.name, getattr(instance, field.name)))
    return copy


def checked_path(name: str, value: Any) -> Path:
    """Return a path; ValueError for other values, and for texts that are no name of a file or folder."""
    check_type(name, value, (str, os.PathLike))
    text = os.fspath(value)
    if not text or "\0" in text:
        raise ValueError(f"{name}={short_repr(text)}: must be the path of a file or folder, without a null character")
    return Path(text)


def checked_choice(name: str, value: Any, legal: Iterable[str]) -> str:
    """Return one of some texts; ValueError for any other value."""
    texts = tuple(legal)
    if not isinstance(value, str) or value not in texts:
        raise ValueError(f"{name}={short_repr(value)}: must be one of {', '.join(texts)}")
    return value


def checked_flag(name: str, value: Any) -> bool:
    """Return True or False; ValueError for other values."""
    if not isinstance(value, bool | np.bool_):
        raise ValueError(f"{name}={short_repr(value)}: must be True or False")
    return bool(value)


def checked_number(name: str, value: Any, requirement: str = "", largest: float = LARGEST_NUMBER) -> float:
    """Return a real number of at most `largest` in magnitude as a float; the error says "must be <requirement>"."""
    is_real = isinstance(value, numbers.Real) and not isinstance(value, bool)
    # The comparison precedes the conversion, because an integer may be too large for a float.
    if not is_real or not -largest <= value <= largest:
        legal = requirement or f"a finite number, at most {largest:g} in magnitude"
        raise ValueError(f"{name}={short_repr(value)}: must be {legal}")
    return float(value)


def checked_between(name: str, value: Any, low: float, high: float) -> float:
    """Return a real number from `low` to `high` as a float; ValueError otherwise."""
    legal = f"from {low:g} to {high:g}"
    number = checked_number(name, value, legal)
    if not low <= number <= high:
        raise ValueError(f"{name}={number!r}: must be {legal}")
    return number


def checked_count(name: str, value: Any, least: int, most: int) -> int:
    """Return an integer from `least` to `most`; ValueError otherwise."""
    # A value that is not an integer is replaced by an integer out of range.
    try:
        count = operator.index(value) if not isinstance(value, bool) else least - 1
    except TypeError:
        count = least - 1
    if not least <= count <= most:
        raise ValueError(f"{name}={short_repr(value)}: must be an integer from {least} to {most}")
    return count


def checked_generator(rng: RandomNumbers) -> np.random.Generator:
    """Return the generator of a parameter `rng`; ValueError unless it is as in `RandomNumbers`."""
    return np.random.default_rng(rng if rng is None or isinstance(rng, np.random.Generator) else checked_seed(rng))


def checked_seed(rng: RandomNumbers) -> int:
    """Return the seed of a parameter `rng`, for several generators that depend on it: an integer itself, or a random one."""
    if rng is None or isinstance(rng, np.random.Generator):
        return int(np.random.default_rng(rng).integers(_SEEDS))
    try:
        return checked_count("rng", rng, 0, _SEEDS - 1)
    except ValueError as error:
        raise ValueError(f"{error}, a numpy.random.Generator or None") from None


def checked_array(name: str, value: Any, *, keep_type: bool = False) -> np.ndarray:
    """Return an array of floats or, with `keep_type`, of the type of the value; shape and range are not checked."""
    try:
        array: np.ndarray = np.asarray(value)
        if array.dtype.kind in _NOT_REAL:
            raise TypeError
        return array if keep_type else array.astype(float, copy=False)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name}={short_repr(value)}: must be an array of real numbers with rows of equal length") from None


def checked_finite(name: str, value: Any) -> Any:
    """Return a finite number as a float, or finite numbers as an array; ValueError otherwise."""
    if isinstance(value, numbers.Real):
        return checked_number(name, value)
    array = checked_array(name, value)
    if not np.isfinite(array).all():
        raise ValueError(f"{name}={short_repr(value)}: must be finite numbers")
    return array


def checked_integers(name: str, value: Any) -> np.ndarray:
    """Return an array of int64; an empty array may be given with any type."""
    array = checked_array(name, value, keep_type=True)
    if array.size and array.dtype.kind not in "iu":
        raise ValueError(f"{name}={short_repr(value)}: must be integers")
    return array.astype(np.int64)


def checked_t_max(
    t_max: float, longest: float = LONGEST_TIME, unit: Callable[[], float] = lambda: 1.0, *, name: str = "t_max"
) -> float:
    """Return `t_max`, above 0 and at most `longest` times the larger of `unit()` and 1, as a float; ValueError otherwise."""
    # Type checkers would report that the check of a float cannot fail.
    given_t_max: Any = t_max
    is_number = isinstance(given_t_max, int | float | np.number) and not isinstance(given_t_max, bool)
    # `unit` takes time, so it is called only for large values.
    if is_number and given_t_max > longest:
        longest *= max(unit(), 1.0)
    # The comparison precedes the conversion, because an integer may be too large for a float.
    if not (is_number and 0 < given_t_max <= longest):
        raise ValueError(f"{name}={short_repr(t_max)}: must be above 0 and at most {longest:g}")
    return float(t_max)


def checked_states(name: str, states: Any, *, allow_forbidden: bool = False) -> np.ndarray:
    """Return an array (n, 4) of x, y, px and py, each at most `LARGEST_NUMBER` in magnitude.

    With `allow_forbidden`, momenta may be NaN: there is no such orbit.
    """
    array: np.ndarray = np.ascontiguousarray(checked_array(name, states))
    if array.ndim != 2 or array.shape[1] != 4:
        raise ValueError(f"{name} of shape {array.shape}: must be (n, 4) with columns x, y, px, py")
    is_legal_number = np.abs(array) <= LARGEST_NUMBER
    if allow_forbidden:
        is_legal_number[:, 2:] |= np.isnan(array[:, 2:])
    is_legal = is_legal_number.all(axis=1)
    if not is_legal.all():
        row = int(np.argmin(is_legal))
        raise ValueError(f"{name}: row {row} has a number that is not finite or larger than {LARGEST_NUMBER:g} in magnitude")
    return array


def checked_state(name: str, state: Any) -> np.ndarray:
    """Return an array (4,) of x, y, px and py, each at most `LARGEST_NUMBER` in magnitude."""
    array = checked_array(name, state)
    if array.shape != (4,) or not np.all(np.abs(array) <= LARGEST_NUMBER):
        limit = f"at most {LARGEST_NUMBER:g} in magnitude"
        raise ValueError(f"{name}={short_repr(state)}: must be four finite numbers x, y, px, py, {limit}")
    return array
