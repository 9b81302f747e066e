"""The view state as a link: all choices, at full precision, in the query string of the page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import islice
from typing import Any
from urllib.parse import parse_qsl, urlencode

from app.state.system_review import PageReview
from app.state.view import ANALYSES, FIRST_VIEW, PICTURES, View, allowed_resolutions, allowed_t_max
from app.state.view_state import ViewState, longest_first_t_max
from app.state.watched_starts import WATCHED
from engine.foundations.validation import LARGEST_NUMBER
from engine.slices.slice_text import write_slice
from plots.layers.table import LAYERS, LAYERS_BY_PICTURE
from plots.links.link_formats import (
    SWITCH,
    TIMES,
    WINDOW,
    Format,
    LinkParameter,
    choice_format,
    name_format,
    number_choice_format,
    number_format,
)
from plots.links.link_system import SYSTEM_FORMATS, write_system
from plots.links.map_link import (
    ENERGY,
    FIX,
    LONGEST_QUOTE,
    MAP_FORMATS,
    MAP_PARAMETERS,
    PLANE,
    SETTING_FORMATS,
    read_layers,
    read_parts,
    read_view,
    safe_text,
    sides_in_links,
)
from plots.links.map_view import SETTINGS
from plots.links.presets import Preset
from plots.pictures.palette import MOST_ORBITS, PALETTES

EMBED = "embed"
"""Link parameter of a page in an iframe of another page. Its value is the name of the only picture that is shown."""

_DEFAULT_PICTURE = "basins"
_JACOBI = "C"
_SECTION = MAP_PARAMETERS["section"]
# The parameters that a message names.
_MAIN_PARAMETERS = ", ".join((*SYSTEM_FORMATS, PLANE, ENERGY))
# Prefix of the parameters of the view with which the state is compared.
_COMPARED = "with_"
# Names of the parameters of system, slice, energy and section.
_VIEW_PARAMETERS = (*SYSTEM_FORMATS, PLANE, FIX, ENERGY, _SECTION.name)

# Indices of starts by the number that the page shows.
_PLACES = {str(place + 1): place for place in range(MOST_ORBITS)}


# Link parameters of attributes of the view state with one parameter each, in the order of links: fields of `View`, then the
# visitor's own choices.
_LINKED: dict[str, LinkParameter] = {
    "section": _SECTION,
    "t_max": replace(MAP_PARAMETERS["t_max"], form=number_choice_format(allowed_t_max)),
    "resolution": replace(MAP_PARAMETERS["resolution"], form=number_choice_format(lambda: sides_in_links(allowed_resolutions()))),
    "window": MAP_PARAMETERS["window"],
    "box": LinkParameter("box", WINDOW, of_system=True),
    "analysis": LinkParameter("analysis", name_format(ANALYSES)),
    "watched": LinkParameter("watch", WATCHED),
    "starts": MAP_PARAMETERS["starts"],
    "chosen": LinkParameter("look", choice_format(_PLACES), of_system=True),
    "focus": LinkParameter("focus", name_format(PICTURES)),
    "palette": LinkParameter("palette", name_format(PALETTES)),
    "lock_times": LinkParameter("lock_times", TIMES),
}

# Text forms of all values with one parameter each, by parameter.
_FORMATS: dict[str, Format] = {
    **MAP_FORMATS,
    _JACOBI: number_format(-LARGEST_NUMBER, LARGEST_NUMBER, "a number, such as 3.17"),
    **{parameter.name: parameter.form for parameter in _LINKED.values()},
    EMBED: _LINKED["focus"].form,
}

PARAMETERS = (*_FORMATS, PLANE, FIX, *(f"{_COMPARED}{name}" for name in _VIEW_PARAMETERS))
"""Names of the parameters of a link."""

MOST_UNKNOWN = 3
"""Largest number of unknown parameters of a link that the page names."""

# Prefix of the parameters of Bokeh, which loads a page in another page.
_OF_BOKEH = "bokeh-"

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
        Names and values of the query string. Unknown names are ignored, because other sites append their own; see
        `unknown_parameters`.
    prefix
        Prefix of the names in messages.

    Returns
    -------
    values : dict
        Valid values by attribute of the view state.
    problems : list of str
        A message for each invalid value.
    """
    parts, problems = read_parts(parameters, _FORMATS, prefix)
    values = {attribute: parts[parameter.name] for attribute, parameter in _LINKED.items() if parameter.name in parts}
    values |= read_layers(parts)
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
    for more_values, more_problems in (read_view(parameters, parts, prefix), _read_compared(parameters)):
        values |= more_values
        problems += more_problems
    return values, problems


def unknown_parameters(names: Iterable[str]) -> tuple[str, ...]:
    """Return the first names of a query string, at most `MOST_UNKNOWN`, that are no parameters of a link and not very long."""
    unknown = (name for name in names if name not in PARAMETERS and not name.startswith(_OF_BOKEH))
    return tuple(islice((name for name in unknown if len(name) <= LONGEST_QUOTE), MOST_UNKNOWN))


def ignored_parameters(names: Sequence[str]) -> str:
    """Return the message about unknown parameters of a link."""
    return f"Ignored {', '.join(map(safe_text, names))}: the parameters of a link are {_MAIN_PARAMETERS} and others."


def linked_view(values: Mapping[str, Any]) -> View:
    """Return the view of a link, before or after the review of its system. Missing values are those of the first view."""
    return View(**{name: values[name] for name in FIRST_VIEW.values() if name in values})


def preset_view(preset: Preset) -> View:
    """Return the view of a preset, with defaults for choices that the settings of the server do not allow."""
    values, _ = read_link(dict(parse_qsl(preset.link)))
    return linked_view(values)


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
    energy = {} if view.energy is None else {ENERGY: _FORMATS[ENERGY].write(view.energy)}
    section = {} if view.section == FIRST_VIEW.section else {_SECTION.name: _SECTION.form.write(view.section)}
    return {**write_system(view.system), PLANE: axes, **({FIX: held} if held else {}), **energy, **section}


def _write_layers(state: ViewState) -> dict[str, str]:
    """Return the layers that are on, and the settings that differ from their defaults."""
    layers = {name: SWITCH.write(True) for name in LAYERS if name in state.layers}
    changed = {name: value for name, value in state.settings.items() if value != SETTINGS[name].default}
    return layers | {name: SETTING_FORMATS[name].write(value) for name, value in changed.items()}


def _read_compared(parameters: Mapping[str, str]) -> tuple[dict[str, Any], list[str]]:
    """Return the view with which a link compares, or a message for each invalid value."""
    given = {name: parameters[_COMPARED + name] for name in _VIEW_PARAMETERS if _COMPARED + name in parameters}
    if not given:
        return {}, []
    if ENERGY in given:
        # Links of earlier versions contain both ends of an axis h. The first end is used.
        given[ENERGY], _, _ = given[ENERGY].partition(",")
    values, problems = read_link(given, _COMPARED)
    return {} if problems else {"compared": linked_view(values)}, problems
