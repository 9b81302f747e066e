"""The pixels of the pictures of a map."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

import numpy as np

from engine import EscapeMap
from plots.layers.map_analyses import NO_ANALYSES
from plots.layers.table import LAYERS, PICTURES, TITLES
from plots.pictures.image_columns import NO_LAYER, map_columns
from plots.pictures.palette import Palette, rgba
from plots.pictures.time_scale import TimeScale, fitted_scale

LAYER_COLUMNS = tuple(name for layer in LAYERS.values() if layer.pixels is not None for name in layer.pixels.column_names)
"""Columns of the pixels of layers."""


def layer_columns(frame: EscapeMap, names: Collection[str]) -> dict[str, list[Any]]:
    """Return the columns of all layers: of named layers as far as a map determines them, of others with a single pixel."""
    images, _ = frame.thinned()
    pixels = (layer.pixels for layer in LAYERS.values() if layer.name in names)
    known = {one.column: [one.first_codes(images)] for one in pixels if one is not None and one.first_codes is not None}
    return dict.fromkeys(LAYER_COLUMNS, NO_LAYER) | known


def result_columns(name: str, frame: EscapeMap, result: Any) -> dict[str, list[Any]]:
    """Return the columns of the result of a layer on its map; none if the layer has no pixels."""
    pixels = LAYERS[name].pixels
    return {} if pixels is None else pixels.columns(result, frame)


def picture_pixels(
    frame: EscapeMap, picture: str, palette: Palette, analyses: Mapping[str, Any] = NO_ANALYSES, times: TimeScale | None = None
) -> np.ndarray:
    """Return the pixels of a picture without axes and curves.

    Parameters
    ----------
    frame
        The map, finished or not.
    picture
        One of `TITLES`.
    palette
        Colours.
    analyses
        Results of the layers.
    times
        Scale of the escape times; None for `fitted_scale`.

    Returns
    -------
    numpy.ndarray
        (rows, columns, 4) uint8 RGBA, one pixel per start, row 0 on top.

    Raises
    ------
    ValueError
        If `picture` is not one of `TITLES`.
    """
    if picture not in TITLES:
        raise ValueError(f"picture={picture!r}: must be one of {', '.join(TITLES)}")
    drawn, columns = PICTURES[picture], map_columns(frame) | layer_columns(frame, LAYERS)
    for name, result in analyses.items():
        columns |= result_columns(name, frame, result)
    pixels = rgba(drawn.colours(palette))[columns[drawn.column][0]]
    if drawn.has_times:
        _paint_times(pixels, columns["escape_time"][0], palette, times or fitted_scale(frame))
    for name in analyses:
        _paint_over(pixels, name, picture, columns)
    rows, wide = frame.fate.shape
    whole: np.ndarray = pixels.repeat(frame.stride, axis=0).repeat(frame.stride, axis=1)[:rows, :wide]
    return np.ascontiguousarray(whole[::-1])


def _paint_times(pixels: np.ndarray, escape_time: np.ndarray, palette: Palette, times: TimeScale) -> None:
    escaped = np.isfinite(escape_time)
    pixels[escaped] = rgba(palette.escape_time)[times.classes(escape_time[escaped], len(palette.escape_time))]


def _paint_over(pixels: np.ndarray, name: str, picture: str, columns: dict[str, list[Any]]) -> None:
    """Paint the marks of a layer."""
    pixels_of, over = LAYERS[name].pixels, LAYERS[name].over_picture(picture)
    if pixels_of is None or over is None or over.pixel_colours is None:
        return
    marks = rgba(over.pixel_colours)[columns[pixels_of.column][0]]
    is_marked = marks[..., 3] > 0
    pixels[is_marked] = marks[is_marked]
