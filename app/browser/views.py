"""What the page shows, as data for the engine in the browser."""

from __future__ import annotations

from typing import Any

from app.browser.system_request import system_key
from app.state.view_state import ViewState
from engine import Plane
from plots.image_columns import pixel_coding

_COORDINATES = {"x", "y", "px", "py", "h"}


def describe_view(state: ViewState) -> dict[str, Any]:
    """The view as `ServerView` in modules/preview.js describes it."""
    return {
        "system": system_key(state.potential),
        "plane": state.plane.name,
        "slice": describe_slice(state.plane),
        "energy": state.energy,
        "home": state.window is None,
        "resolution": state.resolution,
        "colours": list(state.colours.channels),
        "coding": pixel_coding(),
    }


def describe_slice(plane: Plane) -> dict[str, Any] | None:
    """Which starts a plane holds: its axes, fixed coordinates, and the momentum that the energy decides, with its sign.

    None for a plane with an axis that is no coordinate, which the browser does not know.
    """
    axes = ("x", plane.ordinate)
    if not set(axes) <= _COORDINATES:
        return None
    fixed = {name: 0.0 for name in ("y", "px") if name not in axes}
    return {"axes": list(axes), "fixed": fixed, "decided": "py", "sign": 1}
