"""The region around the origin in which a potential lies below an energy, on a grid: is it closed, and do the exits bound it?"""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from engine.potentials.potential import Potential

# Just below a saddle the ridge there is too thin for a grid: looked at is this share of the energy.
_BELOW = 0.9
_ANGLES, _RADII = 360, 300
_NEAREST, _FARTHEST = 1e-2, 50.0
_AROUND = 1.5


def opens_below(potential: Potential, energy: float, furthest: float) -> bool:
    """Whether the region around the origin with V a little below `energy` reaches far beyond `furthest`, the last saddle."""
    radius = furthest * np.geomspace(_NEAREST, _FARTHEST, _RADII)
    x, y = _polar(radius)
    bottom = float(potential.value(0.0, 0.0))
    return bool(_around_origin(potential.value(x, y) < bottom + _BELOW * (energy - bottom))[-1].any())


def find_bulging_channel(potential: Potential) -> int:
    """A channel past whose closed exit, straight across its saddle, the well reaches at an energy below the saddle; 0 if none.

    There the rule that tells inside from outside, by the saddle nearest in direction, would be wrong.
    """
    distance = np.hypot(*potential.saddles.T)
    x, y = _polar(_AROUND * float(distance.max()) * (np.arange(_RADII) + 0.5) / _RADII)
    bottom = float(potential.value(0.0, 0.0))
    value, outside = potential.value(x, y), _beyond_saddles(potential, x, y)
    for energy in np.unique(potential.saddle_energies):
        allowed = value < bottom + _BELOW * (energy - bottom)
        inside = _around_origin(allowed & (outside == 0))
        reached = allowed & ndimage.binary_dilation(inside) & (outside > 0)
        for channel in np.unique(outside[reached]):
            if potential.saddle_energies[channel - 1] >= energy:
                return int(channel)
    return 0


def _polar(radius: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """x and y (radii, angles) of a grid that goes round twice, so that no region is cut where it ends."""
    angle = np.linspace(0.0, 4.0 * np.pi, 2 * _ANGLES + 1)
    return radius[:, None] * np.cos(angle), radius[:, None] * np.sin(angle)


def _around_origin(allowed: np.ndarray) -> np.ndarray:
    """What of a region on a polar grid is connected with its innermost circle."""
    allowed = allowed.copy()
    allowed[0] = True
    labels = ndimage.label(allowed)[0]
    connected: np.ndarray = labels == labels[0, 0]
    return connected


def _beyond_saddles(potential: Potential, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """The channel beyond whose saddle each point lies, 0 inside; the saddle nearest in direction decides."""
    distance = np.hypot(*potential.saddles.T)
    towards = np.array([(sx * x + sy * y) / r for (sx, sy), r in zip(potential.saddles, distance, strict=True)])
    nearest = np.argmax(towards, axis=0)
    beyond = np.zeros(x.shape, int)
    for k, saddle in enumerate(potential.saddles):
        ux, uy = potential.outward_direction(k + 1)
        past = ux * (x - saddle[0]) + uy * (y - saddle[1]) > 0.0
        beyond[(nearest == k) & past] = k + 1
    return beyond
