"""A view: the system, the slice and the analyses that the page shows. Links, presets and the view state share its fields."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import StrEnum

from app.runtime.process_state import process_state
from app.state.watched_starts import WatchedStarts
from engine import Window
from plots.layers.table import PICTURES as PICTURE_ENTRIES
from plots.links.map_view import RESOLUTION_CHOICES, T_MAX_CHOICES, MapView
from plots.studies.table import studies_by_tab


class Analysis(StrEnum):
    """The analyses beside the maps that are no studies. Links contain the values, so the values must not change."""

    ORBIT = "orbit"
    STATISTICS = "statistics"
    MEASURES = "measures"
    WATCH = "watch"


ANALYSES = (Analysis.ORBIT, Analysis.STATISTICS, Analysis.MEASURES, *studies_by_tab(), Analysis.WATCH)
"""Names of all analyses beside the maps that have a tab, studies included, in the order of their tabs."""


def _up_to[Number: (int, float)](limit: float, choices: dict[str, Number]) -> dict[str, Number]:
    """Return the choices up to a limit, and always the smallest choice."""
    smallest = min(choices.values())
    return {name: value for name, value in choices.items() if value <= max(limit, smallest)}


def allowed_t_max() -> dict[str, float]:
    """Return the time horizons that the server's settings allow, by label."""
    return _up_to(process_state().settings.longest_t_max, T_MAX_CHOICES)


def allowed_resolutions() -> dict[str, int]:
    """Return the resolutions that the server's settings allow, by label."""
    return _up_to(process_state().settings.largest_resolution, RESOLUTION_CHOICES)


def sharper_resolution(resolution: int, pixels: int) -> int | None:
    """Return the resolution that follows this one while a picture has more pixels on the screen; None if there is none."""
    sharpest = process_state().settings.sharpest_resolution
    larger = [each for each in allowed_resolutions().values() if resolution < each <= sharpest]
    return min(larger, default=None) if resolution < pixels else None


PICTURES = ("well", *(name for name in PICTURE_ENTRIES if name != "curves"))
"""Names of the pictures: the well, the maps of starts, and the comparison with another view."""


@dataclass(frozen=True)
class View(MapView):
    """A view. By default it is the first view of the page. Colours do not belong to a view.

    Attributes
    ----------
    box
        The part of the plane that the statistics count; None for the window.
    analysis
        The analysis shown beside the maps, one of `ANALYSES`.
    watched
        Starts of the orbits in the player of many orbits.
    chosen
        The index of the chosen start.
    """

    box: Window | None = None
    analysis: str = Analysis.ORBIT
    watched: WatchedStarts = field(default=WatchedStarts())
    chosen: int = 0

    def within_limits(self) -> View:
        """Return the view with the nearest t_max and resolution that the settings of the server allow."""
        t_max, resolution = max(allowed_t_max().values()), max(allowed_resolutions().values())
        return replace(self, t_max=min(self.t_max, t_max), resolution=min(self.resolution, resolution))


FIRST_VIEW = View()
"""The view of the page without a link."""
