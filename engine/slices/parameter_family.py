"""The potentials along a parameter of a system, with exits that keep their numbers.

Finding and classifying critical points takes a tenth of a second, so this is done at a few values of the parameter only, the
nodes. Between two nodes with the same exits, Newton's method continues the saddles in a millisecond. If the exits of two
neighbouring nodes cannot be matched, exits appear or disappear between the nodes, and further nodes are inserted.
"""

from __future__ import annotations

import functools
import math
import threading
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.foundations.arrays import read_only
from engine.slices.axes import ParameterAxis
from engine.systems.outcomes import Exit
from engine.systems.potential import Potential

# Nodes divide the range of the axis into this many parts.
_PARTS = 8
# Nodes divide the distance from the system's own value to the farther end of the range into at most this many parts.
_MOST_PARTS = 24
# A part whose ends have different exits is halved up to this many times.
_HALVINGS = 12
_NEWTON_STEPS = 20
# Number of potentials along the axis that `find_members` finds.
_SCAN_VALUES = 112
# Newton's method has converged when its last step is below this share of the distance from the origin.
_TOLERANCE = 1e-12
# Newton's method may move a saddle by this share of the distance to the nearest other saddle.
_LARGEST_SHARE = 0.5
# Two saddles are the same if their distance is below this share of their distance from the origin.
_SAME = 1e-7


MOST_FOUND = 120
"""Largest number of potentials of a family whose critical points are searched. This many take about 10 s."""


class ManyExitsError(ValueError):
    """The exits change too often along the parameter."""


@dataclass(frozen=True, eq=False)
class Member:
    """A potential of a family.

    Attributes
    ----------
    potential
        The potential.
    numbers
        Fate in the family of each fate of the potential, int8, of shape (outcomes + 1,); entry 0 is 0.
    """

    potential: Potential
    numbers: np.ndarray

    def numbers_at(self, energy: float) -> np.ndarray:
        """Return `numbers` at an energy, where an exit of several channels has the lowest number of these channels."""
        numbers = self.numbers.copy()
        for merged in self.potential.well.merged_exits(energy):
            channels = list(merged.channels)
            numbers[channels] = np.sort(numbers[channels])
        return read_only(numbers)

    @property
    def of_others(self) -> np.ndarray:
        """The fates in the family of the outcomes that are not exits."""
        return self.numbers[self.potential.channels + 1 :]


class ParameterFamily:
    """Finds the potentials along one axis and numbers their outcomes. `parameter_family` returns the one family of an axis.

    Outcomes keep the numbers that they have at the system's own value of the parameter. Exits that do not exist there get the
    next numbers in the order in which they appear, first towards higher and then towards lower values.

    Parameters
    ----------
    axis
        The axis.
    most_found
        Largest number of potentials whose critical points are searched, 1 or more.
    """

    def __init__(self, axis: ParameterAxis, most_found: int = MOST_FOUND) -> None:
        self._axis, self._most_found = axis, most_found
        self._own_value = axis.system.value_of(axis.key)
        self._reach = max(abs(axis.low - self._own_value), abs(axis.high - self._own_value))
        self._step = max((axis.high - axis.low) / _PARTS, self._reach / _MOST_PARTS)
        self._found_count = 0
        # Potentials inside parts whose ends have different exits.
        self._between_nodes: dict[float, Member] = {}
        self._nodes: dict[float, Member] = {}
        self._node_matches: dict[tuple[float, float], list[int] | None] = {}
        self._lock = threading.Lock()
        first = axis.potential(self._own_value)
        self._nodes[self._own_value] = Member(first, read_only(np.arange(len(first.outcomes) + 1, dtype=np.int8)))
        self.outcomes = first.outcomes
        """The outcomes of all potentials of the family that have been found so far."""
        self._extend_to(axis.high)
        self._extend_to(axis.low)

    def member(self, value: float) -> Member:
        """Return the potential at a value of the parameter.

        Raises
        ------
        ManyExitsError
            If the exits change too often between the value of the system and this one.
        ValueError
            If the system has no potential at this value.
        """
        with self._lock:
            return self._member(value)

    def _member(self, value: float) -> Member:
        self._extend_to(value)
        for known in (self._nodes, self._between_nodes):
            if value in known:
                return known[value]
        values = sorted(self._nodes)
        above = next(place for place, node in enumerate(values) if node > value)
        low, high = values[above - 1], values[above]
        between = self._between(value, low, high)
        if between is None:
            between = self._between_nodes[value] = self._linked(value, min(low, high, key=lambda node: (abs(node - value), node)))
        return between

    def _extend_to(self, value: float) -> None:
        """Add nodes, away from the system's own value, until they enclose a value."""
        sign = math.copysign(1.0, value - self._own_value)
        while True:
            ends = sorted(self._nodes)
            end = ends[-1] if sign > 0 else ends[0]
            if (value - end) * sign <= 0.0:
                return
            self._connect(end, self._node_after(end, value, sign))

    def _node_after(self, end: float, value: float, sign: float) -> float:
        """Return the next node: the next multiple of the step inside the range, and twice the distance outside it.

        If the system has no potential at the node, return the value to reach.
        """
        distance = abs(end - self._own_value)
        further = self._step * (math.floor(distance / self._step * (1.0 + _TOLERANCE)) + 1)
        node = self._own_value + sign * (further if distance < self._reach else 2.0 * distance)
        try:
            self._axis.potential(node)
        except ValueError:
            return value
        return node

    def _connect(self, known: float, new: float) -> None:
        """Add a node at `new`, next to the node `known`; if their exits differ, first insert nodes between them."""
        potential = self._axis.potential(new)
        for _ in range(_HALVINGS):
            if _match(self._nodes[known].potential, potential) is not None:
                break
            middle = 0.5 * (known + new)
            if _match(self._nodes[known].potential, self._axis.potential(middle)) is None:
                new, potential = middle, self._axis.potential(middle)
            else:
                self._nodes[middle] = self._linked(middle, known)
                known = middle
        self._nodes[new] = self._linked(new, known)

    def _linked(self, value: float, node: float) -> Member:
        """Find the potential at a value. Its exits get the numbers of the same exits at a node, and new numbers otherwise."""
        self._found_count += 1
        if self._found_count > self._most_found:
            raise ManyExitsError(
                f"parameter {self._axis.key}: its exits change too often up to {value:.6g}; choose a smaller range"
            )
        potential, neighbour = self._axis.potential(value), self._nodes[node]
        numbers = np.array([*np.zeros(potential.channels + 1), *neighbour.of_others], np.int8)
        for channel, place in enumerate(_continue(potential, neighbour.potential.saddles), start=1):
            k = _nearest(potential.saddles, place)
            if k is not None and not numbers[k + 1]:
                numbers[k + 1] = neighbour.numbers[channel]
        new = np.flatnonzero(numbers[1:] == 0) + 1
        numbers[new] = len(self.outcomes) + 1 + np.arange(new.size)
        known = sum(outcome.kind is Exit for outcome in self.outcomes)
        self.outcomes += tuple(Exit.outcome(known + k) for k in range(1, new.size + 1))
        return Member(potential, read_only(numbers))

    def _matches(self, low: float, high: float) -> list[int] | None:
        """Match the exits of two nodes, once for each pair of nodes."""
        if (low, high) not in self._node_matches:
            self._node_matches[low, high] = _match(self._nodes[low].potential, self._nodes[high].potential)
        return self._node_matches[low, high]

    def _between(self, value: float, low: float, high: float) -> Member | None:
        """Continue the saddles of two nodes to a value between them; None if the exits of the nodes differ."""
        first, last = self._nodes[low], self._nodes[high]
        matched = self._matches(low, high)
        share = (value - low) / (high - low)
        if matched is None or len(first.potential.well.channel_mergers) != len(last.potential.well.channel_mergers):
            return None
        order = np.array(matched, int)
        plain = self._axis.potential(value)
        saddles = _continue(plain, (1.0 - share) * first.potential.saddles + share * last.potential.saddles[order])
        maxima, channels = np.empty((0, 2)), []
        for merger in first.potential.well.channel_mergers:
            around = {int(order[k - 1]) + 1 for k in merger.channels}
            other = next((each for each in last.potential.well.channel_mergers if set(each.channels) == around), None)
            if other is None:
                return None
            guess = (1.0 - share) * np.array([[merger.x, merger.y]]) + share * np.array([[other.x, other.y]])
            maxima = np.concatenate([maxima, _continue(plain, guess)])
            channels.append([k - 1 for k in merger.channels])
        if not (np.isfinite(saddles).all() and np.isfinite(maxima).all()):
            return None
        potential = plain.continued(repr(self._axis), saddles, maxima, channels)
        ordered = [_nearest(saddles, place) for place in potential.saddles]
        if None in ordered or len(set(ordered)) < len(saddles):
            return None
        numbers = np.array([0, *(first.numbers[k + 1] for k in ordered if k is not None), *first.of_others], np.int8)
        return Member(potential, read_only(numbers))


@functools.lru_cache(maxsize=256)
def parameter_family(axis: ParameterAxis) -> ParameterFamily:
    """Return the family of an axis; this takes up to a second, and less if its nodes are stored on disk."""
    return ParameterFamily(axis)


def find_members(axis: ParameterAxis) -> None:
    """Find potentials along a whole axis, to time the lines of a map and to store the critical points on disk.

    Raises
    ------
    ManyExitsError
        If the exits change too often.
    """
    family = parameter_family(axis)
    for value in np.linspace(axis.low, axis.high, _SCAN_VALUES).tolist():
        try:
            family.member(value)
        except ManyExitsError:
            raise
        except ValueError:
            # The system has no potential there, so the line of the map remains empty.
            continue


def _match(first: Potential, last: Potential) -> list[int] | None:
    """Return the index of the last potential's saddle for each exit saddle of the first; None unless they match one to one."""
    if first.channels != last.channels:
        return None
    found = [_nearest(last.saddles, place) for place in _continue(last, first.saddles)]
    matched = [k for k in found if k is not None]
    return matched if len(set(matched)) == first.channels else None


def _continue(potential: Potential, points: np.ndarray) -> np.ndarray:
    """Continue critical points of another potential to this one by Newton's method; (n, 2), NaN where there is none."""
    start = points = np.array(points)
    if not len(points):
        return points
    with np.errstate(all="ignore"):
        step = np.full_like(points, np.inf)
        for _ in range(_NEWTON_STEPS):
            if not np.any(np.hypot(*step.T) > _TOLERANCE * np.hypot(*points.T)):
                break
            (gx, gy), (vxx, vxy, vyy) = potential.gradient(*points.T), potential.hessian(*points.T)
            step = np.column_stack([gx * vyy - gy * vxy, gy * vxx - gx * vxy]) / (vxx * vyy - vxy * vxy)[:, None]
            points = points - step
        near = np.hypot(*step.T) <= _TOLERANCE * np.hypot(*points.T)
        moved = np.hypot(*(points - start).T) <= _LARGEST_SHARE * _separation(start)
    result: np.ndarray = np.where((near & moved)[:, None], points, np.nan)
    return result


def _separation(points: np.ndarray) -> np.ndarray:
    """Return the distance of each point to the nearest other point or to the origin, of shape (n,)."""
    others = np.concatenate([points, np.zeros((1, 2))])
    distances = np.hypot(*np.moveaxis(points[:, None] - others, -1, 0))
    distances[np.arange(len(points)), np.arange(len(points))] = np.inf
    nearest: np.ndarray = distances.min(axis=1)
    return nearest


def _nearest(points: Sequence[np.ndarray] | np.ndarray, place: np.ndarray) -> int | None:
    """Return the index of the point at a place; None if no point is there."""
    if not len(points) or not np.isfinite(place).all():
        return None
    distances = np.hypot(*(np.asarray(points) - place).T)
    k = int(np.argmin(distances))
    return k if distances[k] <= _SAME * np.hypot(*place) else None
