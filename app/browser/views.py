"""The view of the page as data for the engine in the browser."""

from __future__ import annotations

from typing import Any

from app.browser.browser_system import system_key
from app.state.view_state import ViewState
from engine.slices.slice_text import write_slice
from plots.layers.map_images import LAYER_COLUMNS
from plots.pictures.image_columns import pixel_coding


def describe_view(state: ViewState) -> dict[str, Any]:
    """Return the view in the form of `ServerView` in modules/gestures/preview.js."""
    outcomes = state.potential.outcomes_at(state.energy)
    return {
        "system": system_key(state.potential),
        "plane": ";".join(filter(None, write_slice(state.plane))),
        # Only the server knows the potentials along a parameter.
        "slice": state.plane.to_dict(state.potential.units) if state.plane.parameter is None else None,
        "energy": state.energy,
        "home": state.window is None,
        "resolution": state.resolution,
        "colours": [entry.colour for entry in state.colours.end_entries(outcomes)],
        "labels": [end.label for end in outcomes],
        "coding": {**pixel_coding(outcomes), "layers": list(LAYER_COLUMNS)},
    }
