"""Generated functions as kernels, for machines that cannot call them otherwise."""

from __future__ import annotations

from engine.integrator.jit.decorator import kernel
from engine.integrator.jit.function_pointers import call_jets, call_potential_value


@kernel
def potential_at(potential_value, coefficients, x, y):
    """V at one point."""
    return call_potential_value(potential_value, coefficients, x, y)


@kernel
def compute_series(jets, coefficients, start, series):
    """Set `series` (2, ORDER + 1, n) to those of x and y of the steps that begin at `start` (4, n); n is even."""
    call_jets(jets, coefficients, start.shape[1], start[0], start[1], start[2], start[3], series[0], series[1])
