"""Pictures of a map: their titles, their colour codes and their pixels."""

from __future__ import annotations

import numpy as np

from engine import EscapeMap
from plots.pictures.image_columns import character_column, doubt_tones, map_columns, passage_column
from plots.pictures.map_analyses import NO_ANALYSES, MapAnalyses
from plots.pictures.palette import DOUBT, Palette, rgba
from plots.pictures.time_scale import TimeScale, fitted_scale

TITLES = {
    "curves": "Zero-velocity curve and exits",
    "basins": "Basins of escape",
    "times": "Escape time",
    "crossings": "Crossings of y = 0",
    "characters": "Regular or chaotic",
    "origins": "Origin and exit",
}
"""Titles of all pictures."""

COMPARISON_TITLES = {"compared": "The other view", "differences": "Where they differ"}
"""Titles of the pictures that compare a map with that of another view."""

PAINTED = {
    "curves": ("fate", "region_colours"),
    "basins": ("fate", "fate_colours"),
    "times": ("fate", "background_colours"),
    "crossings": ("crossing_class", "crossing_colours"),
    "characters": ("character", "character_colours"),
    "origins": ("passage", "passage_colours"),
    "compared": ("fate", "fate_colours"),
    "differences": ("difference", "difference_colours"),
}
"""For each picture its column of pixel codes and the attribute of `Palette` with the colours of the codes."""

ON_DEMAND = {"characters": "judge", "origins": "origins"}
"""Pictures that need a follow-up analysis, and the attribute of the view state that requests it."""

DOUBTED = ("basins", "crossings")
"""Pictures in which doubtful pixels are marked."""

CROSSED_BY_MANIFOLDS = ("curves", "basins", "crossings")
"""Pictures in which stable manifolds are drawn."""


def picture_pixels(
    frame: EscapeMap, picture: str, palette: Palette, analyses: MapAnalyses = NO_ANALYSES, times: TimeScale | None = None
) -> np.ndarray:
    """Pixels of a picture without axes and curves.

    Parameters
    ----------
    frame
        The map, finished or not.
    picture
        One of `TITLES`.
    palette
        Colours.
    analyses
        Results of follow-up analyses: regularity, origins and doubtful pixels.
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
    columns = map_columns(frame, characters=picture == "characters")
    if analyses.regularity is not None:
        columns |= character_column(frame, analyses.regularity)
    if analyses.origins is not None:
        columns |= passage_column(analyses.origins)
    column, colours = PAINTED[picture]
    pixels = rgba(getattr(palette, colours))[columns[column][0]]
    if picture == "times":
        shown = columns["escape_time"][0]
        escaped = np.isfinite(shown)
        scale = times or fitted_scale(frame)
        pixels[escaped] = rgba(palette.escape_time)[scale.classes(shown[escaped], len(palette.escape_time))]
    if analyses.trust is not None and picture in DOUBTED:
        tones = doubt_tones(analyses.trust)
        pixels[tones > 0] = rgba(DOUBT)[tones[tones > 0] - 1]
    rows, wide = frame.fate.shape
    whole: np.ndarray = pixels.repeat(frame.stride, axis=0).repeat(frame.stride, axis=1)[:rows, :wide]
    return np.ascontiguousarray(whole[::-1])
