"""The periodic orbit near a start: Newton's method from the returns of the start."""

from __future__ import annotations

from typing import Any

import numpy as np

from engine.exits.exit_rows import absent_exits
from engine.foundations.validation import checked_count, checked_state, checks_types
from engine.foundations.wording import format_count
from engine.integrator.kernels.dense_output import advance_states, trace_steps
from engine.periodic.closed_orbits import primitive_returns, with_all_returns
from engine.periodic.family_parameter import EnergyParameter
from engine.periodic.periodic_orbit import PeriodicOrbit
from engine.periodic.shooting import Trial, close_orbit, crosses_section, divided
from engine.propagation.passages import find_passages_of_orbit
from engine.slices.sections.section import Section
from engine.slices.sections.section_text import checked_section
from engine.systems.potential import Potential

MOST_RETURNS = 100
"""Largest number of returns of a periodic orbit."""

# Longest time before the start at which its orbit begins, in units of the well.
_BEFORE = 1e-3
# Largest number of returns of the orbits among which the nearest is chosen.
_CHOSEN_RETURNS = 6


class NoPeriodicOrbitError(RuntimeError):
    """No periodic orbit was found near a start."""


@checks_types(potential=Potential)
def find_periodic_orbit(
    potential: Potential,
    state: Any,
    returns: int | None = None,
    t_max: float | None = None,
    *,
    section: Section | str = Section.Y_UP,
) -> PeriodicOrbit:
    """Find the periodic orbit near a start, at the energy of the start, by Newton's method with multiple shooting.

    Parameters
    ----------
    potential
        The potential.
    state
        (4,) x, y, px, py, finite: for instance a point of an island on the section, or any point of an orbit.
    returns
        Number of returns to the section after which the orbit of the start comes near to it, 1 to 100; None for the nearest of
        the orbits that are found for 1 to 6. The periodic orbit can have another number of returns, for instance a divisor.
    t_max
        Longest time of the returns, 0 < t_max ≤ 1e8, dimensionless; by default as in `MapSpec`.
    section
        The surface of section: a `Section` or text, see `read_section`.

    Returns
    -------
    The `PeriodicOrbit`, which closes to 1e-10 in units of the well.

    Raises
    ------
    NoPeriodicOrbitError
        If none is found. The message says why.
    ValueError
        If a parameter is out of range, or `section` is not legal.

    Examples
    --------
    >>> from escape_explorer import CASES, find_periodic_orbit
    >>> orbit = find_periodic_orbit(CASES["III"], [0.0, 0.0, 0.05, 0.77], returns=1)
    >>> orbit.describe()
    'Periodic orbit, stable, T = 6.28319, a = −0.323683, 1 return to y = 0.'
    """
    start, section = checked_state("state", state), checked_section(section)
    t_max = potential.checked_t_max(t_max)
    numbers = range(1, _CHOSEN_RETURNS + 1) if returns is None else [checked_count("returns", returns, 1, MOST_RETURNS)]
    orbits = [orbit for n in numbers if (orbit := close_near(potential, section, start, n, t_max)) is not None]
    if not orbits:
        raise NoPeriodicOrbitError(_reason(potential, section, start, numbers[0], t_max))
    first = first_point(potential, section, start, t_max)
    assert first is not None
    orbit = min(orbits, key=lambda each: _distance(potential, section, each, first))
    return PeriodicOrbit.from_trial(potential, section, orbit)


def close_near(potential: Potential, section: Section, start: np.ndarray, returns: int, t_max: float) -> Trial | None:
    """Return the closed orbit near a start, (4,), in units of the well; None if it is not found.

    Start, section and t_max are in the units of the potential. The orbit found can have another number of returns.
    """
    units, well, well_section = potential.units, potential.in_well_units, section.in_well_units(potential.units)
    passages = _returns_of(potential, section, start, returns + 1, t_max)
    if len(passages) <= returns:
        return None
    # The start need not be on the section: the orbit is closed from its first return.
    states, durations = passages[:-1, :4], np.diff(passages[:, 4])
    trial = divided(well, Trial(states, durations, float(potential.energy(start)) / units.energy, (1,) * returns))
    parameter = EnergyParameter(potential, section)
    closed = close_orbit(parameter, trial)
    if closed is None or not crosses_section(well, well_section, closed[0]):
        return None
    # Newton's method can lead to an orbit with further returns, or with fewer.
    orbit = with_all_returns(well, well_section, closed[0])
    orbit = orbit.shortened(primitive_returns(orbit))
    if orbit.durations.size != returns:
        closed = close_orbit(parameter, divided(well, orbit))
    return None if closed is None else closed[0]


def _returns_of(potential: Potential, section: Section, start: np.ndarray, count: int, t_max: float) -> np.ndarray:
    """Return the first points of an orbit on a section, (n, 5), in units of the well, with the start if it is on the section."""
    units, well = potential.units, potential.in_well_units
    kernels, state, numbers = well.well.kernels, start / units.state, section.in_well_units(units).numbers
    # The kernel does not count a start on the section, so the orbit begins shortly before, at most a step of the integrator.
    times = trace_steps(kernels, state, _BEFORE, len(well.outcomes))[1:2, 4]
    before = float(times[0]) if times.size else _BEFORE
    earlier = advance_states(kernels, state[None], np.array([-before]))[0]
    # An orbit may leave through an exit over a saddle and return, but it ends at a body or an escape radius.
    return find_passages_of_orbit(well, earlier, count, t_max / units.time + before, numbers, absent_exits(well))


def first_point(potential: Potential, section: Section, start: np.ndarray, t_max: float) -> np.ndarray | None:
    """Return the first point of an orbit on a section, (4,), in units of the well; None if it does not reach the section."""
    points = _returns_of(potential, section, start, 1, t_max)
    return points[0, :4] if len(points) else None


def _distance(potential: Potential, section: Section, orbit: Trial, point: np.ndarray) -> float:
    """Return the distance of a point from the nearest return of an orbit, in the coordinates of the section."""
    axes = section.in_well_units(potential.units).axes
    return float(np.hypot(*(axes.points(orbit.states[orbit.returns]) - axes.points(point)).T).min())


def _reason(potential: Potential, section: Section, start: np.ndarray, returns: int, t_max: float) -> str:
    """Return why no periodic orbit was found."""
    found = len(_returns_of(potential, section, start, returns + 1, t_max))
    if found <= returns:
        times = format_count(returns, "time")
        end = f"before it ends or t_max={t_max:g}"
        return f"no periodic orbit: the orbit of the start does not return {times} to {section.place} {end}"
    return "no periodic orbit: Newton's method does not converge from this start; choose a start nearer to the orbit"
