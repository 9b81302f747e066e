"""Follow orbits to exits of any shape with heyoka's own event detection: lines, discs of centres, the escape circle.

All numbers are in the units of the potential. The lines are those of `find_lyapunov_orbits`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

from engine import Potential, classify_orbits, find_lyapunov_orbits
from engine.integrator.kernels import exit_geometry as geometry
from engine.systems.escape_arcs import EscapeArc
from tests.peers.taylor_heyoka import START_TIME, coordinates, equations

TOLERANCES = (1e-18, 1e-16)
SHIFT = 1e-11
# Largest spread of the end times of a robust orbit, and rounding of end times that is added to the spread, in units of time.
LARGEST_SPREAD, ROUNDING = 1e-4, 1e-10


class Ends(NamedTuple):
    """Fates, end times (t_max for fate 0) and upward crossings of y = 0, each of shape (n,)."""

    fate: np.ndarray
    time: np.ndarray
    crossings: np.ndarray


@dataclass(frozen=True)
class Exit:
    """A function of heyoka's x and y that rises through 0 where orbits leave, and the fate at a point, 0 if it does not count."""

    height: Any
    fate_at: Callable[[float, float], int]


def exits_of(potential: Potential, energy: float) -> list[Exit]:
    x, y, *_ = coordinates()
    exits = [_line(orbit.channel, orbit.curve, x, y) for orbit in find_lyapunov_orbits(potential, energy)]
    for fate, centre in enumerate(potential.centres, potential.channels + 1):
        # The division by the radius gives the functions of all exits the same scale.
        height = 1.0 - ((x - centre.x) ** 2.0 + (y - centre.y) ** 2.0) * (1.0 / centre.radius**2)
        exits.append(Exit(height, lambda _x, _y, fate=fate: fate))
    if potential.escape_radius is not None:
        height = (x**2.0 + y**2.0) * (1.0 / potential.escape_radius**2) - 1.0
        exits.append(Exit(height, _fate_on_circle(potential)))
    return exits


def _fate_on_circle(potential: Potential) -> Callable[[float, float], int]:
    """Return the fate at a point of the escape circle, which may be divided into arcs."""
    arcs = [end for end in potential.ends if isinstance(end, EscapeArc)]
    if not arcs:
        return lambda _x, _y: len(potential.outcomes)
    first_fate, width = len(potential.outcomes) - len(arcs) + 1, 360.0 / len(arcs)
    return lambda x, y: first_fate + int((math.degrees(math.atan2(y, x)) - arcs[0].begin) % 360.0 // width)


def _line(channel: int, curve: np.ndarray, x: Any, y: Any) -> Exit:
    assert curve[geometry.SHAPE] == geometry.LINE
    place, (ox, oy) = (
        curve[[geometry.ORIGIN_X, geometry.ORIGIN_Y]],
        curve[[geometry.OUTWARD_X, geometry.OUTWARD_Y]],
    )
    # Points beyond the walls do not count, because the parabola continues through other allowed regions.
    middle, reach = curve[geometry.MIDDLE], (1.0 + 1e-9) * curve[geometry.HALF_WIDTH]
    constant, linear, square = curve[geometry.COEFFICIENTS : geometry.COEFFICIENTS + 3]
    s = (ox * (y - place[1]) - oy * (x - place[0]) - middle) * (1.0 / curve[geometry.HALF_WIDTH])
    height = ox * (x - place[0]) + oy * (y - place[1]) - (constant - square) - linear * s - 2.0 * square * s * s

    def fate_at(x: float, y: float) -> int:
        return channel if abs(ox * (y - place[1]) - oy * (x - place[0]) - middle) <= reach else 0

    return Exit(height, fate_at)


class Peer:
    """Follows orbits of one potential and one energy to their ends."""

    def __init__(self, potential: Potential, energy: float, tolerance: float) -> None:
        self.fate = self.crossings = 0
        exits = exits_of(potential, energy)
        leave = [hy.t_event(each.height, callback=self._left(each), direction=hy.event_direction.positive) for each in exits]
        upward = hy.nt_event(coordinates()[1], self._upward, direction=hy.event_direction.positive)
        self.start_time = START_TIME * potential.units.time
        self.integrator = hy.taylor_adaptive(equations(potential), [0.0] * 4, tol=tolerance, t_events=leave, nt_events=[upward])

    def __deepcopy__(self, _memo: object) -> Peer:
        # heyoka copies its callbacks, and all copies must update this object.
        return self

    def _left(self, each: Exit) -> Callable[[Any, int], bool]:
        def callback(integrator: Any, _sign: int) -> bool:
            self.fate = each.fate_at(*integrator.state[:2])
            return self.fate == 0

        return callback

    def _upward(self, _integrator: Any, time: float, _sign: int) -> None:
        self.crossings += time > self.start_time

    def follow(self, states: np.ndarray, t_max: float) -> Ends:
        ends = Ends(np.zeros(len(states), int), np.full(len(states), t_max), np.zeros(len(states), int))
        for n, state in enumerate(states):
            self.fate = self.crossings = 0
            self.integrator.reset_cooldowns()
            self.integrator.time = 0.0
            self.integrator.state[:] = state
            self.integrator.propagate_until(t_max)
            assert np.isfinite(self.integrator.state).all()
            ends.fate[n], ends.time[n], ends.crossings[n] = self.fate, self.integrator.time, self.crossings
        return ends


class Comparison(NamedTuple):
    """Numbers of compared, robust and wrong orbits, and the largest deviation of the end time of a robust orbit."""

    orbits: int
    robust: int
    wrong: int
    deviation: float


def compare(potential: Potential, energy: float, states: np.ndarray, t_max: float) -> Comparison:
    """Compare the engine's outcomes with heyoka's, where heyoka's do not change with a shift of the start and the tolerance."""
    ours = classify_orbits(potential, energy, states, t_max)
    shift = SHIFT * potential.units.state * np.array([1.0, -1.0, 0.0, 0.0])
    peers = [Peer(potential, energy, tolerance) for tolerance in TOLERANCES]
    runs = [peer.follow(states, t_max) for peer in peers] + [peers[0].follow(states + shift, t_max)]
    fates, times, crossings = (np.array(each) for each in zip(*runs, strict=True))
    spread = np.ptp(times, axis=0) / potential.units.time
    escapes = fates[0] > 0
    robust = (np.ptp(fates, axis=0) == 0) & (np.ptp(crossings, axis=0) == 0) & (spread < LARGEST_SPREAD)
    apart = np.where(escapes, np.abs(ours.escape_time - times[0]) / potential.units.time, 0.0)
    is_late = ~(apart <= spread + ROUNDING * (1.0 + times[0] / potential.units.time))
    wrong = (ours.fate != fates[0]) | (ours.crossings != crossings[0]) | is_late
    counted = robust & (ours.fate == fates[0])
    return Comparison(len(states), int(robust.sum()), int((robust & wrong).sum()), float(apart[counted].max(initial=0.0)))
