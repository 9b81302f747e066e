"""Functions for former public names whose parameters or results have changed, see `engine.foundations.former_names`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.exits.lyapunov_orbits import LyapunovOrbit
from engine.foundations.validation import checks_types
from engine.slices.axes import ParameterAxis
from engine.slices.slice import Slice
from engine.sweeps.measures import CURVES, QUICK_CURVES
from engine.sweeps.spec import SweepSpec
from engine.sweeps.sweep import compute_sweep
from engine.systems.potential import Potential
from engine.trajectories.trajectory import Orbit

if TYPE_CHECKING:
    import xarray as xr


def make_curves_spec(
    potential: Potential,
    plane: Slice,
    values: Sequence[float],
    resolution: tuple[int, int] = (112, 112),
    t_max: float | None = None,
    exponent: bool = True,
    along: ParameterAxis | None = None,
    energy: float | None = None,
    refine: int = 0,
) -> SweepSpec:
    """Make the request of a sweep from the parameters of the former `CurvesSpec`."""
    measures = CURVES if exponent else QUICK_CURVES
    return SweepSpec(
        potential, plane, values, resolution, t_max=t_max, measures=measures, along=along, energy=energy, refine=refine
    )


def run_sweep(spec: SweepSpec, store: Any, **options: Any) -> xr.Dataset:
    """Compute a sweep into a store, and return its dataset."""
    return compute_sweep(spec, store, **options).dataset


@checks_types(potential=Potential, orbit=LyapunovOrbit)
def find_multipliers(potential: Potential, orbit: LyapunovOrbit) -> np.ndarray:
    """Return the multipliers of an orbit; ValueError if the orbit belongs to another potential."""
    _check_same_motion(potential, orbit.potential)
    return orbit.find_multipliers()


@checks_types(potential=Potential, orbit=Orbit)
def find_section_crossings(potential: Potential, orbit: Orbit) -> np.ndarray:
    """Return the crossings of y = 0 of an orbit; ValueError if the orbit belongs to another potential."""
    if orbit.potential is not None:
        _check_same_motion(potential, orbit.potential)
    return replace(orbit, potential=potential).find_section_crossings()


def _check_same_motion(potential: Potential, orbit_potential: Potential) -> None:
    if (potential.form, potential.rotation) != (orbit_potential.form, orbit_potential.rotation):
        raise ValueError(f"potential={potential.name}: must be that of the orbit, {orbit_potential.name}")
