"""Surfaces of section: what counts as a crossing of an orbit.

Each kind of section is a class. A section is where a form of the state vanishes. Orbits cross it upward, where the form becomes
positive, downward, or in both directions.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import ClassVar, NamedTuple, Self

import numpy as np

from engine.foundations.validation import check_type
from engine.foundations.wording import format_count
from engine.integrator.source.section_numbers import NAMES, UPWARD, SectionForm, SectionNumbers
from engine.slices.slice import Slice
from engine.systems.well_units import WellUnits


class Crossing(Enum):
    """The directions in which an orbit crosses a section."""

    UP = "up"
    DOWN = "down"
    BOTH = "both"


def write_number(value: float) -> str:
    """Return a number with as many digits as it takes to restore it, without a decimal point if it is an integer."""
    return repr(value).removesuffix(".0")


class CrossingWords(NamedTuple):
    """Words for the crossings of a section.

    Attributes
    ----------
    singular, plural
        One crossing, "upward crossing", and several.
    place
        What follows these words: " of y = 0".
    absence
        That there is none: "without crossing y = 0 upward".
    title
        The title of a picture of their number: "Crossings of y = 0".
    """

    singular: str
    plural: str
    place: str
    absence: str
    title: str


class SectionAxes(NamedTuple):
    """Two coordinates on a section, in which its points are drawn: linear functions of the state.

    Attributes
    ----------
    symbols
        The symbols of both coordinates.
    components
        (2, 4) their change per unit of x, y, px and py.
    origin
        (2,) x and y of the point from which lengths are measured.
    """

    symbols: tuple[str, str]
    components: np.ndarray
    origin: tuple[float, float] = (0.0, 0.0)

    def points(self, states: np.ndarray) -> np.ndarray:
        """Return the coordinates of states (…, 4) x, y, px, py, of shape (…, 2)."""
        return (states - [*self.origin, 0.0, 0.0]) @ self.components.T


@dataclass(frozen=True)
class Section:
    """A surface of section in phase space, with the directions in which crossings count; `read_section` makes one from text.

    There are sections of a linear form of x, y, px and py, of rays from a centre, and of apsides. `Section.Y_UP` is y = 0,
    crossed upward, the section of Zotos (2014), at which crossings are counted by default.

    Attributes
    ----------
    direction
        The direction in which crossings count, or both.
    """

    Y_UP: ClassVar[Section]

    direction: Crossing = Crossing.UP

    def __post_init__(self) -> None:
        check_type("direction", self.direction, Crossing)

    @property
    def place(self) -> str:
        """The section without a direction, as `read_section` reads it: "y = 0"."""
        raise NotImplementedError

    @property
    def text(self) -> str:
        """The section with its direction, from which `read_section` restores it: "y = 0 up"."""
        return f"{self.place} {self.direction.value}"

    @property
    def words(self) -> CrossingWords:
        """The words for its crossings."""
        return words_of(self.place, {Crossing.UP: "upward", Crossing.DOWN: "downward"}.get(self.direction))

    @property
    def crossings_name(self) -> str:
        """Crossings in words: "upward crossings of y = 0"."""
        return f"{self.words.plural}{self.words.place}"

    def count(self, number: int) -> str:
        """Return a number of crossings in words: "1 upward crossing of y = 0"."""
        words = self.words
        return f"{format_count(number, words.singular, words.plural)}{words.place}"

    @property
    def axes(self) -> SectionAxes:
        """The coordinates in which points of the section are drawn."""
        raise NotImplementedError

    @property
    def form(self) -> dict[str, float]:
        """The numbers of the form and of the side of the section, by name; numbers of 0 may be missing."""
        raise NotImplementedError

    def in_well_units(self, units: WellUnits) -> Self:
        """Return the section in units of a well."""
        raise NotImplementedError

    @property
    def plane(self) -> Slice:
        """A slice whose starts are on the section; from a section of positions they go upward, unless crossings are downward."""
        raise NotImplementedError

    def is_drawn_on(self, plane: Slice) -> bool:
        """Return whether the axes of a slice on the section are the coordinates in which its points are drawn."""
        return plane == self.plane and plane.axis_symbols == self.axes.symbols

    def settle(self, states: np.ndarray) -> np.ndarray:
        """Return states (…, 4) of the section without the rounding errors of a coordinate that the section fixes."""
        return states

    @property
    def numbers(self) -> SectionNumbers:
        """The section as the kernels take it, for a section in units of the well."""
        numbers = self._signed_form()
        if numbers == Section.Y_UP._signed_form():
            return UPWARD
        rows = tuple(tuple(numbers.get(name, 0.0) for name in names) for names in NAMES)
        return SectionNumbers(SectionForm.RADIAL if "radial" in numbers else SectionForm.LINEAR, rows)

    def _signed_form(self) -> dict[str, float]:
        """Return the numbers of the section; they are negative for downward crossings."""
        sign = -1.0 if self.direction is Crossing.DOWN else 1.0
        form = {name: value if name.startswith("side") else sign * value for name, value in self.form.items() if value}
        return form | ({"both": 1.0} if self.direction is Crossing.BOTH else {})

    @property
    def is_mirrored(self) -> bool:
        """Whether the mirror images under x → −x of crossings are crossings."""
        numbers = self._signed_form()
        mirrored = {name: -value if name in {"x", "px", "side_x"} else value for name, value in numbers.items()}
        reversed_form = {
            name: value if name in {"both"} or name.startswith("side") else -value for name, value in mirrored.items()
        }
        return numbers == mirrored or (self.direction is Crossing.BOTH and numbers == reversed_form)


def words_of(place: str, direction: str | None) -> CrossingWords:
    """Return the words for the crossings of a place in a direction, "upward"; None for both directions."""
    noun = f"{direction} crossing" if direction else "crossing"
    absence = f"without crossing {place}{f' {direction}' if direction else ''}"
    return CrossingWords(noun, f"{noun}s", f" of {place}", absence, f"Crossings of {place}")
