"""Continue a periodic orbit to the family to which it belongs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checked_count, checked_number, checks_types
from engine.foundations.wording import format_number
from engine.periodic.closed_orbits import half_symmetry, sampled_path
from engine.periodic.family import NUMBERS, OrbitFamily, SpecialPoint
from engine.periodic.following import Member, Segment, first_member, follow_family
from engine.periodic.periodic_orbit import PeriodicOrbit
from engine.periodic.shooting import Trial, close_orbit
from engine.periodic.special_points import Located, find_special_points, numbers_of
from engine.systems.potential import Potential

MOST_MEMBERS = 10_000
"""Largest number of members of a family."""

# Largest distance of neighbouring members in the space of states, times and the energy, in units of the well.
_LONGEST_STEP = 0.05
# Sizes of the path of an orbit near an equilibrium, and speed and force near a saddle, in units of the well.
_SMALL_ORBIT, _SLOW = 0.02, 0.02
# Change of the energy between members that no longer counts, and speed and force of orbits so near an equilibrium.
_SMALLEST_CHANGE, _SLOWEST = 1e-9, 1e-3
# Points of the path on which the end of a family is judged.
_PATH_POINTS = 2000
_HOMOCLINIC = "the period grows without limit, because the orbits tend to an equilibrium"
# Members after which a family can close.
_FEWEST_MEMBERS = 10


@shows_progress("family")
@checks_types(orbit=PeriodicOrbit, execution=Execution)
def continue_family(
    orbit: PeriodicOrbit,
    until: Any,
    *,
    most_members: int = 1000,
    execution: Execution = DEFAULT_EXECUTION,
    on_frame: Callable[[OrbitFamily], None] | None = None,
) -> OrbitFamily:
    """Continue a periodic orbit in its energy, through folds, to the family to which it belongs.

    Parameters
    ----------
    orbit
        The `PeriodicOrbit`.
    until
        An energy above or below that of the orbit, dimensionless: the family is followed in this direction, while its energy is
        between both. Or a pair (low, high): it is followed in both directions, while its energy is between these.
    most_members
        Largest number of members in each direction, 2 to 10 000, without special points.
    execution
        How the computation runs. When it is cancelled, the family ends at the last member found.
    on_frame
        Called with the family so far after each member.

    Returns
    -------
    The `OrbitFamily`, from the end of lower energy of `orbit` to that of higher energy. Each member closes to 1e-10 in units of
    the well, and special points are located to about 1e-12 in energy. The returns of `orbit` are followed; if further crossings
    of the section appear along the family, they are not counted.

    Raises
    ------
    ValueError
        If `until` is not finite or not beyond the energy of the orbit, or `most_members` is out of range.

    Notes
    -----
    Pseudo-arclength continuation: Keller 1977, in Applications of Bifurcation Theory, 359. The energy is an unknown of the
    equations, so families are followed through folds without an artificial parameter.

    Examples
    --------
    >>> from escape_explorer import CASES, continue_family, find_periodic_orbit
    >>> orbit = find_periodic_orbit(CASES["III"], [0.0, 0.0, 0.0, 0.4**0.5], returns=1)
    >>> family = continue_family(orbit, until=0.6)
    >>> [(point.name, round(point.energy, 9)) for point in family.special if point.kind != "resonance"]
    [('touching', 0.435576877), ('branching', 0.581679744)]
    """
    bounds = _checked_bounds(orbit, until)
    most_members = checked_count("most_members", most_members, 2, MOST_MEMBERS)
    directions = [rising for rising, bound in zip((False, True), bounds, strict=True) if bound != orbit.energy]
    branches = [_Branch(orbit, bounds, most_members, rising=rising) for rising in directions]
    for number, branch in enumerate(branches):
        for _ in branch.grow(execution.part(number, len(branches))):
            if on_frame is not None:
                on_frame(_joined(orbit, branches, complete=False))
    return _joined(orbit, branches, complete=not execution.is_cancelled)


def _checked_bounds(orbit: PeriodicOrbit, until: Any) -> tuple[float, float]:
    """Return the lowest and the highest energy of a family; one of them is that of the orbit if `until` is one energy."""
    given = np.asarray(until, dtype=object).ravel()
    if given.size not in (1, 2):
        raise ValueError(f"until={until!r}: must be an energy or a pair of energies")
    bounds = [checked_number("until", bound) for bound in given]
    low, high = sorted([bounds[0], orbit.energy]) if len(bounds) == 1 else bounds
    if not (low <= orbit.energy <= high and low < high):
        energy = format_number(orbit.energy, 8)
        raise ValueError(f"until={until!r}: must be another energy than that of the orbit, {energy}, or (low, high) around it")
    return low, high


class _Entry(NamedTuple):
    """A member of a family with the special points that are located at it, or after it."""

    orbit: PeriodicOrbit
    special: list[Located]


class _Branch:
    """The members of a family on one side of an orbit, found in units of the well."""

    def __init__(self, orbit: PeriodicOrbit, bounds: tuple[float, float], most_members: int, *, rising: bool) -> None:
        units = orbit.potential.units
        self._potential, self._section = orbit.potential.in_well_units, orbit.section.in_well_units(units)
        self._orbit, self._most = orbit, most_members
        self._bounds = bounds[0] / units.energy, bounds[1] / units.energy
        self.rising, self.entries = rising, [_Entry(orbit, [])]
        self.end = "the search has not ended"

    def grow(self, execution: Execution) -> Iterator[None]:
        """Find the members one after the other, and yield after each."""
        trial = self._orbit.trial
        symmetry = half_symmetry(self._potential, trial)
        first = first_member(self._potential, self._section, trial, rising=self.rising)
        if first is None:
            self.end = "the orbit cannot be integrated"
            return
        numbers, last = numbers_of(self._potential, symmetry, first), first
        for count, whole in enumerate(follow_family(self._potential, self._section, first, _LONGEST_STEP), 2):
            segment, is_last = self._limited(whole)
            last = segment.after
            before, numbers = numbers, numbers_of(self._potential, symmetry, last)
            ends = before._replace(slope=float(segment.before.direction[-1])), numbers
            self._add(find_special_points(self._potential, self._section, segment, symmetry, ends), last)
            execution.report(partial(self._share, count))
            yield
            if is_last or self._has_ended(first, segment, count, execution):
                return
        self.end = _reason(self._potential, last)

    def _add(self, special: list[Located], member: Member) -> None:
        """Add the special points of a segment, and its last member."""
        for located in special:
            if located.converged:
                self.entries.append(_Entry(self._restored(located.member), [located]))
            else:
                self.entries[-1].special.append(located)
        self.entries.append(_Entry(self._restored(member), []))

    def _restored(self, member: Member) -> PeriodicOrbit:
        orbit = self._orbit
        return PeriodicOrbit.from_trial(orbit.potential, orbit.section, member.orbit, member.stability_index)

    def _share(self, count: int) -> float:
        """Return the share of the energies that is done, or of the members, whichever is larger."""
        first, last = (self.entries[k].orbit.energy / self._orbit.potential.units.energy for k in (0, -1))
        return min(max((last - first) / (self._bounds[self.rising] - first), count / self._most, 0.0), 1.0)

    def _limited(self, segment: Segment) -> tuple[Segment, bool]:
        """Return a segment within the range of energies, and whether it is the last one."""
        begin, end = segment
        bound = float(np.clip(end.orbit.energy, *self._bounds))
        if bound == end.orbit.energy:
            return segment, False
        is_asked_for = bound != self._bounds[not self.rising]
        self.end = "the energy asked for is reached" if is_asked_for else "it turns back to the lowest or highest energy"
        share = (bound - begin.orbit.energy) / (end.orbit.energy - begin.orbit.energy)
        guess = begin.orbit.moved(begin.orbit.vector + share * (end.orbit.vector - begin.orbit.vector))
        closed = close_orbit(self._potential, self._section, guess._replace(energy=bound))
        if closed is None:
            self.end = "its member at the last energy is not found"
            return segment, True
        return Segment(begin, Member.of(self._potential, *closed, end.direction)), True

    def _has_ended(self, first: Member, segment: Segment, count: int, execution: Execution) -> bool:
        """Return whether no further member is wanted, and keep the reason."""
        if execution.is_cancelled:
            self.end = "the search was cancelled"
        elif count == self._most:
            self.end = "the largest number of members is reached"
        elif self._has_stopped(segment):
            self.end = _reason(self._potential, segment.after)
        elif count > _FEWEST_MEMBERS and _is_closed(first.orbit, segment):
            self.end = "it is closed and returns to its first member"
        else:
            return False
        return True

    def _has_stopped(self, segment: Segment) -> bool:
        """Return whether the energy hardly changes any more, because the orbits tend to an equilibrium."""
        change = abs(segment.after.orbit.energy - segment.before.orbit.energy)
        return change < _SMALLEST_CHANGE and _slowness(self._potential, segment.after.orbit) < _SLOWEST


def _is_closed(first: Trial, segment: Segment) -> bool:
    """Return whether a segment ends nearer to an orbit than its length."""
    begin, end = segment.before.orbit, segment.after.orbit
    length = float(np.linalg.norm(end.vector - begin.vector))
    steps = end.states[end.returns] - first.states[first.returns], end.durations - first.durations, end.energy - first.energy
    return all(bool(np.abs(step).max() < length) for step in steps)


def _reason(potential: Potential, member: Member) -> str:
    """Return why no further member is found after a member."""
    x, y = sampled_path(potential, member.orbit, _PATH_POINTS)[1:3]
    if max(np.ptp(x), np.ptp(y)) < _SMALL_ORBIT:
        return "the orbits shrink to an equilibrium"
    if any(np.hypot(x - centre.x, y - centre.y).min() < 2.0 * centre.radius for centre in potential.centres):
        return "the orbits collide with a body"
    if _slowness(potential, member.orbit) < _SLOW:
        return _HOMOCLINIC
    return "no further member is found: the returns to the section change, or the orbits are too unstable"


def _slowness(potential: Potential, orbit: Trial) -> float:
    """Return the smallest sum of speed and force along an orbit, which is 0 at an equilibrium."""
    x, y, vx, vy = sampled_path(potential, orbit, _PATH_POINTS)[1:]
    return float(np.hypot(np.hypot(vx, vy), np.hypot(*potential.gradient(x, y))).min())


def _joined(orbit: PeriodicOrbit, branches: list[_Branch], *, complete: bool) -> OrbitFamily:
    """Return the family of branches on one or both sides of an orbit, from its lower to its higher end."""
    entries = [_Entry(orbit, [located for branch in branches for located in branch.entries[0].special])]
    ends = ["it was continued from this orbit"] * 2
    for branch in branches:
        ends[branch.rising] = branch.end
        # The first entry of a branch is the orbit itself.
        entries = [*entries, *branch.entries[1:]] if branch.rising else [*branch.entries[:0:-1], *entries]
    special = [_special_point(k, entry, located) for k, entry in enumerate(entries) for located in entry.special]
    columns = (np.array([getattr(entry.orbit, name) for entry in entries]) for name in NUMBERS)
    energy, period, stability_index, action = map(read_only, columns)
    states, time = (read_only(np.array([getattr(entry.orbit, name) for entry in entries])) for name in ("states", "time"))
    return OrbitFamily(
        energy, period, stability_index, action, states, time, tuple(special), (ends[0], ends[1]), complete,
        section=orbit.section, potential=orbit.potential,
    )  # fmt: skip


def _special_point(member: int, entry: _Entry, located: Located) -> SpecialPoint:
    orbit = entry.orbit
    return SpecialPoint(located.kind, member, orbit.energy, orbit.period, *located.resonance, converged=located.converged)
