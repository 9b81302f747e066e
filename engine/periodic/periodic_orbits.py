"""The periodic orbits of a slice, as a table of their returns."""

from __future__ import annotations

import operator
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from engine.exits.closed_orbit import Stability
from engine.foundations.arrays import read_only
from engine.foundations.result import Result
from engine.foundations.wording import format_count, format_number
from engine.maps.spec import MapSpec
from engine.periodic.periodic_orbit import DIGITS, STATE_COLUMNS, PeriodicOrbit
from engine.slices.sections.section import Section


class PointsOfOrbits(Result):
    """Base of tables with a row for each point of a periodic orbit on a slice."""

    spec: MapSpec
    x: np.ndarray
    y: np.ndarray
    px: np.ndarray
    py: np.ndarray
    stability_index: np.ndarray
    row_dimension: ClassVar = "point"
    held_as: ClassVar = {"spec": "terms"}

    @property
    def section(self) -> Section:
        """The surface of section."""
        return self.spec.section

    @property
    def states(self) -> np.ndarray:
        """(points, 4) x, y, px, py of all points."""
        return np.column_stack([getattr(self, name) for name in STATE_COLUMNS])

    @property
    def stability(self) -> np.ndarray:
        """(points,) the `Stability` of the orbit of each point."""
        return np.array([Stability.of(index) for index in self.stability_index], object)

    def provenance(self) -> dict[str, Any]:
        """Return the potential, the request, the integrator and the version."""
        return self.spec.provenance()


@dataclass(frozen=True, eq=False, repr=False)
class PeriodicOrbits(PointsOfOrbits):
    """The periodic orbits of one energy with points in a window of a section, as returned by `find_periodic_orbits`.

    Its columns have a row for each return of each orbit. Iteration yields the orbits, each as a `PeriodicOrbit`.

    Attributes
    ----------
    spec
        The request of the starts, with the potential, the energy, the section and the window.
    most_returns
        Largest number of returns in a period that was searched for.
    orbit
        (points,) number of the orbit of each point, from 1, by the number of returns and the period.
    time
        (points,) time of the return, from 0.
    x, y, px, py
        (points,) state at the return.
    period, stability_index, action
        (points,) numbers of the orbit, see `PeriodicOrbit`.
    image_of
        (points,) number of the first orbit of which this orbit is an image under a symmetry of the motion; 0 if there is none.
    complete
        Whether the search has ended.
    """

    spec: MapSpec
    most_returns: int
    orbit: np.ndarray
    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    px: np.ndarray
    py: np.ndarray
    period: np.ndarray
    stability_index: np.ndarray
    action: np.ndarray
    image_of: np.ndarray
    complete: bool = True

    @property
    def energy(self) -> float:
        """Energy h of the orbits."""
        return energy_of(self.spec)

    def __len__(self) -> int:
        return int(self.orbit.max(initial=0))

    def __iter__(self) -> Iterator[PeriodicOrbit]:
        return (self[k] for k in range(len(self)))

    def __getitem__(self, index: int) -> PeriodicOrbit:
        if not -len(self) <= operator.index(index) < len(self):
            raise IndexError(f"index={index}: must be below the number of orbits, {len(self)}")
        rows = self.orbit == range(1, len(self) + 1)[index]
        first = int(np.argmax(rows))
        numbers = float(self.period[first]), float(self.stability_index[first]), float(self.action[first])
        time, x, y, px, py = (read_only(getattr(self, name)[rows]) for name in ("time", *STATE_COLUMNS))
        return PeriodicOrbit(self.energy, *numbers, time, x, y, px, py, section=self.section, potential=self.spec.potential)

    @property
    def points(self) -> np.ndarray:
        """(points, 2) all returns in the coordinates in which the section is drawn."""
        return self.section.axes.points(self.states)

    @property
    def returns(self) -> np.ndarray:
        """(points,) number of returns of the orbit of each point."""
        return np.bincount(self.orbit)[self.orbit]

    def nearest(self, x: float, ordinate: float) -> PeriodicOrbit | None:
        """Return the orbit with the return nearest to a place on the section; None if there is no orbit."""
        point = self.nearest_point(x, ordinate)
        return None if point is None else self[int(self.orbit[point]) - 1]

    def nearest_point(self, x: float, ordinate: float) -> int | None:
        """Return the number of the return nearest to a place in shares of the window, from 0; None if there is no orbit."""
        if not len(self):
            return None
        sides = [high - low for low, high in self.spec.find_window().ranges]
        return int(np.argmin(np.hypot(*((self.points - [x, ordinate]) / sides).T)))

    def describe(self) -> str:
        """Return the numbers of orbits in one sentence."""
        first = np.unique(self.orbit, return_index=True)[1]
        stable = int((self.stability[first] == Stability.STABLE).sum())
        numbers = f"{format_count(len(self), 'periodic orbit')} with up to {format_count(self.most_returns, 'return')}"
        place = f"to {self.section.place} at h = {format_number(self.energy, DIGITS)}"
        return f"{numbers} {place}: {stable} stable, {len(self) - stable} unstable{'' if self.complete else ', so far'}."


def energy_of(spec: MapSpec) -> float:
    """Return the energy of all starts of a request whose plane is the slice of its section; ValueError for another one."""
    if not spec.section.is_drawn_on(spec.plane) or spec.common_energy is None:
        if spec.section.plane is None or not spec.section.is_drawn_on(spec.section.plane):
            raise ValueError(f"spec: the points of its section {spec.section.place} are on no slice; choose another section")
        raise ValueError(f"spec: its plane is {spec.plane.title}; must be the slice of its section {spec.section.place}")
    return spec.common_energy
