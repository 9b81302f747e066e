"""The compiled kernels of a potential, and how fine their steps are: a well of another size or stiffness has other units.

Lengths that decide something are meant in units of `Potential.length`, which is 1 for the three cases of Zotos (2014).
"""

from __future__ import annotations

from types import ModuleType

from engine.potentials.potential import Potential
from engine.taylor.bound_kernels import load_kernels
from engine.taylor.source.recurrence import REACH, TOLERANCE

_GLIDE_STEP = 1.0 / 3.0


def kernels_of(potential: Potential) -> ModuleType:
    """The kernels, as of `load_kernels`."""
    return load_kernels(potential.terms, potential.channels, REACH * potential.length)


def step_tolerance(potential: Potential, tolerance: float = TOLERANCE) -> float:
    """What a step's last terms may come to, a length, for one that is meant for wells of size 1."""
    return tolerance * potential.length


def fixed_step_size(potential: Potential) -> float:
    """Step in time of orbits side by side: at the order in use their energy is kept as well as with steps of free size."""
    return _GLIDE_STEP / max(1.0, potential.fastest_frequency)
