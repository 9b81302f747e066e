"""The view as a link: everything that was chosen, at full precision, in the address of the page."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, astuple
from typing import Any
from urllib.parse import urlencode

import numpy as np

from app.rendering.palette import MOST_ORBITS, PALETTES
from app.state.system import SYSTEM, TYPED, System, refusal
from app.state.view_state import RESOLUTION_CHOICES, SWITCHES, T_MAX_CHOICES, Start, ViewState
from engine import CASES, FREQUENCIES, LONGEST_TEXT, POTENTIALS, STRENGTHS, Plane, Window, review_potential

LONGEST_VALUE = LONGEST_TEXT
"""Most characters that a value in a link may have."""

_SHOWN = 40


def write_link(state: ViewState) -> str:
    """The query string, with its question mark, that opens the page on this view."""
    chosen: dict[str, Any] = {
        "case": state.case,
        **({"V": state.formula} if state.case == TYPED else {}),
        **{name: repr(value) for name, value in state.system.changed.items()},
        "plane": state.plane.name.lower(),
        "h": repr(float(state.energy)),
        "t_max": f"{state.t_max:g}",
        "resolution": state.resolution,
    }
    if state.window is not None:
        chosen["window"] = _joined(astuple(state.window))
    chosen |= {name: "yes" for name in SWITCHES if getattr(state, name)}
    if state.palette != ViewState.param.palette.default:
        chosen["palette"] = state.palette
    starts: tuple[Start, ...] = state.starts
    if starts:
        chosen["orbits"] = ";".join(map(_joined, starts))
        chosen["look"] = state.chosen + 1
    return "?" + urlencode(chosen, safe=",;")


def read_link(parameters: Mapping[str, str]) -> tuple[dict[str, Any], list[str]]:
    """What a link asks for, as values of the view state, and a sentence for each value that is of no use.

    Values that are of no use are left out, as are parameters that nobody here knows: other sites append their own.
    """
    values: dict[str, Any] = {}
    problems: list[str] = []
    for name, (attribute, read, legal) in _READERS.items():
        if name not in parameters:
            continue
        text = parameters[name]
        try:
            if len(text) > LONGEST_VALUE:
                raise ValueError
            values[attribute] = read(text)
        except (ValueError, KeyError):
            problems.append(f"In the link, {name}={_shown(text)} is of no use: it must be {legal}.")
    values, refused = _with_system(values)
    problems += [refused] if refused else []
    if values.get("chosen", 0) >= len(values.get("starts", (0,))):
        values["chosen"] = 0
    return values, problems


def _with_system(values: dict[str, Any]) -> tuple[dict[str, Any], str]:
    """The values with a system that can be shown and an energy for it, and the reason where the one asked for cannot."""
    asked = {name: values[name] for name in SYSTEM if name in values}
    if not asked:
        return values, ""
    plain: dict[str, Any] = {"case": TYPED if "formula" in asked else ViewState.param.case.default}
    system = System(**(plain | asked))
    try:
        why = None if system.case in CASES and not system.changed else refusal(review_potential(system.potential))
    except ValueError as error:
        why = str(error)
    if why is None:
        return {"energy": system.energies.first} | values | asdict(system), ""
    # Where another system takes its place, its energy, window and orbits mean nothing.
    others = {name: value for name, value in values.items() if name not in (*SYSTEM, "energy", "window", "starts", "chosen")}
    return others, f"The potential in the link is of no use: {why}"


def _shown(text: str) -> str:
    """A visitor's text as it may be shown: short, and without a character that any markup gives a meaning to."""
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


_CASES = {name: name for name in (*POTENTIALS, TYPED)}
_PLANES = {plane.name.lower(): plane for plane in Plane}
_TIMES = {f"{t_max:g}": t_max for t_max in T_MAX_CHOICES.values()}
_RESOLUTIONS = {str(side): side for side in RESOLUTION_CHOICES.values()}
_SWITCH = {"yes": True, "no": False}
_PALETTES = {name: name for name in PALETTES}
_PLACES = {str(place + 1): place for place in range(MOST_ORBITS)}

# For each parameter: what it sets, how it is read, and what is legal.
_READERS: dict[str, tuple[str, Callable[[str], Any], str]] = {
    "case": ("case", _one_of(_CASES), f"one of {', '.join(_CASES)}"),
    "V": ("formula", str, f"a polynomial in x and y of at most {LONGEST_TEXT} characters"),
    "omega_1": ("omega_1", _between(*FREQUENCIES), f"a number from {FREQUENCIES[0]:g} to {FREQUENCIES[1]:g}"),
    "omega_2": ("omega_2", _between(*FREQUENCIES), f"a number from {FREQUENCIES[0]:g} to {FREQUENCIES[1]:g}"),
    "epsilon": ("epsilon", _between(*STRENGTHS), f"a number from {STRENGTHS[0]:g} to {STRENGTHS[1]:g}"),
    "plane": ("plane", _one_of(_PLANES), f"one of {', '.join(_PLANES)}"),
    "h": ("energy", _read_number, "a finite number"),
    "t_max": ("t_max", _one_of(_TIMES), f"one of {', '.join(_TIMES)}"),
    "resolution": ("resolution", _one_of(_RESOLUTIONS), f"one of {', '.join(_RESOLUTIONS)}"),
    "window": ("window", lambda text: Window(*_read_numbers(text, 4)), "x_low,x_high,ordinate_low,ordinate_high"),
    **{name: (name, _one_of(_SWITCH), "yes or no") for name in SWITCHES},
    "palette": ("palette", _one_of(_PALETTES), f"one of {', '.join(_PALETTES)}"),
    "orbits": ("starts", _read_starts, f"up to {MOST_ORBITS} starts x,ordinate with semicolons between"),
    "look": ("chosen", _one_of(_PLACES), f"one of {', '.join(_PLACES)}"),
}

LINKED = tuple(attribute for attribute, _, _ in _READERS.values())
"""What a link holds of the view state."""
