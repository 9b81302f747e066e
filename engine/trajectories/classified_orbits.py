"""Outcomes of many orbits, given by their starts."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checked_number, checked_states, checks_types
from engine.propagation.classification import Outcomes, classify_in_well_units
from engine.slices.sections.section import Section
from engine.slices.sections.section_text import checked_section
from engine.systems.potential import Potential

ENERGY_TOLERANCE = 1e-9
"""Largest difference between energies that count as one, in units of the well."""


@shows_progress("orbits")
@checks_types(potential=Potential, execution=Execution)
def classify_orbits(
    potential: Potential,
    energy: float | None,
    states: Any,
    t_max: float | None = None,
    *,
    section: Section | str = Section.Y_UP,
    execution: Execution = DEFAULT_EXECUTION,
) -> Outcomes:
    """Compute fate, escape time and number of crossings of orbits.

    Parameters
    ----------
    potential
        The potential.
    energy
        h of all orbits, finite, at most 1e9 in magnitude, dimensionless; None for the energy of each start. Energies count as one
        if they are equal to within 1e-9 units of the well.
    states
        (n, 4) x, y, px, py, with the energy h to within 1e-9 units of the well. Starts with a momentum that is NaN, as
        `start_states` returns them, are forbidden.
    t_max
        Largest integration time, 0 < t_max ≤ 1e8, dimensionless; by default as in `MapSpec`.
    section
        The surface of section at which crossings are counted: a `Section` or text, see `read_section`.
    execution
        How the computation runs. When it is cancelled, orbits without a result stay `Fate.NOT_COMPUTED`.

    Returns
    -------
    The `Outcomes`; `to_pandas` and `to_xarray` have a row for each orbit.

    Raises
    ------
    ValueError
        If a state is not finite and not forbidden, or has another energy, a parameter is out of range, or `section` is not legal.

    Examples
    --------
    >>> import numpy as np
    >>> from escape_explorer import CASES, Plane, classify_orbits, start_states
    >>> states = start_states(CASES["I"], Plane.X_PX, 0.3, np.array([-0.3, 0.0, 0.3]), np.zeros(3))
    >>> outcomes = classify_orbits(CASES["I"], 0.3, states, t_max=100.0)
    >>> outcomes.fate.tolist(), outcomes.escape_time.round(2).tolist()
    ([1, 1, 1], [45.7, 2.03, 1.82])
    """
    states = checked_states("states", states, allow_forbidden=True)
    is_forbidden = np.isnan(states).any(axis=1)
    if energy is not None:
        checked_states_of_energy(potential, energy, states[~is_forbidden])
    t_max = potential.checked_t_max(t_max)
    units, section = potential.units, checked_section(section)
    energies = np.full(len(states), np.nan) if energy is None else np.full(len(states), float(energy))
    if energy is None:
        energies[~is_forbidden] = _common_energies(potential, _own_energies(potential, states, is_forbidden)[~is_forbidden])
    outcomes = classify_in_well_units(
        potential.in_well_units, energies / units.energy, states / units.state, t_max / units.time, execution,
        section.in_well_units(units).numbers,
    )  # fmt: skip
    known = energies[np.isfinite(energies)]
    ends = (float(known.min()), float(known.max())) if known.size else (0.0, 0.0)
    common = ends[0] if ends[0] == ends[1] else ends
    made_by = potential.describe_run(energy=common, t_max=t_max, section=section.text)
    return replace(units.restore(outcomes), t_max=t_max, outcomes=potential.outcomes_at(common), made_by=made_by)


def _own_energies(potential: Potential, states: np.ndarray, is_forbidden: np.ndarray) -> np.ndarray:
    """Return the energy of each start; ValueError where it is infinite, as at the place of a body."""
    energies: np.ndarray = potential.energy(states)
    is_legal = np.isfinite(energies) | is_forbidden
    if not is_legal.all():
        row = int(np.argmin(is_legal))
        raise ValueError(f"states: row {row} has energy {float(energies[row])!r}; must have a finite energy")
    return energies


def _common_energies(potential: Potential, energies: np.ndarray) -> np.ndarray:
    """Return the energies with one value for those that agree up to `ENERGY_TOLERANCE`: the lowest of them."""
    values, position = np.unique(energies, return_inverse=True)
    begins_group = np.diff(values, prepend=-np.inf) > ENERGY_TOLERANCE * potential.units.energy
    lowest: np.ndarray = values[begins_group][np.cumsum(begins_group) - 1]
    return lowest[position]


def checked_states_of_energy(potential: Potential, energy: float, states: Any) -> np.ndarray:
    """Return the states as an array; ValueError unless all have the energy to within `ENERGY_TOLERANCE`."""
    energy = checked_number("energy", energy)
    array = checked_states("states", states)
    difference = np.abs(potential.energy(array) - energy)
    tolerance = ENERGY_TOLERANCE * potential.units.energy
    if np.any(difference > tolerance):
        row = int(np.argmax(difference))
        row_energy = float(potential.energy(array[row]))
        raise ValueError(f"states: row {row} has energy {row_energy!r}; must be energy={energy} to within {tolerance:.2g}")
    return array
