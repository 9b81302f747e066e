"""Make the pixels of the pictures of a map."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

import numpy as np

from engine import EscapeMap
from engine.foundations.validation import checked_choice
from plots.layers.layer import NO_ANALYSES, Analyses
from plots.layers.table import LAYERS, LAYERS_BY_PICTURE, PICTURES, TITLES
from plots.pictures.image_columns import NO_LAYER, map_columns
from plots.pictures.palette import Palette, rgba
from plots.pictures.time_scale import TimeScale, fitted_scale

LAYER_COLUMNS = tuple(name for layer in LAYERS.values() if layer.pixels is not None for name in layer.pixels.column_names)
"""Columns of the pixels of layers."""


def layer_columns(frame: EscapeMap, names: Collection[str]) -> dict[str, list[Any]]:
    """Return the columns of all layers before their results.

    A layer in `names` that has `Pixels.first_codes` has these codes. The columns of all other layers are a single pixel.
    """
    images, _ = frame.thinned()
    pixels = (layer.pixels for layer in LAYERS.values() if layer.name in names)
    known_columns = {
        each.column: [each.first_codes(images)] for each in pixels if each is not None and each.first_codes is not None
    }
    return dict.fromkeys(LAYER_COLUMNS, NO_LAYER) | known_columns


def result_columns(name: str, frame: EscapeMap, result: Any) -> dict[str, list[Any]]:
    """Return the columns of the result of a layer on its map; none if the layer has no pixels."""
    pixels = LAYERS[name].pixels
    return {} if pixels is None else pixels.columns(result, frame)


def picture_pixels(
    frame: EscapeMap, picture: str, palette: Palette, analyses: Analyses = NO_ANALYSES, times: TimeScale | None = None
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
        uint8 RGBA of shape (rows, columns, 4), one pixel per start, row 0 on top.

    Raises
    ------
    ValueError
        If `picture` is not one of `TITLES`.
    """
    columns = _columns(frame, picture, analyses)
    pixels = rgba(PICTURES[picture].colours(palette))[columns[PICTURES[picture].column][0]]
    if PICTURES[picture].has_times:
        _paint_times(pixels, columns["escape_time"][0], palette, times or fitted_scale(frame))
    for name in analyses:
        _paint_over(pixels, name, picture, columns)
    return _enlarge(pixels, frame)


def picture_values(frame: EscapeMap, picture: str, analyses: Analyses = NO_ANALYSES) -> np.ndarray:
    """Return the numbers of a picture whose legend has a scale.

    Parameters
    ----------
    frame, picture, analyses
        As in `picture_pixels`.

    Returns
    -------
    numpy.ndarray
        float32 of shape (rows, columns), row 0 on top; NaN where `picture_pixels` shows no number.
    """
    columns = _columns(frame, picture, analyses)
    layer_pixels = LAYERS_BY_PICTURE[picture].pixels if picture in LAYERS_BY_PICTURE else None
    values: np.ndarray = columns["escape_time" if layer_pixels is None else layer_pixels.value_column][0].copy()
    for name in analyses:
        values[_marks(name, picture, columns)[..., 3] > 0] = np.nan
    return _enlarge(values, frame)


def _columns(frame: EscapeMap, picture: str, analyses: Analyses) -> dict[str, list[Any]]:
    checked_choice("picture", picture, TITLES)
    columns = map_columns(frame) | layer_columns(frame, LAYERS)
    for name, result in analyses.items():
        columns |= result_columns(name, frame, result)
    return columns


def _enlarge(pixels: np.ndarray, frame: EscapeMap) -> np.ndarray:
    """Return one pixel per start, row 0 on top, for the pixels of a frame, row 0 lowest."""
    row_count, column_count = frame.fate.shape
    enlarged: np.ndarray = pixels.repeat(frame.stride, axis=0).repeat(frame.stride, axis=1)[:row_count, :column_count]
    return np.ascontiguousarray(enlarged[::-1])


def _paint_times(pixels: np.ndarray, escape_time: np.ndarray, palette: Palette, times: TimeScale) -> None:
    """Paint the escaped pixels in place."""
    has_escaped = np.isfinite(escape_time)
    pixels[has_escaped] = rgba(palette.escape_time)[times.classes(escape_time[has_escaped], len(palette.escape_time))]


def _paint_over(pixels: np.ndarray, name: str, picture: str, columns: dict[str, list[Any]]) -> None:
    """Paint the marks of a layer in place."""
    marks = _marks(name, picture, columns)
    pixels[marks[..., 3] > 0] = marks[marks[..., 3] > 0]


def _marks(name: str, picture: str, columns: dict[str, list[Any]]) -> np.ndarray:
    """Return the colours, of shape (rows, columns, 4), that a layer gives to the pixels of a picture; clear where it has none."""
    layer_pixels = LAYERS[name].pixels
    over = LAYERS[name].over_picture(picture)
    if layer_pixels is None or over is None or over.pixel_colours is None:
        return np.zeros((*columns["fate"][0].shape, 4), np.uint8)
    return rgba(over.pixel_colours)[columns[layer_pixels.column][0]]
