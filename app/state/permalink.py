"""The view state as a link: all choices, at full precision, in the query string of the page."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import asdict, astuple
from typing import Any
from urllib.parse import urlencode

import numpy as np

from app.rendering.palette import MOST_ORBITS, PALETTES
from app.state.system import SYSTEM, TYPED, System, refusal
from app.state.view_state import LAYERS, Analysis, Start, ViewState, allowed_resolutions, allowed_t_max
from engine import CASES, FREQUENCIES, LONGEST_TEXT, POTENTIALS, STRENGTHS, Plane, Window, review_potential

LONGEST_VALUE = LONGEST_TEXT
"""Maximal length of a value in a link, in characters."""

_SHOWN = 40


def write_link(state: ViewState) -> str:
    """Query string of a view state, with its question mark."""
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
    chosen |= {name: "yes" for name in LAYERS if getattr(state, name)}
    if state.analysis is not Analysis.NONE:
        chosen["analysis"] = state.analysis.value
    if state.palette != ViewState.param.palette.default:
        chosen["palette"] = state.palette
    starts: tuple[Start, ...] = state.starts
    if starts:
        chosen["orbits"] = ";".join(map(_joined, starts))
        chosen["look"] = state.chosen + 1
    return "?" + urlencode(chosen, safe=",;")


def read_link(parameters: Mapping[str, str]) -> tuple[dict[str, Any], list[str]]:
    """Parse the parameters of a link.

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
            problems.append(f"Ignored {name}={_shown(text)} in the link: choose {legal}.")
    values, problem = _with_system(values)
    problems += [problem] if problem else []
    if values.get("chosen", 0) >= len(values.get("starts", (0,))):
        values["chosen"] = 0
    return values, problems


def _with_system(values: dict[str, Any]) -> tuple[dict[str, Any], str]:
    """Complete the values by a system and its energy; drop an invalid system and return the reason."""
    asked = {name: values[name] for name in SYSTEM if name in values}
    if not asked:
        return values, ""
    defaults: dict[str, Any] = {"case": TYPED if "formula" in asked else ViewState.param.case.default}
    system = System(**(defaults | asked))
    try:
        problem = None if system.case in CASES and not system.changed else refusal(review_potential(system.potential))
    except ValueError as error:
        problem = str(error)
    if problem is None:
        return {"energy": system.energies.first} | values | asdict(system), ""
    # Energy, window and starts are meaningless for the default system.
    others = {name: value for name, value in values.items() if name not in (*SYSTEM, "energy", "window", "starts", "chosen")}
    return others, f"Ignored the potential in the link: {problem}"


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
_SWITCH = {"yes": True, "no": False}
_ANALYSES = {analysis.value: analysis for analysis in Analysis}
_PALETTES = {name: name for name in PALETTES}
_PLACES = {str(place + 1): place for place in range(MOST_ORBITS)}

# For each parameter: attribute of the view state, parser, and legal values.
_READERS: dict[str, tuple[str, Callable[[str], Any], str]] = {
    "case": ("case", _one_of(_CASES), f"one of {', '.join(_CASES)}"),
    "V": ("formula", str, f"a polynomial in x and y of at most {LONGEST_TEXT} characters"),
    "omega_1": ("omega_1", _between(*FREQUENCIES), f"a number from {FREQUENCIES[0]:g} to {FREQUENCIES[1]:g}"),
    "omega_2": ("omega_2", _between(*FREQUENCIES), f"a number from {FREQUENCIES[0]:g} to {FREQUENCIES[1]:g}"),
    "epsilon": ("epsilon", _between(*STRENGTHS), f"a number from {STRENGTHS[0]:g} to {STRENGTHS[1]:g}"),
    "plane": ("plane", _one_of(_PLANES), f"one of {', '.join(_PLANES)}"),
    "h": ("energy", _read_number, "a finite number"),
    "window": ("window", lambda text: Window(*_read_numbers(text, 4)), "x_low,x_high,ordinate_low,ordinate_high"),
    **{name: (name, _one_of(_SWITCH), "yes or no") for name in LAYERS},
    "analysis": ("analysis", _one_of(_ANALYSES), f"one of {', '.join(Analysis)}"),
    "palette": ("palette", _one_of(_PALETTES), f"one of {', '.join(_PALETTES)}"),
    "orbits": ("starts", _read_starts, f"up to {MOST_ORBITS} starts x,ordinate, separated by semicolons"),
    "look": ("chosen", _one_of(_PLACES), f"one of {', '.join(_PLACES)}"),
}


def _limited_readers() -> dict[str, tuple[str, Callable[[str], Any], str]]:
    """Readers of the parameters whose choices depend on the server's settings."""
    times = {text: t_max for t_max in allowed_t_max().values() for text in (f"{t_max:g}", f"{t_max:.0f}")}
    sides = {str(side): side for side in allowed_resolutions().values()}
    return {
        "t_max": ("t_max", _one_of(times), ", ".join(allowed_t_max())),
        "resolution": ("resolution", _one_of(sides), ", ".join(sides)),
    }


LINKED = (*(attribute for attribute, _, _ in _READERS.values()), "t_max", "resolution")
"""Attributes of the view state that a link contains."""
