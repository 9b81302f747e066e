"""A view: the system, the slice and the analyses that the page shows. Links, presets and the view state share its fields."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from enum import StrEnum
from types import MappingProxyType
from typing import Any

from app.runtime.process_state import process_state
from app.state.watched_starts import WatchedStarts
from engine import MapSpec, Plane, Section, Slice, System, Window
from engine.foundations.wording import format_number
from engine.slices.axes import Energy
from engine.systems.review.potential_review import SystemReview
from plots.layers.table import LAYERS
from plots.layers.table import PICTURES as PICTURE_ENTRIES
from plots.pictures.setting import Setting, Settings
from plots.studies.table import STUDIES, studies_by_tab

Start = tuple[float, float]
"""x and ordinate of a start in the plane."""


class Analysis(StrEnum):
    """The analyses beside the maps that are no studies. Links contain the values, so the values must not change."""

    ORBIT = "orbit"
    STATISTICS = "statistics"
    MEASURES = "measures"
    WATCH = "watch"


ANALYSES = (Analysis.ORBIT, Analysis.STATISTICS, Analysis.MEASURES, *studies_by_tab(), Analysis.WATCH)
"""Names of all analyses beside the maps that have a tab, studies included, in the order of their tabs."""

_FIRST_SYSTEM = System("I")


def _up_to[Number: (int, float)](limit: float, choices: dict[str, Number]) -> dict[str, Number]:
    """Return the choices up to a limit, and always the smallest choice."""
    smallest = min(choices.values())
    return {name: value for name, value in choices.items() if value <= max(limit, smallest)}


T_MAX_CHOICES = {"100": 1e2, "1 000": 1e3, "10 000": 1e4, "100 000": 1e5, "1 000 000": 1e6}
"""Longest times of the orbits, by label."""

RESOLUTION_CHOICES = {"112 × 112": 112, "224 × 224": 224, "450 × 450": 450, "900 × 900": 900}
"""Columns and rows of the map, by label."""


def allowed_t_max() -> dict[str, float]:
    """Return the time horizons that the server's settings allow, by label."""
    return _up_to(process_state().settings.longest_t_max, T_MAX_CHOICES)


def allowed_resolutions() -> dict[str, int]:
    """Return the resolutions that the server's settings allow, by label."""
    return _up_to(process_state().settings.largest_resolution, RESOLUTION_CHOICES)


PICTURES = ("well", *(name for name in PICTURE_ENTRIES if name != "curves"))
"""Names of the pictures: the well, the maps of starts, and the comparison with another view."""


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
class View:
    """A view. By default it is the first view of the page. Colours do not belong to a view.

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
    box
        The part of the plane that the statistics count; None for the window.
    layers
        Names of the layers that are on, as in `plots.layers.table.LAYERS`.
    settings
        The values of all `SETTINGS`, by name.
    section
        The surface of section at which crossings are counted.
    analysis
        The analysis shown beside the maps, one of `ANALYSES`.
    watched
        Starts of the orbits in the player of many orbits.
    starts, chosen
        Starts of up to `plots.pictures.palette.MOST_ORBITS` orbits, and the index of the chosen start.
    """

    system: System = _FIRST_SYSTEM
    plane: Slice = Plane.X_PX
    energy: float | None = None
    t_max: float = 1e5
    resolution: int = MapSpec.resolution[0]
    window: Window | None = None
    box: Window | None = None
    layers: frozenset[str] = frozenset()
    settings: Settings = field(default_factory=default_settings, hash=False)
    section: Section = Section.Y_UP
    analysis: str = Analysis.ORBIT
    watched: WatchedStarts = field(default=WatchedStarts())
    starts: tuple[Start, ...] = ()
    chosen: int = 0

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

    def within_limits(self) -> View:
        """Return the view with the nearest t_max and resolution that the settings of the server allow."""
        t_max, resolution = max(allowed_t_max().values()), max(allowed_resolutions().values())
        return replace(self, t_max=min(self.t_max, t_max), resolution=min(self.resolution, resolution))

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


FIRST_VIEW = View()
"""The view of the page without a link."""
