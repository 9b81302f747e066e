"""Tests of the Hill region, the region around the origin with V below an energy, on a polar grid: is it closed by the exits?"""

from __future__ import annotations

import numpy as np

from engine.potentials.potential import Potential

# The tests use this share of the saddle energy: right at the saddle energy the ridge is too narrow for the grid.
_ENERGY_SHARE = 0.9
_ANGLES, _RADII = 360, 300
# Radii of the grid of `is_open_below`, in units of the distance of the outermost critical point.
_SMALLEST_RADIUS, _LARGEST_RADIUS = 1e-2, 50.0
# Largest radius of the grid of `find_bulging_channel`, in units of the distance of the outermost saddle.
_RADIUS_AROUND_SADDLES = 1.5


def is_open_below(potential: Potential, energy: float, outermost: float) -> bool:
    """Whether the region around the origin slightly below `energy` extends far beyond the radius `outermost`."""
    x, y = _polar_grid(outermost * np.geomspace(_SMALLEST_RADIUS, _LARGEST_RADIUS, _RADII))
    bottom = float(potential.value(0.0, 0.0))
    return bool(_connected_to_origin(potential.value(x, y) < bottom + _ENERGY_SHARE * (energy - bottom))[-1].any())


def find_bulging_channel(potential: Potential) -> int:
    """A channel whose straight line across the saddle is crossed by the well at an energy below the saddle; 0 if there is none.

    There the rule that separates inside from outside, the saddle nearest in direction, would be wrong.
    """
    distance = np.hypot(*potential.saddles.T)
    x, y = _polar_grid(_RADIUS_AROUND_SADDLES * float(distance.max()) * (np.arange(_RADII) + 0.5) / _RADII)
    bottom = float(potential.value(0.0, 0.0))
    value, beyond = potential.value(x, y), _channel_beyond_saddle(potential, x, y)
    for energy in np.unique(potential.saddle_energies):
        allowed = value < bottom + _ENERGY_SHARE * (energy - bottom)
        inside = _connected_to_origin(allowed & (beyond == 0))
        crossed = allowed & _touching(inside) & (beyond > 0)
        for channel in np.unique(beyond[crossed]):
            if potential.saddle_energies[channel - 1] >= energy:
                return int(channel)
    return 0


def _polar_grid(radius: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """x and y (radii, angles); the angles span two turns, so that the edge of the grid does not split a region."""
    angle = np.linspace(0.0, 4.0 * np.pi, 2 * _ANGLES + 1)
    return radius[:, None] * np.cos(angle), radius[:, None] * np.sin(angle)


def _connected_to_origin(allowed: np.ndarray) -> np.ndarray:
    """The part of a region on a polar grid that is connected to the innermost circle."""
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


def _touching(region: np.ndarray) -> np.ndarray:
    """A region and its neighbours along both axes."""
    grown = region.copy()
    for axis in (0, 1):
        cells, neighbours = np.moveaxis(grown, axis, 0), np.moveaxis(region, axis, 0)
        cells[1:] |= neighbours[:-1]
        cells[:-1] |= neighbours[1:]
    return grown


def _channel_beyond_saddle(potential: Potential, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The channel beyond whose saddle each point lies, 0 inside; only the saddle nearest in direction is considered."""
    distance = np.hypot(*potential.saddles.T)
    towards = np.array([(sx * x + sy * y) / r for (sx, sy), r in zip(potential.saddles, distance, strict=True)])
    nearest = np.argmax(towards, axis=0)
    beyond = np.zeros(x.shape, int)
    for k, (saddle, (ux, uy)) in enumerate(zip(potential.saddles, potential.outward_directions, strict=True)):
        past = ux * (x - saddle[0]) + uy * (y - saddle[1]) > 0.0
        beyond[(nearest == k) & past] = k + 1
    return beyond
