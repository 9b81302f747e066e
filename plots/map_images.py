"""Pictures of a map: their titles, their colour codes and their pixels."""

from __future__ import annotations

import math

import numpy as np

from engine import EscapeMap
from plots.image_columns import character_column, doubt_tones, longest_typical_time, map_columns, passage_column
from plots.map_analyses import NO_ANALYSES, MapAnalyses
from plots.palette import DOUBT, Palette, rgba

TITLES = {
    "curves": "Zero-velocity curve and exits",
    "basins": "Basins of escape",
    "times": "Escape time",
    "crossings": "Crossings of y = 0",
    "characters": "Regular or chaotic",
    "origins": "Origin and exit",
}
"""Titles of all pictures."""

PAINTED = {
    "curves": ("fate", "region_colours"),
    "basins": ("fate", "fate_colours"),
    "times": ("fate", "background_colours"),
    "crossings": ("crossing_class", "crossing_colours"),
    "characters": ("character", "character_colours"),
    "origins": ("passage", "passage_colours"),
}
"""For each picture its column of pixel codes and the attribute of `Palette` with the colours of the codes."""

ON_DEMAND = {"characters": "judge", "origins": "origins"}
"""Pictures that need a follow-up analysis, and the attribute of the view state that requests it."""

DOUBTED = ("basins", "crossings")
"""Pictures in which doubtful pixels are marked."""

CROSSED_BY_MANIFOLDS = ("curves", "basins", "crossings")
"""Pictures in which stable manifolds are drawn."""

SHORTEST_TIME = 1.0
"""Lower end of the logarithmic scale of escape times."""

SMALLEST_PICTURE, LARGEST_PICTURE = 100, 4000
"""Sides in pixels that a map in a picture file may have."""


def picture_pixels(
    frame: EscapeMap, picture: str, palette: Palette, analyses: MapAnalyses = NO_ANALYSES, longest: float | None = None
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
    longest
        Upper end of the scale of escape times; None for `longest_typical_time`.

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
        times = columns["escape_time"][0]
        escaped = np.isfinite(times)
        pixels[escaped] = time_colours(times[escaped], longest or longest_typical_time(frame), palette)
    if analyses.trust is not None and picture in DOUBTED:
        tones = doubt_tones(analyses.trust)
        pixels[tones > 0] = rgba(DOUBT)[tones[tones > 0] - 1]
    rows, wide = frame.fate.shape
    whole: np.ndarray = pixels.repeat(frame.stride, axis=0).repeat(frame.stride, axis=1)[:rows, :wide]
    return np.ascontiguousarray(whole[::-1])


def time_colours(times: np.ndarray, longest: float, palette: Palette) -> np.ndarray:
    """(n, 4) colours of escape times, on a logarithmic scale from `SHORTEST_TIME` to `longest`."""
    colours = rgba(palette.escape_time)
    place = np.log(np.clip(times, SHORTEST_TIME, longest) / SHORTEST_TIME) / math.log(longest / SHORTEST_TIME) * len(colours)
    chosen: np.ndarray = colours[np.minimum(place.astype(int), len(colours) - 1)]
    return chosen
