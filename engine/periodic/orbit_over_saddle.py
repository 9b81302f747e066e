"""Lyapunov orbits as orbits that return to a section across their channel, from which their families are continued."""

from __future__ import annotations

import numpy as np

from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.exits.saddle_orbits.brake_orbits import saddle_axes
from engine.exits.saddle_orbits.merged_orbits import axes_between
from engine.periodic.closed_orbits import orbit_through, passages_of
from engine.periodic.family_parameter import EnergyParameter
from engine.periodic.nearest_orbit import NoPeriodicOrbitError
from engine.periodic.periodic_orbit import PeriodicOrbit
from engine.periodic.shooting import close_orbit, divided
from engine.slices.sections.linear_section import LinearSection

# Decimals of the coefficients of a section, without their rounding errors.
_DECIMALS = 12


def returns_of_lyapunov_orbit(orbit: LyapunovOrbit) -> PeriodicOrbit:
    """Return a Lyapunov orbit with its returns to the line through its saddle along the channel.

    Orbits of its family cross this line however small they are. An orbit over several saddles crosses the line in the middle
    between the outermost saddles.

    Raises
    ------
    NoPeriodicOrbitError
        If the orbit is too unstable to be closed by its returns.
    """
    potential, section = orbit.potential, _section_along_channel(orbit)
    well, units, nodes = potential.in_well_units, potential.units, orbit.nodes
    returns = passages_of(well, section.in_well_units(units), nodes)
    trial = orbit_through(returns, float(nodes.durations.sum()), orbit.energy / units.energy)
    closed = close_orbit(EnergyParameter(potential, section), divided(well, trial))
    if closed is None:
        raise NoPeriodicOrbitError(f"no periodic orbit: the Lyapunov orbit {orbit.name} is too unstable; choose another energy")
    return PeriodicOrbit.from_trial(potential, section, closed[0])


def _section_along_channel(orbit: LyapunovOrbit) -> LinearSection:
    """Return the line q = 0 in the axes of the channel, with a first coefficient above 0."""
    well, length = orbit.potential.in_well_units, orbit.potential.units.length
    axes = axes_between(well, (orbit.channel, *orbit.others)) if orbit.others else saddle_axes(well, orbit.channel)
    form = np.round([*axes.across, axes.across @ axes.origin], _DECIMALS)
    x, y, value = (form * np.sign(form[np.flatnonzero(form)[0]])).tolist()
    return LinearSection(x=x, y=y, value=value * length)
