"""The path of an orbit in its well as a small picture, for a message on a page that shows no well."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from engine import Fate, MapSpec, Plane, Window
from plots.pictures.orbit_curves import OrbitCurves

# Largest number of samples that are drawn. A longer path would fill the picture.
_MOST_SAMPLES = 5000
# Largest number of points of the drawn line.
_MOST_POINTS = 1000
# Width and height of the picture, in pixels.
_SIDE = 160


def path_picture(curves: OrbitCurves, colour: str) -> str:
    """Return HTML of the path in (x, y) in its well, with a dot at the start.

    Of a long path that leaves, the end is drawn; of other long paths, the beginning.
    """
    x, y = curves.path
    if not x.size:
        return ""
    part = slice(-_MOST_SAMPLES, None) if curves.orbit.fate > Fate.BOUNDED else slice(_MOST_SAMPLES)
    step = max(1, math.ceil(x[part].size / _MOST_POINTS))
    path = _pixels(curves.window, x[part][::step], y[part][::step])
    [start] = _pixels(curves.window, x[:1], y[:1])
    start_x, start_y = start.split(",")
    walls = "".join(_line(_pixels(curves.window, *piece.T), "currentColor") for piece in _limiting_curve(curves))
    return (
        f"<svg class='path' viewBox='0 0 {_SIDE} {_SIDE}' width='{_SIDE}' height='{_SIDE}' aria-hidden='true'>"
        f"{walls}{_line(path, colour)}<circle cx='{start_x}' cy='{start_y}' r='3' fill='currentColor'/></svg>"
    )


def _limiting_curve(curves: OrbitCurves) -> list[np.ndarray]:
    """Return the pieces (n, 2) of V = h in the window of the well."""
    orbit = curves.orbit
    if orbit.potential is None:
        return []
    return MapSpec(orbit.potential, Plane.X_Y, orbit.energy, window=curves.window).trace_zero_velocity_curve()


def _pixels(window: Window, x: np.ndarray, y: np.ndarray) -> list[str]:
    """Return points as places in the picture."""
    scale = _SIDE / window.width
    pixels = zip((x - window.x_low) * scale, (window.ordinate_high - y) * scale, strict=True)
    return [f"{left:.1f},{top:.1f}" for left, top in pixels]


def _line(points: Iterable[str], colour: str) -> str:
    return f"<polyline points='{' '.join(points)}' fill='none' stroke='{colour}'/>"
