"""A view of a map: the system, the slice, the map and its layers. Presets and the views of the page share its fields."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import Any

from engine import MapSpec, Plane, Section, Slice, System, Window
from engine.foundations.wording import format_number
from engine.slices.axes import Energy
from engine.systems.review.potential_review import SystemReview
from plots.layers.table import LAYERS
from plots.pictures.setting import Setting, Settings
from plots.studies.table import STUDIES

Start = tuple[float, float]
"""x and ordinate of a start in the plane."""

_FIRST_SYSTEM = System("I")

T_MAX_CHOICES = {"100": 1e2, "1 000": 1e3, "10 000": 1e4, "100 000": 1e5, "1 000 000": 1e6}
"""Longest times of the orbits, by label."""

RESOLUTION_CHOICES = {"112 × 112": 112, "224 × 224": 224, "450 × 450": 450, "900 × 900": 900}
"""Columns and rows of the map, by label."""

SETTINGS: Mapping[str, Setting] = MappingProxyType(
    {
        **{setting.name: setting for layer in LAYERS.values() for setting in layer.settings},
        **{setting.name: setting for study in STUDIES.values() for setting in study.settings},
    }
)
"""The settings of all layers and studies, by name."""


def default_settings() -> dict[str, Any]:
    """Return the default of each setting."""
    return {name: setting.default for name, setting in SETTINGS.items()}


@dataclass(frozen=True)
class MapView:
    """A map with layers and chosen orbits.

    Attributes
    ----------
    system
        The system, which may not be reviewed yet.
    plane
        The slice.
    energy
        h, in the units of the potential; None for the initial energy of the system. Unused on a slice with an axis h.
    t_max
        Longest time of the orbits, in the units of the potential.
    resolution
        Columns and rows of the map.
    window
        The part of the plane in view; None for the whole interior, the starts inside all exits.
    layers
        Names of the layers that are on, as in `plots.layers.table.LAYERS`.
    settings
        The values of all `SETTINGS`, by name.
    section
        The surface of section at which crossings are counted.
    starts
        Starts of up to `plots.pictures.palette.MOST_ORBITS` orbits.
    """

    system: System = _FIRST_SYSTEM
    plane: Slice = Plane.X_PX
    energy: float | None = None
    t_max: float = 1e5
    resolution: int = MapSpec.resolution[0]
    window: Window | None = None
    layers: frozenset[str] = frozenset()
    settings: Settings = field(default_factory=default_settings, hash=False)
    section: Section = Section.Y_UP
    starts: tuple[Start, ...] = ()

    @property
    def title(self) -> str:
        """Describe system, slice and energy."""
        energy = "" if self.known_energy is None else f", h = {format_number(self.known_energy, 6)}"
        return f"{self.system.title}, {self.plane.title}{energy}"

    @property
    def known_energy(self) -> float | None:
        """The energy of all starts; None on a slice with an axis h, or if the initial energy of the system is not known yet."""
        return self.energy if self.plane.energy_axis is None else None

    def values(self) -> dict[str, Any]:
        """Return the values of all fields, by name."""
        return {each.name: getattr(self, each.name) for each in fields(self)}

    def map_spec(self, reviewed: SystemReview) -> MapSpec:
        """Return the specification of the map; ValueError if it is invalid.

        Parameters
        ----------
        reviewed
            The review of the view's system.
        """
        side = self.resolution
        energy = self._map_energy(reviewed)
        return MapSpec(reviewed.potential, self.plane, energy, (side, side), self.window, self.t_max, section=self.section)

    def _map_energy(self, reviewed: SystemReview) -> Energy:
        """Return the energy of all starts, or the range of an axis h."""
        energies = reviewed.energies
        if self.plane.energy_axis is not None:
            begins_at_escape = energies.low < reviewed.escape_energy < energies.high
            return reviewed.escape_energy if begins_at_escape else energies.low, energies.high
        return energies.first if self.energy is None else self.energy


FIRST_MAP_VIEW = MapView()
"""The map of the page without a link."""
