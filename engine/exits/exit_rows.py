"""All exits of a system at an energy as the arrays that the kernels take: exits over saddles, and other ends (`End`)."""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import chebyshev

from engine.exits.brake_orbits import saddle_axes
from engine.exits.exit_shapes import absent_channel, closed_channel
from engine.exits.lyapunov_orbits import UndefinedExitsError, find_orbits_in_well_units
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.kernels import exit_geometry as geometry
from engine.systems.potential import Potential
from engine.systems.review.singularity_check import check_defined
from engine.systems.well_units import nearest_power_of_two

# Distance of a gate from the exit, in units of the distance of the saddle from the origin, rounded to a power of 2.
_GATE_MARGIN = 1e-3


def closed_exits(potential: Potential) -> np.ndarray:
    """Return the exits at an energy below all saddles, (outcomes, columns): short lines across the saddles, and all other ends.

    Raises
    ------
    ValueError
        With an escape radius: if V is not defined somewhere within this radius.
    """
    if potential.escape_radius is not None:
        check_defined(potential)
    rows = [
        *(closed_channel(saddle_axes(potential, k + 1), saddle) for k, saddle in enumerate(potential.saddles)),
        *(end.row for end in potential.ends),
    ]
    return np.array(rows).reshape(len(rows), geometry.CURVE_COLUMNS)


def exit_curves(potential: Potential, energy: float) -> np.ndarray:
    """Return the exits of a potential in units of its well at one energy, of shape (outcomes, columns).

    Raises `UndefinedExitsError` if the exits over saddles are not defined, and the errors of `closed_exits`.
    """
    curves = closed_exits(potential)
    for orbit in find_orbits_in_well_units(potential, energy):
        curves[orbit.channel - 1] = orbit.curve
        for channel in orbit.others:
            curves[channel - 1] = absent_channel(saddle_axes(potential, channel), potential.saddles[channel - 1])
    return curves


def exit_curves_at(potential: Potential, energies: np.ndarray, execution: Execution = DEFAULT_EXECUTION) -> np.ndarray:
    """Return `exit_curves` at n energies, of shape (n, outcomes, columns)."""
    curves = np.repeat(closed_exits(potential)[None], len(energies), axis=0)
    for row, energy in enumerate(energies.tolist()):
        execution.raise_if_cancelled()
        curves[row] = exit_curves(potential, energy)
    return curves


def exit_curves_if_known(potential: Potential, energy: float) -> tuple[np.ndarray, str]:
    """Return the `exit_curves`, and the reason why the exits over saddles are unknown; empty if they are known.

    Unknown exits over saddles are returned as absent, so that no orbit crosses them. Other ends remain.
    """
    try:
        return exit_curves(potential, energy), ""
    except UndefinedExitsError as error:
        curves = closed_exits(potential)
        for channel, saddle in enumerate(potential.saddles, start=1):
            curves[channel - 1] = absent_channel(saddle_axes(potential, channel), saddle)
        return curves, error.reason


def exit_gates(curves: np.ndarray) -> np.ndarray:
    """Return the gates of exits (…, outcomes, columns), of shape (outcomes, 3). No orbit ends before it passes a gate.

    A gate is cheap to test. For a channel, it is the line a x + b y = c slightly inside the exits at all energies; for a circle,
    it is the centre and the radius.
    """
    outcomes, columns = curves.shape[-2:]
    rows = curves.reshape(math.prod(curves.shape[:-2]), outcomes, columns)
    gates = np.ascontiguousarray(rows[0][:, [geometry.ORIGIN_X, geometry.ORIGIN_Y, geometry.HALF_WIDTH]])
    is_line = rows[0, :, geometry.SHAPE] <= geometry.LINE
    gates[is_line] = _lines_inside(rows[:, is_line])
    return gates


def _lines_inside(rows: np.ndarray) -> np.ndarray:
    """Return lines across channels, slightly inside their exits (energies, channels, columns), of shape (channels, 3)."""
    # The array axes of u, q, x and y are energies, channels and points.
    s = np.linspace(-1.0, 1.0, 201)
    u = chebyshev.chebval(s, np.moveaxis(rows[..., geometry.COEFFICIENTS :], -1, 0))
    q = rows[..., geometry.MIDDLE, None] + rows[..., geometry.HALF_WIDTH, None] * s
    origin_x, origin_y, outward_x, outward_y = np.moveaxis(rows[..., geometry.ORIGIN_X : geometry.OUTWARD_Y + 1, None], 2, 0)
    x, y = origin_x + u * outward_x - q * outward_y, origin_y + u * outward_y + q * outward_x
    normals = rows[0, :, geometry.OUTWARD_X : geometry.OUTWARD_Y + 1]
    innermost = (normals[:, :1] * x + normals[:, 1:] * y).min(axis=(0, -1))
    saddles = rows[0, :, geometry.ORIGIN_X : geometry.ORIGIN_Y + 1]
    lengths = np.array([nearest_power_of_two(distance) for distance in np.hypot(*saddles.T).tolist()])
    return np.column_stack([normals, innermost - _GATE_MARGIN * lengths])
