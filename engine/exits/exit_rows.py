"""All exits of a system at an energy as the arrays that the kernels take: exits over saddles, and other ends (`End`)."""

from __future__ import annotations

import numpy as np

from engine.exits.exit_shapes import absent_channel, closed_channel
from engine.exits.lyapunov_orbits import UndefinedExitsError, find_orbits_in_well_units
from engine.exits.saddle_orbits.brake_orbits import saddle_axes
from engine.foundations.execution import DEFAULT_EXECUTION, Execution
from engine.integrator.kernels.exit_geometry import CURVE_COLUMNS
from engine.systems.potential import Potential
from engine.systems.review.singularity_check import check_defined


def closed_exits(potential: Potential) -> np.ndarray:
    """Return the exits at an energy below all saddles, (outcomes, columns): short lines across the saddles, and all other ends.

    Raises
    ------
    ValueError
        With an escape radius: if V is not defined somewhere within this radius.
    """
    if not potential.escapes_over_saddles:
        check_defined(potential)
    rows = [
        *(closed_channel(saddle_axes(potential, k + 1), saddle) for k, saddle in enumerate(potential.saddles)),
        *(end.row for end in potential.ends),
    ]
    return np.array(rows).reshape(len(rows), CURVE_COLUMNS)


def absent_exits(potential: Potential) -> np.ndarray:
    """Return the exits, (outcomes, columns), without those over saddles, which no orbit crosses. Other ends remain."""
    curves = closed_exits(potential)
    for channel, saddle in enumerate(potential.saddles, start=1):
        curves[channel - 1] = absent_channel(saddle_axes(potential, channel), saddle)
    return curves


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

    Unknown exits over saddles are returned as absent.
    """
    try:
        return exit_curves(potential, energy), ""
    except UndefinedExitsError as error:
        return absent_exits(potential), error.reason
