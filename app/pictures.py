"""The pictures of a map: what stands over each, which pixel has which colour, and their bare pixels."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from PIL import ImageColor

from app.map_columns import character_column, longest_typical_time, map_columns
from app.palette import Palette
from engine import EscapeMap, RegularityMap

TITLES = {
    "curves": "Zero-velocity curve and exits",
    "basins": "Basins of escape",
    "times": "Escape time",
    "crossings": "Crossings of y = 0",
    "characters": "Regular or chaotic",
}
"""All pictures, and what stands over each."""

PAINTED = {
    "curves": ("fate", "region_colours"),
    "basins": ("fate", "fate_colours"),
    "times": ("fate", "background_colours"),
    "crossings": ("crossing_class", "crossing_colours"),
    "characters": ("character", "character_colours"),
}
"""The column of pixel codes that each picture paints, and the colours of a palette that it has for them."""

SHORTEST_TIME = 1.0
"""Where the logarithmic scale of escape times begins."""


def picture_pixels(frame: EscapeMap, picture: str, palette: Palette, *, regularity: RegularityMap | None = None) -> np.ndarray:
    """The bare picture: (rows, columns, 4) uint8 RGBA, a pixel for each start, with row 0 on top.

    Raises ValueError when `picture` is not one of `TITLES`.
    """
    if picture not in TITLES:
        raise ValueError(f"picture={picture!r}: must be one of {', '.join(TITLES)}")
    columns = map_columns(frame, characters=picture == "characters")
    if regularity is not None:
        columns |= character_column(frame, regularity)
    column, colours = PAINTED[picture]
    pixels = _rgba(getattr(palette, colours))[columns[column][0]]
    if picture == "times":
        times = columns["escape_time"][0]
        known = np.isfinite(times)
        pixels[known] = time_colours(times[known], longest_typical_time(frame), palette)
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
