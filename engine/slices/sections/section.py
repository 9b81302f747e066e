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
from engine.slices.axes import POSITIONS, STATE, Coordinate
from engine.slices.planes import Plane, checked_slice
from engine.slices.slice import Slice
from engine.systems.potential import Potential
from engine.systems.well_units import WellUnits

# Largest difference of a state from a start that is the same, and of their energies, in units of the well.
_ROUNDING = 1e-9


class Crossing(Enum):
    """The directions in which an orbit crosses a section."""

    UP = "up"
    DOWN = "down"
    BOTH = "both"

    @property
    def reversed(self) -> Crossing:
        """The direction of the same crossings backward in time."""
        return {Crossing.UP: Crossing.DOWN, Crossing.DOWN: Crossing.UP}.get(self, self)


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

    def points_of_orbits(self, states: np.ndarray) -> list[np.ndarray]:
        """Return the coordinates of the returns of each orbit that returns, (m, 2), from the states (returns, n, 4) of all."""
        counts = np.isfinite(states[..., 0]).sum(axis=0)
        return [self.points(states[: counts[k], k]) for k in np.flatnonzero(counts)]


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
    def plane(self) -> Slice | None:
        """A slice whose starts are on the section; None if there is none.

        A ray is one half of the line of its slice. From a section of positions, starts go upward, unless crossings are downward.
        On an oblique line or a ray, some starts with a large momentum along the line go in the other direction, because the slice
        fixes the sign of px or py.
        """
        raise NotImplementedError

    @property
    def slice_of_starts(self) -> Slice:
        """The slice `plane`, or (x, px) if there is none on the section."""
        return self.plane or Plane.X_PX

    def is_drawn_on(self, plane: Slice) -> bool:
        """Return whether the axes of a slice on the section are the coordinates in which its points are drawn."""
        return plane == self.plane and plane.axis_symbols == self.axes.symbols

    def columns_on(self, plane: Slice) -> list[int] | None:
        """Return the columns of states that the axes of a slice on the section show; None for a slice with other axes."""
        if not self.is_drawn_on(plane) or not set(plane.axes) <= set(STATE):
            return None
        return [STATE.index(axis) for axis in plane.axes]

    def find_start(
        self, potential: Potential, state: np.ndarray, energy: float | None = None
    ) -> tuple[Slice, tuple[float, float]] | None:
        """Return a slice on the section and the place on it at which a state, (4,), starts.

        None if there is none, or if the state has another energy than a given one.
        """
        with np.errstate(all="ignore"):
            state_energy, unit = float(potential.energy(state)), potential.units.state
        if energy is not None and not abs(state_energy - energy) <= _ROUNDING * potential.units.energy:
            return None
        for plane in [] if self.plane is None else [self.plane, opposite_slice(self.plane)]:
            place = axes_of_slice(plane).points(state)
            (start,) = plane.states(potential, state_energy, *place[:, None])
            if np.allclose(start / unit, state / unit, rtol=0.0, atol=_ROUNDING):
                return plane, (float(place[0]), float(place[1]))
        return None

    def values(self, states: np.ndarray) -> np.ndarray:
        """Return how far states (…, 4) are beyond the section in the direction of its crossings, in its form; negative before."""
        linear, radial, value = self._coefficients_of_state()
        return states @ linear + radial * np.sum(states[..., :2] * states[..., 2:], axis=-1) - value

    def rates(self, states: np.ndarray, changes: np.ndarray) -> np.ndarray:
        """Return the rate of `values` for states (…, 4) with these changes per time, (…, 4)."""
        linear, radial, _ = self._coefficients_of_state()
        products = changes[..., :2] * states[..., 2:] + states[..., :2] * changes[..., 2:]
        return changes @ linear + radial * np.sum(products, axis=-1)

    def _coefficients_of_state(self) -> tuple[np.ndarray, float, float]:
        """Return the coefficients of x, y, px and py, that of x px + y py, and the value."""
        numbers = self._signed_form()
        linear = np.array([numbers.get(coordinate.key, 0.0) for coordinate in STATE])
        return linear, numbers.get("radial", 0.0), numbers.get("value", 0.0)

    def settle(self, states: np.ndarray) -> np.ndarray:
        """Return states (…, 4) of the section without the rounding errors of a coordinate that the section fixes."""
        return states

    def restore_returns(self, points: np.ndarray, units: WellUnits) -> tuple[np.ndarray, np.ndarray]:
        """Return states (returns, n, 4) and times (returns, n) of returns (n, returns, 5) in units of the well."""
        by_return = points.transpose(1, 0, 2)
        return self.settle(by_return[..., :4] * units.state), by_return[..., 4] * units.time

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
    def is_of_positions(self) -> bool:
        """Whether a position is on the section or not, whatever its momentum."""
        return not any(self.form.get(name) for name in ("px", "py", "radial"))

    @property
    def is_mirrored(self) -> bool:
        """Whether the mirror images under x → −x of crossings are crossings."""
        numbers = self._signed_form()
        mirrored = {name: -value if name in {"x", "px", "side_x"} else value for name, value in numbers.items()}
        reversed_form = {
            name: value if name in {"both"} or name.startswith("side") else -value for name, value in mirrored.items()
        }
        return numbers == mirrored or (self.direction is Crossing.BOTH and numbers == reversed_form)


def axes_of_slice(plane: Slice) -> SectionAxes:
    """Return the coordinates of states on a slice whose axes are orthogonal unit vectors."""
    components = np.array([[axis.components.get(coordinate, 0.0) for coordinate in STATE] for axis in plane.axes])
    x, y = (dict(plane.fixed).get(position, 0.0) for position in POSITIONS)
    return SectionAxes(plane.axis_symbols, components, (x, y))


def opposite_slice(plane: Slice) -> Slice:
    """Return the slice at whose starts the momentum, or the angle of the velocity from the radius, has the other sign."""
    if plane.decided is Coordinate.SPEED:
        fixed = tuple((coordinate, -value if coordinate is Coordinate.BETA else value) for coordinate, value in plane.fixed)
        return checked_slice(Slice(*plane.axes, None, 1, fixed))
    return checked_slice(Slice(*plane.axes, plane.solved, -plane.sign, plane.fixed))


def words_of(place: str, direction: str | None) -> CrossingWords:
    """Return the words for the crossings of a place in a direction, "upward"; None for both directions."""
    # As in other texts, the minus sign is the typographic one.
    place = place.replace("-", "−")
    noun = f"{direction} crossing" if direction else "crossing"
    absence = f"without crossing {place}{f' {direction}' if direction else ''}"
    return CrossingWords(noun, f"{noun}s", f" of {place}", absence, f"Crossings of {place}")
