"""Tests of the Hill region, the region around the origin with V below an energy, on a polar grid: is it closed by the exits?"""

from __future__ import annotations

import numpy as np

from engine.potentials.potential import Potential

# The tests use this share of the saddle energy: right at the saddle energy the ridge is too narrow for the grid.
_ENERGY_SHARE = 0.9
_ANGLES, _RADII = 360, 300
# Radii of the grid of `is_open_below`, in units of the distance of the outermost critical point.
_SMALLEST_RADIUS, _LARGEST_RADIUS = 1e-2, 50.0


def is_open_below(potential: Potential, energy: float, outermost: float) -> bool:
    """Whether the region around the origin slightly below `energy` extends far beyond the radius `outermost`."""
    x, y = _polar_grid(outermost * np.geomspace(_SMALLEST_RADIUS, _LARGEST_RADIUS, _RADII))
    bottom = float(potential.value(0.0, 0.0))
    return bool(_connected_to_origin(potential.value(x, y) < bottom + _ENERGY_SHARE * (energy - bottom))[-1].any())


def _polar_grid(radius: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """x and y (radii, angles); the angles span two turns, so that the edge of the grid does not split a region."""
    angle = np.linspace(0.0, 4.0 * np.pi, 2 * _ANGLES + 1)
    return radius[:, None] * np.cos(angle), radius[:, None] * np.sin(angle)


def _connected_to_origin(allowed: np.ndarray) -> np.ndarray:
    """The part of a region on a polar grid that is connected to the innermost circle."""
    # `scipy.ndimage.label` does the same, but takes ten times as long to import.
    allowed = allowed.copy()
    allowed[0] = True
    connected, count = np.zeros_like(allowed), 0
    connected[0] = True
    while int(connected.sum()) > count:
        count = int(connected.sum())
        for view in (np.s_[:], np.s_[::-1]):
            for axis in (0, 1):
                cells, open_cells = (np.moveaxis(grid, axis, 0)[view] for grid in (connected, allowed))
                _spread(cells, open_cells)
    return connected


def _spread(connected: np.ndarray, allowed: np.ndarray) -> None:
    """Connect, in place, the allowed points that follow a connected one along the first axis without a gap."""
    index = np.arange(len(allowed))[:, None]
    last_gap = np.maximum.accumulate(np.where(allowed, -1, index))
    connected |= allowed & (np.maximum.accumulate(np.where(connected, index, -1)) > last_gap)
