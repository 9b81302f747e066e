"""Continue a periodic orbit to the family to which it belongs."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from types import NoneType
from typing import Any

import numpy as np

from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checked_count, checked_number, checks_types, short_repr
from engine.foundations.wording import format_number
from engine.periodic.families.branch import Branch, Entry
from engine.periodic.families.family import COLUMNS, OrbitFamily, SpecialPoint
from engine.periodic.family_parameter import ENERGY, parameter_of_family
from engine.periodic.orbit_over_saddle import returns_of_lyapunov_orbit
from engine.periodic.periodic_orbit import PeriodicOrbit

MOST_MEMBERS = 10_000
"""Largest number of members of a family."""

# Growth of a family from one frame to the next. Each frame has all members.
_GROWTH = 1.1


@shows_progress("family")
@checks_types(
    orbit=(PeriodicOrbit, LyapunovOrbit, OrbitFamily),
    along=(str, NoneType),
    execution=Execution,
    on_frame=(Callable, NoneType),
)
def continue_family(
    orbit: PeriodicOrbit | LyapunovOrbit | OrbitFamily,
    until: Any,
    *,
    along: str | None = None,
    most_members: int = 1000,
    execution: Execution = DEFAULT_EXECUTION,
    on_frame: Callable[[OrbitFamily], None] | None = None,
) -> OrbitFamily:
    """Continue a periodic orbit in its energy, or in a parameter of its system, to the family to which it belongs.

    Parameters
    ----------
    orbit
        The `PeriodicOrbit`; or a `LyapunovOrbit`, whose returns to the line through its saddle along the channel are followed; or
        an `OrbitFamily`, for instance a cancelled one, which goes on from its ends.
    until
        An energy above or below that of the orbit, dimensionless: the family is followed in this direction, while its energy is
        between both. Or a pair (low, high): it is followed in both directions, while its energy is between these. Along a
        parameter of the system, values of this parameter. A family goes on from its last member if `until` is above this member,
        from its first one if `until` is below it, and from both for a pair around all its values.
    along
        What changes along the family: the energy, "h", or the name of a parameter of the system, at the energy of the orbit. None
        for the energy, or for that along which a given family was continued.
    most_members
        Largest number of members found in each direction, 2 to 10 000, without special points.
    execution
        How the computation runs. When it is cancelled, the family ends at the last member found.
    on_frame
        Called with the family so far, each time that it has grown by a tenth.

    Returns
    -------
    The `OrbitFamily`, from the side of lower energies, or values of the parameter, to that of higher ones, through folds. Each
    member closes to 1e-10 in units of the well, and special points are located to about 1e-12 in energy. The returns of `orbit`
    are followed; if further crossings of the section appear along the family, they are not counted. A family that goes on is
    returned as a whole.

    Raises
    ------
    NoPeriodicOrbitError
        If a Lyapunov orbit is too unstable to be closed by its returns.
    ValueError
        If `until` is not finite, not legal or not beyond the values of the orbit or of the family, the system of the potential
        has no parameter `along`, a given family was continued along another one, or `most_members` is out of range.

    Notes
    -----
    Pseudo-arclength continuation: Keller 1977, in Applications of Bifurcation Theory, 359. The energy, or the parameter, is an
    unknown of the equations, so families are followed through folds.

    Examples
    --------
    >>> from escape_explorer import CASES, continue_family, find_periodic_orbit
    >>> orbit = find_periodic_orbit(CASES["III"], [0.0, 0.0, 0.0, 0.4**0.5], returns=1)
    >>> family = continue_family(orbit, until=0.5)
    >>> family = continue_family(family, until=0.6)
    >>> [(point.name, round(point.energy, 9)) for point in family.special if point.kind != "resonance"]
    [('touching', 0.435576877), ('branching', 0.581679744)]
    >>> family = continue_family(orbit, until=3.0, along="epsilon")
    >>> [(point.name, round(point.value, 9)) for point in family.special if point.kind != "resonance"]
    [('touching', 2.177884386), ('branching', 2.908398718)]
    """
    family = _family_of(orbit, along)
    bounds, sides = _checked_bounds(until, family)
    parameter = parameter_of_family(family.potential, family.section, family.along, bounds, float(family.energy[0]))
    most_members = checked_count("most_members", most_members, 2, MOST_MEMBERS)
    branches = {rising: Branch(parameter, family, bounds, most_members, rising=rising) for rising in sides}
    shown = 0
    for number, branch in enumerate(branches.values()):
        for _ in branch.grow(execution.part(number, len(branches))):
            members = len(family) + sum(len(each.entries) - 1 for each in branches.values())
            if on_frame is not None and members >= _GROWTH * shown:
                on_frame(_joined(family, branches, complete=False))
                shown = members
    return _joined(family, branches, complete=not execution.is_cancelled)


def _family_of(orbit: PeriodicOrbit | LyapunovOrbit | OrbitFamily, along: str | None) -> OrbitFamily:
    """Return a family, or the family with an orbit as its only member; ValueError if it cannot be continued along a parameter."""
    if isinstance(orbit, OrbitFamily):
        if along not in (None, orbit.along):
            raise ValueError(f"along={short_repr(along)}: the family was continued along {orbit.along}")
        return orbit
    if isinstance(orbit, LyapunovOrbit):
        orbit = returns_of_lyapunov_orbit(orbit)
    along = ENERGY if along is None else along
    columns: dict[str, Any] = {
        name: read_only(np.array(rows)) for name, rows in _rows([Entry(orbit, _value_of(orbit, along), [])]).items()
    }
    ends = ("it was continued from this orbit",) * 2
    return OrbitFamily(**columns, ends=ends, along=along, section=orbit.section, potential=orbit.potential)


def _value_of(orbit: PeriodicOrbit, along: str) -> float:
    """Return the energy of an orbit, or the value of a parameter of its system; ValueError if the system does not have it."""
    system = orbit.potential.system
    names = () if system is None else system.parameter_names
    if along == ENERGY:
        return orbit.energy
    if system is None or along not in names:
        known = "" if system else f"; the parameters of {orbit.potential.name} are not known, as they are for System(…).potential"
        raise ValueError(f"along={short_repr(along)}: must be one of {', '.join([ENERGY, *names])}{known}")
    return system.value_of(along)


def _checked_bounds(until: Any, family: OrbitFamily) -> tuple[tuple[float, float], list[bool]]:
    """Return the lowest and the highest value of a family that goes on, and on which sides it does: False below, True above."""
    given = np.asarray(until, dtype=object).ravel()
    if given.size not in (1, 2):
        raise ValueError(f"until={until!r}: must be a value of {family.along} or a pair of values")
    bounds = [checked_number("until", bound) for bound in given]
    low, high = min(bounds[0], family.value.min()), max(bounds[-1], family.value.max())
    goes_on = (bounds[0] < family.value[0], bounds[0] > family.value[-1])
    if len(bounds) == 2:
        goes_on = (bounds == [low, high] and low < high,) * 2
    if not any(goes_on):
        first, last = (format_number(float(family.value[k]), 8) for k in (0, -1))
        raise ValueError(
            f"until={until!r}: must be a value of {family.along} below {first} or above {last}, or (low, high) around all values"
        )
    return (float(low), float(high)), [side for side in (False, True) if goes_on[side]]


def _joined(family: OrbitFamily, branches: Mapping[bool, Branch], *, complete: bool) -> OrbitFamily:
    """Return a family with the branches below and above its ends, by whether they are above."""
    below, above = (branches[side].entries if side in branches else [] for side in (False, True))
    # The first entry of a branch is the end of the family.
    before, after = below[:0:-1], above[1:]
    earlier, later = _rows(before), _rows(after)
    columns: dict[str, Any] = {
        name: read_only(np.array([*earlier[name], *getattr(family, name), *later[name]])) for name in earlier
    }
    special = [
        *_special_points(below, len(before), -1),
        *(replace(point, member=point.member + len(before)) for point in family.special),
        *_special_points(above, len(before) + len(family) - 1, 1),
    ]
    ends = (branches[side].end if side in branches else family.ends[side] for side in (False, True))
    special.sort(key=lambda point: point.member)
    return replace(family, **columns, special=tuple(special), ends=tuple(ends), complete=complete)


def _rows(entries: Sequence[Entry]) -> dict[str, list[Any]]:
    """Return the values of each column of a family at some members."""
    columns = {name: [getattr(entry.orbit, name) for entry in entries] for name in COLUMNS}
    return {"value": [entry.value for entry in entries], **columns}


def _special_points(entries: Sequence[Entry], first: int, step: int) -> Iterator[SpecialPoint]:
    """Yield the special points of entries, with the number of the first member and the step to the next one."""
    for member, (orbit, value, special) in zip(itertools.count(first, step), entries):
        for located in special:
            yield SpecialPoint(
                located.kind, member, value, orbit.energy, orbit.period, *located.resonance, converged=located.converged
            )
