"""Kernels compiled ahead of time, or loaded from the kernel cache.

Numba compiles one function at a time, whatever the number of threads, so the order matters: first the kernels of the first frame
of a map, then the kernels that look for evidence, which a complete map needs, then all others. Compilation in the background
waits while kernels of maps are compiled.
"""

from __future__ import annotations

import threading
from collections.abc import Callable

import numpy as np

from engine.evidence.birkhoff_averages import count_agreeing_digits
from engine.evidence.invariant_curves import LEAST_POINTS, find_invariant_curve
from engine.exits.lyapunov_orbits import find_lyapunov_orbits
from engine.foundations.execution import DEFAULT_EXECUTION
from engine.integrator.bound_kernels import is_compiled
from engine.integrator.jit.code_outlines import find_outline
from engine.integrator.jit.compiled_operations import CompiledOperations, compiled_operations
from engine.maps.compute import compute_map
from engine.maps.spec import MapSpec
from engine.propagation.limited_steps import find_section_points
from engine.slices.planes import SECTION
from engine.systems.known_potentials import POTENTIALS
from engine.systems.potential import Potential

# Integration time, in units of the well, of the calls that trigger compilation.
_T_MAX = 10.0

# Execution of these calls: in the calling thread, because the threads of pools have low priority.
_EXECUTION = DEFAULT_EXECUTION.in_this_thread()

# Names of the kernels of the first frame of a map, and of its Lyapunov orbits without and with a rotation of the frame.
_MAP_KERNELS = ("step", "jets", "propagate")
_LYAPUNOV_KERNELS = {False: ("potential_value", "shoot"), True: ("tangent",)}


class Compilations:
    """Counts the running compilations of kernels for maps, for which other compilations wait."""

    def __init__(self) -> None:
        self._running_count = 0
        self._changed = threading.Condition()

    def run(self, *calls: Callable[[], object]) -> None:
        """Make calls that compile kernels for maps, one after the other."""
        self._count(1)
        try:
            for call in calls:
                call()
        finally:
            self._count(-1)

    def _count(self, change: int) -> None:
        with self._changed:
            self._running_count += change
            self._changed.notify_all()

    def wait(self) -> None:
        """Wait until no compilation for maps is running."""
        with self._changed:
            self._changed.wait_for(lambda: not self._running_count)


_map_compilations = Compilations()


def is_ready_for_maps(potential: Potential) -> bool:
    """Return whether the kernels for the first frame of a map of this potential are compiled."""
    lyapunov_kernels = _LYAPUNOV_KERNELS[potential.rotation != 0.0] if potential.escapes_over_saddles else ()
    return is_compiled(potential.in_well_units.well.structure, (*_MAP_KERNELS, *lyapunov_kernels))


def prepare_for_maps(potential: Potential) -> None:
    """Compile the kernels for the first frame of a map, or load them from the cache.

    Parameters
    ----------
    potential
        Any `Potential` with an exit. Compilation takes several seconds.
    """
    if is_ready_for_maps(potential):
        return
    energy = _open_energy(potential)
    _map_compilations.run(
        # The first use of the kernels generates their code, and the calls of a search and of a map compile it.
        lambda: potential.in_well_units.well.kernels,
        lambda: find_lyapunov_orbits(potential, energy),
        lambda: compute_map(small_map(potential, energy), execution=_EXECUTION),
    )


def prepare_for_evidence(potential: Potential) -> None:
    """Compile the kernels that look for evidence that orbits are bounded, or load them from the cache.

    Parameters
    ----------
    potential
        Any `Potential` with an exit.
    """
    if not potential.tori_are_evidence:
        return
    scaled_potential, start = potential.in_well_units, _start_state(potential) / potential.units.state
    call_after_maps(
        lambda: count_agreeing_digits(scaled_potential, start, _T_MAX, execution=_EXECUTION),
        lambda: find_section_points(scaled_potential, start, 1, _T_MAX, execution=_EXECUTION),
        lambda: find_invariant_curve(np.zeros((LEAST_POINTS, 2))),
    )


def reserve_catalogue(operations: CompiledOperations = compiled_operations) -> None:
    """Exempt the kernels of the catalogue from the limit on compiled code.

    Parameters
    ----------
    operations
        The count of compiled code; by default that of this process.
    """
    potentials = [potential.in_well_units for potential in POTENTIALS.values()]
    operations.reserve(find_outline(potential.well.structure).digest for potential in potentials)


def small_map(potential: Potential, energy: float) -> MapSpec:
    """Return the request of a map that takes little time once its kernels are compiled."""
    return MapSpec(potential, SECTION, energy, (2, 2), t_max=_T_MAX * potential.units.time)


def _open_energy(potential: Potential) -> float:
    """Return an energy at which orbits can escape: just above the escape energy, or any with an escape radius."""
    return potential.well.energy_at(1.01) if potential.escapes_over_saddles else potential.well.bottom + potential.units.energy


def _start_state(potential: Potential) -> np.ndarray:
    """Return a state of low energy in the middle of a well or, without a well, at the typical radius, of shape (1, 4)."""
    if potential.well.is_convex_at_origin and potential.escapes_over_saddles:
        return SECTION.states(potential, potential.well.energy_at(0.5), np.zeros(1), np.zeros(1))
    return SECTION.states(potential, _open_energy(potential), np.array([potential.well.typical_radius]), np.zeros(1))


def call_after_maps(*calls: Callable[[], object]) -> None:
    """Make calls that compile kernels one after the other, each at a time when no kernels for maps are compiled."""
    for call in calls:
        _map_compilations.wait()
        call()
