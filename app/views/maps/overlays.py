"""What layers draw over the pictures: marked pixels, and curves."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

from bokeh.models import ColumnDataSource, Glyph, Image, LinearColorMapper, MultiLine
from bokeh.plotting import figure

from app.state.view_state import ViewState
from app.views.components.plots import LaterGlyphs, SourcedGlyphs, with_gaps
from engine import MapSpec
from plots.layers.layer import Layer, Stroke
from plots.layers.table import LAYERS
from plots.pictures.palette import LIGHT, Palette

# The layers that draw over pictures.
_DRAWN_LAYERS = {name: layer for name, layer in LAYERS.items() if layer.over is not None}
_CURVE_COLUMNS = ("xs", "ys", "colour", "width", "alpha", "halo_width", "halo_alpha")


class Overlays:
    """Draws marks and curves of layers over the pictures. A layer is added to the figures when it is first shown.

    Parameters
    ----------
    source
        Data source of all pictures, which contains the pixel columns of the layers.
    state
        View state, whose palette has the colours.
    """

    def __init__(self, source: ColumnDataSource, state: ViewState) -> None:
        self._source, self._state = source, state
        self.curves = {name: ColumnDataSource(_no_curves(), name=name) for name in _DRAWN_LAYERS}
        self._glyphs_by_layer = {name: LaterGlyphs(partial(self._make_glyphs, layer)) for name, layer in _DRAWN_LAYERS.items()}
        self._strokes: dict[str, Sequence[Stroke]] = {}
        self._spec: MapSpec | None = None
        state.param.watch(lambda event: self._show_all_curves(), "palette")

    def draw(self, plot: figure, picture: str) -> None:
        """Add a figure of a picture, over which layers will be drawn."""
        for layer in _DRAWN_LAYERS.values():
            if layer.over_picture(picture) is not None:
                self._glyphs_by_layer[layer.name].add_figure(plot)

    def begin(self, spec: MapSpec) -> None:
        """Remove the curves of another map."""
        if spec != self._spec:
            self._spec = spec
            for name in _DRAWN_LAYERS:
                self.remove(name)

    def show(self, name: str, result: Any) -> None:
        """Draw the result of a layer, if the layer draws over pictures."""
        over = LAYERS[name].over
        if over is None:
            return
        self._glyphs_by_layer[name].draw()
        if over.strokes is not None:
            self._strokes[name] = over.strokes(result)
            self._show_curves(name)

    def remove(self, name: str) -> None:
        """Remove the curves of a layer."""
        if self._strokes.pop(name, None) is not None:
            self.curves[name].data = _no_curves()

    def _show_all_curves(self) -> None:
        for name in self._strokes:
            self._show_curves(name)

    def _show_curves(self, name: str) -> None:
        self.curves[name].data = _curve_columns(self._strokes[name], self._state.colours)

    def _make_glyphs(self, layer: Layer[Any]) -> SourcedGlyphs:
        """Return the glyphs of the marked pixels and of the curves of a layer."""
        over = layer.over
        glyphs: list[tuple[ColumnDataSource, Glyph]] = []
        if over is not None and over.pixel_colours is not None and layer.pixels is not None:
            colours = list(over.pixel_colours)
            mapper = LinearColorMapper(palette=colours, low=-0.5, high=len(colours) - 0.5)
            glyphs.append((self._source, Image(image=layer.pixels.column, dw="dw", dh="dh", color_mapper=mapper)))
        if over is not None and over.strokes is not None:
            halo = {"line_color": LIGHT.halo, "line_width": "halo_width", "line_alpha": "halo_alpha"}
            stroke = {"line_color": "colour", "line_width": "width", "line_alpha": "alpha"}
            glyphs += [(self.curves[layer.name], MultiLine(**style)) for style in (halo, stroke)]
        return glyphs


def _curve_columns(strokes: Sequence[Stroke], palette: Palette) -> dict[str, list[Any]]:
    lines = [with_gaps(stroke.lines) for stroke in strokes]
    return {
        "xs": [line[:, 0] for line in lines],
        "ys": [line[:, 1] for line in lines],
        "colour": [stroke.colour(palette) for stroke in strokes],
        "width": [stroke.width for stroke in strokes],
        "alpha": [stroke.alpha for stroke in strokes],
        "halo_width": [stroke.halo_width for stroke in strokes],
        # The browser draws even lines of width 0.
        "halo_alpha": [float(stroke.halo_width > 0.0) for stroke in strokes],
    }


def _no_curves() -> dict[str, list[Any]]:
    return {name: [] for name in _CURVE_COLUMNS}
