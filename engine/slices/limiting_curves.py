"""The curves V = h on a slice: the boundary of its forbidden region, and equipotentials."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.slices.axes import Energy, highest_energy
from engine.slices.slice import Slice
from engine.slices.window import Window
from engine.systems.potential import Potential

# Number of samples along each side of a window.
_CONTOUR_SAMPLES = 201


def trace_zero_velocity_curve(potential: Potential, plane: Slice, energy: Energy, window: Window) -> list[np.ndarray]:
    """Trace the boundary of the forbidden region of a slice, such as V(x, y) = h, px²/2 + V(x, 0) = h, or V(x, 0) = h.

    Returns the pieces of the curve in a window, (n, 2) each. `energy` is ignored on a slice with an axis h.
    """
    # On a slice with an axis h, `required_energy` is relative to the h of each point, so the boundary is at 0.
    level = highest_energy(energy) if plane.energy_axis is None else 0.0
    (pieces,) = trace_equipotentials(potential, plane, [level], window)
    return pieces


def trace_equipotentials(potential: Potential, plane: Slice, energies: Sequence[float], window: Window) -> list[list[np.ndarray]]:
    """Trace the curves on which `Slice.required_energy` has these values. Returns the pieces of each curve, (n, 2) each."""
    import contourpy

    x, ordinate = (np.linspace(low, high, _CONTOUR_SAMPLES) for low, high in window.ranges)
    required = plane.required_energy(potential, *np.meshgrid(x, ordinate))
    contours = contourpy.contour_generator(x, ordinate, required)
    return [[np.asarray(line) for line in contours.lines(energy)] for energy in energies]
