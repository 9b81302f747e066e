"""Tests on a polar grid of whether the Hill region, the region around the origin with V below an energy, is bounded."""

from __future__ import annotations

import functools

import numpy as np

from engine.systems.potential import Potential

# Energy of the test, as a share of the way from the bottom to the saddle energy. At the saddle energy itself, the ridge is too
# narrow for the grid.
_ENERGY_SHARE = 0.9
# Number of angles of the grid per turn.
_ANGLES = 720
# Number of radii of the grid per factor of e.
_RADII_PER_E_FOLD = 35
# Smallest radius of the grid, in units of the distance of the nearest critical point.
_SMALLEST_RADIUS = 1e-2
# Largest radius of the grid, in units of the distance of the outermost critical point.
_LARGEST_RADIUS = 50.0
# Energy at which openings without a saddle are searched, in units of the range of the critical energies.
_OPEN_ENERGY_FACTOR = 100.0
# Number of potentials for which the check of a closed well is cached.
_CACHE_SIZE = 256


def is_open_without_saddle(potential: Potential, points: np.ndarray) -> bool:
    """Return whether the Hill region at an energy far above those of all critical points (n, 2) extends far beyond them."""
    bottom = float(potential.value(0.0, 0.0))
    # Without other critical points, the range is 0, and the unit of energy takes its place.
    energy_range = float(np.abs(potential.value(*points.T) - bottom).max(initial=0.0)) or potential.units.energy
    return is_open_below(potential, bottom + _OPEN_ENERGY_FACTOR * energy_range, points)


@functools.lru_cache(maxsize=_CACHE_SIZE)
def check_closed_well(potential: Potential) -> None:
    """Raise ValueError unless a potential without exits has a well at the origin that no orbit leaves."""
    points = potential.critical_points
    is_regular_origin = (points == 0.0).all(axis=1) & (potential.well.critical_indices > 0.0)
    if not (is_regular_origin.any() and potential.well.is_convex_at_origin) or is_open_without_saddle(potential, points):
        raise ValueError(
            f"potential={potential.name}: must have exits, or a closed well at the origin, so that it is defined which orbits "
            "escape; see review_potential"
        )


def is_open_below(potential: Potential, energy: float, points: np.ndarray) -> bool:
    """Return whether the region around the origin with V slightly below `energy` extends far beyond all critical points (n, 2).

    The grid is polar in coordinates in which V ≈ ½ r² near the origin of a well, so that the grid resolves narrow wells.
    """
    squared_frequencies, axes = (
        np.linalg.eigh(potential.hessian_matrix(0.0, 0.0)) if potential.well.is_convex_at_origin else (np.ones(2), np.eye(2))
    )
    distances = np.hypot(*(np.sqrt(squared_frequencies) * (points @ axes)).T)
    distances = distances[distances > 0.0]
    # Without critical points elsewhere, the unit of length of the well takes the place of their distance.
    default = np.sqrt(potential.units.energy) if potential.well.is_convex_at_origin else potential.units.length
    nearest, outermost = (distances.min(), distances.max()) if distances.size else (default, default)
    low, high = _SMALLEST_RADIUS * nearest, _LARGEST_RADIUS * outermost
    radii = np.geomspace(low, high, int(_RADII_PER_E_FOLD * np.log(high / low)))[:, None]
    # The angles span two turns, so that the edge of the grid does not split a region.
    angles = np.linspace(0.0, 4.0 * np.pi, 2 * _ANGLES + 1)
    xi = radii * np.cos(angles) / np.sqrt(squared_frequencies[0])
    eta = radii * np.sin(angles) / np.sqrt(squared_frequencies[1])
    values = potential.value(axes[0, 0] * xi + axes[0, 1] * eta, axes[1, 0] * xi + axes[1, 1] * eta)
    bottom = potential.well.bottom
    return bool(_connected_to_origin(values < bottom + _ENERGY_SHARE * (energy - bottom))[-1].any())


def _connected_to_origin(allowed: np.ndarray) -> np.ndarray:
    """Return the part of a region on a polar grid (radii, angles) that is connected to the innermost circle."""
    # `scipy.ndimage.label` gives the same result, but its import takes ten times as long as this function.
    allowed = allowed.copy()
    allowed[0] = True
    connected = np.zeros_like(allowed)
    connected[0] = True
    previous_count = 0
    while (count := int(connected.sum())) > previous_count:
        previous_count = count
        # The region spreads outward and inward, and in both directions of the angle. The views share the memory of `connected`.
        for direction in (np.s_[:], np.s_[::-1]):
            for axis in (0, 1):
                connected_view, allowed_view = (np.moveaxis(grid, axis, 0)[direction] for grid in (connected, allowed))
                _spread(connected_view, allowed_view)
    return connected


def _spread(connected: np.ndarray, allowed: np.ndarray) -> None:
    """Connect, in place, the allowed points that follow a connected point along the first axis without a gap."""
    index = np.arange(len(allowed))[:, None]
    last_gap = np.maximum.accumulate(np.where(allowed, -1, index))
    connected |= allowed & (np.maximum.accumulate(np.where(connected, index, -1)) > last_gap)
