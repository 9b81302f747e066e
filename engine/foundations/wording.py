"""Numbers, counts and codes as text, and summaries of results in a few lines."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from enum import Enum, IntEnum
from typing import Any

import numpy as np

# Largest width of the text of a result, in characters.
_TEXT_WIDTH = 100
# Largest number of lines for each part of the text of a result.
_MOST_LINES = 3
_NO_BREAK_SPACE = "\u00a0"

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def format_count(count: int, singular: str, plural: str = "") -> str:
    """Return a count and its noun, such as "1 box" or "3 boxes"; without `plural`, the noun takes an "s"."""
    return f"{format_whole(count)} {singular if count == 1 else plural or f'{singular}s'}"


def format_whole(value: float) -> str:
    """Return a number rounded to an integer, with spaces between groups of three digits, such as "100 000"."""
    return f"{round(value):,}".replace(",", " ")


def format_duration(seconds: float) -> str:
    """Return a duration as whole seconds, rounded up, or from two minutes on as whole minutes."""
    return f"{math.ceil(seconds)} s" if seconds < 120.0 else f"{round(seconds / 60.0)} min"


def format_time(t: float, digits: int = 6) -> str:
    """Return a time to `digits` significant digits, or to all digits of its integer part, in groups of three digits."""
    if t == round(t) or abs(t) >= 10.0**digits:
        return format_whole(t)
    return f"{t:,.{digits}g}".replace(",", " ")


def format_number(value: float, digits: int = 4) -> str:
    """Return a number to `digits` significant digits, with a typographic minus sign and exponent, such as "1.9 × 10⁻¹²"."""
    return typeset_number(f"{value:.{digits}g}")


def format_point(x: float, y: float, digits: int = 6) -> str:
    """Return a point of the plane to `digits` significant digits: "(0, −0.383458)"."""
    return f"({format_number(x, digits)}, {format_number(y, digits)})"


def format_decimals(value: float, decimals: int) -> str:
    """Return a number to `decimals` decimals, with a typographic minus sign and without a negative zero."""
    return typeset_number(f"{round(value, decimals) + 0.0:.{decimals}f}")


def format_share(share: float, decimals: int = 1) -> str:
    """Return a share between 0 and 1 as a percentage: "3.3 %"."""
    return f"{100.0 * share:.{decimals}f} %"


def format_share_range(low: float, high: float, decimals: int = 2) -> str:
    """Return two shares between 0 and 1 as a range of percentages: "3.21 to 3.40 %"."""
    return f"{100.0 * low:.{decimals}f} to {format_share(high, decimals)}"


def typeset_number(text: str, times: str = " × ") -> str:
    """Return the text of a number, such as "-1e-05", with a typographic minus sign, exponent and infinity: "−10⁻⁵".

    times: what stands between the digits and a power of ten.
    """
    mantissa, _, exponent = text.partition("e")
    number = mantissa.replace("-", "−").replace("inf", "∞")
    if not exponent:
        return number
    power = f"10{str(int(exponent)).translate(_SUPERSCRIPTS)}"
    return power if number == "1" else f"{number}{times}{power}"


def describe_codes(codes: type[IntEnum], labels: Sequence[str] = ()) -> dict[str, str]:
    """Return the dataset attribute that explains integer codes: ``{"codes": "value: name; …"}``.

    `labels` name codes 1, 2 and so on that are not members of the enumeration, such as the outcomes of a `Fate`. If all are the
    default labels, "exit 1" and so on, the attribute omits them.
    """
    meanings = [f"{code.value}: {code.name.lower()}" for code in codes]
    if any(label != _default_label(code) for code, label in enumerate(labels, 1)):
        meanings += [f"{code}: {label}" for code, label in enumerate(labels, 1)]
    return {"codes": "; ".join(meanings)}


def name_code(codes: type[IntEnum], code: int, labels: Sequence[str] = ()) -> str:
    """Return a code in words; `labels` name codes 1, 2 and so on that are not members, by default "exit 1" and so on."""
    if code in codes:
        return codes(code).name.lower().replace("_", " ")
    return labels[code - 1] if 1 <= code <= len(labels) else _default_label(code)


def _default_label(code: int) -> str:
    return f"exit {code}"


def show_numbers(numbers: Mapping[str, Any], codes: Mapping[str, type[IntEnum]], labels: Sequence[str] = ()) -> dict[str, str]:
    """Return scalars as text, by name: codes in words, other numbers to four digits. `labels` name fates 1, 2 and so on."""
    return {name: _show(value, codes.get(name), labels) for name, value in numbers.items()}


def _show(value: Any, codes: type[IntEnum] | None, labels: Sequence[str]) -> str:
    if codes is not None:
        return name_code(codes, value, labels)
    if isinstance(value, float):
        return format_number(value)
    return str(value.value if isinstance(value, Enum) else value)


def summarize(title: str, sentence: str, scalars: Mapping[str, str], arrays: Mapping[str, np.ndarray]) -> str:
    """Return a text in three parts of at most three lines each: a title with a sentence, the scalars, and the arrays."""
    lines = _wrap(f"{title}: {sentence}" if sentence else title, indent="")
    lines += _wrap_items(f"{name} {value}" for name, value in scalars.items())
    return "\n".join(lines + _wrap_items(_name_arrays(arrays)))


def _name_arrays(arrays: Mapping[str, np.ndarray]) -> Iterator[str]:
    """Yield the names of arrays with their shapes; arrays of equal shape are grouped."""
    for shape in dict.fromkeys(array.shape for array in arrays.values()):
        names = " ".join(name for name, array in arrays.items() if array.shape == shape)
        yield f"{names} {' × '.join(map(str, shape))}"


def _wrap_items(items: Iterable[str]) -> list[str]:
    """Join items by commas, and wrap the text into lines that end between two items."""
    lines = _wrap(", ".join(item.replace(" ", _NO_BREAK_SPACE) for item in items))
    return [line.replace(_NO_BREAK_SPACE, " ") for line in lines]


def _wrap(text: str, indent: str = "  ") -> list[str]:
    return textwrap.wrap(
        text, _TEXT_WIDTH, initial_indent=indent, subsequent_indent="  ", max_lines=_MOST_LINES, placeholder=" …",
        break_long_words=False,
    )  # fmt: skip
