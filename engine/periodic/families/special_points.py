"""Special points of a family of periodic orbits: folds, bifurcations and resonances, located between its members."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from engine.foundations.root_finding import find_root
from engine.periodic.closed_orbits import half_index
from engine.periodic.families.following import Member, Segment
from engine.periodic.family_parameter import FamilyParameter
from engine.periodic.shooting import SINGULAR, close_orbit, linearise
from engine.periodic.symmetries import Symmetry

# Distance within which a point is located, as a share of a segment.
_LOCATED = 1e-13
# Shares of the largest singular value below which others are 0, in the order of attempts, see `_member_between`.
_SINGULAR_VALUES = 1e-5, SINGULAR
# Places of the members from which one at a branching point is interpolated, in this share of a segment.
_STEPS, _STENCIL = (-3.0, -2.0, -1.0, 1.0, 2.0, 3.0), 0.1
# Turns m and periods n of the resonances m : n.
_RESONANCES = ((1, 3), (1, 4), (1, 5), (2, 5), (1, 6))


class SpecialKind(StrEnum):
    """What happens at a special point of a family."""

    FOLD = "fold"
    """The parameter of the family, such as the energy, turns back."""
    BRANCHING = "branching"
    """a = 1: another family of the same period meets this one."""
    DOUBLING = "period doubling"
    """a passes −1: a family of twice the period is born."""
    TOUCHING = "touching"
    """a touches −1 and returns, because half a period maps the orbit onto its mirror image: families of twice the period meet."""
    RESONANCE = "resonance"
    """Nearby orbits turn around the orbit m times in n periods: chains of islands are born."""


class Numbers(NamedTuple):
    """The numbers of a member that change their sign, or pass a value, at special points.

    Attributes
    ----------
    slope
        Change of the parameter along the family.
    stability_index
        a.
    half_index
        b, see `engine.periodic.closed_orbits.half_index`, of an orbit with a `half_symmetry`; None for another orbit.
    """

    slope: float
    stability_index: float
    half_index: float | None


class Test(NamedTuple):
    """A function of the numbers of members, which changes its sign at special points of a kind.

    Attributes
    ----------
    kind
        The kind of the points.
    value
        The function; None for members without these points.
    resonance
        m and n of a resonance; (0, 0) for another kind.
    """

    kind: SpecialKind
    value: Callable[[Numbers], float | None]
    resonance: tuple[int, int] = (0, 0)


def _index_minus(value: float, *, also_with_symmetry: bool = False) -> Callable[[Numbers], float | None]:
    return lambda numbers: numbers.stability_index - value if also_with_symmetry or numbers.half_index is None else None


def _half_index_minus(value: float) -> Callable[[Numbers], float | None]:
    return lambda numbers: None if numbers.half_index is None else numbers.half_index - value


_TESTS = (
    Test(SpecialKind.FOLD, lambda numbers: numbers.slope),
    Test(SpecialKind.BRANCHING, _index_minus(1.0)),
    Test(SpecialKind.DOUBLING, _index_minus(-1.0)),
    Test(SpecialKind.BRANCHING, _half_index_minus(1.0)),
    Test(SpecialKind.BRANCHING, _half_index_minus(-1.0)),
    Test(SpecialKind.TOUCHING, _half_index_minus(0.0)),
    *(
        Test(SpecialKind.RESONANCE, _index_minus(math.cos(2.0 * math.pi * m / n), also_with_symmetry=True), (m, n))
        for m, n in _RESONANCES
    ),
)


class Located(NamedTuple):
    """A special point.

    Attributes
    ----------
    share
        Its place in a segment, 0 to 1.
    kind, resonance
        See `Test`.
    member
        The member at the point.
    converged
        Whether it was located; otherwise the member is the first one of the segment.
    """

    share: float
    kind: SpecialKind
    resonance: tuple[int, int]
    member: Member
    converged: bool


def numbers_of(parameter: FamilyParameter, symmetry: Symmetry | None, member: Member) -> Numbers:
    """Return the numbers of a member whose orbit has a `half_symmetry`, or None."""
    half = None if symmetry is None else half_index(parameter.at(member.orbit.value).potential, member.orbit, symmetry)
    return Numbers(float(member.direction[-1]), member.stability_index, half)


def find_special_points(
    parameter: FamilyParameter, segment: Segment, symmetry: Symmetry | None, ends: tuple[Numbers, Numbers]
) -> list[Located]:
    """Return the special points of a segment, whose ends have these numbers, in the order of the family."""
    found = []
    for test in _TESTS:
        values = test.value(ends[0]), test.value(ends[1])
        if values[0] is not None and values[1] is not None and values[0] * values[1] < 0.0:
            found.append(_locate(parameter, segment, symmetry, test, {0.0: values[0], 1.0: values[1]}))
    # At a fold, a is 1 as well.
    has_fold = any(each.kind is SpecialKind.FOLD for each in found)
    return sorted((each for each in found if not (has_fold and each.kind is SpecialKind.BRANCHING)), key=lambda each: each.share)


def _locate(
    parameter: FamilyParameter, segment: Segment, symmetry: Symmetry | None, test: Test, values: dict[float, float]
) -> Located:
    """Return the point at which a test changes its sign in a segment, given its values at the ends, by their shares."""
    members = {0.0: segment.before, 1.0: segment.after}

    def value(share: float) -> float:
        if share not in members:
            members[share] = _member_between(parameter, segment, share)
            found = test.value(numbers_of(parameter, symmetry, members[share]))
            values[share] = math.nan if found is None else found
        return values[share]

    member: Member | None
    try:
        share = find_root(value, 0.0, 1.0, xtol=_LOCATED)
        value(share)
        member = members[share]
    except _NotFoundError:
        # Where another family meets a fold, members are found around it only.
        share, member = values[0.0] / (values[0.0] - values[1.0]), None
    if member is None or test.kind is SpecialKind.BRANCHING:
        member = _interpolated(parameter, segment, symmetry, test, share) or member
    if member is None:
        return Located(0.0, test.kind, test.resonance, segment.before, converged=False)
    return Located(share, test.kind, test.resonance, member, converged=True)


def _interpolated(
    parameter: FamilyParameter, segment: Segment, symmetry: Symmetry | None, test: Test, share: float
) -> Member | None:
    """Return the member at which a test vanishes near a share, from members around it; None if they are not found.

    At a branching point, the equations do not fix the orbit along the other family.
    """
    try:
        members = [_member_between(parameter, segment, share + step * _STENCIL, (SINGULAR,)) for step in _STEPS]
    except _NotFoundError:
        return None
    values = [test.value(numbers_of(parameter, symmetry, member)) for member in members]
    roots = np.polynomial.Polynomial.fit(_STEPS, np.array(values, float), len(_STEPS) - 1).roots()
    place = float(roots[np.argmin(np.abs(roots))].real)
    vectors = np.array([member.orbit.vector for member in members])
    weights = [np.prod([(place - other) / (step - other) for other in _STEPS if other != step]) for step in _STEPS]
    orbit = members[0].orbit.moved(np.array(weights) @ vectors)
    equations = linearise(parameter, orbit)
    return None if equations is None else Member.of(parameter, orbit, equations, members[0].direction)


class _NotFoundError(Exception):
    """There is no member at a place of a segment."""


def _member_between(
    parameter: FamilyParameter, segment: Segment, share: float, singular_values: Sequence[float] = _SINGULAR_VALUES
) -> Member:
    """Return the member nearest to a point of the chord of a segment."""
    begin = segment.before.orbit
    chord = segment.after.orbit.vector - begin.vector
    trial, direction = begin.moved(begin.vector + share * chord), chord / np.linalg.norm(chord)
    # Near a point at which another family meets this one, rounding errors move an orbit along the other family. A symmetry of
    # this family keeps the orbit on it without corrections along the other one.
    for singular in singular_values:
        closed = close_orbit(parameter, trial, direction, singular)
        if closed is not None:
            return Member.of(parameter, *closed, chord)
    raise _NotFoundError
