"""The map of another view, which is compared pixel by pixel with the map in view."""

from __future__ import annotations

from typing import Any

from bokeh.models import ColumnDataSource, Image, LinearColorMapper
from bokeh.plotting import figure

from app.state.view_state import ViewState
from app.views.components.view_store import ViewStore
from app.views.maps.hover import fate_hover
from app.views.maps.map_curves import MapCurves
from engine import EscapeMap, Slice
from plots.layers.picture import OtherView, occurring_fates
from plots.pictures.image_columns import NO_LAYER, difference_column, map_columns

Columns = dict[str, list[Any]]
"""Columns of a data source of maps."""

# The columns of `map_columns` that drawing, hover text and comparison of the other map need.
_MAP_COLUMNS = ("fate", "x", "y", "dw", "dh", "ends")


class ComparedMap:
    """Draws the other map with its limiting curve, in its own window.

    Parameters
    ----------
    store
        Has the ranges of the pictures.
    state
        View state with the colours.
    """

    def __init__(self, store: ViewStore, state: ViewState) -> None:
        # Make the hover tool before the picture, because Bokeh warns if tools and pictures change together.
        self.source = ColumnDataSource(_blank_columns(), name="compared_map")
        self.hover = fate_hover(self.source, store.x, store.ordinate)
        self.other: OtherView | None = None
        """The view of the other map; None without a map."""
        self._outlines = MapCurves(state)

    def draw(self, plot: figure, mapper: LinearColorMapper) -> None:
        """Add the map and its curve to a figure."""
        image = plot.add_glyph(self.source, Image(image="fate", dw="dw", dh="dh", color_mapper=mapper))
        self._outlines.draw(plot)
        self.hover.renderers = [image]

    def show(self, frame: EscapeMap, title: str) -> None:
        """Show the other map."""
        self.other = OtherView(title, frame.spec.outcomes, frame.spec.plane.axis_symbols, occurring_fates(frame))
        columns = map_columns(frame)
        self.source.data = {name: columns[name] for name in _MAP_COLUMNS}
        self._outlines.show(frame.spec)

    def remove(self) -> None:
        """Remove the other map."""
        self.other = None
        self.source.data = _blank_columns()

    def difference(self, columns: Columns, plane: Slice) -> Columns:
        """Return the column ``difference`` for the columns of a map of a slice; blank unless the other map has the same axes."""
        is_compared = self.other is not None and self.other.axes == plane.axis_symbols
        return difference_column(columns, self.source.data) if is_compared else {"difference": NO_LAYER}


def _blank_columns() -> Columns:
    return {"fate": NO_LAYER, "x": [0.0], "y": [0.0], "dw": [0.0], "dh": [0.0], "ends": [[]]}
