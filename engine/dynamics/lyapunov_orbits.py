"""Lyapunov orbits: the unstable periodic orbits over the open saddles. Their paths across the channels are the exits.

At an energy h above the saddle the orbit oscillates between two points at rest on the zero-velocity curve (Contopoulos 1990,
Astron. Astrophys. 231, 41). An orbit that starts at rest on the zero-velocity curve too close to the well moves inward, one that
starts too far out moves outward. The Lyapunov orbit is the root of the velocity along the channel at the turning point.
"""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np
from numpy.polynomial import chebyshev
from scipy import optimize

from engine.arrays import read_only
from engine.dynamics.compiled import kernels_of
from engine.potentials.potential import Potential
from engine.potentials.well_units import WellUnits, nearest_power_of_two
from engine.taylor.kernels import events
from engine.taylor.source.recurrence import ORDER, TOLERANCE
from engine.validation import checked_number

# Lengths along the channel, in units of the distance of the saddle from the origin: where a trial orbit has left the saddle for
# good, the first step of the bracket search, and where this search ends.
_LARGEST_EXCURSION = 1.0
_FIRST_STRIDE = 0.01
_LARGEST_OFFSET = 2.0

_SAMPLES_PER_HALF_PERIOD = 100
_LARGEST_FIT_ERROR = 1e-11
# Distance of a gate from the exit, in units of the distance of the saddle rounded to a power of 2.
_GATE_MARGIN = 1e-3
_MOST_STEPS = 400
# Half the length of the line across a closed saddle, in units of the saddle's distance from the origin.
_CLOSED_HALF_WIDTH = 1e-3
# The lines beyond the ends of an exit are sampled from this |s| − 1 on.
_FIRST_BEYOND, _SAMPLES_BEYOND = 1e-3, 400


@dataclass(frozen=True, eq=False)
class LyapunovOrbit:
    """One Lyapunov orbit; lengths and times are dimensionless. The arrays are read-only.

    Attributes
    ----------
    channel
        Number of its exit channel, from 1.
    energy
        Its energy h.
    period
        Its period.
    x, y
        (201,) path over one period, evenly spaced in time, from rest on one side of the channel to the other and back; the first
        and the last point are equal.
    curve
        (columns,) the exit curve for the kernels; columns as in `engine.taylor.kernels.events`.
    """

    channel: int
    energy: float
    period: float
    x: np.ndarray
    y: np.ndarray
    curve: np.ndarray

    def __post_init__(self) -> None:
        for array in (self.x, self.y, self.curve):
            read_only(array)

    @property
    def half_path(self) -> np.ndarray:
        """(101, 2) the path over half a period, from one side of the channel to the other, for plots."""
        return np.column_stack([self.x, self.y])[: self.x.size // 2 + 1]


def find_lyapunov_orbits(potential: Potential, energy: float) -> tuple[LyapunovOrbit, ...]:
    """The Lyapunov orbit over each saddle below `energy`.

    Parameters
    ----------
    potential
        Any `Potential`.
    energy
        h, finite, dimensionless; tested up to 0.5 for cases I and II and up to 1.0 for case III.

    Returns
    -------
    The orbits in channel order; empty at or below the escape energy.

    Raises
    ------
    ValueError
        If `energy` is not finite, or so high that a Lyapunov orbit is not found or not a graph across its channel, or that
        exits meet.
    """
    energy, units = checked_number("energy", energy), potential.units
    try:
        orbits = _find_orbits(potential.in_well_units, energy / units.energy)
    except _SearchError as error:
        raise ValueError(f"energy={energy}: {error} (potential {potential.name})") from None
    return orbits if units == WellUnits() else tuple(_rescaled(orbit, units) for orbit in orbits)


class _SearchError(Exception):
    """A Lyapunov orbit that was not found or cannot be used as an exit."""


@functools.lru_cache(maxsize=4096)
def _find_orbits(potential: Potential, energy: float) -> tuple[LyapunovOrbit, ...]:
    """The orbits of a potential in units of its well; those of mirror channels are exact mirror images."""
    found: dict[int, LyapunovOrbit] = {}
    for channel in potential.open_channels(energy):
        image = int(potential.mirror_channels[channel]) if potential.mirror_in_x else channel
        found[channel] = _mirrored(found[image], channel) if image in found else _find_orbit(potential, energy, channel)
        if image == channel and potential.mirror_in_x:
            found[channel] = _symmetrized(found[channel])
    orbits = tuple(found.values())
    _check_exits_apart(orbits)
    return orbits


def _rescaled(orbit: LyapunovOrbit, units: WellUnits) -> LyapunovOrbit:
    """An orbit in units of the well, converted to the units of its potential without rounding."""
    length = units.length
    curve = orbit.curve * length
    directions = slice(events.OUTWARD_X, events.OPEN + 1)
    curve[directions] = orbit.curve[directions]
    energy, period = orbit.energy * units.energy, orbit.period * units.time
    return LyapunovOrbit(orbit.channel, energy, period, orbit.x * length, orbit.y * length, curve)


def _check_exits_apart(orbits: tuple[LyapunovOrbit, ...]) -> None:
    for one, other in itertools.combinations(orbits, 2):
        if _paths_cross(one.half_path, other.half_path):
            raise _SearchError(f"too high, the exits of channels {one.channel} and {other.channel} meet")


def _paths_cross(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two polygonal lines, (n, 2) and (m, 2), intersect."""
    if np.any(one.max(axis=0) < other.min(axis=0)) or np.any(other.max(axis=0) < one.min(axis=0)):
        return False

    def sides(line: np.ndarray, points: np.ndarray) -> np.ndarray:
        """(segments, points) on which side of each segment of a line the points lie."""
        along, apart = np.diff(line, axis=0)[:, None], points - line[:-1, None]
        left: np.ndarray = along[..., 0] * apart[..., 1] > along[..., 1] * apart[..., 0]
        return left

    first, second = sides(one, other), sides(other, one).T
    return bool(np.any((first[:, 1:] != first[:, :-1]) & (second[1:] != second[:-1])))


def _mirrored(orbit: LyapunovOrbit, channel: int) -> LyapunovOrbit:
    """The exact image under x → −x, so that mirror images of orbits escape at exactly the same time."""
    return LyapunovOrbit(channel, orbit.energy, orbit.period, -orbit.x, orbit.y, _mirrored_curve(orbit.curve))


def _mirrored_curve(curve: np.ndarray) -> np.ndarray:
    """An exit curve in the axes of the mirrored saddle, where u is unchanged and q has the opposite sign."""
    image = curve.copy()
    image[[events.SADDLE_X, events.OUTWARD_X, events.BEARING_X, events.MIDDLE]] *= -1.0
    image[[events.SLOPE_LOW, events.SLOPE_HIGH]] = -curve[[events.SLOPE_HIGH, events.SLOPE_LOW]]
    image[events.COEFFICIENTS + 1 :: 2] *= -1.0
    return image


def _symmetrized(orbit: LyapunovOrbit) -> LyapunovOrbit:
    """An orbit over a saddle on the y axis, with an exit curve that is exactly symmetric."""
    return replace(orbit, curve=0.5 * (orbit.curve + _mirrored_curve(orbit.curve)))


def _find_orbit(potential: Potential, energy: float, channel: int) -> LyapunovOrbit:
    kernels = kernels_of(potential)
    saddle, outward = potential.saddles[channel - 1], potential.outward_directions[channel - 1]
    distance = float(np.hypot(*saddle))
    steps = np.empty((_MOST_STEPS, 5))
    arguments = (*saddle, *outward, energy, _LARGEST_EXCURSION * distance, TOLERANCE, steps)

    def outward_velocity(u: float) -> float:
        """The velocity along the channel at the turning point, after a start at rest at offset u from the saddle."""
        return float(kernels.shoot(u, *arguments)[0])

    bracket = _find_bracket(outward_velocity, distance)
    if bracket is None:
        raise _SearchError(f"too high, no Lyapunov orbit was found across channel {channel}; choose a lower energy")
    u = optimize.brentq(outward_velocity, *bracket, xtol=1e-17, rtol=4 * np.finfo(float).eps)
    _, half_period, count = kernels.shoot(u, *arguments)
    if not np.isfinite(half_period):
        raise _SearchError(f"the Lyapunov orbit of channel {channel} does not turn back")
    x, y = _sample_path(kernels, steps[:count], half_period)
    curve = _fit_exit_curve(saddle, outward, x, y)
    if curve is None:
        raise _SearchError(f"too high, across channel {channel} the Lyapunov orbit is not a smooth graph and defines no exit")
    curve[events.REACH] = _find_reach(potential, energy, curve)
    there_and_back = np.concatenate([np.arange(x.size), np.arange(x.size - 1)[::-1]])
    return LyapunovOrbit(channel, energy, 2.0 * half_period, x[there_and_back], y[there_and_back], curve)


def _find_bracket(outward_velocity: Callable[[float], float], distance: float) -> tuple[float, float] | None:
    """An inner start that moves inward and an outer one that moves outward, searched from the saddle with growing strides."""
    here, stride = 0.0, _FIRST_STRIDE * distance
    first = outward_velocity(here)
    if np.isnan(first):
        return None
    inward = first < 0
    while abs(here) < _LARGEST_OFFSET * distance:
        there = here + stride if inward else here - stride
        velocity = outward_velocity(there)
        if np.isnan(velocity):
            return None
        if (velocity < 0) != inward:
            return (here, there) if inward else (there, here)
        here, stride = there, 1.5 * stride
    return None


def _sample_path(kernels: ModuleType, steps: np.ndarray, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """x and y (101,) at evenly spaced times from 0 to `duration`, from the Taylor series of the steps (x, y, px, py, t)."""
    x_jet, y_jet = np.empty((2, ORDER + 1, len(steps)))
    kernels.jets(len(steps), *(np.ascontiguousarray(column) for column in steps[:, :4].T), x_jet, y_jet)
    times = np.linspace(0.0, duration, _SAMPLES_PER_HALF_PERIOD + 1)
    row = np.searchsorted(steps[:, 4], times, side="right") - 1
    tau = times - steps[row, 4]
    powers = tau ** np.arange(ORDER + 1)[:, None]
    return (x_jet[:, row] * powers).sum(axis=0), (y_jet[:, row] * powers).sum(axis=0)


def _fit_exit_curve(saddle: np.ndarray, outward: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray | None:
    """The path as a graph u = f(s), s ∈ [−1, 1]; None if it is not a graph or not smooth enough for the fit."""
    u = outward[0] * (x - saddle[0]) + outward[1] * (y - saddle[1])
    q = outward[0] * (y - saddle[1]) - outward[1] * (x - saddle[0])
    middle, half_width = 0.5 * (q[0] + q[-1]), 0.5 * (q[-1] - q[0])
    s = (q - middle) / half_width
    if np.any(np.diff(s) <= 0):
        return None
    basis = chebyshev.chebvander(s, events.CURVE_DEGREE)
    fit = np.linalg.lstsq(basis, u, rcond=None)[0]
    if np.max(np.abs(basis @ fit - u)) > _LARGEST_FIT_ERROR:
        return None
    end_slopes = chebyshev.chebval([-1.0, 1.0], chebyshev.chebder(fit))
    curve = _straight_curve(saddle, outward)
    curve[events.OPEN] = 1.0
    curve[events.MIDDLE : events.SLOPE_HIGH + 1] = middle, half_width, *end_slopes
    curve[events.COEFFICIENTS :] = fit
    return curve


def _find_reach(potential: Potential, energy: float, curve: np.ndarray) -> float:
    """The |s| up to which a crossing counts: half of the way along the straight lines beyond the ends to where V ≤ h again."""
    reach = np.inf
    saddle, outward = curve[[events.SADDLE_X, events.SADDLE_Y]], curve[[events.OUTWARD_X, events.OUTWARD_Y]]
    farthest = _LARGEST_OFFSET * max(float(np.hypot(*saddle)) / curve[events.HALF_WIDTH], 1.0)
    beyond = np.geomspace(_FIRST_BEYOND, farthest, _SAMPLES_BEYOND)
    for end, slope in ((-1.0, curve[events.SLOPE_LOW]), (1.0, curve[events.SLOPE_HIGH])):
        u = chebyshev.chebval(end, curve[events.COEFFICIENTS :]) + slope * end * beyond
        q = curve[events.MIDDLE] + curve[events.HALF_WIDTH] * end * (1.0 + beyond)
        x, y = saddle[0] + outward[0] * u - outward[1] * q, saddle[1] + outward[1] * u + outward[0] * q
        reach = min(reach, 1.0 + 0.5 * beyond[potential.value(x, y) <= energy].min(initial=np.inf))
    return float(reach)


def _straight_curve(saddle: np.ndarray, outward: np.ndarray) -> np.ndarray:
    """(columns,) the exit curve of a closed channel: a short straight line across the saddle."""
    curve = np.zeros(events.CURVE_COLUMNS)
    curve[events.SADDLE_X : events.OUTWARD_Y + 1] = *saddle, *outward
    curve[events.BEARING_X : events.BEARING_Y + 1] = saddle / np.hypot(*saddle)
    curve[events.HALF_WIDTH] = _CLOSED_HALF_WIDTH * np.hypot(*saddle)
    curve[events.REACH] = 1.0
    return curve


def closed_channel_curves(potential: Potential) -> np.ndarray:
    """(channels, columns) exit curves for closed channels: short lines across the saddles, where V is above any lower energy."""
    rows = [_straight_curve(*row) for row in zip(potential.saddles, potential.outward_directions, strict=True)]
    return np.array(rows).reshape(potential.channels, events.CURVE_COLUMNS)


def exit_curves(potential: Potential, energy: float) -> np.ndarray:
    """(channels, columns) exit curves at one energy, for the kernels."""
    curves = closed_channel_curves(potential)
    for orbit in find_lyapunov_orbits(potential, energy):
        curves[orbit.channel - 1] = orbit.curve
    return curves


def exit_curves_in_well_units(potential: Potential, energy: float) -> np.ndarray:
    """(channels, columns) exit curves in units of the well, at an energy in the potential's own units, which errors name."""
    find_lyapunov_orbits(potential, energy)
    return exit_curves(potential.in_well_units, energy / potential.units.energy)


def exit_gates(curves: np.ndarray) -> np.ndarray:
    """(channels, 3) lines a x + b y = c across the channels, slightly inside all exit curves (…, channels, columns).

    The kernels use them as a cheap test: only an orbit beyond a gate can have escaped.
    """
    channels, columns = curves.shape[-2:]
    rows = curves.reshape(math.prod(curves.shape[:-2]), channels, columns)
    s = np.linspace(-1.0, 1.0, 201)
    lowest = chebyshev.chebval(s, np.moveaxis(rows[..., events.COEFFICIENTS :], -1, 0)).min(axis=(0, -1))
    outward = rows[0, :, events.OUTWARD_X : events.OUTWARD_Y + 1]
    saddles = rows[0, :, events.SADDLE_X : events.SADDLE_Y + 1]
    length = np.array([nearest_power_of_two(distance) for distance in np.hypot(*saddles.T).tolist()])
    offset = np.sum(outward * saddles, axis=1) + lowest - _GATE_MARGIN * length
    return np.column_stack([outward, offset])
