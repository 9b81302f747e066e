"""Decide with lines of steepest descent which saddles are exits, and whether each Lyapunov orbit crosses its own channel."""

from __future__ import annotations

from enum import Enum
from functools import lru_cache

import numpy as np
from scipy.integrate import cumulative_trapezoid, solve_ivp

from engine import Potential
from tests.referee.own_system import OwnSystem
from tests.referee.report import UNDECIDED, Report
from tests.referee.setting import Setting

CHECK = "exits"
# Displacement of the beginning of a line along the unstable direction, and sideways, in distances of the nearest critical point.
_ALONG, _SIDEWAYS = 1e-4, 1e-6
# Distance where a line has arrived, in distances of the nearest saddle, and where it has left, in those of the farthest.
_NEAR, _FAR = 0.02, 20.0
# ln of the factors by which lines come closer, and part again, if rounding decides where they lead.
_CLOSER, _APART = 12.0, 12.0
# Largest number of saddles that are tested, the nearest first.
_MOST_SADDLES = 40


class Way(Enum):
    """Where a line of steepest descent leads."""

    WELL = "the well"
    ELSEWHERE = "elsewhere"
    UNDECIDED = "undecided"


Descent = tuple[Way, np.ndarray]


def descend(system: OwnSystem, begin: np.ndarray, near: float, far: float) -> Descent:
    """Return where a line of steepest descent leads, and its points, (n, 2)."""

    def arrived(_s: float, place: np.ndarray) -> float:
        return float(np.hypot(*place)) - near

    def left(_s: float, place: np.ndarray) -> float:
        return float(np.hypot(*place)) - far

    def resting(_s: float, place: np.ndarray) -> float:
        # Near its saddle, a line first comes closer to the unstable direction, and the slope falls.
        if np.hypot(*(place - begin)) < near:
            return 1.0
        return float(np.hypot(*system.gradient(*place))) - 1e-3 * slope

    slope = float(np.hypot(*system.gradient(*begin)))
    arrived.terminal = left.terminal = resting.terminal = True  # type: ignore[attr-defined]

    def direction(_s: float, place: np.ndarray) -> np.ndarray:
        gradient = system.gradient(*place)
        return -gradient / (np.hypot(*gradient) + slope)

    try:
        line = solve_ivp(
            direction, (0.0, 1e4 * far), begin, "Radau", events=(arrived, left, resting), rtol=1e-8, atol=1e-9 * near
        )
    except ValueError:
        # V is not finite at a point that was tried.
        return Way.UNDECIDED, begin[None]
    ways = [way for way, times in zip((Way.WELL, Way.ELSEWHERE, Way.ELSEWHERE), line.t_events, strict=True) if len(times)]
    is_flat = len(line.t_events[2]) and not _is_near_critical_point(system, line.y[:, -1], near)
    if ways == [Way.ELSEWHERE] and (is_flat or _is_led_by_rounding(system, line.t, line.y, slope)):
        return Way.UNDECIDED, line.y.T
    return (ways[0] if ways else Way.UNDECIDED), line.y.T


def _is_near_critical_point(system: OwnSystem, place: np.ndarray, near: float) -> bool:
    """Whether a step of Newton's method from a place is short. In a flat valley, the slope is small and the step is not."""
    return bool(np.hypot(*np.linalg.lstsq(system.curvature(*place), system.gradient(*place))[0]) < near)


def _is_led_by_rounding(system: OwnSystem, s: np.ndarray, places: np.ndarray, slope: float) -> bool:
    """Whether neighbouring lines come closer than the tolerance in a valley, and part again beyond it on a ridge.

    A line that leads to the well nevertheless is certain, because its exact distance from the ridge is still smaller.
    """
    gradient = system.gradient(*places)
    length = np.hypot(*gradient)
    nx, ny = -gradient[1] / length, gradient[0] / length
    (vxx, vxy), (_, vyy) = system.curvature(*places)
    rate = -(nx * nx * vxx + 2.0 * nx * ny * vxy + ny * ny * vyy) / (length + slope)
    logarithm = cumulative_trapezoid(rate, s, initial=0.0)
    closest = np.minimum.accumulate(logarithm)
    return bool(np.any((closest < -_CLOSER) & (logarithm - closest > _APART)))


@lru_cache(maxsize=256)
def descend_steadily(
    system: OwnSystem, saddle: tuple[float, float], side: float, nearest: float, unit: float, far: float
) -> Descent:
    """Return where a line leads on one side of a saddle, undecided if a sideways displacement changes it, and its points.

    The nearest critical point is at the distance `nearest` from the saddle; `unit` is the distance of a saddle from the origin.
    """
    across, along = np.linalg.eigh(system.curvature(*saddle))[1].T[::-1]
    begin = np.array(saddle) + side * _ALONG * nearest * along
    found = [descend(system, begin + shift * _SIDEWAYS * nearest * across, _NEAR * unit, far) for shift in (1.0, -1.0)]
    return (found[0][0] if found[0][0] is found[1][0] else Way.UNDECIDED), found[0][1]


def check_exits(potential: Potential, system: OwnSystem, formula: str, report: Report) -> None:
    """Compare the saddles that are exits."""
    points = potential.critical_points[potential.well.critical_indices < 0.0]
    points = points[np.argsort(np.hypot(*points.T))][:_MOST_SADDLES]
    if not len(points):
        return
    unit, far = float(np.hypot(*points.T).min()), _FAR * float(np.hypot(*points.T).max())
    for place in points:
        ways = {way for way, _ in _descend_on_both_sides(potential, system, place, unit, far)}
        if Way.UNDECIDED in ways:
            report.add(CHECK, UNDECIDED, "a line of steepest descent changes with a shift")
            continue
        leads_out = ways == {Way.WELL, Way.ELSEWHERE}
        is_exit = bool(np.any(np.hypot(*(potential.saddles - place).T) < 1e-9 * unit))
        kind = "an exit is missing" if leads_out else "a saddle is not an exit"
        report.judge(CHECK, kind, leads_out == is_exit, formula=formula, saddle=place.tolist(), ways=[way.value for way in ways])


def _descend_on_both_sides(potential: Potential, system: OwnSystem, saddle: np.ndarray, unit: float, far: float) -> list[Descent]:
    """Return the lines on both sides of a saddle."""
    nearest = float(np.sort(np.hypot(*(potential.critical_points - saddle).T))[1])
    return [descend_steadily(system, tuple(saddle.tolist()), side, nearest, unit, far) for side in (1.0, -1.0)]


def check_channels(setting: Setting, report: Report) -> None:
    """The line of steepest descent from a saddle to both sides crosses the exit over this saddle an odd number of times."""
    exits, unit = setting.exits, float(np.hypot(*setting.potential.saddles.T).min())
    for channel, path in zip(exits.channels, exits.paths, strict=True):
        saddle = setting.potential.saddles[channel - 1]
        lines = _descend_on_both_sides(setting.potential, setting.system, saddle, unit, _FAR * setting.size)
        if {way for way, _ in lines} != {Way.WELL, Way.ELSEWHERE}:
            report.add(CHECK, UNDECIDED, "a line of steepest descent changes with a shift")
            continue
        line = np.concatenate([lines[0][1][::-1], saddle[None], lines[1][1]])
        known = {"exit": channel, "saddle": saddle.tolist(), "rests": path[[0, -1]].tolist(), **setting.reproduction}
        report.judge(CHECK, "a Lyapunov orbit does not cross its channel", count_meetings(line, path) % 2 == 1, **known)


def count_meetings(first: np.ndarray, second: np.ndarray) -> int:
    """Return the number of pairs of segments of two polylines (n, 2) that cross."""

    def sides(line: np.ndarray, points: np.ndarray) -> np.ndarray:
        along, apart = np.diff(line, axis=0)[:, None], points - line[:-1, None]
        return along[..., 0] * apart[..., 1] > along[..., 1] * apart[..., 0]

    left, right = sides(first, second), sides(second, first)
    return int(np.count_nonzero((left[:, 1:] != left[:, :-1]) & (right[:, 1:] != right[:, :-1]).T))
