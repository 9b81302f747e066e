"""The legend of all maps."""

from __future__ import annotations

from collections.abc import Iterable

import panel as pn

from app.views.components.legends import legend_items, passage_legend
from app.views.components.numbers import grouped
from engine import Fate, MapSpec
from plots.map_images import SHORTEST_TIME
from plots.palette import Entry, Palette

_STEPS = 12


class MapLegend:
    """Groups of entries: exits, escape times, crossings, curves, and what the layers add."""

    def __init__(self) -> None:
        self.pane = pn.pane.HTML("", name="legend", sizing_mode="stretch_width", margin=(0, 10), css_classes=["map-legend"])

    def show(
        self,
        spec: MapSpec,
        palette: Palette,
        longest: float,
        curves: Iterable[Entry],
        *,
        regularity: str | None = None,
        origins: bool = False,
        locked: bool = False,
    ) -> None:
        """Describe a map.

        Parameters
        ----------
        spec
            The map.
        palette
            Its colours.
        longest
            Escape time at the end of the colour scale; longer ones have the last colour.
        curves
            Entries of the curves and overlays.
        regularity
            Result of the analysis of bounded orbits; None while that picture is not shown.
        origins
            Whether the picture of origins and exits is shown.
        locked
            Whether the escape times keep their scale.
        """
        outcomes = palette.outcomes
        groups = {
            "Exit": legend_items([*palette.channel_entries(spec.potential.channels), outcomes[Fate.BOUNDED]]),
            "Escape time": _colour_scale(palette, longest, locked=locked),
            "Crossings": legend_items(palette.crossing_entries),
            "Other starts": legend_items([outcomes[fate] for fate in (Fate.FORBIDDEN, Fate.OUTSIDE, Fate.NOT_COMPUTED)]),
            "Curves": legend_items(curves),
        }
        if regularity is not None:
            groups["Bounded orbits"] = f"{legend_items(palette.character_entries[1:])} <span>{regularity}</span>"
        body = "".join(f"<div><b>{name}</b> {items}</div>" for name, items in groups.items() if items)
        self.pane.object = f"<div class='legend'>{body}</div>" + (
            passage_legend(palette, spec.potential.channels) if origins else ""
        )


def _colour_scale(palette: Palette, longest: float, *, locked: bool) -> str:
    """The logarithmic scale of escape times; the colours at its ends stand for all shorter and all longer times."""
    colours = palette.escape_time
    stops = ",".join(colours[round(step * (len(colours) - 1) / _STEPS)] for step in range(_STEPS + 1))
    bar = f"<i class='scale' style='background:linear-gradient(90deg,{stops})'></i>"
    kind = "logarithmic, locked" if locked else "logarithmic"
    return f"<span>≤ {SHORTEST_TIME:g} {bar} ≥ {grouped(longest)}</span>({kind})"
