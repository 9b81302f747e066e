"""Lines on pictures to print, with smooth edges."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from PIL import Image, ImageDraw

# Lines are drawn this much larger and shrunk, as Pillow draws them without smooth edges; less on pictures that are large.
_SMOOTHING, _LARGEST_MASK = 4, 8000


def stroke(picture: Image.Image, pieces: Iterable[np.ndarray], colour: str, width: float) -> None:
    """Draw lines, (n, 2) shares of the picture's width and height from its lower left corner, `width` pixels wide."""
    scale = max(1, min(_SMOOTHING, _LARGEST_MASK // max(picture.size)))
    mask = Image.new("L", (scale * picture.width, scale * picture.height))
    draw = ImageDraw.Draw(mask)
    for piece in pieces:
        points = (piece * [1, -1] + [0, 1]) * mask.size
        draw.line([(float(x), float(y)) for x, y in points], 255, max(1, round(width * scale)), joint="curve")
    picture.paste(colour, (0, 0, *picture.size), mask.reduce(scale))
