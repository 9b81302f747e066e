"""How values are written in links and read from them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import astuple, dataclass
from typing import Any

import numpy as np

from engine import Window, read_section
from plots.pictures.palette import MOST_ORBITS
from plots.pictures.time_scale import TimeScale

# Lower end of a scale of escape times if the link contains only the upper end (dimensionless).
_DEFAULT_LOW_TIME = 1.0


@dataclass(frozen=True)
class Format:
    """The text form of a value in a link.

    Attributes
    ----------
    write
        Returns the text for a value.
    read
        Returns the value for a text; raises ValueError or KeyError for a text that is not legal.
    legal
        Returns a description of the legal values, which may depend on the settings of the server.
    """

    write: Callable[[Any], str]
    read: Callable[[str], Any]
    legal: Callable[[], str]


@dataclass(frozen=True)
class LinkParameter:
    """The link parameter for a field of the view.

    Attributes
    ----------
    name
        Name in the link.
    form
        Text form of the value.
    of_system
        Whether the value has no meaning for another system.
    always
        Whether a link also contains the default value.
    """

    name: str
    form: Format
    of_system: bool = False
    always: bool = False


def choice_format(choices: Mapping[str, Any]) -> Format:
    """Return the form of one of several values, written by name."""
    names = {value: name for name, value in choices.items()}
    return Format(names.__getitem__, choices.__getitem__, lambda: listed(choices))


def name_format(names: Iterable[str]) -> Format:
    """Return the form of one of several names."""
    return choice_format({name: name for name in names})


def number_choice_format(choices: Callable[[], Mapping[str, float]]) -> Format:
    """Return the form of one of several labelled numbers. Any usual format can be read: 100000, 1e5, 1E+5, 100 000 or 100,000."""

    def read(text: str) -> float:
        by_value = {float(choice): choice for choice in choices().values()}
        return by_value[read_number("".join(text.split()).replace(",", ""))]

    return Format("{:g}".format, read, lambda: listed(choices()))


def number_format(low: float, high: float, legal: str) -> Format:
    """Return the form of a number from `low` to `high`, written at full precision."""

    def read(text: str) -> float:
        number = read_number(text)
        if not low <= number <= high:
            raise ValueError
        return number

    return Format(lambda number: repr(float(number)), read, lambda: legal)


def read_number(text: str) -> float:
    """Return a finite number; ValueError for other texts."""
    number = float(text)
    if not np.isfinite(number):
        raise ValueError
    return number


def listed(choices: Iterable[str]) -> str:
    """Return choices as an enumeration: "a, b or c"."""
    *first_choices, last = choices
    return f"{', '.join(first_choices)} or {last}" if first_choices else last


def _read_numbers(text: str, count: int) -> tuple[float, ...]:
    numbers = tuple(map(read_number, text.split(",")))
    if len(numbers) != count:
        raise ValueError
    return numbers


def _write_numbers(numbers: Iterable[float]) -> str:
    return ",".join(repr(float(number)) for number in numbers)


def _read_times(text: str) -> TimeScale:
    """Return a scale of escape times; a single number is its upper end."""
    return TimeScale(*_read_numbers(text, 2)) if "," in text else TimeScale(_DEFAULT_LOW_TIME, read_number(text))


def _read_starts(text: str) -> tuple[tuple[float, ...], ...]:
    starts = tuple(_read_numbers(pair, 2) for pair in text.split(";"))
    if len(starts) > MOST_ORBITS:
        raise ValueError
    return starts


SWITCH = choice_format({"yes": True, "no": False})
"""Text form of a switch."""

WINDOW = Format(
    lambda window: _write_numbers(astuple(window)),
    lambda text: Window(*_read_numbers(text, 4)),
    lambda: "four numbers x_low,x_high,ordinate_low,ordinate_high, each low below its high",
)
"""Text form of a window or a box."""

SECTION = Format(lambda section: section.text, read_section, lambda: "a section, such as x = 0 up, angle = 30° or apsis")
"""Text form of a surface of section."""

TIMES = Format(
    lambda times: f"{times.low:g},{times.high:g}",
    _read_times,
    lambda: "two positive numbers low,high, the first below the second",
)
"""Text form of a scale of escape times."""

STARTS = Format(
    lambda starts: ";".join(map(_write_numbers, starts)),
    _read_starts,
    lambda: f"up to {MOST_ORBITS} starts x,ordinate, separated by semicolons",
)
"""Text form of the starts of the orbits."""
