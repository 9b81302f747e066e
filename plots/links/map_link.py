"""The system, the slice, the map and its layers in a link. Presets and the page share these parameters."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from urllib.parse import parse_qsl

from engine import Plane
from engine.foundations.validation import LARGEST_NUMBER
from engine.slices.slice_text import read_slice
from engine.systems.formulas.formula_parser import LONGEST_TEXT
from plots.layers.table import LAYERS
from plots.links.link_formats import (
    SECTION,
    STARTS,
    SWITCH,
    WINDOW,
    Format,
    LinkParameter,
    choice_format,
    listed,
    number_choice_format,
    number_format,
)
from plots.links.link_system import SYSTEM_FORMATS, system_of
from plots.links.map_view import RESOLUTION_CHOICES, SETTINGS, T_MAX_CHOICES, MapView, default_settings

LONGEST_VALUE = LONGEST_TEXT
"""Largest length of a value in a link, in characters."""

PLANE, FIX, ENERGY = "plane", "fix", "h"
"""Names of the parameters of the slice and its energy."""

LONGEST_QUOTE = 40
"""Longest part of a text of a link that a message repeats, in characters."""


def sides_in_links(resolutions: Mapping[str, int]) -> dict[str, int]:
    """Return columns and rows by their text in a link."""
    return {str(side): side for side in resolutions.values()}


MAP_PARAMETERS: Mapping[str, LinkParameter] = {
    "section": LinkParameter("section", SECTION),
    "t_max": LinkParameter("t_max", number_choice_format(lambda: T_MAX_CHOICES), always=True),
    "resolution": LinkParameter("resolution", number_choice_format(lambda: sides_in_links(RESOLUTION_CHOICES)), always=True),
    "window": LinkParameter("window", WINDOW, of_system=True),
    "starts": LinkParameter("orbits", STARTS, of_system=True),
}
"""Link parameters of the fields of `MapView` with one parameter each, besides layers and settings."""

SETTING_FORMATS = {name: choice_format(setting.choices) for name, setting in SETTINGS.items()}
"""Text forms of the settings."""

MAP_FORMATS: Mapping[str, Format] = {
    **SYSTEM_FORMATS,
    ENERGY: number_format(-LARGEST_NUMBER, LARGEST_NUMBER, "a number, such as 0.25"),
    **{parameter.name: parameter.form for parameter in MAP_PARAMETERS.values()},
    **dict.fromkeys(LAYERS, SWITCH),
    **SETTING_FORMATS,
}
"""Text forms of the values with one parameter each, by parameter."""


def read_map_view(link: str) -> MapView:
    """Return the map of a link without its question mark. Parameters that do not belong to the map are ignored.

    Raises
    ------
    ValueError
        If a value is not legal.
    """
    parameters = dict(parse_qsl(link, strict_parsing=True))
    parts, problems = read_parts(parameters, MAP_FORMATS)
    values, slice_problems = read_view(parameters, parts)
    if problems or slice_problems:
        raise ValueError(f"link={link!r}: {[*problems, *slice_problems][0].removeprefix('Ignored ')}")
    values |= {attribute: parts[parameter.name] for attribute, parameter in MAP_PARAMETERS.items() if parameter.name in parts}
    return MapView(**values, **read_layers(parts))


def read_parts(
    parameters: Mapping[str, str], formats: Mapping[str, Format], prefix: str = ""
) -> tuple[dict[str, Any], list[str]]:
    """Return the values with one parameter each, by parameter, and a message for each invalid value.

    Parameters
    ----------
    parameters
        Names and values of the query string.
    formats
        Text forms by parameter. Other parameters are ignored.
    prefix
        Prefix of the names in messages.
    """
    parts: dict[str, Any] = {}
    problems: list[str] = []
    for name, form in formats.items():
        text = parameters.get(name)
        if text is None:
            continue
        try:
            if len(text) > LONGEST_VALUE:
                raise ValueError
            parts[name] = form.read(text)
        except (ValueError, KeyError):
            problems.append(f"Ignored {quoted(prefix + name, text)}: choose {form.legal()}.")
    return parts, problems


def read_layers(parts: Mapping[str, Any]) -> dict[str, Any]:
    """Return the layers and settings of a link, if it contains any."""
    values: dict[str, Any] = {}
    if any(name in parts for name in LAYERS):
        values["layers"] = frozenset(name for name in LAYERS if parts.get(name))
    if any(name in parts for name in SETTINGS):
        values["settings"] = default_settings() | {name: parts[name] for name in SETTINGS if name in parts}
    return values


def read_view(parameters: Mapping[str, str], parts: Mapping[str, Any], prefix: str = "") -> tuple[dict[str, Any], list[str]]:
    """Return system, slice and energy of a link, and messages; `parts` contains the values with one parameter each."""
    system, problems = system_of(parts)
    view: dict[str, Any] = {"system": system} if any(name in parts for name in SYSTEM_FORMATS) else {}
    if ENERGY in parts:
        view["energy"] = parts[ENERGY]
    slice_texts = {name: parameters[name] for name in (PLANE, FIX) if parameters.get(name)}
    if not slice_texts:
        return view, problems
    try:
        if sum(map(len, slice_texts.values())) > LONGEST_VALUE:
            raise ValueError
        view["plane"] = read_slice(slice_texts.get(PLANE, ""), slice_texts.get(FIX, ""), system)
    except ValueError:
        given = ", ".join(quoted(prefix + name, text) for name, text in slice_texts.items())
        legal = f"{listed(plane.key for plane in Plane)}, or two axes such as x,theta held by y=0.1"
        problems.append(f"Ignored {given}: choose {legal}.")
    return view, problems


def quoted(name: str, text: str) -> str:
    """Return the name and the text of a value for messages."""
    # A message with "nan" would look like a result of the page.
    return name if "nan" in text.lower() else f"{name}={safe_text(text)}"


def safe_text(text: str) -> str:
    """Return text from a link for messages: truncated, and without markup characters."""
    safe = "".join(c if c.isascii() and (c.isalnum() or c in " .,+-") else "?" for c in text[:LONGEST_QUOTE])
    return safe + " …" if len(text) > LONGEST_QUOTE else safe
