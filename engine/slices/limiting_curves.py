"""The curves V = h on a slice: the boundary of its forbidden region, and equipotentials."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from engine.foundations.validation import checked_number, checks_types
from engine.slices.axes import Energy, common_energy
from engine.slices.planes import checked_slice
from engine.slices.slice import Slice
from engine.slices.window import GivenWindow, Window, checked_window
from engine.systems.potential import Potential

_CONTOUR_SAMPLES = 201


@checks_types(potential=Potential)
def trace_zero_velocity_curve(potential: Potential, plane: Slice, energy: Energy, window: GivenWindow) -> list[np.ndarray]:
    """Trace the boundary of the forbidden region of a slice: V(x, y) = h, px²/2 + V(x, 0) = h, or V(x, 0) = h.

    Parameters
    ----------
    potential
        The potential.
    plane
        The slice, such as a `Plane`.
    energy
        h, dimensionless; ignored on a slice with an axis h.
    window
        The part of the slice to trace, given as in `MapSpec`.

    Returns
    -------
    The pieces of the curve, each (n, 2).

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane
    >>> len(MapSpec(CASES["I"], Plane.X_PX, 0.19).trace_zero_velocity_curve())
    1
    """
    # With an axis h, the required energy is the energy that is missing.
    level = None if checked_slice(plane).energy_axis is not None else common_energy(energy)
    return trace_equipotentials(potential, plane, (level or 0.0,), checked_window(window))[0]


def trace_equipotentials(potential: Potential, plane: Slice, energies: Sequence[float], window: Window) -> list[list[np.ndarray]]:
    """Return the zero-velocity curves of several energies on a slice of one energy, as a list of (n, 2) pieces for each."""
    import contourpy

    levels = [checked_number("energies", energy) for energy in energies]
    x, ordinate = (
        np.linspace(low, high, _CONTOUR_SAMPLES)
        for low, high in ((window.x_low, window.x_high), (window.ordinate_low, window.ordinate_high))
    )
    required = checked_slice(plane).required_energy(potential, *np.meshgrid(x, ordinate))
    contours = contourpy.contour_generator(x, ordinate, required)
    return [[np.asarray(line) for line in contours.lines(level)] for level in levels]
