"""Returns of many orbits to a section, part by part, so that a computation can report progress and be cancelled."""

from __future__ import annotations

import numpy as np

from engine.foundations.execution import Execution
from engine.foundations.validation import checked_count
from engine.integrator.source.section_numbers import SectionNumbers
from engine.propagation.batch import OrbitBatch
from engine.propagation.fates import Fate
from engine.propagation.passages import find_passages
from engine.systems.potential import Potential

MOST_RETURNS = 100_000
"""Largest number of returns of an orbit."""

# Largest number of returns of all orbits, which take 5 numbers each.
_MOST_POINTS = 5_000_000
# Number of parts of the starts. Progress is reported, and the computation can be cancelled, after each part.
_PARTS = 16
# Numbers of a return: x, y, px, py and the time.
_COLUMNS = 5


def checked_returns(returns: int, orbits: int) -> int:
    """Return a number of returns of each of some orbits; ValueError unless it is from 1 to 100 000, and 5 million in all."""
    if orbits > _MOST_POINTS:
        raise ValueError(f"states: has {orbits} orbits; must have at most {_MOST_POINTS}")
    return checked_count("returns", returns, 1, min(MOST_RETURNS, _MOST_POINTS // max(orbits, 1)))


class FollowedOrbits:
    """The returns of n orbits, of which parts can be followed one after the other; in units of the well.

    Attributes
    ----------
    points
        (n, returns, 5) x, y, px, py and the time of each return so far; NaN for missing returns.
    fate
        (n,) int8 codes so far, see `engine.propagation.passages.Passages`.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    starts
        (n, 4) x, y, px, py; NaN for forbidden starts.
    curve_row, curves
        The exits, see `find_passages`.
    returns
        Largest number of returns of each orbit.
    t_max
        Longest time, above 0.
    section
        The section, see `Section.numbers`.
    """

    def __init__(
        self,
        potential: Potential,
        starts: np.ndarray,
        curve_row: np.ndarray,
        curves: np.ndarray,
        returns: int,
        t_max: float,
        section: SectionNumbers,
    ) -> None:
        self._potential, self._starts, self._curve_row, self._curves = potential, starts, curve_row, curves
        self._t_max, self._section = t_max, section
        self.points = np.full((len(starts), returns, _COLUMNS), np.nan)
        self.fate = np.full(len(starts), Fate.NOT_COMPUTED, np.int8)
        # Number of orbits that have not been followed yet; unknown until `parts` is called.
        self._pending = len(starts)

    def parts(self, execution: Execution, least_size: int = 1) -> list[np.ndarray]:
        """Return the indices of the starts that are inside all exits, in parts of similar size. The others get their fates."""
        batch = OrbitBatch.from_starts(self._starts, self._curve_row)
        allowed = np.flatnonzero(batch.fate == Fate.NOT_COMPUTED)
        tested = batch.mark_outside(self._potential, allowed, self._curves, execution=execution)
        inside = tested[batch.fate[tested] == Fate.NOT_COMPUTED]
        self.fate = batch.fate
        # A cancelled test leaves starts of which it is not known whether they are inside.
        self._pending = inside.size + allowed.size - tested.size
        return np.array_split(inside, min(_PARTS, max(inside.size // least_size, 1)))

    def follow(self, part: np.ndarray, execution: Execution) -> None:
        """Find the returns of the orbits with these indices."""
        found = find_passages(
            self._potential, self._starts[part], self._curve_row[part], self._curves, self.points.shape[1], self._t_max,
            self._section, execution=execution,
        )  # fmt: skip
        if not execution.is_cancelled:
            self.points[part], self.fate[part] = found
            self._pending -= part.size

    @property
    def complete(self) -> bool:
        """Whether all orbits have been followed."""
        return self._pending == 0

    def share_done(self) -> float:
        """Return the share of the orbits that have been followed."""
        return 1.0 - self._pending / max(len(self.points), 1)
