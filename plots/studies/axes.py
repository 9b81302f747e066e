"""Studies against the energy or a parameter: the values at which something is computed, and the view of a value."""

from __future__ import annotations

import math

import numpy as np

from engine import ParameterAxis, Slice, System
from engine.slices.planes import SECTION
from engine.slices.slice_text import default_range
from plots.studies.study import Changes, Subject

ENERGY = "h"
"""Name of the energy as an axis."""


def energy_and_parameters(system: System) -> tuple[str, ...]:
    """Return the names of the energy and of the parameters of a system."""
    return (ENERGY, *system.parameter_names)


def value_on(axis: str, system: System, energy: float) -> float:
    """Return the value of the energy or of a parameter in a view."""
    return energy if axis == ENERGY else system.value_of(axis)


def parameter_axis(subject: Subject, axis: str) -> ParameterAxis | None:
    """Return the parameter of the subject with its usual range; None for the energy."""
    return None if axis == ENERGY else ParameterAxis(axis, *default_range(subject.system, axis), subject.system)


def usual_range(subject: Subject, axis: str) -> tuple[float, float]:
    """Return the range in which the energy of a subject, or a parameter of its system, is explored."""
    energies = subject.energies
    return (energies.low, energies.high) if axis == ENERGY else default_range(subject.system, axis)


def spaced_values(subject: Subject, axis: str, count: int) -> tuple[float, ...]:
    """Return evenly spaced values over the range of the energy or of a parameter.

    Parameters
    ----------
    subject
        The subject, whose system has the range.
    axis
        "h" or the name of a parameter.
    count
        Number of values, at least 2.

    Returns
    -------
    The values, rounded to 4 decimals, or to more if the spacing is small.
    """
    low, high = usual_range(subject, axis)
    decimals = max(4, 2 - math.floor(math.log10((high - low) / (count - 1))))
    return tuple(np.round(np.linspace(low, high, count), decimals).tolist())


def swept_slice(subject: Subject) -> Slice:
    """Return the slice of the subject, or the surface of section if the slice has an axis of energies or of a parameter."""
    plane = subject.plane
    return plane if plane.energy_axis is None and plane.parameter is None else SECTION


def changes_at(subject: Subject, axis: str, values: np.ndarray, x: float) -> Changes:
    """Return the changes that open the map at the computed value nearest to `x`.

    Parameters
    ----------
    subject
        The subject of the result.
    axis
        "h" or the name of a parameter.
    values
        (n,) computed values of it.
    x
        The position of the click on the axis.
    """
    if not values.size:
        return {}
    value = float(values[np.argmin(np.abs(values - x))])
    if axis == ENERGY:
        return {"energy": value, "plane": swept_slice(subject)}
    return system_changes(subject, axis, value, subject.energy)


def system_changes(subject: Subject, axis: str, value: float, energy: float) -> Changes:
    """Return the changes that open the map at a value of a parameter and at an energy."""
    system = subject.system.with_parameter(axis, value)
    return {"system": system, "energy": energy, "plane": swept_slice(subject), "window": None, "starts": (), "chosen": 0}
