"""What the layer and the studies of periodic orbits have in common: the searches, and the colours of stability."""

from __future__ import annotations

from engine import MapSpec, Stability, find_periodic_orbits, find_symmetric_families
from engine.jobs.job import Job
from engine.results import PeriodicOrbits, SymmetricFamilies

RETURNS = 3
"""Largest number of returns in a period that the page searches for."""

# Columns and rows of the grid of starts.
_STARTS = (30, 30)

STABILITY_COLOURS = {Stability.STABLE: "#0f8a72", Stability.UNSTABLE: "#d4551f", Stability.REFLECTING: "#8a56c9"}
"""Colours of periodic orbits by their stability."""

SPECIAL = "#b07d00"
"""Colour of special points of families of periodic orbits."""


def periodic_job(spec: MapSpec, returns: int = RETURNS) -> Job[PeriodicOrbits]:
    """Return the job that finds the periodic orbits on the slice of a map, with its own grid."""
    starts = MapSpec(spec.potential, spec.plane, spec.energy, _STARTS, spec.given_window, spec.t_max, section=spec.section)
    return Job(find_periodic_orbits, (starts,), (("returns", returns),))


def families_job(spec: MapSpec, returns: int = RETURNS) -> Job[SymmetricFamilies]:
    """Return the job that finds the families of periodic orbits on a slice along h.

    Its grid is that of a map of default resolution, with the same energies, whose exits are then known.
    """
    starts = MapSpec(spec.potential, spec.plane, spec.energy, window=spec.given_window, t_max=spec.t_max, section=spec.section)
    return Job(find_symmetric_families, (starts,), (("returns", returns),))
