"""Maps without a page."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from app.views.maps.map_plots import MapActions, MapsView

_NOTHING = MapActions(
    tap=lambda x, ordinate: None,
    dive=lambda x, ordinate: None,
    zoom=lambda window: None,
    rest=lambda: None,
    box=lambda box: None,
    choose=lambda name: None,
)


def make_maps(**actions: Any) -> MapsView:
    """Return the view of maps that calls these actions."""
    return MapsView(replace(_NOTHING, **actions))
