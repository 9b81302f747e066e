"""Results in a few lines of text."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import Enum, IntEnum
from typing import Any

import numpy as np

from engine.foundations.codes import name_code
from engine.foundations.wording import format_number

_WIDTH, _MOST_LINES = 100, 3
# A space at which lines do not end.
_UNBROKEN = "\u00a0"


def show_numbers(numbers: Mapping[str, Any], codes: Mapping[str, type[IntEnum]], labels: Sequence[str] = ()) -> dict[str, str]:
    """Scalars as text, by name: codes in words, with the labels of fates from 1, other numbers to four digits."""
    return {name: _show(value, codes.get(name), labels) for name, value in numbers.items()}


def _show(value: Any, codes: type[IntEnum] | None, labels: Sequence[str]) -> str:
    if codes is not None:
        return name_code(codes, value, labels)
    if isinstance(value, float):
        return format_number(value)
    return str(value.value if isinstance(value, Enum) else value)


def summarize(title: str, sentence: str, shown: Mapping[str, str], arrays: Mapping[str, np.ndarray]) -> str:
    """A title with a sentence, then the scalars and the arrays, each in three lines at most."""
    lines = _wrap(f"{title}: {sentence}" if sentence else title, indent="")
    lines += _wrap_items(f"{name} {value}" for name, value in shown.items())
    return "\n".join(lines + _wrap_items(_name_arrays(arrays)))


def _name_arrays(arrays: Mapping[str, np.ndarray]) -> Iterator[str]:
    """Names of arrays with their shape, those of equal shape together."""
    for shape in dict.fromkeys(array.shape for array in arrays.values()):
        names = " ".join(name for name, array in arrays.items() if array.shape == shape)
        yield f"{names} {' × '.join(map(str, shape))}"


def _wrap_items(items: Iterable[str]) -> list[str]:
    """A list of items in lines that end between two of them."""
    lines = _wrap(", ".join(item.replace(" ", _UNBROKEN) for item in items))
    return [line.replace(_UNBROKEN, " ") for line in lines]


def _wrap(text: str, indent: str = "  ") -> list[str]:
    return textwrap.wrap(
        text, _WIDTH, initial_indent=indent, subsequent_indent="  ", max_lines=_MOST_LINES, placeholder=" …",
        break_long_words=False,
    )  # fmt: skip
