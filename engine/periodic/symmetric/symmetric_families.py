"""Families of symmetric periodic orbits on a slice, as curves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from engine.exits.closed_orbit import Stability
from engine.foundations.wording import format_count, format_number
from engine.maps.spec import MapSpec
from engine.periodic.nearest_orbit import find_periodic_orbit
from engine.periodic.periodic_orbit import DIGITS, PeriodicOrbit
from engine.periodic.periodic_orbits import PointsOfOrbits


@dataclass(frozen=True, eq=False, repr=False)
class SymmetricFamilies(PointsOfOrbits):
    """The families of symmetric periodic orbits on a slice along the energy, as returned by `find_symmetric_families`.

    They are curves. The columns have a row for each point of a curve, and each point is the start of a periodic orbit. An orbit
    with two starts on the slice is on two curves. All quantities are dimensionless, and arrays are read-only.

    Attributes
    ----------
    spec
        The request of the starts, with the potential, the slice, the section and the window.
    most_returns
        Largest number of returns in a period that was searched for.
    curve
        (points,) number of the curve of each point, from 1, by the number of returns; points follow each other along a curve.
    returns
        (points,) number of returns of the orbit to the section in a period.
    abscissa, ordinate
        (points,) place on the slice, such as x and h.
    x, y, px, py
        (points,) start of the orbit.
    period, stability_index
        (points,) numbers of the orbit, see `PeriodicOrbit`.
    complete
        Whether the search has ended.
    """

    spec: MapSpec
    most_returns: int
    curve: np.ndarray
    returns: np.ndarray
    abscissa: np.ndarray
    ordinate: np.ndarray
    x: np.ndarray
    y: np.ndarray
    px: np.ndarray
    py: np.ndarray
    period: np.ndarray
    stability_index: np.ndarray
    complete: bool = True

    def __len__(self) -> int:
        return int(self.curve.max(initial=0))

    @property
    def points(self) -> np.ndarray:
        """(points, 2) all places on the slice."""
        return np.column_stack([self.abscissa, self.ordinate])

    @property
    def energy(self) -> np.ndarray:
        """(points,) energy h of the orbits."""
        return self.spec.energies(self.abscissa, self.ordinate)

    def orbit(self, point: int) -> PeriodicOrbit:
        """Return the orbit of a point, from 0, with all its returns.

        Raises
        ------
        NoPeriodicOrbitError
            If it is too unstable for Newton's method.
        """
        spec = self.spec
        return find_periodic_orbit(spec.potential, self.states[point], int(self.returns[point]), spec.t_max, section=spec.section)

    def describe(self) -> str:
        """Return the numbers of curves and points in one sentence."""
        curves, points = format_count(len(self), "curve"), format_count(len(self.curve), "point")
        returns = f"with up to {format_count(self.most_returns, 'return')} to {self.section.place}"
        stable = int((self.stability == Stability.STABLE).sum())
        low, high = (format_number(edge, DIGITS) for edge in self.spec.find_window().ranges[self.spec.plane.energy_axis or 0])
        return (
            f"{curves} of symmetric periodic orbits {returns} between h = {low} and {high}: {stable} of {points} stable"
            f"{'' if self.complete else ', so far'}."
        )
