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
from engine.integrator.kernels.dense_output import sample_path
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
# Largest speed at the second end of a trial orbit that is corrected later.
_LARGEST_ROUGH_SPEED = 1e-3
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
    """A trial orbit: the integrator's steps, (n, 5) states and times at which they begin, and its duration."""

    steps: np.ndarray
    half_period: float


def saddle_axes(potential: Potential, channel: int) -> Axes:
    """Return axes with a saddle as origin and its unstable direction as outward direction."""
    return Axes(potential.saddles[channel - 1], potential.well.outward_directions[channel - 1])


def chord_axes(path: np.ndarray) -> Axes:
    """Return axes with q along the line between the ends of a path (2, n), and the origin near its first end."""
    chord = path[:, -1] - path[:, 0]
    return Axes(path[:, 0] + _LINE_START * chord, np.array([chord[1], -chord[0]]) / np.hypot(*chord))


def find_directly(potential: Potential, energy: float, channel: int) -> BrakeOrbit | None:
    """Return the orbit over a saddle at one energy, searched from the saddle; None if it is not found."""
    axes = saddle_axes(potential, channel)
    orbit = _shoot(potential, energy, channel, axes, _saddle_search(potential, channel))
    if orbit is None:
        return None
    # A start on a wall of another channel leads to an orbit across that channel.
    _, q = axes.coordinates(orbit.path)
    return orbit if q[0] < 0.0 < q[-1] else None


def find_roughly(potential: Potential, energy: float, channel: int, count: int) -> Iterator[tuple[float, np.ndarray]]:
    """Yield half a period and states (count, 4), evenly spaced over it, of trial orbits over a saddle from either of its walls.

    Errors grow along a very unstable orbit. These trial orbits are only nearly at rest at their ends.
    """
    for direction in (1.0, -1.0):
        axes = Axes(potential.saddles[channel - 1], direction * saddle_axes(potential, channel).outward)
        trials = _Trials(potential, energy, axes, _LARGEST_EXCURSION * _saddle_distance(potential, channel))
        bracket = _find_bracket(trials.outward_velocity, _saddle_search(potential, channel))
        shot = None if bracket is None else trials.shoot(bracket, _LARGEST_ROUGH_SPEED)
        if shot is not None:
            yield shot.half_period, sample_path(potential.well.kernels, shot.steps, np.linspace(0.0, shot.half_period, count)).T


def find_from_outside(potential: Potential, energy: float, axes: Axes, search_size: float) -> Iterator[BrakeOrbit]:
    """Yield the orbits from a wall at q < 0 to a wall at q > 0, the outermost first.

    `search_size` is the unit of the lengths of the search: the distance of the outermost saddle from the origin.
    """
    trials = _Trials(potential, energy, axes, _LARGEST_MOVE * search_size)
    offsets = _FARTHEST_START * search_size * np.linspace(1.0, -1.0, _STARTS)
    velocities = [trials.outward_velocity(u) for u in offsets.tolist()]
    for k in range(_STARTS - 1):
        if velocities[k] > 0.0 > velocities[k + 1]:
            orbit = trials.solve((float(offsets[k + 1]), float(offsets[k])))
            if orbit is not None:
                yield orbit


def continue_in_energy(potential: Potential, energy: float, channel: int) -> BrakeOrbit | None:
    """Follow the orbit over a saddle from small oscillations up to an energy with an adaptive step; None if this fails."""
    saddle_energy = float(potential.well.saddle_energies[channel - 1])
    height = energy - saddle_energy

    # The continuation begins without an orbit, at the energy of the saddle.
    def advance(orbit: BrakeOrbit | None, target: float) -> BrakeOrbit | None:
        return _next_orbit(potential, target, channel, orbit) if orbit else find_directly(potential, target, channel)

    limits = StepLimits(_FIRST_ENERGY_STEP * height, _SMALLEST_ENERGY_STEP * height, _MOST_ENERGY_STEPS)
    return follow(advance, None, saddle_energy, energy, limits)


def _next_orbit(potential: Potential, energy: float, channel: int, previous: BrakeOrbit) -> BrakeOrbit | None:
    """Continue the previous orbit to a nearby energy; None if the orbit found there is not close to the previous orbit."""
    ends = previous.path[:, [0, -1]]
    length = float(np.hypot(*(ends[:, 1] - ends[:, 0])))
    search = _Search(_FIRST_SHIFT * length, _LARGEST_SHIFT * length)
    orbit = _shoot(potential, energy, channel, chord_axes(previous.path), search)
    if orbit is None:
        return None
    move = float(np.hypot(*(orbit.path[:, [0, -1]] - ends)).max()) / length
    change = abs(orbit.half_period - previous.half_period) / previous.half_period
    return orbit if max(move, change) < _LARGEST_CHANGE else None


def _saddle_search(potential: Potential, channel: int) -> _Search:
    distance = _saddle_distance(potential, channel)
    return _Search(_FIRST_STRIDE * distance, _LARGEST_OFFSET * distance)


def _saddle_distance(potential: Potential, channel: int) -> float:
    return float(np.hypot(*potential.saddles[channel - 1]))


def _shoot(potential: Potential, energy: float, channel: int, axes: Axes, search: _Search) -> BrakeOrbit | None:
    """Return the orbit whose start is nearest to the origin of the axes along the channel; None if it is not found."""
    trials = _Trials(potential, energy, axes, _LARGEST_EXCURSION * _saddle_distance(potential, channel))
    bracket = _find_bracket(trials.outward_velocity, search)
    return None if bracket is None else trials.solve(bracket)


class _Trials:
    """Shoots orbits from rest on the wall at q < 0 in some axes, and follows them along the channel as far as `reach`."""

    def __init__(self, potential: Potential, energy: float, axes: Axes, reach: float) -> None:
        self._kernels, self._steps = potential.well.kernels, np.empty((_MOST_STEPS, 5))
        self._arguments = (*axes.origin, *axes.outward, energy, reach, TOLERANCE, self._steps)

    def outward_velocity(self, u: float) -> float:
        """Return the velocity along the channel at the turning point, after a start at rest at offset u."""
        return float(self._kernels.shoot(u, *self._arguments)[0])

    def solve(self, bracket: tuple[float, float]) -> BrakeOrbit | None:
        """Return the orbit that starts between two offsets and ends at rest; None if no orbit does."""
        shot = self.shoot(bracket, _LARGEST_END_SPEED)
        if shot is None:
            return None
        coefficients = np.empty((2, ORDER + 1, len(shot.steps)))
        self._kernels.jets(len(shot.steps), *(np.ascontiguousarray(column) for column in shot.steps[:, :4].T), *coefficients)
        begins = shot.steps[:, 4]
        times = np.linspace(0.0, shot.half_period, _INTERVALS_PER_HALF_PERIOD + 1)
        step = np.searchsorted(begins, times, side="right") - 1
        powers = (times - begins[step]) ** np.arange(ORDER + 1)[:, None]
        return BrakeOrbit(shot.half_period, (coefficients[:, :, step] * powers).sum(axis=1))

    def shoot(self, bracket: tuple[float, float], largest_speed: float) -> _Shot | None:
        """Return the trial orbit that starts between two offsets and ends slower than `largest_speed`; None if none does."""
        try:
            u = find_root(self.outward_velocity, *bracket, xtol=1e-17)
        except ValueError:
            # A trial orbit between the two offsets does not turn, so its velocity is NaN.
            return None
        velocity, half_period, count = self._kernels.shoot(u, *self._arguments)
        if not (np.isfinite(half_period) and abs(velocity) < largest_speed):
            return None
        return _Shot(self._steps[:count].copy(), half_period)


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
