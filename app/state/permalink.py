"""The view state as a link: all choices, at full precision, in the query string of the page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import astuple
from typing import Any
from urllib.parse import urlencode

import numpy as np

from app.state.system_review import SystemReview
from app.state.view_state import (
    IMAGE_CHOICES,
    LAYERS,
    LOCKED_TIMES,
    SYSTEM,
    Analysis,
    Start,
    ViewState,
    allowed_resolutions,
    allowed_t_max,
)
from engine import POTENTIALS, Plane, Window
from engine.service import FREQUENCIES, LARGEST_NUMBER, LONGEST_TEXT, STRENGTHS, TYPED, System
from plots.palette import MOST_ORBITS, PALETTES

LONGEST_VALUE = LONGEST_TEXT
"""Maximal length of a value in a link, in characters."""

_SHOWN = 40
# Attributes that have no meaning for another system.
_OF_SYSTEM = ("energy", "window", "box", "starts", "chosen")


def write_link(state: ViewState) -> str:
    """Query string of a view state, with its question mark."""
    chosen: dict[str, Any] = {
        "case": state.case,
        **({"V": state.formula} if state.case == TYPED else {}),
        **{name: repr(value) for name, value in state.system.changed.items()},
        "plane": state.plane.key,
        "h": repr(float(state.energy)),
        "t_max": f"{state.t_max:g}",
        "resolution": state.resolution,
    }
    for name in ("window", "box"):
        part: Window | None = getattr(state, name)
        if part is not None:
            chosen[name] = _joined(astuple(part))
    chosen |= {name: "yes" for name in LAYERS if getattr(state, name)}
    if state.images:
        chosen["images"] = state.images
    if state.analysis is not Analysis.ORBIT:
        chosen["analysis"] = state.analysis.value
    if state.palette != ViewState.param.palette.default:
        chosen["palette"] = state.palette
    if state.lock_times is not None:
        chosen["lock_times"] = f"{state.lock_times:g}"
    starts: tuple[Start, ...] = state.starts
    if starts:
        chosen["orbits"] = ";".join(map(_joined, starts))
        chosen["look"] = state.chosen + 1
    return "?" + urlencode(chosen, safe=",;")


def read_link(parameters: Mapping[str, str]) -> tuple[dict[str, Any], list[str]]:
    """Parse the parameters of a link; its potential is reviewed later, see `linked_system` and `fit_to_system`.

    Parameters
    ----------
    parameters
        Names and values of the query string. Unknown names are ignored: other sites append their own.

    Returns
    -------
    values : dict
        Valid values by attribute of the view state.
    problems : list of str
        A message for each invalid value.
    """
    values: dict[str, Any] = {}
    problems: list[str] = []
    for name, (attribute, read, legal) in (_READERS | _limited_readers()).items():
        if name not in parameters:
            continue
        text = parameters[name]
        try:
            if len(text) > LONGEST_VALUE:
                raise ValueError
            values[attribute] = read(text)
        except (ValueError, KeyError):
            problems.append(f"Ignored {_quoted(name, text)}: choose {legal}.")
    if values.get("chosen", 0) >= len(values.get("starts", (0,))):
        values["chosen"] = 0
    return values, problems


def linked_system(values: Mapping[str, Any]) -> System:
    """The system of the values of a link, not reviewed yet; that of the first view if they name none."""
    named: dict[str, Any] = {"case": TYPED if "formula" in values else ViewState.param.case.default}
    return System(**(named | {name: values[name] for name in SYSTEM if name in values}))


def without_system(values: Mapping[str, Any]) -> dict[str, Any]:
    """The values of a link that have a meaning for any system."""
    return {name: value for name, value in values.items() if name not in (*SYSTEM, *_OF_SYSTEM)}


def fit_to_system(values: Mapping[str, Any], reviewed: SystemReview) -> tuple[dict[str, Any], list[str]]:
    """The values of a link to show together with its system, and a message for an invalid one.

    Parameters
    ----------
    values
        Values of `read_link`.
    reviewed
        The review of their `linked_system`, which is not refused.
    """
    assert reviewed.energies is not None, "a refused system is not shown"
    lowest, first = float(reviewed.potential.value(0.0, 0.0)), reviewed.energies.first
    shown = {"energy": first} | {name: value for name, value in values.items() if name not in SYSTEM}
    if shown["energy"] > lowest:
        return shown, []
    problem = f"Ignored h={shown['energy']:.6g}: choose an energy above {lowest:.6g}, such as {first:.6g}."
    return shown | {"energy": first}, [problem]


def refused_link(problem: str) -> str:
    """The message for a link whose system is refused."""
    return f"Ignored the potential in the link: {problem}"


def _quoted(name: str, text: str) -> str:
    # "nan" in a message looks like a result.
    return name if "nan" in text.lower() else f"{name}={_shown(text)}"


def _shown(text: str) -> str:
    """Text of a link for messages: truncated, and without markup characters."""
    safe = "".join(c if c.isascii() and (c.isalnum() or c in " .,+-") else "?" for c in text[:_SHOWN])
    return safe + " …" if len(text) > _SHOWN else safe


def _joined(numbers: tuple[float, ...]) -> str:
    return ",".join(repr(float(number)) for number in numbers)


def _read_number(text: str) -> float:
    number = float(text)
    if not np.isfinite(number):
        raise ValueError
    return number


def _read_numbers(text: str, count: int) -> tuple[float, ...]:
    numbers = tuple(map(_read_number, text.split(",")))
    if len(numbers) != count:
        raise ValueError
    return numbers


def _read_window(text: str) -> Window:
    return Window(*_read_numbers(text, 4))


def _read_starts(text: str) -> tuple[tuple[float, ...], ...]:
    starts = tuple(_read_numbers(pair, 2) for pair in text.split(";"))
    if len(starts) > MOST_ORBITS:
        raise ValueError
    return starts


def _between(low: float, high: float) -> Callable[[str], float]:
    def read(text: str) -> float:
        number = _read_number(text)
        if not low <= number <= high:
            raise ValueError
        return number

    return read


def _one_of(choices: Mapping[str, Any]) -> Callable[[str], Any]:
    return lambda text: choices[text]


def _one_number_of(choices: Iterable[float]) -> Callable[[str], Any]:
    """A parser of any usual format of one of the numbers: 100000, 1e5, 1E+5, 100 000 and 100,000."""
    by_value = {float(choice): choice for choice in choices}
    return lambda text: by_value[_read_number("".join(text.split()).replace(",", ""))]


def _listed(choices: Iterable[str]) -> str:
    *others, last = choices
    return f"{', '.join(others)} or {last}" if others else last


_CASES = {name: name for name in (*POTENTIALS, TYPED)}
_PLANES = {plane.key: plane for plane in Plane}
_SWITCH = {"yes": True, "no": False}
_ANALYSES = {analysis.value: analysis for analysis in Analysis}
_PALETTES = {name: name for name in PALETTES}
_PLACES = {str(place + 1): place for place in range(MOST_ORBITS)}
_WINDOW = "four numbers x_low,x_high,ordinate_low,ordinate_high, each low below its high"

# For each parameter: attribute of the view state, parser, and legal values.
_READERS: dict[str, tuple[str, Callable[[str], Any], str]] = {
    "case": ("case", _one_of(_CASES), _listed(_CASES)),
    "V": ("formula", str, f"a polynomial in x and y of at most {LONGEST_TEXT} characters"),
    "omega_1": ("omega_1", _between(*FREQUENCIES), f"a number from {FREQUENCIES[0]:g} to {FREQUENCIES[1]:g}"),
    "omega_2": ("omega_2", _between(*FREQUENCIES), f"a number from {FREQUENCIES[0]:g} to {FREQUENCIES[1]:g}"),
    "epsilon": ("epsilon", _between(*STRENGTHS), f"a number from {STRENGTHS[0]:g} to {STRENGTHS[1]:g}"),
    "plane": ("plane", _one_of(_PLANES), _listed(_PLANES)),
    "h": ("energy", _between(-LARGEST_NUMBER, LARGEST_NUMBER), "a number, such as 0.25"),
    "window": ("window", _read_window, _WINDOW),
    "box": ("box", _read_window, _WINDOW),
    **{name: (name, _one_of(_SWITCH), "yes or no") for name in LAYERS},
    "analysis": ("analysis", _one_of(_ANALYSES), _listed(_ANALYSES)),
    "images": ("images", _one_of(IMAGE_CHOICES), _listed(IMAGE_CHOICES)),
    "palette": ("palette", _one_of(_PALETTES), _listed(_PALETTES)),
    "lock_times": ("lock_times", _between(*LOCKED_TIMES), f"a number from {LOCKED_TIMES[0]:g} to {LOCKED_TIMES[1]:g}"),
    "orbits": ("starts", _read_starts, f"up to {MOST_ORBITS} starts x,ordinate, separated by semicolons"),
    "look": ("chosen", _one_of(_PLACES), _listed(_PLACES)),
}


def _limited_readers() -> dict[str, tuple[str, Callable[[str], Any], str]]:
    """Readers of the parameters whose choices depend on the server's settings."""
    times, sides = allowed_t_max(), allowed_resolutions().values()
    return {
        "t_max": ("t_max", _one_number_of(times.values()), _listed(times)),
        "resolution": ("resolution", _one_number_of(sides), _listed(map(str, sides))),
    }


PARAMETERS = (*_READERS, "t_max", "resolution")
"""Names of the parameters of a link."""

LINKED = (*(attribute for attribute, _, _ in _READERS.values()), "t_max", "resolution")
"""Attributes of the view state that a link contains."""
