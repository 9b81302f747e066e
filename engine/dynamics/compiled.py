"""The compiled kernels of a potential and their step control.

Tolerances that are lengths are given in units of `Potential.length`, which is 1 for the three cases of Zotos (2014).
"""

from __future__ import annotations

from types import ModuleType

from engine.potentials.potential import Potential
from engine.taylor.bound_kernels import load_kernels
from engine.taylor.source.recurrence import REACH, TOLERANCE

# Step for a frequency of 1. At the order of the Taylor kernels it conserves energy as well as adaptive steps do.
_FIXED_STEP = 1.0 / 3.0


def kernels_of(potential: Potential) -> ModuleType:
    """The compiled kernels of a potential, from `load_kernels`."""
    return load_kernels(potential.terms, potential.channels, REACH * potential.length)


def step_tolerance(potential: Potential, tolerance: float = TOLERANCE) -> float:
    """The tolerance of a Taylor step for a well of this size; `tolerance` is the one for a well of size 1."""
    return tolerance * potential.length


def fixed_step_size(potential: Potential) -> float:
    """The time step of fixed-step integration, dimensionless."""
    return _FIXED_STEP / max(1.0, potential.fastest_frequency)
