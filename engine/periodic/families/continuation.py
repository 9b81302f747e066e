"""Continue a periodic orbit to the family to which it belongs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checked_count, checked_number, checks_types, short_repr
from engine.foundations.wording import format_number
from engine.periodic.closed_orbits import half_symmetry
from engine.periodic.families.family import NUMBERS, OrbitFamily, SpecialPoint
from engine.periodic.families.following import Member, Segment, first_member, follow_family
from engine.periodic.families.special_points import Located, find_special_points, numbers_of
from engine.periodic.family_parameter import ENERGY, FamilyParameter, parameter_of_family
from engine.periodic.orbit_over_saddle import returns_of_lyapunov_orbit
from engine.periodic.periodic_orbit import PeriodicOrbit
from engine.periodic.shooting import Trial, close_orbit
from engine.systems.potential import Potential

MOST_MEMBERS = 10_000
"""Largest number of members of a family."""

# Largest distance of neighbouring members in the space of states, times and the parameter.
_LONGEST_STEP = 0.05
# Sizes of the path of an orbit near an equilibrium, and speed and force near a saddle, in units of the well.
_SMALL_ORBIT, _SLOW = 0.02, 0.02
# Change of the parameter between members that no longer counts, and speed and force of orbits so near an equilibrium.
_SMALLEST_CHANGE, _SLOWEST = 1e-9, 1e-3
# Points of the path on which the end of a family is judged.
_PATH_POINTS = 2000
_HOMOCLINIC = "the period grows without limit, because the orbits tend to an equilibrium"
# Members after which a family can close.
_FEWEST_MEMBERS = 10
# Growth of a family from one frame to the next. Each frame has all members.
_GROWTH = 1.1


@shows_progress("family")
@checks_types(orbit=(PeriodicOrbit, LyapunovOrbit), along=str, execution=Execution)
def continue_family(
    orbit: PeriodicOrbit | LyapunovOrbit,
    until: Any,
    *,
    along: str = ENERGY,
    most_members: int = 1000,
    execution: Execution = DEFAULT_EXECUTION,
    on_frame: Callable[[OrbitFamily], None] | None = None,
) -> OrbitFamily:
    """Continue a periodic orbit in its energy, or in a parameter of its system, to the family to which it belongs.

    Parameters
    ----------
    orbit
        The `PeriodicOrbit`, or a `LyapunovOrbit`, whose returns to the line through its saddle along the channel are followed.
    until
        An energy above or below that of the orbit, dimensionless: the family is followed in this direction, while its energy is
        between both. Or a pair (low, high): it is followed in both directions, while its energy is between these. Along a
        parameter of the system, values of this parameter.
    along
        What changes along the family: the energy, "h", or the name of a parameter of the system, at the energy of the orbit.
    most_members
        Largest number of members in each direction, 2 to 10 000, without special points.
    execution
        How the computation runs. When it is cancelled, the family ends at the last member found.
    on_frame
        Called with the family so far, each time that it has grown by a tenth.

    Returns
    -------
    The `OrbitFamily`, from the side of lower energies, or values of the parameter, to that of higher ones, through folds. Each
    member closes to 1e-10 in units of the well, and special points are located to about 1e-12 in energy. The returns of `orbit`
    are followed; if further crossings of the section appear along the family, they are not counted.

    Raises
    ------
    NoPeriodicOrbitError
        If a Lyapunov orbit is too unstable to be closed by its returns.
    ValueError
        If `until` is not finite, not legal or not beyond the value of the orbit, the system of the potential has no parameter
        `along`, or `most_members` is out of range.

    Notes
    -----
    Pseudo-arclength continuation: Keller 1977, in Applications of Bifurcation Theory, 359. The energy, or the parameter, is an
    unknown of the equations, so families are followed through folds.

    Examples
    --------
    >>> from escape_explorer import CASES, continue_family, find_periodic_orbit
    >>> orbit = find_periodic_orbit(CASES["III"], [0.0, 0.0, 0.0, 0.4**0.5], returns=1)
    >>> family = continue_family(orbit, until=0.6)
    >>> [(point.name, round(point.energy, 9)) for point in family.special if point.kind != "resonance"]
    [('touching', 0.435576877), ('branching', 0.581679744)]
    >>> family = continue_family(orbit, until=3.0, along="epsilon")
    >>> [(point.name, round(point.value, 9)) for point in family.special if point.kind != "resonance"]
    [('touching', 2.177884386), ('branching', 2.908398718)]
    """
    if isinstance(orbit, LyapunovOrbit):
        orbit = returns_of_lyapunov_orbit(orbit)
    value = _value_of(orbit, along)
    bounds = _checked_bounds(until, along, value)
    parameter = parameter_of_family(orbit.potential, orbit.section, along, bounds, orbit.energy)
    most_members = checked_count("most_members", most_members, 2, MOST_MEMBERS)
    start = _Entry(orbit, value, [])
    branches = [
        _Branch(parameter, start, bounds, most_members, rising=rising)
        for rising, bound in zip((False, True), bounds, strict=True)
        if bound != value
    ]
    shown = 0
    for number, branch in enumerate(branches):
        for _ in branch.grow(execution.part(number, len(branches))):
            members = sum(len(each.entries) for each in branches)
            if on_frame is not None and members >= _GROWTH * shown:
                on_frame(_joined(start, branches, along, complete=False))
                shown = members
    return _joined(start, branches, along, complete=not execution.is_cancelled)


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


def _checked_bounds(until: Any, along: str, value: float) -> tuple[float, float]:
    """Return the lowest and the highest value of a family; one of them is that of the orbit if `until` is one value."""
    given = np.asarray(until, dtype=object).ravel()
    if given.size not in (1, 2):
        raise ValueError(f"until={until!r}: must be a value of {along} or a pair of values")
    bounds = [checked_number("until", bound) for bound in given]
    low, high = sorted([bounds[0], value]) if len(bounds) == 1 else bounds
    if not (low <= value <= high and low < high):
        own = format_number(value, 8)
        raise ValueError(
            f"until={until!r}: must be another value of {along} than that of the orbit, {own}, or (low, high) around it"
        )
    return low, high


class _Entry(NamedTuple):
    """A member of a family, the value of its parameter, and the special points that are located at it, or after it."""

    orbit: PeriodicOrbit
    value: float
    special: list[Located]


class _Branch:
    """The members of a family on one side of an orbit, found in units of the well and of the parameter."""

    def __init__(
        self, parameter: FamilyParameter, start: _Entry, bounds: tuple[float, float], most_members: int, *, rising: bool
    ) -> None:
        self._parameter, self._most = parameter, most_members
        self._bounds = bounds[0] / parameter.unit, bounds[1] / parameter.unit
        self.rising, self.entries = rising, [start._replace(special=[])]
        self.end = "the search has not ended"

    def grow(self, execution: Execution) -> Iterator[None]:
        """Find the members one after the other, and yield after each."""
        parameter = self._parameter
        trial = self.entries[0].orbit.trial._replace(value=self.entries[0].value / parameter.unit)
        symmetry = half_symmetry(parameter.at(trial.value).potential, trial, parameter.symmetries_at(trial.value))
        first = first_member(parameter, trial, rising=self.rising)
        if first is None:
            self.end = "the orbit cannot be integrated"
            return
        numbers, last = numbers_of(parameter, symmetry, first), first
        for count, whole in enumerate(follow_family(parameter, first, _LONGEST_STEP), 2):
            segment, is_last = self._limited(whole)
            last = segment.after
            before, numbers = numbers, numbers_of(parameter, symmetry, last)
            ends = before._replace(slope=float(segment.before.direction[-1])), numbers
            self._add(find_special_points(parameter, segment, symmetry, ends), last)
            execution.report(partial(self._share, count))
            yield
            if is_last or self._has_ended(first, segment, count, execution):
                return
        self.end = _reason(parameter, last)

    def _add(self, special: list[Located], member: Member) -> None:
        """Add the special points of a segment, and its last member."""
        for located in special:
            if located.converged:
                self.entries.append(self._restored(located.member)._replace(special=[located]))
            else:
                self.entries[-1].special.append(located)
        self.entries.append(self._restored(member))

    def _restored(self, member: Member) -> _Entry:
        """Return a member in the units of the potential and of the parameter."""
        parameter, value = self._parameter, member.orbit.value
        orbit = member.orbit._replace(value=parameter.energy_at(value))
        restored = PeriodicOrbit.from_trial(parameter.potential_at(value), parameter.section, orbit, member.stability_index)
        return _Entry(restored, value * parameter.unit, [])

    def _share(self, count: int) -> float:
        """Return the share of the range that is done, or of the members, whichever is larger."""
        first, last = (self.entries[k].value / self._parameter.unit for k in (0, -1))
        return min(max((last - first) / (self._bounds[self.rising] - first), count / self._most, 0.0), 1.0)

    def _limited(self, segment: Segment) -> tuple[Segment, bool]:
        """Return a segment within the range of the parameter, and whether it is the last one."""
        (begin, end), noun = segment, self._parameter.noun
        if self._bounds[0] < end.orbit.value < self._bounds[1]:
            return segment, False
        bound = float(np.clip(end.orbit.value, *self._bounds))
        is_asked_for = bound != self._bounds[not self.rising]
        self.end = f"the {noun} asked for is reached" if is_asked_for else f"it turns back to the lowest or highest {noun}"
        if bound == end.orbit.value:
            return segment, True
        share = (bound - begin.orbit.value) / (end.orbit.value - begin.orbit.value)
        guess = begin.orbit.moved(begin.orbit.vector + share * (end.orbit.vector - begin.orbit.vector))
        closed = close_orbit(self._parameter, guess._replace(value=bound))
        if closed is None:
            self.end = f"its member at the last {noun} is not found"
            return segment, True
        return Segment(begin, Member.of(self._parameter, *closed, end.direction)), True

    def _has_ended(self, first: Member, segment: Segment, count: int, execution: Execution) -> bool:
        """Return whether no further member is wanted, and keep the reason."""
        if execution.is_cancelled:
            self.end = "the search was cancelled"
        elif count == self._most:
            self.end = "the largest number of members is reached"
        elif self._has_stopped(segment):
            self.end = _reason(self._parameter, segment.after)
        elif count > _FEWEST_MEMBERS and _is_closed(first.orbit, segment):
            self.end = "it is closed and returns to its first member"
        else:
            return False
        return True

    def _has_stopped(self, segment: Segment) -> bool:
        """Return whether the parameter hardly changes any more, because the orbits tend to an equilibrium."""
        change, orbit = abs(segment.after.orbit.value - segment.before.orbit.value), segment.after.orbit
        return change < _SMALLEST_CHANGE and _slowness(self._parameter.at(orbit.value).potential, orbit) < _SLOWEST


def _is_closed(first: Trial, segment: Segment) -> bool:
    """Return whether a segment ends nearer to an orbit than its length."""
    begin, end = segment.before.orbit, segment.after.orbit
    length = float(np.linalg.norm(end.vector - begin.vector))
    steps = end.states[end.returns] - first.states[first.returns], end.durations - first.durations, end.value - first.value
    return all(bool(np.abs(step).max() < length) for step in steps)


def _reason(parameter: FamilyParameter, member: Member) -> str:
    """Return why no further member is found after a member."""
    potential = parameter.at(member.orbit.value).potential
    x, y = member.orbit.nodes.sampled_path(potential, _PATH_POINTS)[1:3]
    if max(np.ptp(x), np.ptp(y)) < _SMALL_ORBIT:
        return "the orbits shrink to an equilibrium"
    if any(np.hypot(x - centre.x, y - centre.y).min() < 2.0 * centre.radius for centre in potential.centres):
        return "the orbits collide with a body"
    if _slowness(potential, member.orbit) < _SLOW:
        return _HOMOCLINIC
    return "no further member is found: the returns to the section change, or the orbits are too unstable"


def _slowness(potential: Potential, orbit: Trial) -> float:
    """Return the smallest sum of speed and force along an orbit, which is 0 at an equilibrium."""
    x, y, vx, vy = orbit.nodes.sampled_path(potential, _PATH_POINTS)[1:]
    return float(np.hypot(np.hypot(vx, vy), np.hypot(*potential.gradient(x, y))).min())


def _joined(start: _Entry, branches: list[_Branch], along: str, *, complete: bool) -> OrbitFamily:
    """Return the family of branches on one or both sides of an orbit, from its lower to its higher end."""
    entries = [start._replace(special=[located for branch in branches for located in branch.entries[0].special])]
    ends = ["it was continued from this orbit"] * 2
    for branch in branches:
        ends[branch.rising] = branch.end
        # The first entry of a branch is the orbit itself.
        entries = [*entries, *branch.entries[1:]] if branch.rising else [*branch.entries[:0:-1], *entries]
    special = [_special_point(k, entry, located) for k, entry in enumerate(entries) for located in entry.special]
    columns = (np.array([getattr(entry.orbit, name) for entry in entries]) for name in NUMBERS)
    energy, period, stability_index, action = map(read_only, columns)
    states, time = (read_only(np.array([getattr(entry.orbit, name) for entry in entries])) for name in ("states", "time"))
    value = read_only(np.array([entry.value for entry in entries]))
    return OrbitFamily(
        value, energy, period, stability_index, action, states, time, tuple(special), (ends[0], ends[1]), complete, along,
        section=start.orbit.section, potential=start.orbit.potential,
    )  # fmt: skip


def _special_point(member: int, entry: _Entry, located: Located) -> SpecialPoint:
    orbit = entry.orbit
    return SpecialPoint(
        located.kind, member, entry.value, orbit.energy, orbit.period, *located.resonance, converged=located.converged
    )
