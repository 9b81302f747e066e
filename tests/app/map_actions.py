"""Make the view of maps without a page."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from app.state.view_state import ViewState
from app.views.maps.map_plots import MapActions, MapsView

_NOTHING = MapActions(
    tap=lambda x, ordinate: None,
    zoom_to_point=lambda x, ordinate: None,
    zoom=lambda window: None,
    end_gesture=lambda: None,
    count_in=lambda box: None,
)


def make_maps(state: ViewState | None = None, **actions: Any) -> MapsView:
    """Return the view of maps that follows a view state and calls these actions."""
    return MapsView(state or ViewState(), replace(_NOTHING, **actions))
