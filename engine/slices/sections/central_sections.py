"""Sections about a centre: rays at an angle, and apsides."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from engine.foundations.validation import checked_number, replace_unchecked, short_repr
from engine.slices.planes import Plane
from engine.slices.sections.linear_section import oblique_slice
from engine.slices.sections.section import Crossing, CrossingWords, Section, SectionAxes, words_of, write_number
from engine.slices.slice import Slice
from engine.systems.well_units import WellUnits

# The names of apsides, by the direction in which they cross the section.
_APSIDES = {Crossing.UP: "pericentre", Crossing.DOWN: "apocentre", Crossing.BOTH: "apsis"}


@dataclass(frozen=True)
class RaySection(Section):
    """The states whose position is on a ray from a centre, at an angle from the +x axis.

    Parameters
    ----------
    direction
        The crossings that count: upward is counterclockwise.
    degrees
        The angle in degrees, from −360 to 360.
    centre
        x and y of the centre, dimensionless.
    """

    degrees: float = 0.0
    centre: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        # The sum turns −0 into 0.
        degrees = checked_number("section degrees", self.degrees) + 0.0
        if not -360.0 <= degrees <= 360.0:
            raise ValueError(f"section degrees={short_repr(self.degrees)}: must be from -360 to 360")
        object.__setattr__(self, "degrees", degrees)
        object.__setattr__(self, "centre", checked_centre(self.centre))

    @property
    def place(self) -> str:
        """See `Section.place`."""
        return f"angle = {write_number(self.degrees)}°{_about(self.centre)}"

    @property
    def words(self) -> CrossingWords:
        """See `Section.words`."""
        directions = {Crossing.UP: "counterclockwise", Crossing.DOWN: "clockwise"}
        place = f"the ray at {write_number(self.degrees)}°{_about(self.centre)}"
        return words_of(place, directions.get(self.direction))

    @property
    def _direction(self) -> tuple[float, float]:
        """The unit vector along the ray, exact along the axes."""
        quarter, rest = divmod(self.degrees, 90.0)
        cosine, sine = math.cos(math.radians(rest)), math.sin(math.radians(rest))
        return [(cosine, sine), (-sine, cosine), (-cosine, -sine), (sine, -cosine)][int(quarter) % 4]

    @property
    def form(self) -> dict[str, float]:
        """See `Section.form`."""
        (cosine, sine), (x, y) = self._direction, self.centre
        value, side_value = cosine * y - sine * x, cosine * x + sine * y
        return {"x": -sine, "y": cosine, "value": value, "side_x": cosine, "side_y": sine, "side_value": side_value}

    def in_well_units(self, units: WellUnits) -> RaySection:
        """Return the section in units of a well."""
        return replace_unchecked(self, centre=_scaled(self.centre, units))

    @property
    def axes(self) -> SectionAxes:
        """See `Section.axes`."""
        return SectionAxes(("r", "pr"), np.kron(np.eye(2), self._direction), self.centre)

    @property
    def plane(self) -> Slice:
        """See `Section.plane`."""
        cosine, sine = self._direction
        sign = -1 if self.direction is Crossing.DOWN else 1
        return oblique_slice(np.array([cosine, sine]), np.array(self.centre), (-sine, cosine), sign)


@dataclass(frozen=True)
class ApsisSection(Section):
    """The states at right angles to the direction of a centre: the distance from it is smallest or largest.

    Parameters
    ----------
    direction
        The crossings that count: upward at pericentres, where the distance begins to increase, downward at apocentres.
    centre
        x and y of the centre, dimensionless.
    """

    centre: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        super().__post_init__()
        object.__setattr__(self, "centre", checked_centre(self.centre))

    @property
    def place(self) -> str:
        """See `Section.place`."""
        return f"apsis{_about(self.centre)}"

    @property
    def text(self) -> str:
        """See `Section.text`."""
        return f"{_APSIDES[self.direction]}{_about(self.centre)}"

    @property
    def words(self) -> CrossingWords:
        """See `Section.words`."""
        name, place = _APSIDES[self.direction], _about(self.centre).replace("-", "−")
        article, plural = ("a" if name[0] == "p" else "an"), ("apsides" if name == "apsis" else f"{name}s")
        return CrossingWords(name, plural, place, f"without {article} {name}{place}", f"{plural.capitalize()}{place}")

    @property
    def form(self) -> dict[str, float]:
        """See `Section.form`."""
        x, y = self.centre
        return {"px": -x, "py": -y, "radial": 1.0}

    def in_well_units(self, units: WellUnits) -> ApsisSection:
        """Return the section in units of a well."""
        return replace_unchecked(self, centre=_scaled(self.centre, units))

    @property
    def axes(self) -> SectionAxes:
        """See `Section.axes`."""
        return SectionAxes(("x", "y"), np.eye(4)[:2])

    @property
    def plane(self) -> Slice | None:
        """See `Section.plane`."""
        return Plane.TANGENTIAL if self.centre == (0.0, 0.0) else None


def checked_centre(value: object) -> tuple[float, float]:
    """Return a centre as two numbers; ValueError if it is something else."""
    try:
        x, y = value  # type: ignore[misc]
    except (TypeError, ValueError):
        raise ValueError(f"section centre={short_repr(value)}: must be x and y") from None
    # The types of the parts are not known to type checkers.
    return checked_number("section centre", x) + 0.0, checked_number("section centre", y) + 0.0  # type: ignore[has-type]


def _about(centre: tuple[float, float]) -> str:
    """Return a centre other than the origin in words."""
    return "" if centre == (0.0, 0.0) else f" about ({', '.join(map(write_number, centre))})"


def _scaled(centre: tuple[float, float], units: WellUnits) -> tuple[float, float]:
    """Return a centre in units of a well."""
    return centre[0] / units.length, centre[1] / units.length
