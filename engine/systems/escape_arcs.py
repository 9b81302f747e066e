"""Arcs of an escape circle, each an exit: "x²y² exp(−r²); escape 6 exits 4"."""

from __future__ import annotations

import json
import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from engine.foundations.validation import checked_between
from engine.foundations.wording import format_number
from engine.integrator.kernels.exit_geometry import ARC, BEARING_X, BEARING_Y, COEFFICIENTS, MIDDLE, REACH, SHAPE
from engine.systems.outcomes import KINDS, End, EscapeCircle, Exit, Outcome

MOST_ARCS = 8
"""Largest number of arcs of an escape circle."""

# Difference below which two directions are the same, in degrees.
_EQUAL_ANGLES = 1e-9


@dataclass(frozen=True)
class EscapeArc(EscapeCircle):
    """One of equal arcs of the escape circle, each an exit: the outcomes of scattering.

    Parameters
    ----------
    radius
        Radius of the circle, 1e-6 to 1e6, dimensionless.
    number
        Number of the arc, counterclockwise from 1.
    exits
        Number of arcs, 2 to 8.
    begin
        Direction in which the first arc begins, in degrees counterclockwise from the +x axis, −360 to 360.

    Raises
    ------
    ValueError
        If a value is out of range.
    """

    attribute = "escape_arcs"
    clause = r"(?P<radius>[^;]*?)\sexits\s(?P<exits>[^;]*?)(?:\sfrom\s(?P<begin>[^;]*))?$"
    syntax = "one {} radius exits NUMBER from DEGREES"

    number: int
    exits: int
    begin: float

    def __post_init__(self) -> None:
        super().__post_init__()
        checked_between("exits", self.exits, 2, MOST_ARCS)
        checked_between("from", self.begin, -360.0, 360.0)

    @classmethod
    def make(cls, **parameters: Any) -> list[Self]:
        """See `End.make`. By default, the +x axis is in the middle of the first arc."""
        count = checked_between("exits", parameters["exits"], 2, MOST_ARCS)
        if count != int(count):
            raise ValueError(f"exits={count:g}: must be an integer")
        begin = parameters.get("begin", -180.0 / count)
        return [cls(parameters["radius"], number, int(count), begin) for number in range(1, int(count) + 1)]

    @classmethod
    def outcome(cls, number: int, name: str = "", *, occurs: bool = True) -> Outcome:
        """Return the outcome of an arc, which is an exit."""
        return Exit.outcome(number, name, occurs=occurs)

    @property
    def text(self) -> str:
        """The clause of all arcs for the first arc; empty for the others."""
        return f"{self.word} {self.radius!r} exits {self.exits} from {self.begin!r}" if self.number == 1 else ""

    @property
    def geometry(self) -> str:
        """See `End.geometry`."""
        low, high = self._ends
        return f"{super().geometry} from {format_number(low)}° to {format_number(high)}°"

    @property
    def place(self) -> tuple[float, float]:
        """See `End.place`: the middle of the arc."""
        return self.radius * math.cos(self._middle), self.radius * math.sin(self._middle)

    @property
    def _middle(self) -> float:
        """The direction of the middle of the arc in radians."""
        return math.radians(0.5 * sum(self._ends))

    @property
    def _ends(self) -> tuple[float, float]:
        """The directions of both ends of the arc in degrees."""
        return self.begin + 360.0 * (self.number - 1) / self.exits, self.begin + 360.0 * self.number / self.exits

    def image(self, signs: tuple[float, float]) -> Hashable:
        """See `End.image`."""
        low, high = self._ends
        begin = {(1.0, 1.0): low, (-1.0, 1.0): 180.0 - high, (1.0, -1.0): -high, (-1.0, -1.0): low + 180.0}[signs]
        return self.radius, round(begin / _EQUAL_ANGLES) % round(360.0 / _EQUAL_ANGLES)

    @property
    def row(self) -> np.ndarray:
        """See `End.row`."""
        row, half = super().row, math.pi / self.exits
        row[[SHAPE, MIDDLE, COEFFICIENTS]] = ARC, self._middle, half
        row[[BEARING_X, BEARING_Y, REACH]] = math.cos(self._middle), math.sin(self._middle), math.cos(half)
        return row

    def contains(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """See `End.contains`."""
        turn = np.degrees(np.arctan2(y, x)) - self.begin
        return super().contains(x, y) & (np.floor(turn % 360.0 * self.exits / 360.0) == self.number - 1)

    @classmethod
    def write(cls, ends: Sequence[End]) -> Any:
        """See `End.write`."""
        arcs = [end for end in ends if isinstance(end, EscapeArc)]
        return json.dumps([[arc.radius, arc.number, arc.exits, arc.begin] for arc in arcs])

    @classmethod
    def read(cls, attribute: Any) -> list[Self]:
        """See `End.read`."""
        return [cls(*values) for values in json.loads(attribute)]


def end_kinds() -> list[type[End]]:
    """Return the kinds of ends besides the exits over saddles. A clause is of the first kind that matches it."""
    return [EscapeArc, *(kind for kind in KINDS.values() if issubclass(kind, End))]
