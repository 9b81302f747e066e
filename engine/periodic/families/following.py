"""Follow a family of periodic orbits through its members, by their distance in the space of unknowns.

The parameter is one of the unknowns, so a family is followed through folds, where its value turns (pseudo-arclength continuation;
Keller 1977, in Applications of Bifurcation Theory). All quantities are in units of the well and of the parameter.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from engine.periodic.family_parameter import FamilyParameter
from engine.periodic.shooting import Equations, Trial, close_orbit, crosses_section, divided, linearise

# First step, and smallest step, in the space of unknowns.
_FIRST_STEP, _SMALLEST_STEP = 0.01, 1e-7
# Factors by which a step grows after a success and shrinks after a failure.
_LONGER, _SHORTER = 1.5, 0.5
# Smallest cosine of the angle between the directions at neighbouring members. A larger angle can be a jump to another family.
_LEAST_COSINE = 0.9
# Largest change of the stability index between neighbouring members, relative to 1 + |a|.
_LARGEST_CHANGE = 0.5


class Member(NamedTuple):
    """A member of a family: the orbit, its stability index, and the direction of the family in the space of unknowns."""

    orbit: Trial
    stability_index: float
    direction: np.ndarray

    @classmethod
    def of(cls, parameter: FamilyParameter, orbit: Trial, equations: Equations, previous: np.ndarray) -> Member:
        """Return a closed orbit as a member. Its direction is on the side of a previous direction."""
        null_vector = np.linalg.svd(equations.jacobian)[2][-1]
        direction = null_vector if null_vector @ previous >= 0.0 else -null_vector
        return cls(orbit, orbit.nodes.stability_index(parameter.at(orbit.value).potential), direction)


def first_member(parameter: FamilyParameter, orbit: Trial, towards: np.ndarray) -> Member | None:
    """Return the first member of a family, from a closed orbit, in a direction; None if the orbit cannot be integrated.

    The direction has the numbers of the returns, see `Trial.numbers`.
    """
    equations = linearise(parameter, orbit)
    if equations is None:
        return None
    previous = np.zeros(orbit.vector.size)
    previous[orbit.is_of_returns] = towards
    return Member.of(parameter, orbit, equations, previous)


class Segment(NamedTuple):
    """The part of a family between two neighbouring members, which have the same nodes."""

    before: Member
    after: Member


def follow_family(parameter: FamilyParameter, first: Member, longest_step: float) -> Iterator[Segment]:
    """Yield the segments of a family from a member. The iterator ends where the next member is not found.

    Parameters
    ----------
    parameter
        The parameter.
    first
        The first member.
    longest_step
        Largest distance of neighbouring members in the space of unknowns of an orbit without nodes between its returns. Such
        nodes add to the distance of orbits.
    """
    member, step = first, min(_FIRST_STEP, longest_step)
    while step >= _SMALLEST_STEP:
        following = _advance(parameter, member, step)
        if following is None:
            step *= _SHORTER
            continue
        yield Segment(member, following)
        member = _divided(parameter, following)
        step = min(step * _LONGER, longest_step * math.sqrt(len(member.orbit.states) / len(member.orbit.durations)))


def _divided(parameter: FamilyParameter, member: Member) -> Member:
    """Return a member with further nodes if its errors grow much; its direction is found again."""
    orbit = divided(parameter.at(member.orbit.value).potential, member.orbit)
    if orbit.parts == member.orbit.parts:
        return member
    equations = linearise(parameter, orbit)
    if equations is None:
        return member
    # The times and the value change as before.
    count = len(orbit.durations) + 1
    previous = np.concatenate([np.zeros(orbit.states.size), member.direction[-count:]])
    return Member.of(parameter, orbit, equations, previous)


def _predicted(parameter: FamilyParameter, member: Member, step: float) -> tuple[Trial, np.ndarray | None]:
    """Return the trial orbit at a distance from a member and the direction in which it is not corrected, see `close_orbit`."""
    orbit, change = member.orbit, step * member.direction
    limit = float(np.clip(orbit.value + change[-1], *parameter.limits))
    if limit == orbit.value + change[-1]:
        return orbit.moved(orbit.vector + change), member.direction
    # There is no potential beyond the legal values, so the next member is that of the last legal one.
    return orbit.moved(orbit.vector + (limit - orbit.value) / change[-1] * change)._replace(value=limit), None


def _advance(parameter: FamilyParameter, member: Member, step: float) -> Member | None:
    """Return the member at a distance; None if it is not found, or may belong to another family."""
    predicted, direction = _predicted(parameter, member, step)
    closed = close_orbit(parameter, predicted, direction)
    if closed is None:
        return None
    orbit, equations = closed
    potential, section, _ = parameter.at(orbit.value)
    if not crosses_section(potential, section, orbit):
        return None
    following = Member.of(parameter, orbit, equations, member.direction)
    before, after = member.stability_index, following.stability_index
    is_near = np.linalg.norm(orbit.vector - predicted.vector) <= step
    changes_little = abs(after - before) <= _LARGEST_CHANGE * (1.0 + min(abs(before), abs(after)))
    is_straight = following.direction @ member.direction >= _LEAST_COSINE
    return following if is_near and changes_little and is_straight else None
