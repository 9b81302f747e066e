"""Orbits over a saddle between two points at rest on the zero-velocity curve, found by shooting and by continuation in energy.

At an energy h above the saddle, such a brake orbit oscillates between two points where it is at rest (Contopoulos 1990, Astron.
Astrophys. 231, 41). A trial orbit that starts at rest on the zero-velocity curve moves inward if its start is too close to the
well, and outward if its start is too far out. In between is the start for which the velocity along the channel is 0 at the
turning point across the channel. The zero-velocity curve along a side of the channel is a wall. All quantities are in units of
the well.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from engine.exits.saddle_orbits.continuation import StepLimits, follow
from engine.foundations.root_finding import find_root
from engine.integrator.source.recurrence import TOLERANCE
from engine.integrator.source.series import ORDER
from engine.systems.potential import Potential

# Lengths of the search from the saddle along the channel, in units of the distance of the saddle from the origin.

# Distance from the saddle beyond which a trial orbit has left the saddle.
_LARGEST_EXCURSION = 1.0
# First step of the bracket search.
_FIRST_STRIDE = 0.01
# End of the bracket search.
_LARGEST_OFFSET = 2.0

# Lengths of the search from outside, see `find_from_outside`.

# Number of starts.
_STARTS = 241
# Farthest start along the channel, in units of `search_size`.
_FARTHEST_START = 1.5
# Distance moved along the channel with which a trial orbit has left, in the same unit.
_LARGEST_MOVE = 0.6

# Lengths of the continuation, in units of the distance between the ends of the preceding orbit.

# Distance from the first end at which the line to the zero-velocity curve begins.
_LINE_START = 0.1
# First step of the bracket search.
_FIRST_SHIFT = 1e-4
# End of the bracket search.
_LARGEST_SHIFT = 0.2
# Largest relative change of the ends and of the period; a larger change can be a jump to another orbit.
_LARGEST_CHANGE = 0.15
# First step of the energy, in units of its height above the saddle.
_FIRST_ENERGY_STEP = 2.0**-4
# Smallest step of the energy, in the same unit.
_SMALLEST_ENERGY_STEP = 2.0**-14
_MOST_ENERGY_STEPS = 256

# Largest speed at the second end, in units of the well. A root with a larger speed is a discontinuity of the velocity.
_LARGEST_END_SPEED = 1e-8
# Largest speed at the second end of a shot that is joined with another.
_LARGEST_JOINED_END_SPEED = 1e-3
# Largest distance between two shots where they are joined, in units of the well.
_LARGEST_MISMATCH = 1e-8
# Two shots that are joined are compared up to this share of the half period before and after the middle.
_OVERLAP = 0.05
# The path of half a period has one point more.
_INTERVALS_PER_HALF_PERIOD = 100
# Largest number of integrator steps of a trial orbit.
_MOST_STEPS = 400


class BrakeOrbit(NamedTuple):
    """Half a period of an orbit between two points at rest.

    Attributes
    ----------
    half_period
        Duration of the half period, dimensionless.
    path
        (2, 101) x and y, evenly spaced in time, with the well on the left.
    inner_states
        See `LyapunovOrbit.inner_states`.
    """

    half_period: float
    path: np.ndarray
    inner_states: np.ndarray = np.empty((0, 4))


class Axes(NamedTuple):
    """Coordinates u, q of a channel: u along the unit vector `outward`, (2,), from `origin`, (2,), and q 90° to the left of u."""

    origin: np.ndarray
    outward: np.ndarray

    def coordinates(self, path: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return u and q of a path of shape (2, n)."""
        dx, dy = path[0] - self.origin[0], path[1] - self.origin[1]
        return self.outward[0] * dx + self.outward[1] * dy, self.outward[0] * dy - self.outward[1] * dx

    @property
    def across(self) -> np.ndarray:
        """The direction of q, (2,)."""
        return np.array([-self.outward[1], self.outward[0]])

    def points(self, u: np.ndarray, q: np.ndarray) -> np.ndarray:
        """Return x and y of the points at u and q, of shape (2, …)."""
        return np.moveaxis(self.origin + u[..., None] * self.outward + q[..., None] * self.across, -1, 0)


class _Search(NamedTuple):
    """Lengths of a bracket search along the channel: its first step and its largest distance from the origin of the axes."""

    stride: float
    farthest: float


class _Shot(NamedTuple):
    """A trial orbit of n steps, at rest at its start and nearly at rest at its end.

    `coefficients`, (2, ORDER + 1, n), are the Taylor coefficients of x and y; `begins`, (n,), are the times at which steps begin.
    """

    coefficients: np.ndarray
    begins: np.ndarray
    half_period: float

    @property
    def orbit(self) -> BrakeOrbit:
        return BrakeOrbit(self.half_period, self.path)

    @property
    def path(self) -> np.ndarray:
        """(2, 101) x and y, evenly spaced in time."""
        return self.positions(np.linspace(0.0, self.half_period, _INTERVALS_PER_HALF_PERIOD + 1))

    def positions(self, times: np.ndarray) -> np.ndarray:
        """Return x and y at m `times`, of shape (2, m)."""
        step = np.searchsorted(self.begins, times, side="right") - 1
        powers = (times - self.begins[step]) ** np.arange(ORDER + 1)[:, None]
        return (self.coefficients[:, :, step] * powers).sum(axis=1)


def saddle_axes(potential: Potential, channel: int) -> Axes:
    """Return axes with a saddle as origin and its unstable direction as outward direction."""
    return Axes(potential.saddles[channel - 1], potential.well.outward_directions[channel - 1])


def chord_axes(path: np.ndarray) -> Axes:
    """Return axes with q along the line between the ends of a path (2, n), and the origin near its first end."""
    chord = path[:, -1] - path[:, 0]
    return Axes(path[:, 0] + _LINE_START * chord, np.array([chord[1], -chord[0]]) / np.hypot(*chord))


def find_directly(potential: Potential, energy: float, channel: int) -> BrakeOrbit | None:
    """Return the orbit over a saddle at one energy, searched from the saddle; None if it is not found."""
    shot = _find_from_saddle(potential, energy, channel, saddle_axes(potential, channel), _LARGEST_END_SPEED)
    return None if shot is None else shot.orbit


def find_from_both_ends(potential: Potential, energy: float, channel: int) -> BrakeOrbit | None:
    """Return the orbit over a saddle at one energy, shot from both ends and joined in its middle; None if it is not found.

    Errors of a shot then grow over only a quarter of a period. The zero-velocity curve may also bend away at the first end.
    """
    axes = saddle_axes(potential, channel)
    # With reversed axes, the shot starts at the second end.
    backward = _find_from_saddle(potential, energy, channel, Axes(axes.origin, -axes.outward), _LARGEST_JOINED_END_SPEED)
    if backward is None:
        return None
    path = backward.path[:, ::-1]
    forward = _shoot(potential, energy, channel, chord_axes(path), _chord_search(path), _LARGEST_JOINED_END_SPEED)
    return None if forward is None else _join(forward, backward, chord_axes(path))


def find_from_outside(potential: Potential, energy: float, axes: Axes, search_size: float) -> Iterator[BrakeOrbit]:
    """Yield the orbits from a wall at q < 0 to a wall at q > 0, the outermost first.

    `search_size` is the unit of the lengths of the search: the distance of the outermost saddle from the origin.
    """
    trials = _Trials(potential, energy, axes, _LARGEST_MOVE * search_size)
    offsets = _FARTHEST_START * search_size * np.linspace(1.0, -1.0, _STARTS)
    velocities = [trials.outward_velocity(u) for u in offsets.tolist()]
    for k in range(_STARTS - 1):
        if velocities[k] > 0.0 > velocities[k + 1]:
            shot = trials.solve((float(offsets[k + 1]), float(offsets[k])), _LARGEST_END_SPEED)
            if shot is not None:
                yield shot.orbit


def continue_in_energy(potential: Potential, energy: float, channel: int) -> BrakeOrbit | None:
    """Follow the orbit over a saddle from small oscillations up to an energy with an adaptive step; None if this fails."""
    saddle_energy = float(potential.well.saddle_energies[channel - 1])
    height = energy - saddle_energy

    # The continuation begins without an orbit, at the energy of the saddle.
    def advance(orbit: BrakeOrbit | None, target: float) -> BrakeOrbit | None:
        return _next_orbit(potential, target, channel, orbit) if orbit else find_directly(potential, target, channel)

    limits = StepLimits(_FIRST_ENERGY_STEP * height, _SMALLEST_ENERGY_STEP * height, _MOST_ENERGY_STEPS)
    return follow(advance, None, saddle_energy, energy, limits)


def _find_from_saddle(potential: Potential, energy: float, channel: int, axes: Axes, largest_speed: float) -> _Shot | None:
    """Return the orbit from a point with q < 0 in axes at the saddle to a point with q > 0; None if it is not found."""
    saddle_distance = _saddle_distance(potential, channel)
    search = _Search(_FIRST_STRIDE * saddle_distance, _LARGEST_OFFSET * saddle_distance)
    shot = _shoot(potential, energy, channel, axes, search, largest_speed)
    if shot is None:
        return None
    # A start on a wall of another channel leads to an orbit across that channel.
    _, q = axes.coordinates(shot.path)
    return shot if q[0] < 0.0 < q[-1] else None


def _join(forward: _Shot, backward: _Shot, axes: Axes) -> BrakeOrbit | None:
    """Join two shots from both ends to an orbit; None if they do not meet in the middle."""
    path, reversed_path = forward.path, backward.path[:, ::-1]
    if np.abs((path - reversed_path)[:, [0, -1]]).max() > _LARGEST_CHANGE * _chord_length(reversed_path):
        return None
    first_q, last_q = axes.coordinates(path)[1][0], axes.coordinates(reversed_path)[1][-1]
    middle_q = 0.5 * (first_q + last_q)
    forward_duration, backward_duration = _time_at(middle_q, forward, axes), _time_at(middle_q, backward, axes)
    half_period = forward_duration + backward_duration
    overlap = forward_duration + _OVERLAP * half_period * np.linspace(-1.0, 1.0, 11)
    # `not … <` also rejects NaN.
    if not np.abs(forward.positions(overlap) - backward.positions(half_period - overlap)).max() < _LARGEST_MISMATCH:
        return None
    times = np.linspace(0.0, half_period, _INTERVALS_PER_HALF_PERIOD + 1)
    path = np.where(times < forward_duration, forward.positions(times), backward.positions(half_period - times))
    return BrakeOrbit(half_period, path)


def _time_at(q: float, shot: _Shot, axes: Axes) -> float:
    """Return the time at which a trial orbit passes q."""

    def distance(time: float) -> float:
        return float(axes.coordinates(shot.positions(np.array([time])))[1][0]) - q

    return find_root(distance, 0.0, shot.half_period, xtol=1e-15)


def _next_orbit(potential: Potential, energy: float, channel: int, previous: BrakeOrbit) -> BrakeOrbit | None:
    """Continue the previous orbit to a nearby energy; None if the orbit found there is not close to the previous orbit."""
    ends = previous.path[:, [0, -1]]
    shot = _shoot(potential, energy, channel, chord_axes(previous.path), _chord_search(previous.path), _LARGEST_END_SPEED)
    if shot is None:
        return None
    orbit, length = shot.orbit, _chord_length(previous.path)
    move = float(np.hypot(*(orbit.path[:, [0, -1]] - ends)).max()) / length
    change = abs(orbit.half_period - previous.half_period) / previous.half_period
    return orbit if max(move, change) < _LARGEST_CHANGE else None


def _chord_length(path: np.ndarray) -> float:
    return float(np.hypot(*(path[:, -1] - path[:, 0])))


def _chord_search(path: np.ndarray) -> _Search:
    length = _chord_length(path)
    return _Search(_FIRST_SHIFT * length, _LARGEST_SHIFT * length)


def _saddle_distance(potential: Potential, channel: int) -> float:
    return float(np.hypot(*potential.saddles[channel - 1]))


def _shoot(potential: Potential, energy: float, channel: int, axes: Axes, search: _Search, largest_speed: float) -> _Shot | None:
    """Return the orbit whose start is nearest to the origin of the axes along the channel; None if it is not found."""
    trials = _Trials(potential, energy, axes, _LARGEST_EXCURSION * _saddle_distance(potential, channel))
    bracket = _find_bracket(trials.outward_velocity, search)
    return None if bracket is None else trials.solve(bracket, largest_speed)


class _Trials:
    """Shoots orbits from rest on the wall at q < 0 in some axes, and follows them along the channel as far as `reach`."""

    def __init__(self, potential: Potential, energy: float, axes: Axes, reach: float) -> None:
        self._kernels, self._steps = potential.well.kernels, np.empty((_MOST_STEPS, 5))
        self._arguments = (*axes.origin, *axes.outward, energy, reach, TOLERANCE, self._steps)

    def outward_velocity(self, u: float) -> float:
        """Return the velocity along the channel at the turning point, after a start at rest at offset u."""
        return float(self._kernels.shoot(u, *self._arguments)[0])

    def solve(self, bracket: tuple[float, float], largest_speed: float) -> _Shot | None:
        """Return the orbit that starts between two offsets and ends slower than `largest_speed`; None if no orbit does."""
        try:
            u = find_root(self.outward_velocity, *bracket, xtol=1e-17)
        except ValueError:
            # A trial orbit between the two offsets does not turn, so its velocity is NaN.
            return None
        velocity, half_period, count = self._kernels.shoot(u, *self._arguments)
        if not (np.isfinite(half_period) and abs(velocity) < largest_speed):
            return None
        coefficients = np.empty((2, ORDER + 1, count))
        self._kernels.jets(count, *(np.ascontiguousarray(column) for column in self._steps[:count, :4].T), *coefficients)
        return _Shot(coefficients, self._steps[:count, 4].copy(), half_period)


def _find_bracket(outward_velocity: Callable[[float], float], search: _Search) -> tuple[float, float] | None:
    """Return the offsets of a start that moves inward and of a start farther out that moves outward; None if none are found."""
    offset, stride = 0.0, search.stride
    first_velocity = outward_velocity(offset)
    if np.isnan(first_velocity):
        return None
    moves_inward = first_velocity < 0
    while abs(offset) < search.farthest:
        next_offset = offset + stride if moves_inward else offset - stride
        velocity = outward_velocity(next_offset)
        if np.isnan(velocity):
            return None
        if (velocity < 0) != moves_inward:
            return (offset, next_offset) if moves_inward else (next_offset, offset)
        offset, stride = next_offset, 1.5 * stride
    return None
