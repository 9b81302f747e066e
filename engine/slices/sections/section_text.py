"""Sections as text, for addresses, files and the command line: "x = 0, px > 0", "y = 0.1 both", "angle = 30°", "apsis"."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from engine.foundations.validation import check_type, short_repr
from engine.slices.axes import STATE
from engine.slices.sections.central_sections import ApsisSection, RaySection
from engine.slices.sections.linear_section import LinearSection
from engine.slices.sections.section import Crossing, Section

LEGAL_SECTIONS = "x = 0, px > 0; y = 0.1 both; x + y = 0.2 down; angle = 30°; apsis; pericentre about (0.5, 0)"
"""Examples of sections as text."""

FORMER_ATTRIBUTES: Mapping[str, Any] = {"section": Section.Y_UP.text}
"""Attributes that files of earlier versions, which had one section, lack; with their values."""

# Names of directions at the end of a text: for all sections, for rays, and for apsides.
_DIRECTIONS = {
    "up": Crossing.UP, "upward": Crossing.UP, "down": Crossing.DOWN, "downward": Crossing.DOWN, "both": Crossing.BOTH,
}  # fmt: skip
_ROTATIONS = {"counterclockwise": Crossing.UP, "clockwise": Crossing.DOWN}
_RADIAL_DIRECTIONS = {"outward": Crossing.UP, "inward": Crossing.DOWN}
_ALL_DIRECTIONS = {*_DIRECTIONS, *_ROTATIONS, *_RADIAL_DIRECTIONS}
# Names of the ends of an orbit's path about a centre, with the directions that they stand for.
_ENDS = {
    "pericentre": Crossing.UP, "pericenter": Crossing.UP, "periapsis": Crossing.UP,
    "apocentre": Crossing.DOWN, "apocenter": Crossing.DOWN, "apoapsis": Crossing.DOWN,
}  # fmt: skip
_NUMBER = r"[+-]?\s*(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?"
_TERM = re.compile(r"\s*([+-])?\s*((?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)?\s*\*?\s*(px|py|x|y)(?![\w(])\s*")
_CENTRE = re.compile(rf"\s+about\s*\(\s*({_NUMBER})\s*,\s*({_NUMBER})\s*\)$")
_VELOCITY = re.compile(r"^(px|py)\s*([<>])\s*0(?:\.0*)?$")


def read_section(text: str) -> Section:
    """Return the section that a text describes.

    Parameters
    ----------
    text
        A linear form of x, y, px and py with its value, "x - 2 y = 0.1"; an angle in degrees, "angle = 30°"; or "apsis",
        "pericentre" or "apocentre". After an angle or an apsis, a centre: "about (0.5, 0)". At the end a direction: "up", "down"
        or "both", or for x or y alone the sign of its momentum, ", px > 0". Without a direction, crossings are upward, or in
        both directions for "apsis".

    Raises
    ------
    ValueError
        If the text is not legal; the message has legal texts.

    Examples
    --------
    >>> from escape_explorer import read_section
    >>> read_section("x = 0, px < 0").text, read_section("apsis about (0.5, 0)").crossings_name
    ('x = 0 down', 'apsides about (0.5, 0)')
    """
    check_type("section", text, str)
    try:
        return _read(text.strip().replace("−", "-").lower())
    except _NotASectionError:
        raise ValueError(f"section={short_repr(text)}: must be a section such as {LEGAL_SECTIONS}") from None


def section_of_file(attributes: Mapping[Any, Any]) -> Section:
    """Return the section that the attributes of a file, of any version, name."""
    return read_section(str({**FORMER_ATTRIBUTES, **attributes}["section"]))


def checked_section(value: Any) -> Section:
    """Return a section, given as a `Section` or as text; ValueError for anything else."""
    if isinstance(value, Section) and type(value) is not Section:
        return value
    if isinstance(value, str):
        return read_section(value)
    raise ValueError(f"section={short_repr(value)}: must be a Section, or a text such as {LEGAL_SECTIONS}")


class _NotASectionError(Exception):
    """A text does not describe a section."""


def _read(text: str) -> Section:
    rest, word = _split_direction(text)
    head, centre = _split_centre(rest)
    if head in _ENDS:
        return ApsisSection(_read_direction(word, {"": _ENDS[head]}), centre)
    if head == "apsis":
        return ApsisSection(_read_direction(word, {"": Crossing.BOTH, **_DIRECTIONS, **_RADIAL_DIRECTIONS}), centre)
    name, equals, value = (part.strip() for part in rest.partition("="))
    if not equals:
        raise _NotASectionError
    if name in {"angle", "theta"}:
        angle, centre = _split_centre(value)
        direction = _read_direction(word, {"": Crossing.UP, **_DIRECTIONS, **_ROTATIONS})
        return RaySection(direction, _read_number(angle.removesuffix("°")), centre)
    conditions = {f"p{name} >": Crossing.UP, f"p{name} <": Crossing.DOWN}
    direction = _read_direction(word, {"": Crossing.UP, **_DIRECTIONS, **conditions})
    return LinearSection(direction, **_read_form(name), value=_read_number(value))


def _split_direction(text: str) -> tuple[str, str]:
    """Return a text without its direction, and the direction: a word, a condition on a momentum such as "px >", or nothing."""
    before, comma, last = text.rpartition(",")
    if comma and (velocity := _VELOCITY.match(last.strip())):
        return before.strip(), " ".join(velocity.groups())
    head, _, word = text.rpartition(" ")
    return (head.strip().removesuffix(",").strip(), word) if word in _ALL_DIRECTIONS else (text, "")


def _read_direction(word: str, directions: Mapping[str, Crossing]) -> Crossing:
    if word not in directions:
        raise _NotASectionError
    return directions[word]


def _split_centre(text: str) -> tuple[str, tuple[float, float]]:
    """Return a text without its centre, and the centre, by default the origin."""
    found = _CENTRE.search(text)
    if found is None:
        return text, (0.0, 0.0)
    return text[: found.start()].strip(), (_read_number(found[1]), _read_number(found[2]))


def _read_form(text: str) -> dict[str, float]:
    """Return the coefficients of a linear form, by coordinate."""
    form = dict.fromkeys((coordinate.key for coordinate in STATE), 0.0)
    position = 0
    while position < len(text):
        term = _TERM.match(text, position)
        if term is None or (position and not term[1]):
            raise _NotASectionError
        form[term[3]] += float(f"{term[1] or ''}{term[2] or 1}")
        position = term.end()
    return form


def _read_number(text: str) -> float:
    if not re.fullmatch(_NUMBER, text.strip()):
        raise _NotASectionError
    return float(text.replace(" ", ""))
