"""The view state as a link: all choices, at full precision, in the query string of the page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import astuple
from typing import Any
from urllib.parse import urlencode

import numpy as np

from app.state.compared_view import ComparedView
from app.state.link_letters import LETTERS, drop_unknown_letters, letters_in_link, read_letters
from app.state.view_state import (
    IMAGE_CHOICES,
    LAYERS,
    PICTURES,
    SYSTEM,
    Analysis,
    Start,
    ViewState,
    allowed_resolutions,
    allowed_t_max,
    longest_first_t_max,
)
from app.state.watched_starts import COUNTS, DEFAULT_STARTS, StartsFrom, WatchedStarts
from engine import POTENTIALS, Plane, Slice, System, Window
from engine.foundations.validation import LARGEST_NUMBER
from engine.slices.slice_text import read_slice, write_slice
from engine.systems.formulas.formula_parser import LARGEST_VALUE, LONGEST_TEXT
from engine.systems.parameters import WELL_PARAMETERS
from engine.systems.review.potential_review import SystemReview
from engine.systems.system import TYPED
from plots.pictures.map_images import ON_DEMAND
from plots.pictures.palette import MOST_ORBITS, PALETTES
from plots.pictures.time_scale import TimeScale

LONGEST_VALUE = LONGEST_TEXT
"""Maximal length of a value in a link, in characters."""

EMBED = "embed"
"""Parameter of a page in a frame of another one, which shows one picture only; its value is that of ``focus``."""

_FIRST_EMBEDDED = "basins"
# The lower end of a scale of escape times whose link names the upper end only.
_SHORTEST = 1.0
_SHOWN = 40
# Attributes that have no meaning for another system.
_OF_SYSTEM = ("energy", "window", "box", "starts", "chosen")


def write_link(state: ViewState, *, embedded: bool = False) -> str:
    """Query string of a view state, with its question mark.

    Parameters
    ----------
    state
        The view.
    embedded
        Whether the page shows one picture only: the one that is shown large, or else the basins.
    """
    chosen: dict[str, Any] = {
        **_system_in_link(state.system),
        **_slice_in_link(state.plane),
        "h": repr(float(state.energy)),
        "t_max": f"{state.t_max:g}",
        "resolution": state.resolution,
    }
    if state.compared is not None:
        chosen |= _compared_in_link(state.compared)
    for name in ("window", "box"):
        part: Window | None = getattr(state, name)
        if part is not None:
            chosen[name] = _joined(astuple(part))
    chosen |= {name: "yes" for name in LAYERS if getattr(state, name)}
    if state.images:
        chosen["images"] = state.images
    if state.analysis is not Analysis.ORBIT:
        chosen["analysis"] = state.analysis.value
    if state.watched != DEFAULT_STARTS:
        chosen["watch"] = f"{state.watched.where},{state.watched.count},{state.watched.seed},{state.watched.radius:g}"
    if embedded:
        chosen[EMBED] = state.focus or _FIRST_EMBEDDED
    elif state.focus:
        chosen["focus"] = state.focus
    if state.palette != ViewState.param.palette.default:
        chosen["palette"] = state.palette
    if state.lock_times is not None:
        chosen["lock_times"] = f"{state.lock_times.low:g},{state.lock_times.high:g}"
    starts: tuple[Start, ...] = state.starts
    if starts:
        chosen["orbits"] = ";".join(map(_joined, starts))
        chosen["look"] = state.chosen + 1
    return "?" + urlencode(chosen, safe=",;:=")


def read_link(parameters: Mapping[str, str], prefix: str = "") -> tuple[dict[str, Any], list[str]]:
    """Parse the parameters of a link; its potential is reviewed later, see `linked_system` and `fit_to_system`.

    Parameters
    ----------
    parameters
        Names and values of the query string. Unknown names are ignored: other sites append their own.
    prefix
        What the names begin with in messages.

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
            value = read(text)
            values[attribute] = values.get(attribute, {}) | value if isinstance(value, dict) else value
        except (ValueError, KeyError):
            problems.append(f"Ignored {_quoted(prefix + name, text)}: choose {legal}.")
    problems += drop_unknown_letters(values)
    problems += [*_read_slice(parameters, values, prefix), *_read_compared(parameters, values)]
    if EMBED in parameters and values.get("focus") in ON_DEMAND:
        values[ON_DEMAND[values["focus"]]] = True
    if values.get("chosen", 0) >= len(values.get("starts", (0,))):
        values["chosen"] = 0
    return values, problems


def _system_in_link(system: System) -> dict[str, str]:
    """The system as parameters of a link."""
    return {
        "case": system.case,
        **({"V": system.formula} if system.case == TYPED else {}),
        **{name: repr(value) for name, value in system.parameters.items() if name in WELL_PARAMETERS},
        **letters_in_link(system),
    }


def _compared_in_link(view: ComparedView) -> dict[str, str]:
    """The view with which the state is compared; the names of its parameters are those of the state with a prefix."""
    energies = view.energy if isinstance(view.energy, tuple) else (view.energy,)
    parts = {**_system_in_link(view.system), **_slice_in_link(view.plane), "h": _joined(energies)}
    return {f"{_COMPARED}{name}": text for name, text in parts.items()}


def _read_compared(parameters: Mapping[str, str], values: dict[str, Any]) -> list[str]:
    """Add the view with which the state is compared to the values of a link, or return messages why there is none."""
    given = {name.removeprefix(_COMPARED): text for name, text in parameters.items() if name.startswith(_COMPARED)}
    if not given:
        return []
    energy = given.pop("h", "")
    described = {name: text for name, text in given.items() if name in _DESCRIBES_VIEW}
    found, problems = read_link(described, _COMPARED)
    try:
        plane = found.get("plane", ViewState.param.plane.default)
        if len(energy) > LONGEST_VALUE:
            raise ValueError
        first, *last = _read_numbers(energy, 1 if plane.energy_axis is None else 2)
        if max(map(abs, (first, *last))) > LARGEST_NUMBER:
            raise ValueError
    except ValueError:
        return [*problems, f"Ignored {_quoted(f'{_COMPARED}h', energy)}: choose a number, such as 0.25, or two for an axis h."]
    if not problems:
        values["compared"] = ComparedView(linked_system(found), plane, (first, last[0]) if last else first)
    return problems


def _slice_in_link(chosen: Slice) -> dict[str, str]:
    """The slice as parameters of a link."""
    axes, held = write_slice(chosen)
    return {_PLANE: axes, **({_FIX: held} if held else {})}


def _read_slice(parameters: Mapping[str, str], values: dict[str, Any], prefix: str) -> list[str]:
    """Add the slice of a link to its values, or return a message why there is none."""
    axes, held = (parameters.get(name, "") for name in (_PLANE, _FIX))
    if not axes and not held:
        return []
    try:
        if len(axes) + len(held) > LONGEST_VALUE:
            raise ValueError
        values["plane"] = read_slice(axes, held, linked_system(values))
    except ValueError:
        shown = ", ".join(_quoted(prefix + name, parameters[name]) for name in (_PLANE, _FIX) if name in parameters)
        return [f"Ignored {shown}: choose {_listed(plane.key for plane in Plane)}, or two axes such as x,theta held by y=0.1."]
    return []


def linked_system(values: Mapping[str, Any]) -> System:
    """The system of the values of a link, not reviewed yet; that of the first view if they name none."""
    named: dict[str, Any] = {"case": TYPED if "formula" in values else ViewState.param.case.default}
    return System(**(named | {name: values[name] for name in SYSTEM if name in values}))


def without_system(values: Mapping[str, Any]) -> dict[str, Any]:
    """The values of a link that have a meaning for any system."""
    return {
        name: value
        for name, value in values.items()
        if name not in (*SYSTEM, *_OF_SYSTEM) and not (name == "plane" and value.parameter is not None)
    }


def fit_to_system(values: Mapping[str, Any], reviewed: SystemReview) -> tuple[dict[str, Any], list[str]]:
    """The values of a link to show together with its system, and a message for an invalid one.

    Parameters
    ----------
    values
        Values of `read_link`.
    reviewed
        The review of their `linked_system`, which is not refused.
    """
    lowest, first = float(reviewed.potential.value(0.0, 0.0)), reviewed.energies.first
    t_max = min(ViewState.param.t_max.default, longest_first_t_max(reviewed.potential))
    shown = {"energy": first, "t_max": t_max} | {name: value for name, value in values.items() if name not in SYSTEM}
    if shown["energy"] > lowest:
        return shown, []
    problem = f"Ignored h={shown['energy']:.6g}: choose an energy above {lowest:.6g}, such as {first:.6g}."
    return shown | {"energy": first}, [problem]


def refused_link(problem: str) -> str:
    """The message for a link whose system is refused."""
    return f"Ignored the potential in the link: {problem}"


def refused_comparison(problem: str) -> str:
    """The message for a link whose view to compare with has a system that is refused."""
    return f"Ignored the view in the link with which to compare: {problem}"


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


def _read_times(text: str) -> TimeScale:
    """A scale of escape times; a single number is its upper end."""
    return TimeScale(*_read_numbers(text, 2)) if "," in text else TimeScale(_SHORTEST, _read_number(text))


def _read_starts(text: str) -> tuple[tuple[float, ...], ...]:
    starts = tuple(_read_numbers(pair, 2) for pair in text.split(";"))
    if len(starts) > MOST_ORBITS:
        raise ValueError
    return starts


def _read_watched(text: str) -> WatchedStarts:
    where, count, seed, radius = text.split(",")
    return WatchedStarts(StartsFrom(where), int(count), int(seed), _read_number(radius))


def _between(low: float, high: float) -> Callable[[str], float]:
    def read(text: str) -> float:
        number = _read_number(text)
        if not low <= number <= high:
            raise ValueError
        return number

    return read


def _parameter(name: str, low: float, high: float) -> Callable[[str], dict[str, float]]:
    """A parser of the value of ω1, ω2 or ε."""
    read = _between(low, high)
    return lambda text: {name: read(text)}


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
_PLANE, _FIX = "plane", "fix"
_COMPARED = "with_"
_DESCRIBES_VIEW = ("case", "V", *WELL_PARAMETERS, LETTERS, _PLANE, _FIX)
_SWITCH = {"yes": True, "no": False}
_ANALYSES = {analysis.value: analysis for analysis in Analysis}
_PICTURES = {name: name for name in PICTURES}
_PALETTES = {name: name for name in PALETTES}
_PLACES = {str(place + 1): place for place in range(MOST_ORBITS)}
_WINDOW = "four numbers x_low,x_high,ordinate_low,ordinate_high, each low below its high"

# For each parameter: attribute of the view state, parser, and legal values.
_READERS: dict[str, tuple[str, Callable[[str], Any], str]] = {
    "case": ("case", _one_of(_CASES), _listed(_CASES)),
    "V": ("formula", str, f"a formula in x and y of at most {LONGEST_TEXT} characters"),
    **{
        name: ("parameters", _parameter(name, low, high), f"a number from {low:g} to {high:g}")
        for name, (_, _, (low, high)) in WELL_PARAMETERS.items()
    },
    LETTERS: (
        "parameters",
        read_letters,
        f"letter:number pairs such as a:1.5,b:-2, from {-LARGEST_VALUE:g} to {LARGEST_VALUE:g}",
    ),
    "h": ("energy", _between(-LARGEST_NUMBER, LARGEST_NUMBER), "a number, such as 0.25"),
    "window": ("window", _read_window, _WINDOW),
    "box": ("box", _read_window, _WINDOW),
    **{name: (name, _one_of(_SWITCH), "yes or no") for name in LAYERS},
    "analysis": ("analysis", _one_of(_ANALYSES), _listed(_ANALYSES)),
    "watch": (
        "watched",
        _read_watched,
        f"{_listed(StartsFrom)}, {_listed(map(str, COUNTS))}, a seed, and a power of ten, such as well,5000,1,-2",
    ),
    "focus": ("focus", _one_of(_PICTURES), _listed(_PICTURES)),
    EMBED: ("focus", _one_of(_PICTURES), _listed(_PICTURES)),
    "images": ("images", _one_of(IMAGE_CHOICES), _listed(IMAGE_CHOICES)),
    "palette": ("palette", _one_of(_PALETTES), _listed(_PALETTES)),
    "lock_times": ("lock_times", _read_times, "two positive numbers low,high, the first below the second"),
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


PARAMETERS = (*_READERS, _PLANE, _FIX, *(f"{_COMPARED}{name}" for name in (*_DESCRIBES_VIEW, "h")), "t_max", "resolution")
"""Names of the parameters of a link."""

LINKED = (*dict.fromkeys(attribute for attribute, _, _ in _READERS.values()), "plane", "compared", "t_max", "resolution")
"""Attributes of the view state that a link contains."""
