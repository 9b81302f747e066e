"""The compiled kernels of a potential in units of its well (`Potential.in_well_units`), and their fixed step."""

from __future__ import annotations

from types import ModuleType

from engine.integrator.bound_kernels import load_kernels
from engine.systems.potential import Potential

# Time step for a frequency of 1. At the order of the Taylor kernels, energy is conserved as well as by adaptive steps.
_FIXED_STEP = 1.0 / 3.0


def kernels_of(potential: Potential) -> ModuleType:
    """Return the compiled kernels of a potential in units of its well, from `load_kernels`."""
    channels, sides, _ = potential.well.setting
    return load_kernels(potential.form.definition, channels, sides=sides, rotation=potential.rotation)


def fixed_step_size(potential: Potential) -> float:
    """Return the time step of fixed-step integration, dimensionless."""
    return _FIXED_STEP / max(1.0, potential.well.fastest_frequency)
