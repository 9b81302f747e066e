"""The path of an orbit as a small picture, for a message on a page that shows no well."""

from __future__ import annotations

import math

from plots.pictures.orbit_curves import OrbitCurves

# Largest number of samples that are drawn. A longer path would fill the picture.
_MOST_SAMPLES = 3000
# Largest number of points of the drawn line.
_MOST_POINTS = 600
# Width and height of the picture, in pixels.
_SIDE = 120


def path_picture(curves: OrbitCurves, colour: str) -> str:
    """Return HTML of the path in (x, y) within the window of its well, with a dot at the start."""
    x, y = (values[:_MOST_SAMPLES] for values in curves.path)
    step = max(1, math.ceil(x.size / _MOST_POINTS))
    window = curves.window
    scale = _SIDE / window.width
    pixels = zip((x[::step] - window.x_low) * scale, (window.ordinate_high - y[::step]) * scale, strict=True)
    points = [f"{left:.1f},{top:.1f}" for left, top in pixels]
    if not points:
        return ""
    start_x, start_y = points[0].split(",")
    return (
        f"<svg class='path' viewBox='0 0 {_SIDE} {_SIDE}' width='{_SIDE}' height='{_SIDE}' aria-hidden='true'>"
        f"<polyline points='{' '.join(points)}' fill='none' stroke='{colour}'/>"
        f"<circle cx='{start_x}' cy='{start_y}' r='3' fill='currentColor'/></svg>"
    )
