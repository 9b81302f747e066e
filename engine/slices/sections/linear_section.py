"""Sections on which a linear form of the state has a value: sections of coordinates, and oblique ones."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from engine.foundations.validation import LARGEST_NUMBER, checked_number, replace_unchecked
from engine.slices.axes import MOMENTA, POSITIONS, STATE, Coordinate, Direction
from engine.slices.planes import checked_slice
from engine.slices.sections.section import Crossing, Section, SectionAxes, write_number
from engine.slices.slice import Slice
from engine.systems.well_units import WellUnits

# Smallest magnitude of the largest coefficient of a form.
_SMALLEST = 1e-9


@dataclass(frozen=True)
class LinearSection(Section):
    """The states on which a linear form of x, y, px and py has a value, such as x = 0.1 or x + y = 0.

    Parameters
    ----------
    direction
        The crossings that count: upward where the form increases.
    x, y, px, py
        Coefficients of the form, dimensionless, from −1e9 to 1e9; the magnitude of the largest is at least 1e-9.
    value
        Value of the form, dimensionless, at most 1e9 times the magnitude of the largest coefficient.
    """

    x: float = 0.0
    y: float = 0.0
    px: float = 0.0
    py: float = 0.0
    value: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in (*(coordinate.key for coordinate in STATE), "value"):
            # The sum turns −0 into 0.
            object.__setattr__(self, name, checked_number(f"section {name}", getattr(self, name)) + 0.0)
        largest = max(map(abs, self._coefficients.values()), default=0.0)
        if largest < _SMALLEST:
            raise ValueError(f"section: one of the coefficients x, y, px and py must be at least {_SMALLEST:g} in magnitude")
        checked_number("section value", self.value / largest, f"at most {LARGEST_NUMBER:g} times the largest coefficient")

    @property
    def _coefficients(self) -> dict[Coordinate, float]:
        """The coefficients other than 0."""
        return {coordinate: value for coordinate in STATE if (value := getattr(self, coordinate.key))}

    @property
    def place(self) -> str:
        """See `Section.place`."""
        text = ""
        for coordinate, value in self._coefficients.items():
            sign = ("-" if value < 0.0 else "") if not text else (" - " if value < 0.0 else " + ")
            text += f"{sign}{'' if abs(value) == 1.0 else f'{write_number(abs(value))} '}{coordinate.key}"
        return f"{text} = {write_number(self.value)}"

    @property
    def form(self) -> dict[str, float]:
        """See `Section.form`."""
        return {coordinate.key: value for coordinate, value in self._coefficients.items()} | {"value": self.value}

    def in_well_units(self, units: WellUnits) -> LinearSection:
        """Return the section in units of a well."""
        scaled = {coordinate.key: value * coordinate.unit(units) for coordinate, value in self._coefficients.items()}
        # The coefficient of a section of one coordinate does not change.
        unit = max(coordinate.unit(units) for coordinate in self._coefficients)
        numbers = {name: value / unit for name, value in scaled.items()} | {"value": self.value / unit}
        return replace_unchecked(self, **numbers)

    def settle(self, states: np.ndarray) -> np.ndarray:
        """Return states with the exact value of the coordinate of a section of one coordinate."""
        if len(self._coefficients) > 1:
            return states
        settled = states.copy()
        ((coordinate, coefficient),) = self._coefficients.items()
        column = STATE.index(coordinate)
        settled[..., column] = np.where(np.isfinite(states[..., column]), self.value / coefficient, np.nan)
        return settled

    @property
    def axes(self) -> SectionAxes:
        """See `Section.axes`."""
        if self.px or self.py:
            return SectionAxes(("x", "y"), np.eye(4)[:2])
        if not self.x:
            return SectionAxes(("x", "px"), np.eye(4)[[0, 2]])
        if not self.y:
            return SectionAxes(("y", "py"), np.eye(4)[[1, 3]])
        return SectionAxes(("s", "ps"), np.kron(np.eye(2), self._along))

    @property
    def _along(self) -> np.ndarray:
        """The unit vector along a line in the plane of the positions, in the direction in which x grows."""
        along: np.ndarray = np.array([self.y, -self.x]) / math.hypot(self.x, self.y)
        return along if along[0] >= 0.0 else -along

    @property
    def plane(self) -> Slice | None:
        """See `Section.plane`."""
        if self.px or self.py:
            return self._plane_of_momentum()
        sign = -1 if self.direction is Crossing.DOWN else 1
        if self.x and self.y:
            foot = np.array([self.x, self.y]) * self.value / (self.x**2 + self.y**2)
            return oblique_slice(self._along, foot, (self.x, self.y), sign)
        coordinate, coefficient = (Coordinate.X, self.x) if self.x else (Coordinate.Y, self.y)
        axes = (Coordinate.Y, Coordinate.PY) if self.x else (Coordinate.X, Coordinate.PX)
        solved = Coordinate.PX if self.x else Coordinate.PY
        fixed = ((coordinate, self.value / coefficient),)
        return checked_slice(Slice(*axes, solved, sign if coefficient > 0.0 else -sign, fixed))

    def _plane_of_momentum(self) -> Slice | None:
        """Return a slice of positions on a section of one momentum."""
        if len(self._coefficients) > 1:
            return None
        ((momentum, coefficient),) = self._coefficients.items()
        (solved,) = (other for other in MOMENTA if other is not momentum)
        return checked_slice(Slice(*POSITIONS, solved, 1, ((momentum, self.value / coefficient),)))


Section.Y_UP = LinearSection(y=1.0)


def section_of_coordinate(plane: Slice) -> LinearSection | None:
    """Return the section on which all starts of a slice have one value of x or of y and cross it; None if there is none."""
    fixed = dict(plane.fixed)
    direction = Crossing.UP if plane.sign > 0 else Crossing.DOWN
    sections = [LinearSection(direction, **{c.key: 1.0}, value=fixed.get(c, 0.0)) for c in POSITIONS]
    return next((section for section in sections if section.plane == plane), None)


def oblique_slice(along: np.ndarray, point: np.ndarray, normal: tuple[float, float], sign: int) -> Slice:
    """Return a slice on a line of positions: the position along it, from a point, and the momentum that is less normal to it."""
    solved = Coordinate.PX if abs(normal[0]) > abs(normal[1]) else Coordinate.PY
    (free,) = (momentum for momentum in MOMENTA if momentum is not solved)
    component = normal[0] if solved is Coordinate.PX else normal[1]
    fixed = tuple(zip(POSITIONS, point.tolist(), strict=True))
    return Slice(Direction("s", *along.tolist()), free, solved, sign if component > 0.0 else -sign, fixed)
