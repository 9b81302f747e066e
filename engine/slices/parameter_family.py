"""The potentials along a parameter of a system, with exits that keep their numbers.

Finding and classifying critical points takes a tenth of a second. They are therefore searched only at a few values of the
parameter, the nodes. Between two nodes with the same exits, Newton's method continues the saddles in a millisecond. If the
exits of two neighbouring nodes cannot be matched, exits appear or disappear between the nodes, and further nodes are inserted.
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
from engine.systems.merged_channels import ChannelMerger
from engine.systems.outcomes import Exit
from engine.systems.potential import Potential

# Number of parts into which nodes divide the range of the axis.
_RANGE_PARTS = 8
# Largest number of parts into which nodes divide the distance from the system's own value to the farther end of the range.
_MOST_REACH_PARTS = 24
# Largest number of halvings of a part whose ends have different exits.
_HALVINGS = 12
# Largest number of steps of Newton's method.
_NEWTON_STEPS = 20
# Number of values along the axis at which `find_members` finds potentials.
_SCAN_VALUES = 112
# Largest last step of Newton's method that has converged, as a share of the distance from the origin, and largest relative
# rounding error of the distance of a node.
_TOLERANCE = 1e-12
# Largest distance by which Newton's method may move a saddle, as a share of the distance to the nearest other saddle.
_LARGEST_MOVE = 0.5
# Largest distance between two saddles that count as the same, as a share of their distance from the origin.
_SAME_TOLERANCE = 1e-7

MOST_SEARCHES = 120
"""Largest number of potentials of a family whose critical points are searched. All these searches take about 10 s."""


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
        For each fate of the potential, the fate in the family, int8, of shape (outcomes + 1,); entry 0 is 0.
    """

    potential: Potential
    numbers: np.ndarray

    def numbers_at(self, energy: float) -> np.ndarray:
        """Return `numbers` at an energy, where an exit of several channels has the lowest number of these channels."""
        numbers = self.numbers.copy()
        for merged in self.potential.well.merged_exits(energy):
            # The lowest channel stands for the exit, so it gets the lowest number.
            channels = list(merged.channels)
            numbers[channels] = np.sort(numbers[channels])
        return read_only(numbers)

    @property
    def other_fates(self) -> np.ndarray:
        """The fates, in the family, of the outcomes of the potential that are not exits."""
        return self.numbers[self.potential.channels + 1 :]


class ParameterFamily:
    """Finds the potentials along one axis and numbers their outcomes. `parameter_family` returns the family of an axis.

    Outcomes keep the numbers that they have at the system's own value of the parameter. Exits that do not exist at this value get
    the next numbers in the order in which they appear, first towards higher and then towards lower values.

    Parameters
    ----------
    axis
        The axis.
    most_found
        Largest number of potentials whose critical points are searched, 1 or more.
    """

    def __init__(self, axis: ParameterAxis, most_searches: int = MOST_SEARCHES) -> None:
        self._axis, self._most_searches = axis, most_searches
        self._own_value = axis.system.value_of(axis.key)
        self._reach = max(abs(axis.low - self._own_value), abs(axis.high - self._own_value))
        self._step = max((axis.high - axis.low) / _RANGE_PARTS, self._reach / _MOST_REACH_PARTS)
        # Number of potentials whose critical points have been searched.
        self._search_count = 0
        # Potentials inside parts whose ends have different exits.
        self._between_nodes: dict[float, Member] = {}
        self._nodes: dict[float, Member] = {}
        self._node_matches: dict[tuple[float, float], list[int] | None] = {}
        self._lock = threading.Lock()
        own_potential = axis.potential(self._own_value)
        own_numbers = np.arange(len(own_potential.outcomes) + 1, dtype=np.int8)
        self._nodes[self._own_value] = Member(own_potential, read_only(own_numbers))
        self.outcomes = own_potential.outcomes
        """The outcomes of all potentials of the family that have been found so far."""
        self._extend_to(axis.high)
        self._extend_to(axis.low)

    def member(self, value: float) -> Member:
        """Return the potential at a value of the parameter.

        Raises
        ------
        ManyExitsError
            If the exits change too often between the system's own value and this value.
        ValueError
            If the system has no potential at this value.
        """
        with self._lock:
            return self._member(value)

    def _member(self, value: float) -> Member:
        self._extend_to(value)
        for members in (self._nodes, self._between_nodes):
            if value in members:
                return members[value]
        nodes = sorted(self._nodes)
        upper_index = next(index for index, node in enumerate(nodes) if node > value)
        low, high = nodes[upper_index - 1], nodes[upper_index]
        member = self._interpolate_member(value, low, high)
        if member is None:
            nearest_node = min(low, high, key=lambda node: (abs(node - value), node))
            member = self._between_nodes[value] = self._find_member(value, nearest_node)
        return member

    def _extend_to(self, value: float) -> None:
        """Add nodes, away from the system's own value, until they enclose a value."""
        sign = math.copysign(1.0, value - self._own_value)
        while True:
            end = max(self._nodes) if sign > 0 else min(self._nodes)
            if (value - end) * sign <= 0.0:
                return
            self._connect(end, self._node_after(end, value, sign))

    def _node_after(self, end: float, value: float, sign: float) -> float:
        """Return the node after the outermost node `end`, on the way to a value.

        Distances from the system's own value are multiples of the step inside the range, and are doubled outside. If the system
        has no potential at the node, the value itself is the next node.
        """
        distance = abs(end - self._own_value)
        next_multiple = self._step * (math.floor(distance / self._step * (1.0 + _TOLERANCE)) + 1)
        node = self._own_value + sign * (next_multiple if distance < self._reach else 2.0 * distance)
        try:
            self._axis.potential(node)
        except ValueError:
            return value
        return node

    def _connect(self, node: float, new_node: float) -> None:
        """Add a new node next to a node; if their exits differ, add nodes between them, as far as the exits can be matched."""
        potential = self._axis.potential(new_node)
        for _ in range(_HALVINGS):
            if _match_exits(self._nodes[node].potential, potential) is not None:
                break
            middle = 0.5 * (node + new_node)
            if _match_exits(self._nodes[node].potential, self._axis.potential(middle)) is None:
                new_node, potential = middle, self._axis.potential(middle)
            else:
                self._nodes[middle] = self._find_member(middle, node)
                node = middle
        self._nodes[new_node] = self._find_member(new_node, node)

    def _find_member(self, value: float, node: float) -> Member:
        """Search the exits at a value. Exits that also exist at a node keep their numbers, and other exits get new numbers."""
        self._search_count += 1
        if self._search_count > self._most_searches:
            raise ManyExitsError(
                f"parameter {self._axis.key}: its exits change too often up to {value:.6g}; choose a smaller range"
            )
        potential, neighbour = self._axis.potential(value), self._nodes[node]
        # 0 stands for an exit without a number.
        numbers = np.array([*np.zeros(potential.channels + 1), *neighbour.other_fates], np.int8)
        for channel, position in enumerate(_continue_points(potential, neighbour.potential.saddles), start=1):
            k = _index_at(potential.saddles, position)
            if k is not None and not numbers[k + 1]:
                numbers[k + 1] = neighbour.numbers[channel]
        new_channels = np.flatnonzero(numbers[1:] == 0) + 1
        numbers[new_channels] = len(self.outcomes) + 1 + np.arange(new_channels.size)
        exit_count = sum(outcome.kind is Exit for outcome in self.outcomes)
        self.outcomes += tuple(Exit.outcome(exit_count + k) for k in range(1, new_channels.size + 1))
        return Member(potential, read_only(numbers))

    def _match_nodes(self, low: float, high: float) -> list[int] | None:
        """Return `_match_exits` of two nodes, computed once for each pair of nodes."""
        if (low, high) not in self._node_matches:
            self._node_matches[low, high] = _match_exits(self._nodes[low].potential, self._nodes[high].potential)
        return self._node_matches[low, high]

    def _interpolate_member(self, value: float, low: float, high: float) -> Member | None:
        """Continue the saddles of two nodes to a value between them; None if the exits of the nodes differ."""
        low_member, high_member = self._nodes[low], self._nodes[high]
        matches = self._match_nodes(low, high)
        if matches is None:
            return None
        mergers = _match_mergers(low_member.potential, high_member.potential, matches)
        if mergers is None:
            return None
        share = (value - low) / (high - low)
        unsearched = self._axis.potential(value)
        guesses = (1.0 - share) * low_member.potential.saddles + share * high_member.potential.saddles[np.array(matches, int)]
        saddles = _continue_points(unsearched, guesses)
        maxima = np.empty((0, 2))
        for low_merger, high_merger in mergers:
            guess = (1.0 - share) * np.array([[low_merger.x, low_merger.y]]) + share * np.array([[high_merger.x, high_merger.y]])
            maxima = np.concatenate([maxima, _continue_points(unsearched, guess)])
        if not (np.isfinite(saddles).all() and np.isfinite(maxima).all()):
            return None
        saddle_indices = [[channel - 1 for channel in merger.channels] for merger, _ in mergers]
        potential = unsearched.continued(repr(self._axis), saddles, maxima, saddle_indices)
        # The potential sorts its saddles anew.
        indices = [_index_at(saddles, position) for position in potential.saddles]
        if None in indices or len(set(indices)) < len(saddles):
            return None
        numbers = np.array([0, *(low_member.numbers[k + 1] for k in indices if k is not None), *low_member.other_fates], np.int8)
        return Member(potential, read_only(numbers))


@functools.lru_cache(maxsize=256)
def parameter_family(axis: ParameterAxis) -> ParameterFamily:
    """Return the family of an axis. The search takes up to a second, or less if the nodes are stored on disk."""
    return ParameterFamily(axis)


def find_members(axis: ParameterAxis) -> None:
    """Find potentials along a whole axis and store their critical points on disk, so that later searches take little time.

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
            # This ValueError concerns the whole axis.
            raise
        except ValueError:
            # The system has no potential there, so the line of the map remains empty.
            continue


def _match_exits(first: Potential, last: Potential) -> list[int] | None:
    """Return, for each exit saddle of the first potential, the index of the saddle of the last; None unless all match."""
    if first.channels != last.channels:
        return None
    nearest = [_index_at(last.saddles, position) for position in _continue_points(last, first.saddles)]
    matches = [k for k in nearest if k is not None]
    return matches if len(set(matches)) == first.channels else None


def _match_mergers(first: Potential, last: Potential, matches: Sequence[int]) -> list[tuple[ChannelMerger, ChannelMerger]] | None:
    """Pair the mergers of two potentials between the same exits, given the result of `_match_exits`; None unless all match."""
    first_mergers, last_mergers = first.well.channel_mergers, last.well.channel_mergers
    by_channels = {frozenset(merger.channels): merger for merger in reversed(last_mergers)}
    images = [by_channels.get(frozenset(matches[k - 1] + 1 for k in merger.channels)) for merger in first_mergers]
    pairs = [(merger, image) for merger, image in zip(first_mergers, images, strict=True) if image is not None]
    return pairs if len(first_mergers) == len(last_mergers) == len(pairs) else None


def _continue_points(potential: Potential, points: np.ndarray) -> np.ndarray:
    """Continue critical points (n, 2) of another potential to this one by Newton's method; NaN where a point is not found."""
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
        has_converged = np.hypot(*step.T) <= _TOLERANCE * np.hypot(*points.T)
        is_near = np.hypot(*(points - start).T) <= _LARGEST_MOVE * _separation(start)
    return np.where((has_converged & is_near)[:, None], points, np.nan)


def _separation(points: np.ndarray) -> np.ndarray:
    """Return the distance from each point to the nearest other point or to the origin, of shape (n,)."""
    targets = np.concatenate([points, np.zeros((1, 2))])
    distances = np.hypot(*np.moveaxis(points[:, None] - targets, -1, 0))
    distances[np.arange(len(points)), np.arange(len(points))] = np.inf
    return distances.min(axis=1)


def _index_at(points: Sequence[np.ndarray] | np.ndarray, position: np.ndarray) -> int | None:
    """Return the index of the point at a position, within `_SAME_TOLERANCE`; None if no point is there."""
    if not len(points) or not np.isfinite(position).all():
        return None
    distances = np.hypot(*(np.asarray(points) - position).T)
    k = int(np.argmin(distances))
    return k if distances[k] <= _SAME_TOLERANCE * np.hypot(*position) else None
