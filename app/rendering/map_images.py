"""The pictures of a map: what stands over each, which pixel has which colour, and their bare pixels."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from PIL import ImageColor

from app.rendering.image_columns import character_column, longest_typical_time, map_columns, passage_column
from app.rendering.map_analyses import NO_ANALYSES, MapAnalyses
from app.rendering.palette import DOUBT, Palette
from engine import EscapeMap, Trust

TITLES = {
    "curves": "Zero-velocity curve and exits",
    "basins": "Basins of escape",
    "times": "Escape time",
    "crossings": "Crossings of y = 0",
    "characters": "Regular or chaotic",
    "origins": "Origin and exit",
}
"""All pictures, and what stands over each."""

PAINTED = {
    "curves": ("fate", "region_colours"),
    "basins": ("fate", "fate_colours"),
    "times": ("fate", "background_colours"),
    "crossings": ("crossing_class", "crossing_colours"),
    "characters": ("character", "character_colours"),
    "origins": ("passage", "passage_colours"),
}
"""The column of pixel codes that each picture paints, and the colours of a palette that it has for them."""

ON_DEMAND = {"characters": "judge", "origins": "origins"}
"""Pictures that are shown when somebody asks for them, and the switch of the view state that does."""

DOUBTED = ("basins", "crossings")
"""Pictures in which doubtful pixels are marked."""

SHORTEST_TIME = 1.0
"""Where the logarithmic scale of escape times begins."""


def picture_pixels(frame: EscapeMap, picture: str, palette: Palette, findings: MapAnalyses = NO_ANALYSES) -> np.ndarray:
    """The bare picture: (rows, columns, 4) uint8 RGBA, a pixel for each start, with row 0 on top.

    `findings` paint what the map does not know by itself, and the doubtful pixels.

    Raises ValueError when `picture` is not one of `TITLES`.
    """
    if picture not in TITLES:
        raise ValueError(f"picture={picture!r}: must be one of {', '.join(TITLES)}")
    columns = map_columns(frame, characters=picture == "characters")
    if findings.regularity is not None:
        columns |= character_column(frame, findings.regularity)
    if findings.origins is not None:
        columns |= passage_column(findings.origins)
    column, colours = PAINTED[picture]
    pixels = _rgba(getattr(palette, colours))[columns[column][0]]
    if picture == "times":
        times = columns["escape_time"][0]
        known = np.isfinite(times)
        pixels[known] = time_colours(times[known], longest_typical_time(frame), palette)
    if findings.trust is not None and picture in DOUBTED:
        pixels[findings.trust.trust == Trust.DOUBTFUL] = _rgba([DOUBT])
    rows, wide = frame.fate.shape
    whole: np.ndarray = pixels.repeat(frame.stride, axis=0).repeat(frame.stride, axis=1)[:rows, :wide]
    return np.ascontiguousarray(whole[::-1])


def _rgba(colours: Sequence[str]) -> np.ndarray:
    return np.array([ImageColor.getcolor(colour, "RGBA") for colour in colours], np.uint8)


def time_colours(times: np.ndarray, longest: float, palette: Palette) -> np.ndarray:
    """(n, 4) colours of escape times, on a logarithmic scale from SHORTEST_TIME to `longest`."""
    colours = _rgba(palette.escape_time)
    place = np.log(np.clip(times, SHORTEST_TIME, longest) / SHORTEST_TIME) / math.log(longest / SHORTEST_TIME) * len(colours)
    chosen: np.ndarray = colours[np.minimum(place.astype(int), len(colours) - 1)]
    return chosen
