"""Lyapunov orbits: the unstable periodic orbits over the open saddles. Their paths across the channels are the exits."""

from __future__ import annotations

import functools
import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.polynomial import chebyshev

from engine.exits.brake_orbits import Axes, chord_axes, continue_in_energy, find_directly, find_from_both_ends, saddle_axes
from engine.potentials.hill_region import check_closed_well
from engine.potentials.potential import Potential
from engine.potentials.well_units import ENERGY, LENGTH, TIME, WellUnits, nearest_power_of_two
from engine.results.arrays import read_only
from engine.results.result import Result
from engine.taylor.kernels import events
from engine.validation import checked_number, checks_types

# In units of the well.
_LARGEST_FIT_ERROR = 1e-9
# Ends of two orbits closer than this, in units of the well, are the same.
_SAME_END = 1e-6
# Distance of a gate from the exit, in units of the distance of the saddle rounded to a power of 2.
_GATE_MARGIN = 1e-3
# Half the length of the line across a closed saddle, in units of the saddle's distance from the origin.
_CLOSED_HALF_WIDTH = 1e-3
# The lines beyond the ends of an exit are sampled from this |s| − 1 on, up to this multiple of the distance of the saddle.
_FIRST_BEYOND, _FARTHEST_BEYOND, _SAMPLES_BEYOND = 1e-3, 2.0, 400


@dataclass(frozen=True, eq=False, repr=False)
class LyapunovOrbit(Result):
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
    energy: float = field(metadata=ENERGY)
    period: float = field(metadata=TIME)
    x: np.ndarray = field(metadata=LENGTH)
    y: np.ndarray = field(metadata=LENGTH)
    curve: np.ndarray

    def __post_init__(self) -> None:
        for array in (self.x, self.y, self.curve):
            read_only(array)

    def columns(self) -> Mapping[str, np.ndarray]:
        """The path and its times."""
        return {"t": np.linspace(0.0, self.period, self.x.size), "x": self.x, "y": self.y}

    @property
    def half_path(self) -> np.ndarray:
        """(101, 2) the path over half a period, from one side of the channel to the other, for plots."""
        return np.column_stack([self.x, self.y])[: self.x.size // 2 + 1]


@checks_types(potential=Potential)
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
        If `energy` is not finite, or above a maximum between two exits, or if a Lyapunov orbit is not found or not a graph over
        a line, or if exits meet.

    Examples
    --------
    >>> from escape_explorer import CASES, find_lyapunov_orbits
    >>> [round(orbit.period, 6) for orbit in find_lyapunov_orbits(CASES["I"], 0.19)]
    [4.437671, 4.437671]
    >>> find_lyapunov_orbits(CASES["I"], 0.1)
    ()
    """
    units = potential.units
    scaled = checked_number("energy", energy) / units.energy
    try:
        orbits = _find_orbits(potential.in_well_units, scaled)
    except _SearchError as error:
        stated = scaled * potential.in_well_units.stated_units.energy
        raise ValueError(f"energy={stated}: {error} (potential {potential.name})") from None
    return orbits if units == WellUnits() else tuple(_restored(orbit, units) for orbit in orbits)


def _check_below_maxima(potential: Potential, energy: float) -> None:
    units = potential.stated_units
    for merger in potential.channel_mergers:
        if energy > merger.energy:
            raise _SearchError(
                f"{merger.describe()} are one above the maximum between them, V = {merger.energy * units.energy:.6g} at "
                f"({merger.x * units.length:.6g}, {merger.y * units.length:.6g}); choose a lower energy"
            )


class _SearchError(Exception):
    """A Lyapunov orbit that was not found or cannot be used as an exit."""


@functools.lru_cache(maxsize=4096)
def _find_orbits(potential: Potential, energy: float) -> tuple[LyapunovOrbit, ...]:
    """The orbits of a potential in units of its well."""
    _check_below_maxima(potential, energy)
    try:
        return _find_separate_orbits(potential, energy, follow=False)
    except _SearchError:
        return _find_separate_orbits(potential, energy, follow=True)


def _find_separate_orbits(potential: Potential, energy: float, follow: bool) -> tuple[LyapunovOrbit, ...]:
    """Orbits that do not meet, searched at this energy or followed up to it; those of mirror channels are exact mirror images."""
    found: dict[int, LyapunovOrbit] = {}
    for channel in potential.open_channels(energy):
        image = int(potential.mirror_channels[channel]) if potential.mirror_in_x else channel
        found[channel] = _mirrored(found[image], channel) if image in found else _find_orbit(potential, energy, channel, follow)
        if image == channel and potential.mirror_in_x:
            found[channel] = _symmetrized(found[channel])
    orbits = tuple(found.values())
    _check_exits_apart(orbits)
    return orbits


def _restored(orbit: LyapunovOrbit, units: WellUnits) -> LyapunovOrbit:
    """An orbit in units of the well, in the units of its potential; in its exit curve, directions have no unit."""
    curve = orbit.curve * units.length
    directions = slice(events.OUTWARD_X, events.OPEN + 1)
    curve[directions] = orbit.curve[directions]
    return replace(units.restore(orbit), curve=curve)


def _check_exits_apart(orbits: tuple[LyapunovOrbit, ...]) -> None:
    for one, other in itertools.combinations(orbits, 2):
        if _paths_cross(one.half_path, other.half_path) or _same_ends(one.half_path, other.half_path):
            raise _SearchError(f"the exits of channels {one.channel} and {other.channel} meet; choose a lower energy")


def _same_ends(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether two paths, (n, 2) each, connect the same points: then they are one, up to rounding errors."""
    return bool(np.abs(one[[0, -1]] - other[[0, -1]]).max() < _SAME_END)


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
    image[[events.ORIGIN_X, events.OUTWARD_X, events.BEARING_X, events.MIDDLE]] *= -1.0
    image[[events.SLOPE_LOW, events.SLOPE_HIGH]] = -curve[[events.SLOPE_HIGH, events.SLOPE_LOW]]
    image[events.COEFFICIENTS + 1 :: 2] *= -1.0
    return image


def _symmetrized(orbit: LyapunovOrbit) -> LyapunovOrbit:
    """An orbit over a saddle on the y axis, with an exit curve that is exactly symmetric."""
    return replace(orbit, curve=0.5 * (orbit.curve + _mirrored_curve(orbit.curve)))


def _find_orbit(potential: Potential, energy: float, channel: int, follow: bool) -> LyapunovOrbit:
    place = potential, energy, channel
    orbit = (continue_in_energy(*place) or find_from_both_ends(*place)) if follow else find_directly(*place)
    if orbit is None:
        raise _SearchError(f"no Lyapunov orbit was found across channel {channel}; choose another energy")
    axes = chord_axes(orbit.path) if follow else saddle_axes(potential, channel)
    curve = _fit_exit_curve(axes, potential.saddles[channel - 1], orbit.path)
    if curve is None:
        raise _SearchError(f"the Lyapunov orbit across channel {channel} is not a smooth graph; choose another energy")
    curve[events.REACH] = _find_reach(potential, energy, curve)
    x, y = orbit.path
    there_and_back = np.concatenate([np.arange(x.size), np.arange(x.size - 1)[::-1]])
    return LyapunovOrbit(channel, energy, 2.0 * orbit.half_period, x[there_and_back], y[there_and_back], curve)


def _fit_exit_curve(axes: Axes, saddle: np.ndarray, path: np.ndarray) -> np.ndarray | None:
    """The path as a graph u = f(s), s ∈ [−1, 1]; None if it is not a graph or not smooth enough for the fit."""
    u, q = axes.coordinates(path)
    middle, half_width = 0.5 * (q[0] + q[-1]), 0.5 * (q[-1] - q[0])
    s = (q - middle) / half_width
    if np.any(np.diff(s) <= 0):
        return None
    basis = chebyshev.chebvander(s, events.CURVE_DEGREE)
    fit = np.linalg.lstsq(basis, u, rcond=None)[0]
    if np.max(np.abs(basis @ fit - u)) > _LARGEST_FIT_ERROR:
        return None
    end_slopes = chebyshev.chebval([-1.0, 1.0], chebyshev.chebder(fit))
    curve = _straight_curve(axes, saddle)
    curve[events.OPEN] = 1.0
    curve[events.MIDDLE : events.SLOPE_HIGH + 1] = middle, half_width, *end_slopes
    curve[events.COEFFICIENTS :] = fit
    return curve


def _find_reach(potential: Potential, energy: float, curve: np.ndarray) -> float:
    """The |s| up to which a crossing counts: half of the way along the straight lines beyond the ends to where V ≤ h again."""
    reach = np.inf
    saddle, outward = curve[[events.ORIGIN_X, events.ORIGIN_Y]], curve[[events.OUTWARD_X, events.OUTWARD_Y]]
    farthest = _FARTHEST_BEYOND * max(float(np.hypot(*saddle)) / curve[events.HALF_WIDTH], 1.0)
    beyond = np.geomspace(_FIRST_BEYOND, farthest, _SAMPLES_BEYOND)
    for end, slope in ((-1.0, curve[events.SLOPE_LOW]), (1.0, curve[events.SLOPE_HIGH])):
        u = chebyshev.chebval(end, curve[events.COEFFICIENTS :]) + slope * end * beyond
        q = curve[events.MIDDLE] + curve[events.HALF_WIDTH] * end * (1.0 + beyond)
        x, y = saddle[0] + outward[0] * u - outward[1] * q, saddle[1] + outward[1] * u + outward[0] * q
        reach = min(reach, 1.0 + 0.5 * beyond[potential.value(x, y) <= energy].min(initial=np.inf))
    return float(reach)


def _straight_curve(axes: Axes, saddle: np.ndarray) -> np.ndarray:
    """(columns,) the exit curve of a closed channel: a short straight line through the origin of the axes."""
    curve = np.zeros(events.CURVE_COLUMNS)
    curve[events.ORIGIN_X : events.OUTWARD_Y + 1] = *axes.origin, *axes.outward
    curve[events.BEARING_X : events.BEARING_Y + 1] = saddle / np.hypot(*saddle)
    curve[events.HALF_WIDTH] = _CLOSED_HALF_WIDTH * np.hypot(*saddle)
    curve[events.REACH] = 1.0
    return curve


def exit_curve_over_chord(potential: Potential, orbit: LyapunovOrbit) -> np.ndarray | None:
    """(columns,) the exit curve of an orbit in units of the well, in the axes of its chord, which depend smoothly on the energy.

    None if the path is not a smooth graph over the chord.
    """
    path = orbit.half_path.T
    if chord_axes(path).outward @ potential.outward_directions[orbit.channel - 1] < 0.0:
        # Mirrored orbits have the well on the other side of their path.
        path = path[:, ::-1]
    curve = _fit_exit_curve(chord_axes(path), potential.saddles[orbit.channel - 1], path)
    if curve is not None:
        curve[events.REACH] = _find_reach(potential, orbit.energy, curve)
    return curve


def closed_channel_curves(potential: Potential) -> np.ndarray:
    """(channels, columns) exit curves for closed channels: short lines across the saddles, where V is above any lower energy.

    Raises
    ------
    ValueError
        If there are no exits, but the well is not closed either: it is not defined which orbits escape.
    """
    if not potential.channels:
        check_closed_well(potential)
    rows = [_straight_curve(saddle_axes(potential, k + 1), saddle) for k, saddle in enumerate(potential.saddles)]
    return np.array(rows).reshape(potential.channels, events.CURVE_COLUMNS)


def exit_curves(potential: Potential, energy: float) -> np.ndarray:
    """(channels, columns) exit curves at one energy, for the kernels."""
    curves = closed_channel_curves(potential)
    for orbit in find_lyapunov_orbits(potential, energy):
        curves[orbit.channel - 1] = orbit.curve
    return curves


def exit_gates(curves: np.ndarray) -> np.ndarray:
    """(channels, 3) lines a x + b y = c across the channels, slightly inside all exit curves (…, channels, columns).

    The kernels use them as a cheap test: only an orbit beyond a gate can have escaped.
    """
    channels, columns = curves.shape[-2:]
    rows = curves.reshape(math.prod(curves.shape[:-2]), channels, columns)
    s = np.linspace(-1.0, 1.0, 201)
    u = chebyshev.chebval(s, np.moveaxis(rows[..., events.COEFFICIENTS :], -1, 0))
    q = rows[..., events.MIDDLE, None] + rows[..., events.HALF_WIDTH, None] * s
    origin_x, origin_y, outward_x, outward_y = np.moveaxis(rows[..., events.ORIGIN_X : events.OUTWARD_Y + 1, None], 2, 0)
    x, y = origin_x + u * outward_x - q * outward_y, origin_y + u * outward_y + q * outward_x
    gates = rows[0, :, events.OUTWARD_X : events.OUTWARD_Y + 1]
    lowest = (gates[:, :1] * x + gates[:, 1:] * y).min(axis=(0, -1))
    origins = rows[0, :, events.ORIGIN_X : events.ORIGIN_Y + 1]
    length = np.array([nearest_power_of_two(distance) for distance in np.hypot(*origins.T).tolist()])
    return np.column_stack([gates, lowest - _GATE_MARGIN * length])
