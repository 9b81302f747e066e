"""States of many orbits at chosen times, in one result."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.exits.exit_rows import exit_curves
from engine.foundations.execution import DEFAULT_EXECUTION, SERIAL_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checked_array, checked_states, checks_types, short_repr
from engine.integrator.kernels.dense_output import sample_path
from engine.integrator.source.section_numbers import SectionNumbers
from engine.propagation.classification import Outcomes, record_orbit
from engine.propagation.fates import Fate, OrbitResult
from engine.slices.sections.section import Section
from engine.slices.sections.section_text import checked_section
from engine.systems.outcomes import Outcome
from engine.systems.potential import Potential
from engine.systems.well_units import ENERGY, LENGTH, MOMENTUM, TIME
from engine.trajectories.trajectory import MAX_ORBIT_TIME

if TYPE_CHECKING:
    import xarray as xr

# Number of components of a state.
_COMPONENTS = 4


@dataclass(frozen=True, eq=False, repr=False)
class SampledOrbits(OrbitResult):
    """The states of n orbits at m times each, dimensionless; arrays are read-only.

    Attributes
    ----------
    t
        (n, m) times.
    x, y, px, py
        (n, m) states at these times; NaN after the escape.
    fate, escape_time, crossings
        (n,) outcome of each orbit until its last time, as in `Outcomes`.
    energy
        (n,) h of each orbit.
    outcomes
        The outcomes of the potential, see `Potential.outcomes`; empty if they are not known.
    """

    t: np.ndarray = field(metadata=TIME)
    x: np.ndarray = field(metadata=LENGTH)
    y: np.ndarray = field(metadata=LENGTH)
    px: np.ndarray = field(metadata=MOMENTUM)
    py: np.ndarray = field(metadata=MOMENTUM)
    fate: np.ndarray
    escape_time: np.ndarray = field(metadata=TIME)
    crossings: np.ndarray
    energy: np.ndarray = field(metadata=ENERGY)
    outcomes: tuple[Outcome, ...] = field(default=(), repr=False)
    codes: ClassVar = {"fate": Fate}
    row_dimension: ClassVar = "orbit"
    held_as: ClassVar = OrbitResult.held_as | {name: name for name in ("t", "x", "y", "px", "py")}

    def columns(self) -> dict[str, np.ndarray]:
        """Return the outcome and the energy of each orbit."""
        return {name: getattr(self, name) for name in ("fate", "escape_time", "crossings", "energy")}

    def to_xarray(self) -> xr.Dataset:
        """Return all orbits with the dimensions (orbit, t), or (orbit, sample) if each orbit has its own times.

        The dataset can be written as NetCDF and Zarr.
        """
        attributes = {"units": "1"}
        times_are_common = bool((self.t == self.t[0]).all() and (np.diff(self.t[0]) > 0.0).all())
        times = ("t", self.t[0], attributes) if times_are_common else (("orbit", "sample"), self.t, attributes)
        dimensions = ("orbit", "t" if times_are_common else "sample")
        paths = {name: (dimensions, getattr(self, name), attributes) for name in ("x", "y", "px", "py")}
        return super().to_xarray().assign(paths).assign_coords(t=times)


@shows_progress("orbits")
@checks_types(potential=Potential, execution=Execution)
def sample_orbits(
    potential: Potential,
    states: Any,
    times: Any,
    *,
    section: Section | str = Section.Y_UP,
    execution: Execution = DEFAULT_EXECUTION,
) -> SampledOrbits:
    """Integrate many orbits, of any energies, and return their states at chosen times.

    The states are evaluated from the Taylor series of the steps, without interpolation; fates and escape times are those of
    `classify_orbits`.

    Parameters
    ----------
    potential
        The potential.
    states
        (n, 4) x, y, px, py at t = 0; finite, dimensionless.
    times
        (m,) times for all orbits, or (n, m) times of each orbit, dimensionless: ascending, at least 0 and at most 1e7, the last
        time above 0.
    section
        The surface of section at which crossings are counted: a `Section` or text, see `read_section`.
    execution
        How the computation runs.

    Returns
    -------
    The `SampledOrbits`.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    ValueError
        If there is no state, a state is not finite, the times are out of range or not ascending, or `section` is not legal.

    Examples
    --------
    >>> import numpy as np
    >>> from escape_explorer import CASES, sample_orbits, sample_starts
    >>> starts = sample_starts(CASES["III"], 0.45, 100, rng=1)
    >>> orbits = sample_orbits(CASES["III"], starts, np.linspace(0.0, 20.0, 5))
    >>> np.isfinite(orbits.x).sum(axis=0).tolist()
    [100, 41, 31, 28, 25]
    """
    states, times = checked_states("states", states), checked_array("times", times)
    if not len(states):
        raise ValueError("states: must be at least one state")
    times = _checked_times(times, len(states), potential)
    units, scaled_potential, section = potential.units, potential.in_well_units, checked_section(section)
    numbers = section.in_well_units(units).numbers
    # The kernels are compiled before the threads begin.
    _ = scaled_potential.well.kernels_of(numbers.form)
    futures = [
        execution.submit(_sample_orbit, scaled_potential, start / units.state, orbit_times / units.time, numbers)
        for start, orbit_times in zip(states, times, strict=True)
    ]
    results = []
    for index, future in enumerate(futures):
        if execution.is_cancelled:
            for pending in futures[index:]:
                pending.cancel()
        execution.raise_if_cancelled()
        results.append(execution.collect(future))
        execution.report(lambda index=index: (index + 1) / len(futures))  # type: ignore[misc]
    energies = potential.energy(states)
    outcomes = potential.outcomes_at((float(energies.min()), float(energies.max())))
    orbits = units.restore(_join_orbits(scaled_potential, states / units.state, times / units.time, results))
    made_by = potential.describe_run(t_max=float(times[:, -1].max()), section=section.text)
    return replace(orbits, outcomes=outcomes, made_by=made_by)


def _sample_orbit(
    potential: Potential, start: np.ndarray, times: np.ndarray, section: SectionNumbers
) -> tuple[np.ndarray, Outcomes]:
    """Return the states of one orbit at m times, of shape (4, m), and its outcome, in units of the well."""
    curves = exit_curves(potential, float(potential.energy(start)))
    orbit_steps = record_orbit(potential, start, curves, times[-1], SERIAL_EXECUTION, section)
    path = np.full((_COMPONENTS, times.size), np.nan)
    if len(orbit_steps.steps):
        count = int(np.searchsorted(times, orbit_steps.t_end, side="right"))
        path[:, :count] = sample_path(potential.well.kernels, orbit_steps.steps, times[:count])
    else:
        # An orbit that starts outside has a state at t = 0 only.
        path[:, times == 0.0] = start[:, None]
    return path, orbit_steps.outcomes


def _join_orbits(potential: Potential, states: np.ndarray, times: np.ndarray, results: list[Any]) -> SampledOrbits:
    """Join the paths and outcomes that `_sample_orbit` returned for all orbits, in units of the well."""
    paths = np.array([path for path, _ in results]).reshape(len(results), _COMPONENTS, times.shape[1])
    names = ("fate", "escape_time", "crossings")
    outcomes = (np.concatenate([getattr(outcome, name) for _, outcome in results]) for name in names)
    arrays = (times, *paths.transpose(1, 0, 2), *outcomes, np.atleast_1d(potential.energy(states)))
    fields: list[Any] = [np.ascontiguousarray(array) for array in arrays]
    return SampledOrbits(*fields)


def _checked_times(times: np.ndarray, count: int, potential: Potential) -> np.ndarray:
    """Return the times of each orbit, of shape (n, m); ValueError if they are not as `sample_orbits` takes them."""
    rows = np.array(np.broadcast_to(times, (count, times.size))) if times.ndim == 1 else times
    if not (rows.ndim == 2 and len(rows) == count and rows.size > 0):
        raise ValueError(f"times of shape {times.shape}: must be (m,) or ({count}, m)")
    if not ((rows[:, 0] >= 0.0).all() and (np.diff(rows) >= 0.0).all()):
        raise ValueError(f"times={short_repr(times.tolist())}: must be ascending from 0")
    for last in (rows[:, -1].min(), rows[:, -1].max()):
        potential.checked_t_max(float(last), MAX_ORBIT_TIME, name="times: the last one")
    return rows
