"""Pictures in the coordinates of a slice: of a map, and of the result of a layer without its map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import Colormap, ListedColormap, LogNorm, Normalize

from engine import EscapeMap, MapSpec
from plots.layers.layer import NO_ANALYSES, Analyses, Layer, Stroke
from plots.layers.map_images import picture_pixels, picture_values
from plots.layers.picture import ColourScale, Legend, ShownMap
from plots.layers.table import LAYERS, PICTURES, map_legend
from plots.pictures.palette import Palette, rgba
from plots.pictures.time_scale import WITHOUT_ESCAPES, TimeScale
from plots.printed.window_axes import draw_limits, draw_pixels, draw_strokes


@dataclass(frozen=True, eq=False)
class PlanePicture:
    """Pixels and curves in the window of a request.

    Attributes
    ----------
    spec
        The request.
    title
        Title of the picture.
    palette
        Colours of the curves.
    legend
        Legend of the pixels and of the curves of layers.
    pixels
        uint8 RGBA of shape (rows, columns, 4), row 0 on top; None without pixels.
    values
        Numbers in the colours of `Legend.scale`, of shape (rows, columns), row 0 on top, NaN where the pixels are seen; None
        without numbers.
    strokes
        Curves of layers, from back to front.
    """

    spec: MapSpec
    title: str
    palette: Palette
    legend: Legend
    pixels: np.ndarray | None = None
    values: np.ndarray | None = None
    strokes: Sequence[Stroke] = ()

    def draw(self, axes: Axes, cmap: Any = None, norm: Any = None) -> list[Artist]:
        """Draw pixels, limiting curve, Lyapunov orbits and layers, and return them: numbers on a scale are the last image.

        `cmap` and `norm` replace those of the scale, as in `matplotlib.axes.Axes.imshow`.
        """
        spec, window = self.spec, self.spec.find_window()
        artists: list[Artist] = []
        if self.pixels is not None:
            artists.append(draw_pixels(axes, self.pixels, window))
        if self.values is not None and self.legend.scale is not None:
            scale_cmap, scale_norm = scale_colours(self.legend.scale)
            scale_cmap.colorbar_extend = "both"  # type: ignore[assignment]  # The types of Matplotlib say bool.
            colours = scale_cmap if cmap is None else cmap, scale_norm if norm is None else norm
            artists.append(draw_pixels(axes, np.ma.masked_invalid(self.values), window, *colours))
        artists += draw_limits(axes, spec.potential, spec.plane, spec.energy, window, self.palette.channels)
        return artists + draw_strokes(axes, self.strokes, window, self.palette)


def map_picture(
    frame: EscapeMap, picture: str, palette: Palette, analyses: Analyses = NO_ANALYSES, times: TimeScale | None = None
) -> PlanePicture:
    """Return a picture of a map, one of `plots.layers.table.TITLES`. `times` is the scale of the escape times."""
    pixels = picture_pixels(frame, picture, palette, analyses, times)
    legend = map_legend(picture, ShownMap.of(frame, palette, analyses, times))
    values = None
    if legend.scale is not None:
        values = picture_values(frame, picture, analyses)
        pixels[np.isfinite(values)] = 0
    overlays = [(LAYERS[name].over_picture(picture), result) for name, result in analyses.items()]
    strokes = [stroke for over, result in overlays if over is not None and over.strokes for stroke in over.strokes(result)]
    return PlanePicture(frame.spec, PICTURES[picture].title_for(frame.spec), palette, legend, pixels, values, strokes)


def layer_picture(layer: Layer[Any], result: Any, palette: Palette) -> PlanePicture:
    """Return the picture of the result of a layer without the map."""
    spec = layer.spec_of(result)
    shown = ShownMap(spec, palette, WITHOUT_ESCAPES, frozenset(), results={layer.name: result})
    scale = layer.picture.legend(shown).scale if layer.picture is not None else None
    pixels = values = None
    if layer.pixels is not None:
        pixels = rgba([*layer.pixels.colours(palette)])[layer.pixels.codes(result, None)][::-1]
        if scale is not None and layer.pixels.values is not None:
            values = layer.pixels.values(result)[::-1]
    entries = layer.pixels.entries(result, palette) if layer.pixels is not None else ()
    over = layer.over if layer.over is not None and layer.over.strokes is not None else None
    legend = Legend(entries, scale=scale, over=over.legend(result, palette) if over is not None else ())
    strokes = over.strokes(result) if over is not None and over.strokes is not None else ()
    return PlanePicture(spec, layer.title, palette, legend, pixels, values, strokes)


def scale_colours(scale: ColourScale) -> tuple[Colormap, Normalize]:
    """Return the colours of a scale, and its norm."""
    return ListedColormap(list(scale.colours)), (LogNorm if scale.is_logarithmic else Normalize)(scale.low, scale.high)
