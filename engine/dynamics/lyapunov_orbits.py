"""Lyapunov orbits: the unstable periodic orbit over each open saddle, whose curve across the channel is the exit.

At energy h above a saddle the orbit swings between two points at rest on the zero-velocity curve and runs back along the
same path (Contopoulos 1990, Astron. Astrophys. 231, 41). A start at rest on the wall a little too far in falls inward, one
too far out falls outward; the orbit is the root of the velocity along the channel at the moment the swing turns back.
"""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np
from numpy.polynomial import chebyshev
from scipy import optimize

from engine.dynamics.compiled import kernels_of
from engine.potentials.potential import Potential
from engine.taylor.kernels import events
from engine.taylor.source.recurrence import ORDER, TOLERANCE
from engine.validation import read_number

# In units of the distance from the well's bottom to the saddle: how far along the channel a start may run before it is
# plain which way it falls, the first stride of the search for a bracket, and how far that search goes.
_REACH = 1.0
_FIRST_STRIDE = 0.01
_FURTHEST = 2.0

_SAMPLES_PER_SWING = 100
_LARGEST_MISFIT = 1e-11
# In units of the distance of the saddle, taken as a power of 2.
_GATE_MARGIN = 1e-3
_MOST_STEPS = 400
# Column k holds the power series of the Chebyshev polynomial T_k.
_CHEBYSHEV_TO_POWER = np.column_stack(
    [
        np.pad(chebyshev.cheb2poly(row[: k + 1]), (0, events.CURVE_DEGREE - k))
        for k, row in enumerate(np.eye(events.CURVE_DEGREE + 1))
    ]
)


@dataclass(frozen=True, eq=False)
class LyapunovOrbit:
    """One Lyapunov orbit; lengths and times are dimensionless.

    Attributes
    ----------
    channel
        Number of the exit channel it closes, from 1.
    energy
        Its energy h.
    period
        Time for there and back.
    x, y
        (201,) path over one whole period, evenly spaced in time, from rest on one wall to the other and back: the first
        and the last point are the same.
    curve
        The exit as a row of numbers for the kernels (columns in `engine.taylor.kernels.events`).
    """

    channel: int
    energy: float
    period: float
    x: np.ndarray
    y: np.ndarray
    curve: np.ndarray

    @property
    def half_path(self) -> np.ndarray:
        """(101, 2) the path from wall to wall, once: what to draw."""
        return np.column_stack([self.x, self.y])[: self.x.size // 2 + 1]


def find_lyapunov_orbits(potential: Potential, energy: float) -> tuple[LyapunovOrbit, ...]:
    """The Lyapunov orbit over each saddle that lies below `energy`.

    Parameters
    ----------
    potential
        Any `Potential`.
    energy
        h, finite, dimensionless; for cases I and II tested to 0.5, for III to 1.0.

    Returns
    -------
    In channel order; empty at or below the escape energy, where nothing can leave.

    Raises
    ------
    ValueError
        When `energy` is not finite, or so high that no Lyapunov orbit that crosses its channel as a graph is found, or that the
        exits meet.
    """
    return _find_all(potential, read_number("energy", energy))


@functools.lru_cache(maxsize=4096)
def _find_all(potential: Potential, energy: float) -> tuple[LyapunovOrbit, ...]:
    """Found in units of the potential's length, in which every absolute length of the search and of the steps is at home."""
    length = potential.length
    if length == 1.0:
        orbits = _find_in_units(potential, energy, energy)
    else:
        found = _find_in_units(potential.in_units(length), energy / length**2, energy)
        orbits = tuple(_enlarged(orbit, length) for orbit in found)
    _check_apart(potential, energy, orbits)
    return orbits


def _find_in_units(potential: Potential, energy: float, named: float) -> tuple[LyapunovOrbit, ...]:
    """The orbits of a potential of length 1; errors name the energy as the caller knows it."""
    found: dict[int, LyapunovOrbit] = {}
    for channel in potential.open_channels(energy):
        image = int(potential.mirror_channels[channel]) if potential.mirror_in_x else channel
        found[channel] = _mirrored(found[image], channel) if image in found else _find(potential, energy, channel, named)
        if image == channel and potential.mirror_in_x:
            found[channel] = _symmetrised(found[channel])
    return tuple(found.values())


def _enlarged(orbit: LyapunovOrbit, length: float) -> LyapunovOrbit:
    """An orbit found in units of `length`, a power of 2, in the units of its potential: no digit changes."""
    curve = orbit.curve * length
    directions = slice(events.OUTWARD_X, events.BEARING_Y + 1)
    curve[directions] = orbit.curve[directions]
    arrays = (orbit.x * length, orbit.y * length, curve)
    for array in arrays:
        array.flags.writeable = False
    return LyapunovOrbit(orbit.channel, orbit.energy * length**2, orbit.period, *arrays)


def _check_apart(potential: Potential, energy: float, orbits: tuple[LyapunovOrbit, ...]) -> None:
    """Every exit must lie in the directions in which its saddle is the nearest: by that rule a point is said to be outside."""
    towards = potential.saddles / np.hypot(*potential.saddles.T)[:, None] if orbits else potential.saddles
    for orbit in orbits:
        nearest = np.argmax(orbit.half_path @ towards.T, axis=1) + 1
        if np.any(nearest != orbit.channel):
            other = int(nearest[nearest != orbit.channel][0])
            meet = f"the exits of channels {orbit.channel} and {other} meet"
            raise ValueError(f"energy={energy}: too high for potential {potential.name}: {meet}")


def _mirrored(orbit: LyapunovOrbit, channel: int) -> LyapunovOrbit:
    """The image under x → −x, exact to the bit, so that mirror images of orbits escape at the very same time."""
    arrays = (-orbit.x, orbit.y.copy(), _mirrored_curve(orbit.curve))
    for array in arrays:
        array.flags.writeable = False
    return LyapunovOrbit(channel, orbit.energy, orbit.period, *arrays)


def _mirrored_curve(curve: np.ndarray) -> np.ndarray:
    """An exit curve in the axes of the mirrored saddle, where u is the same and q has the other sign."""
    image = curve.copy()
    image[[events.SADDLE_X, events.OUTWARD_X, events.BEARING_X, events.MIDDLE]] *= -1.0
    image[[events.SLOPE_LOW, events.SLOPE_HIGH]] = -curve[[events.SLOPE_HIGH, events.SLOPE_LOW]]
    image[events.COEFFICIENTS + 1 :: 2] *= -1.0
    return image


def _symmetrised(orbit: LyapunovOrbit) -> LyapunovOrbit:
    """An orbit that is its own mirror image, made so to the bit."""
    curve = 0.5 * (orbit.curve + _mirrored_curve(orbit.curve))
    curve.flags.writeable = False
    return replace(orbit, curve=curve)


@functools.cache
def channel_axes(potential: Potential, channel: int) -> np.ndarray:
    """Unit vector along the unstable direction of a channel's saddle, pointing away from the well."""
    return potential.outward_direction(channel)


def _find(potential: Potential, energy: float, channel: int, named: float) -> LyapunovOrbit:
    kernels = kernels_of(potential)
    saddle = potential.saddles[channel - 1]
    outward = channel_axes(potential, channel)
    scale = float(np.hypot(*saddle))
    steps = np.empty((_MOST_STEPS, 5))
    frame = (*saddle, *outward, energy, _REACH * scale, TOLERANCE, steps)

    def drift(u: float) -> float:
        return float(kernels.shoot(u, *frame)[0])

    bracket = _bracket(drift, scale)
    if bracket is None:
        raise ValueError(f"energy={named}: no Lyapunov orbit found across channel {channel} of potential {potential.name}")
    u = optimize.brentq(drift, *bracket, xtol=1e-17, rtol=4 * np.finfo(float).eps)
    _, half_period, count = kernels.shoot(u, *frame)
    if not np.isfinite(half_period):
        raise ValueError(f"energy={named}: the Lyapunov orbit of channel {channel} of {potential.name} does not turn back")
    x, y = _dense_path(kernels, steps[:count], half_period)
    curve = _exit_curve(saddle, outward, x, y)
    if curve is None:
        raise ValueError(
            f"energy={named}: too high for potential {potential.name}: across channel {channel} the Lyapunov orbit is no "
            f"longer a smooth graph, so the exit is not defined by it"
        )
    whole = np.concatenate([np.arange(x.size), np.arange(x.size - 1)[::-1]])
    arrays = (x[whole], y[whole], curve)
    for array in arrays:
        array.flags.writeable = False
    return LyapunovOrbit(channel, energy, 2.0 * half_period, *arrays)


def _bracket(drift: object, scale: float) -> tuple[float, float] | None:
    """Two neighbouring starts, the inner of which falls inward and the outer outward; strides grow from the saddle on."""
    assert callable(drift)
    here, stride = 0.0, _FIRST_STRIDE * scale
    first = drift(here)
    if np.isnan(first):
        return None
    inward = first < 0
    while abs(here) < _FURTHEST * scale:
        there = here + stride if inward else here - stride
        value = drift(there)
        if np.isnan(value):
            return None
        if (value < 0) != inward:
            return (here, there) if inward else (there, here)
        here, stride = there, 1.5 * stride
    return None


def _dense_path(kernels: ModuleType, steps: np.ndarray, duration: float) -> tuple[np.ndarray, np.ndarray]:
    """x, y at evenly spaced times from 0 to `duration`."""
    x_jet, y_jet = np.empty((2, ORDER + 1, len(steps)))
    kernels.jets(len(steps), *(np.ascontiguousarray(column) for column in steps[:, :4].T), x_jet, y_jet)
    times = np.linspace(0.0, duration, _SAMPLES_PER_SWING + 1)
    row = np.searchsorted(steps[:, 4], times, side="right") - 1
    tau = times - steps[row, 4]
    powers = tau ** np.arange(ORDER + 1)[:, None]
    return (x_jet[:, row] * powers).sum(axis=0), (y_jet[:, row] * powers).sum(axis=0)


def _exit_curve(saddle: np.ndarray, outward: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray | None:
    """The path as u = f(s); None when it is not a graph over s or not smooth enough for the fit."""
    u = outward[0] * (x - saddle[0]) + outward[1] * (y - saddle[1])
    q = outward[0] * (y - saddle[1]) - outward[1] * (x - saddle[0])
    middle, half_width = 0.5 * (q[0] + q[-1]), 0.5 * (q[-1] - q[0])
    s = (q - middle) / half_width
    if np.any(np.diff(s) <= 0):
        return None
    basis = chebyshev.chebvander(s, events.CURVE_DEGREE)
    fit = np.linalg.lstsq(basis, u, rcond=None)[0]
    if np.max(np.abs(basis @ fit - u)) > _LARGEST_MISFIT:
        return None
    power = _CHEBYSHEV_TO_POWER @ fit
    degrees = np.arange(events.CURVE_DEGREE + 1)
    slopes = [float(np.sum(power * degrees * side ** (degrees - 1))) for side in (-1.0, 1.0)]
    curve = np.empty(events.CURVE_COLUMNS)
    curve[events.SADDLE_X : events.OUTWARD_Y + 1] = *saddle, *outward
    curve[events.BEARING_X : events.BEARING_Y + 1] = saddle / np.hypot(*saddle)
    curve[events.MIDDLE : events.SLOPE_HIGH + 1] = middle, half_width, *slopes
    curve[events.COEFFICIENTS :] = power
    return curve


def closed_curves(potential: Potential) -> np.ndarray:
    """(channels, columns) curves of channels that are all closed: straight across their saddles.

    No orbit of lower energy than the saddle gets there from inside; what such an energy allows beyond is outside.
    """
    curves = np.zeros((potential.channels, events.CURVE_COLUMNS))
    for k, saddle in enumerate(potential.saddles):
        curves[k, events.SADDLE_X : events.OUTWARD_Y + 1] = *saddle, *channel_axes(potential, k + 1)
        curves[k, events.BEARING_X : events.BEARING_Y + 1] = saddle / np.hypot(*saddle)
    curves[:, events.HALF_WIDTH] = 1.0
    return curves


def exit_curves(potential: Potential, energy: float) -> np.ndarray:
    """(channels, columns) exit curves at one energy, for the kernels."""
    curves = closed_curves(potential)
    for orbit in find_lyapunov_orbits(potential, energy):
        curves[orbit.channel - 1] = orbit.curve
    return curves


def find_outside_exits(potential: Potential, energy: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """int8, shaped like x and y: the channel beyond whose Lyapunov orbit each point lies, 0 inside."""
    row = np.zeros(x.size, np.int64)
    outside: np.ndarray = events.find_outside(x.ravel(), y.ravel(), exit_curves(potential, energy)[None], row)
    return outside.reshape(x.shape)


def exit_gates(curves: np.ndarray) -> np.ndarray:
    """(channels, 3) lines a x + b y = c across each channel, a little inside every exit curve of (…, channels, columns)."""
    channels, columns = curves.shape[-2:]
    rows = curves.reshape(math.prod(curves.shape[:-2]), channels, columns)
    s = np.linspace(-1.0, 1.0, 201)
    lowest = np.polynomial.polynomial.polyval(s, np.moveaxis(rows[..., events.COEFFICIENTS :], -1, 0)).min(axis=(0, -1))
    outward = rows[0, :, events.OUTWARD_X : events.OUTWARD_Y + 1]
    saddles = rows[0, :, events.SADDLE_X : events.SADDLE_Y + 1]
    length = 2.0 ** np.round(np.log2(np.hypot(*saddles.T)))
    offset = np.sum(outward * saddles, axis=1) + lowest - _GATE_MARGIN * length
    return np.column_stack([outward, offset])
