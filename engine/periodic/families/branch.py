"""Follow a family of periodic orbits from one of its ends, and say why it ends."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import NamedTuple

import numpy as np

from engine.foundations.execution import Execution
from engine.periodic.closed_orbits import half_symmetry
from engine.periodic.families.family import OrbitFamily
from engine.periodic.families.following import Member, Segment, first_member, follow_family
from engine.periodic.families.special_points import Located, find_special_points, numbers_of
from engine.periodic.family_parameter import FamilyParameter
from engine.periodic.periodic_orbit import PeriodicOrbit
from engine.periodic.shooting import Trial, close_orbit
from engine.systems.potential import Potential

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


class Entry(NamedTuple):
    """A member of a family, the value of its parameter, and the special points that are located at it, or after it."""

    orbit: PeriodicOrbit
    value: float
    special: list[Located]


class Branch:
    """The members of a family beyond one of its ends, found in units of the well and of the parameter.

    The first entry is the end. A family of one member goes on to higher values of its parameter if the branch is `rising`, and
    otherwise to lower ones. Other families go on as before, beyond the last or the first member.
    """

    def __init__(
        self, parameter: FamilyParameter, family: OrbitFamily, bounds: tuple[float, float], most_members: int, *, rising: bool
    ) -> None:
        self._parameter, self._family, self._most = parameter, family, most_members
        self._bounds = bounds[0] / parameter.unit, bounds[1] / parameter.unit
        member = len(family) - 1 if rising else 0
        self.rising, self.entries = rising, [Entry(family[member], float(family.value[member]), [])]
        self.end = "the search has not ended"

    def grow(self, execution: Execution) -> Iterator[None]:
        """Find the members one after the other, and yield after each."""
        parameter, (other_end, *_, before, trial) = self._parameter, self._known()
        first = first_member(parameter, trial, self._direction(before, trial))
        if first is None:
            self.end = "the orbit cannot be integrated"
            return
        if self._leaves_range(first) or self._has_closed(other_end, before, trial, 1):
            self.end = self._family.ends[self.rising]
            return
        symmetry = half_symmetry(parameter.at(trial.value).potential, trial, parameter.symmetries_at(trial.value))
        numbers, last = numbers_of(parameter, symmetry, first), first
        for count, whole in enumerate(follow_family(parameter, first, _LONGEST_STEP), 2):
            segment, is_last = self._limited(whole)
            last = segment.after
            earlier, numbers = numbers, numbers_of(parameter, symmetry, last)
            ends = earlier._replace(slope=float(segment.before.direction[-1])), numbers
            self._add(find_special_points(parameter, segment, symmetry, ends), last)
            execution.report(partial(self._share, count))
            yield
            if is_last or self._has_ended(other_end, segment, count, execution):
                return
        self.end = _reason(parameter, last)

    def _known(self) -> list[Trial]:
        """Return the other end of the family, a member before the end, and the end."""
        last = len(self._family) - 1
        # The member next to the end can be a special point at nearly the same place.
        members = [0, max(last - 2, 0), last] if self.rising else [last, min(2, last), 0]
        return [self._family.trial(member, self._parameter) for member in members]

    def _direction(self, before: Trial, end: Trial) -> np.ndarray:
        """Return the direction in which the family goes on, as `Trial.numbers`."""
        if len(self._family) > 1:
            return end.numbers - before.numbers
        upward = np.zeros(end.numbers.size)
        upward[-1] = 1.0 if self.rising else -1.0
        return upward

    def _leaves_range(self, end: Member) -> bool:
        """Return whether a member is at a bound of the range of the parameter, and further ones would be beyond it."""
        low, high = self._bounds
        return end.orbit.value >= high if end.direction[-1] > 0.0 else end.orbit.value <= low

    def _add(self, special: list[Located], member: Member) -> None:
        """Add the special points of a segment, and its last member."""
        for located in special:
            if located.converged:
                self.entries.append(self._restored(located.member)._replace(special=[located]))
            else:
                self.entries[-1].special.append(located)
        self.entries.append(self._restored(member))

    def _restored(self, member: Member) -> Entry:
        """Return a member in the units of the potential and of the parameter."""
        parameter, value = self._parameter, member.orbit.value
        orbit = member.orbit._replace(value=parameter.energy_at(value))
        restored = PeriodicOrbit.from_trial(parameter.potential_at(value), parameter.section, orbit, member.stability_index)
        return Entry(restored, value * parameter.unit, [])

    def _share(self, count: int) -> float:
        """Return the share of the range that is done, or of the members, whichever is larger."""
        first, last = (self.entries[k].value / self._parameter.unit for k in (0, -1))
        range = self._bounds[self.rising] - first
        return min(max((last - first) / range if range else 0.0, count / self._most, 0.0), 1.0)

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

    def _has_ended(self, other_end: Trial, segment: Segment, count: int, execution: Execution) -> bool:
        """Return whether no further member is wanted, and keep the reason."""
        if execution.is_cancelled:
            self.end = "the search was cancelled"
        elif count == self._most:
            self.end = "the largest number of members is reached"
        elif self._has_stopped(segment):
            self.end = _reason(self._parameter, segment.after)
        elif self._has_closed(other_end, segment.before.orbit, segment.after.orbit, count):
            self.end = "it is closed and returns to its first member"
        else:
            return False
        return True

    def _has_closed(self, other_end: Trial, before: Trial, end: Trial, count: int) -> bool:
        """Return whether the family ends nearer to its other end than to an earlier member, after some members of the branch."""
        if len(self._family) + count <= _FEWEST_MEMBERS + 1:
            return False
        length = float(np.linalg.norm(end.numbers - before.numbers))
        return bool(np.abs(end.numbers - other_end.numbers).max() < length)

    def _has_stopped(self, segment: Segment) -> bool:
        """Return whether the parameter hardly changes any more, because the orbits tend to an equilibrium."""
        change, orbit = abs(segment.after.orbit.value - segment.before.orbit.value), segment.after.orbit
        return change < _SMALLEST_CHANGE and _slowness(self._parameter.at(orbit.value).potential, orbit) < _SLOWEST


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
