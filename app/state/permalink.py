"""The view state as a link: all choices, at full precision, in the query string of the page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from urllib.parse import urlencode

from app.state.link_formats import (
    SECTION,
    STARTS,
    SWITCH,
    TIMES,
    WATCHED,
    WINDOW,
    Format,
    LinkParameter,
    choice_format,
    listed,
    name_format,
    number_choice_format,
    number_format,
)
from app.state.link_system import SYSTEM_FORMATS, system_of, write_system
from app.state.system_review import PageReview
from app.state.view import (
    ANALYSES,
    FIRST_VIEW,
    PICTURES,
    SETTINGS,
    View,
    allowed_resolutions,
    allowed_t_max,
    default_settings,
)
from app.state.view_state import ViewState, longest_first_t_max
from engine import Plane
from engine.foundations.validation import LARGEST_NUMBER
from engine.slices.slice_text import read_slice, write_slice
from engine.systems.formulas.formula_parser import LONGEST_TEXT
from plots.layers.table import LAYERS, LAYERS_BY_PICTURE
from plots.pictures.palette import MOST_ORBITS, PALETTES

LONGEST_VALUE = LONGEST_TEXT
"""Largest length of a value in a link, in characters."""

EMBED = "embed"
"""Link parameter of a page in an iframe of another page. Its value is the name of the only picture that is shown."""

_DEFAULT_PICTURE = "basins"
# Longest part of a value that a message repeats, in characters.
_LONGEST_QUOTE = 40
# Names of link parameters.
_PLANE, _FIX, _ENERGY, _JACOBI, _SECTION = "plane", "fix", "h", "C", "section"
# Prefix of the parameters of the view with which the state is compared.
_COMPARED = "with_"
# Names of the parameters of system, slice, energy and section.
_VIEW_PARAMETERS = (*SYSTEM_FORMATS, _PLANE, _FIX, _ENERGY, _SECTION)

# Indices of starts by the number that the page shows.
_PLACES = {str(place + 1): place for place in range(MOST_ORBITS)}


def _sides() -> dict[str, int]:
    """Return the columns and rows that the server's settings allow, by their text in a link."""
    return {str(side): side for side in allowed_resolutions().values()}


# Link parameters of attributes of the view state with one parameter each, in the order of links: fields of `View`, then the
# visitor's own choices.
_LINKED: dict[str, LinkParameter] = {
    "section": LinkParameter(_SECTION, SECTION),
    "t_max": LinkParameter("t_max", number_choice_format(allowed_t_max), always=True),
    "resolution": LinkParameter("resolution", number_choice_format(_sides), always=True),
    "window": LinkParameter("window", WINDOW, of_system=True),
    "box": LinkParameter("box", WINDOW, of_system=True),
    "analysis": LinkParameter("analysis", name_format(ANALYSES)),
    "watched": LinkParameter("watch", WATCHED),
    "starts": LinkParameter("orbits", STARTS, of_system=True),
    "chosen": LinkParameter("look", choice_format(_PLACES), of_system=True),
    "focus": LinkParameter("focus", name_format(PICTURES)),
    "palette": LinkParameter("palette", name_format(PALETTES)),
    "lock_times": LinkParameter("lock_times", TIMES),
}

_SETTING_FORMATS = {name: choice_format(setting.choices) for name, setting in SETTINGS.items()}

# Text forms of all values with one parameter each, by parameter.
_FORMATS: dict[str, Format] = {
    **SYSTEM_FORMATS,
    _ENERGY: number_format(-LARGEST_NUMBER, LARGEST_NUMBER, "a number, such as 0.25"),
    _JACOBI: number_format(-LARGEST_NUMBER, LARGEST_NUMBER, "a number, such as 3.17"),
    **{parameter.name: parameter.form for parameter in _LINKED.values()},
    **dict.fromkeys(LAYERS, SWITCH),
    **_SETTING_FORMATS,
    EMBED: _LINKED["focus"].form,
}

PARAMETERS = (*_FORMATS, _PLANE, _FIX, *(f"{_COMPARED}{name}" for name in _VIEW_PARAMETERS))
"""Names of the parameters of a link."""

LINKED = ("system", "plane", "energy", *_LINKED, "layers", "settings", "compared")
"""Attributes of the view state that a link contains."""


def write_link(state: ViewState, *, embedded: bool = False) -> str:
    """Return the query string of a view state, with its question mark.

    Parameters
    ----------
    state
        The view state.
    embedded
        Whether the page shows only one picture: the picture that is shown large, or else the basins.
    """
    written = _write_view(state.view)
    for attribute, parameter in _LINKED.items():
        value = getattr(state, attribute)
        if parameter.always or value != ViewState.param[attribute].default:
            written[parameter.name] = parameter.form.write(value)
    written |= _write_layers(state)
    if embedded:
        written[EMBED] = written.pop("focus", _DEFAULT_PICTURE)
    if state.compared is not None:
        written |= {f"{_COMPARED}{name}": text for name, text in _write_view(state.compared).items()}
    return "?" + urlencode(written, safe=",;:=")


def read_link(parameters: Mapping[str, str], prefix: str = "") -> tuple[dict[str, Any], list[str]]:
    """Parse the parameters of a link. `fit_to_system` adapts the result once the potential is reviewed.

    Parameters
    ----------
    parameters
        Names and values of the query string. Unknown names are ignored: other sites append their own.
    prefix
        Prefix of the names in messages.

    Returns
    -------
    values : dict
        Valid values by attribute of the view state.
    problems : list of str
        A message for each invalid value.
    """
    parts, problems = _read_parts(parameters, prefix)
    values = {attribute: parts[parameter.name] for attribute, parameter in _LINKED.items() if parameter.name in parts}
    values |= _read_layers(parts)
    if _JACOBI in parts:
        values["jacobi"] = parts[_JACOBI]
    if EMBED in parts:
        picture = values["focus"] = parts[EMBED]
        # The picture of a layer needs the layer.
        if picture in LAYERS_BY_PICTURE:
            values["layers"] = values.get("layers", frozenset()) | {LAYERS_BY_PICTURE[picture].name}
    # Without starts, only the index 0 is legal.
    if values.get("chosen", 0) >= len(values.get("starts", (0,))):
        values["chosen"] = 0
    for more_values, more_problems in (_read_view(parameters, parts, prefix), _read_compared(parameters)):
        values |= more_values
        problems += more_problems
    return values, problems


def linked_view(values: Mapping[str, Any]) -> View:
    """Return the view of a link, before or after the review of its system. Missing values are those of the first view."""
    return View(**{name: values[name] for name in FIRST_VIEW.values() if name in values})


def without_system(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the values of a link that do not depend on its system."""
    dropped_names = {"system", "energy", "jacobi", *(name for name, parameter in _LINKED.items() if parameter.of_system)}
    if linked_view(values).plane.parameter is not None:
        dropped_names.add("plane")
    return {name: value for name, value in values.items() if name not in dropped_names}


def fit_to_system(values: Mapping[str, Any], reviewed: PageReview) -> tuple[dict[str, Any], list[str]]:
    """Return the values of a link, completed for its system, and a message for each value that does not fit the system.

    Parameters
    ----------
    values
        Values of `read_link`.
    reviewed
        The review of the system in the link, which was not refused.
    """
    potential = reviewed.potential
    problems: list[str] = []
    jacobi_constant = values.get("jacobi")
    values = {name: value for name, value in values.items() if name != "jacobi"}
    if jacobi_constant is not None and "energy" not in values:
        if potential.rotation:
            values["energy"] = potential.jacobi_energy(jacobi_constant)
        else:
            problems.append(f"Ignored C={jacobi_constant:.6g}: the frame of this system does not rotate.")
    bottom, energies = float(potential.value(0.0, 0.0)), reviewed.energies
    t_max = min(ViewState.param.t_max.default, longest_first_t_max(potential))
    completed = {"energy": energies.first, "t_max": t_max, **values, "system": reviewed.system}
    energy = completed["energy"]
    # The range of the page begins below V at the origin if a body lies elsewhere.
    if energy <= bottom and energy < energies.low:
        lowest = min(bottom, energies.low)
        problems.append(f"Ignored h={energy:.6g}: choose an energy above {lowest:.6g}, such as {energies.first:.6g}.")
        completed["energy"] = energies.first
    return completed, problems


def refused_link(problem: str) -> str:
    """Return the message for a link whose system is refused."""
    return f"Ignored the potential in the link: {problem}"


def refused_comparison(problem: str) -> str:
    """Return the message for a link that compares with a view whose system is refused."""
    return f"Ignored the view in the link with which to compare: {problem}"


def _write_view(view: View) -> dict[str, str]:
    """Return the link parameters of system, slice, energy and section."""
    axes, held = write_slice(view.plane)
    energy = {} if view.energy is None else {_ENERGY: _FORMATS[_ENERGY].write(view.energy)}
    section = {_SECTION: SECTION.write(view.section)} if view.section != FIRST_VIEW.section else {}
    return {**write_system(view.system), _PLANE: axes, **({_FIX: held} if held else {}), **energy, **section}


def _write_layers(state: ViewState) -> dict[str, str]:
    """Return the layers that are on, and the settings that differ from their defaults."""
    layers = {name: SWITCH.write(True) for name in LAYERS if name in state.layers}
    changed = {name: value for name, value in state.settings.items() if value != SETTINGS[name].default}
    return layers | {name: _SETTING_FORMATS[name].write(value) for name, value in changed.items()}


def _read_layers(parts: Mapping[str, Any]) -> dict[str, Any]:
    """Return the layers and settings of a link, if it contains any."""
    values: dict[str, Any] = {}
    if any(name in parts for name in LAYERS):
        values["layers"] = frozenset(name for name in LAYERS if parts.get(name))
    if any(name in parts for name in SETTINGS):
        values["settings"] = default_settings() | {name: parts[name] for name in SETTINGS if name in parts}
    return values


def _read_parts(parameters: Mapping[str, str], prefix: str) -> tuple[dict[str, Any], list[str]]:
    """Return the values with one parameter each, by parameter, and a message for each invalid value."""
    parts: dict[str, Any] = {}
    problems: list[str] = []
    for name, form in _FORMATS.items():
        text = parameters.get(name)
        if text is None:
            continue
        try:
            if len(text) > LONGEST_VALUE:
                raise ValueError
            parts[name] = form.read(text)
        except (ValueError, KeyError):
            problems.append(f"Ignored {_quoted(prefix + name, text)}: choose {form.legal()}.")
    return parts, problems


def _read_view(parameters: Mapping[str, str], parts: Mapping[str, Any], prefix: str) -> tuple[dict[str, Any], list[str]]:
    """Return system, slice and energy of a link, and messages; `parts` contains the values with one parameter each."""
    system, problems = system_of(parts)
    view: dict[str, Any] = {"system": system} if any(name in parts for name in SYSTEM_FORMATS) else {}
    if _ENERGY in parts:
        view["energy"] = parts[_ENERGY]
    slice_texts = {name: parameters[name] for name in (_PLANE, _FIX) if parameters.get(name)}
    if not slice_texts:
        return view, problems
    try:
        if sum(map(len, slice_texts.values())) > LONGEST_VALUE:
            raise ValueError
        view["plane"] = read_slice(slice_texts.get(_PLANE, ""), slice_texts.get(_FIX, ""), system)
    except ValueError:
        quoted = ", ".join(_quoted(prefix + name, text) for name, text in slice_texts.items())
        legal = f"{listed(plane.key for plane in Plane)}, or two axes such as x,theta held by y=0.1"
        problems.append(f"Ignored {quoted}: choose {legal}.")
    return view, problems


def _read_compared(parameters: Mapping[str, str]) -> tuple[dict[str, Any], list[str]]:
    """Return the view with which a link compares, or a message for each invalid value."""
    given = {name: parameters[_COMPARED + name] for name in _VIEW_PARAMETERS if _COMPARED + name in parameters}
    if not given:
        return {}, []
    if _ENERGY in given:
        # Links of earlier versions contain both ends of an axis h. The first end is used.
        given[_ENERGY], _, _ = given[_ENERGY].partition(",")
    values, problems = read_link(given, _COMPARED)
    return {} if problems else {"compared": linked_view(values)}, problems


def _quoted(name: str, text: str) -> str:
    # A message with "nan" would look like a result of the page.
    return name if "nan" in text.lower() else f"{name}={_safe_text(text)}"


def _safe_text(text: str) -> str:
    """Return text from a link for messages: truncated, and without markup characters."""
    safe = "".join(c if c.isascii() and (c.isalnum() or c in " .,+-") else "?" for c in text[:_LONGEST_QUOTE])
    return safe + " …" if len(text) > _LONGEST_QUOTE else safe
