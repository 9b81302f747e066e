"""A view: which starts of orbits are shown, and what is known of them; links, presets and the view state have its fields."""

from __future__ import annotations

from dataclasses import dataclass, fields
from enum import StrEnum
from typing import Any

from app.state.watched_starts import WatchedStarts
from engine import MapSpec, Plane, Slice, System, Window
from engine.slices.energies import Energy
from engine.systems.review.potential_review import SystemReview

Start = tuple[float, float]
"""x and ordinate of a start in the plane."""


class Analysis(StrEnum):
    """What is shown beside the maps; the values stand in links."""

    ORBIT = "orbit"
    STATISTICS = "statistics"
    MEASURES = "measures"
    ENERGIES = "energies"
    WATCH = "watch"


_FIRST_SYSTEM, _FIRST_STARTS = System("I"), WatchedStarts()


@dataclass(frozen=True)
class View:
    """A view, by default the first one of the page; its colours are the visitor's choice.

    Attributes
    ----------
    system
        The system, which may not be reviewed yet.
    plane
        The slice.
    energy
        h, in the units of the potential; None for the first energy of the system. A slice with an axis h does not use it.
    window
        Part of the plane; None for the whole interior.
    t_max
        Longest time of the orbits.
    resolution
        Columns and rows of the map.
    judge
        Whether bounded orbits are classified as regular or chaotic.
    trust
        Whether pixels that depend on rounding are marked.
    manifolds, images
        Whether the stable manifolds of the Lyapunov orbits are drawn, and which image of them; 0 for all.
    origins
        Whether orbits are integrated backward in time, too.
    analysis
        What is shown beside the maps.
    box
        Part of the window for the statistics; None for all of it.
    watched
        Starts of the orbits that are watched.
    starts, chosen
        Starts of up to `plots.pictures.palette.MOST_ORBITS` orbits, and the index of the chosen one.
    """

    system: System = _FIRST_SYSTEM
    plane: Slice = Plane.X_PX
    energy: float | None = None
    window: Window | None = None
    t_max: float = 1e5
    resolution: int = MapSpec.resolution[0]
    judge: bool = False
    trust: bool = False
    manifolds: bool = False
    images: int = 0
    origins: bool = False
    analysis: Analysis = Analysis.ORBIT
    box: Window | None = None
    watched: WatchedStarts = _FIRST_STARTS
    starts: tuple[Start, ...] = ()
    chosen: int = 0

    @property
    def title(self) -> str:
        """System, slice and energy in words."""
        energy = "" if self.known_energy is None else f", h = {self.known_energy:.6g}"
        return f"{self.system.title}, {self.plane.title}{energy}"

    @property
    def known_energy(self) -> float | None:
        """The energy of all starts; None if the slice has an axis h, or before the first energy of the system is known."""
        return self.energy if self.plane.energy_axis is None else None

    def values(self) -> dict[str, Any]:
        """The values of all fields by their names."""
        return {each.name: getattr(self, each.name) for each in fields(self)}

    def map_spec(self, reviewed: SystemReview) -> MapSpec:
        """The map of this view; ValueError if it has none.

        Parameters
        ----------
        reviewed
            The review of its system.
        """
        side = self.resolution
        return MapSpec(reviewed.potential, self.plane, self._map_energy(reviewed), (side, side), self.window, self.t_max)

    def _map_energy(self, reviewed: SystemReview) -> Energy:
        """The energy of all starts, or the range of an axis h."""
        energies = reviewed.energies
        if self.plane.energy_axis is not None:
            return max(reviewed.escape_energy, energies.low), energies.high
        return energies.first if self.energy is None else self.energy


FIRST_VIEW = View()
"""The view of the page without a link."""
