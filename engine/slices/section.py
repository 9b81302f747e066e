"""Surfaces of section: what is counted along an orbit, and where its invariant curves are drawn."""

from __future__ import annotations

from dataclasses import dataclass

from engine.slices.axes import Coordinate
from engine.slices.planes import checked_slice
from engine.slices.slice import Slice


@dataclass(frozen=True)
class Section:
    """A line in (x, y) that orbits pierce in one direction.

    Attributes
    ----------
    coordinate
        x or y, which is 0 on the line.
    direction
        1 if the coordinate rises where the line is pierced, −1 if it falls.
    """

    coordinate: Coordinate
    direction: int = 1

    @property
    def plane(self) -> Slice:
        """The slice of the states on this section: the other coordinate and its momentum as axes."""
        if self.coordinate is Coordinate.Y:
            return checked_slice(Slice(Coordinate.X, Coordinate.PX, Coordinate.PY, self.direction))
        return checked_slice(Slice(Coordinate.Y, Coordinate.PY, Coordinate.PX, self.direction))


SECTION = Section(Coordinate.Y)
"""The section whose crossings are counted: y = 0, upward (Zotos 2014)."""
