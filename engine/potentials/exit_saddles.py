"""Which saddles of a potential lead out of the well at the origin, and which maxima lie beside them.

From a saddle two lines of steepest descent start, one on each side along its unstable direction. If one ends at the origin and
the other elsewhere, at another minimum or at infinity, the saddle is an exit of the well. The two lines of steepest ascent run
through the walls of the channel; above the energy of a maximum at which one of them ends, the channel has no wall there.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

Gradient = Callable[..., tuple[np.ndarray, np.ndarray]]
Hessian = Callable[..., tuple[np.ndarray, np.ndarray, np.ndarray]]

# Distance from the saddle at which a descent starts, in units of the distance of the nearest other critical point.
_START_DISTANCE = 1e-3
# Distance from a critical point at which a descent ends, in units of the distance of the one nearest to the origin.
_END_DISTANCE = 1e-4
# A descent has gone to infinity at this distance from the origin, in units of the distance of the outermost critical point.
_FAR = 10.0

# Duration of a descent in units of its longest e-folding time, enough for every descent to end.
_DURATION = 100.0


def leads_out_of_well(gradient: Gradient, hessian: Hessian, points: np.ndarray) -> np.ndarray:
    """(n,) whether each critical point (n, 2) of a potential is a saddle that leads out of the well at the origin.

    Parameters
    ----------
    gradient, hessian
        (V_x, V_y) and (V_xx, V_xy, V_yy) of the potential as functions of x and y.
    points
        All critical points, including the origin exactly; if the origin is not a minimum, no point leads out.
    """
    origin = np.flatnonzero(np.hypot(*points.T) == 0.0)
    vxx, vxy, vyy = (np.broadcast_to(entry, len(points)) for entry in hessian(points[:, 0], points[:, 1]))
    with np.errstate(over="ignore", invalid="ignore"):
        # An overflow gives NaN or infinity, which is not a saddle.
        determinant = vxx * vyy - vxy**2
    flags = np.zeros(len(points), bool)
    if not origin.size or determinant[origin[0]] <= 0.0 or vxx[origin[0]] <= 0.0 or len(points) < 2:
        return flags
    descent = _Descent(gradient, hessian, points, determinant < 0.0)
    for k in np.flatnonzero(determinant < 0.0):
        one, other = (descent.find_ends(int(k), side) for side in (1.0, -1.0))
        flags[k] = (int(origin[0]) in one) != (int(origin[0]) in other)
    return flags


def find_maxima_beside(gradient: Gradient, hessian: Hessian, points: np.ndarray, saddles: np.ndarray) -> np.ndarray:
    """(m, n) whether a line of steepest ascent from each of m saddles ends at each critical point, a maximum.

    Parameters
    ----------
    gradient, hessian
        (V_x, V_y) and (V_xx, V_xy, V_yy) of the potential as functions of x and y.
    points
        (n, 2) all critical points.
    saddles
        (m,) indices of saddles.
    """
    vxx, vxy, vyy = hessian(points[:, 0], points[:, 1])
    flags = np.zeros((len(saddles), len(points)), bool)
    if not len(saddles) or not np.any((vxx < 0.0) & (vxx * vyy > vxy**2)):
        return flags
    ascent = _Descent(_negative(gradient), _negative(hessian), points, vxx * vyy < vxy**2)
    for row, saddle in zip(flags, saddles, strict=True):
        ends = ascent.find_ends(int(saddle), 1.0) | ascent.find_ends(int(saddle), -1.0)
        row[[end for end in ends if end >= 0]] = True
    return flags


def _negative(derivatives: Callable[..., tuple[np.ndarray, ...]]) -> Callable[..., Any]:
    return lambda x, y: tuple(-value for value in derivatives(x, y))


class _Descent:
    """Lines of steepest descent of one potential from its saddles."""

    def __init__(self, gradient: Gradient, hessian: Hessian, points: np.ndarray, is_saddle: np.ndarray) -> None:
        self.gradient, self.points, self.is_saddle = gradient, points, is_saddle
        distance = np.hypot(*points.T)
        self.length = float(distance[distance > 0.0].min())
        self.far = _FAR * float(distance.max())
        hessians = np.moveaxis(np.array([np.broadcast_to(e, len(points)) for e in hessian(*points.T)]), 0, -1)
        curvatures = [np.abs(np.linalg.eigvalsh([[a, b], [b, c]])) for a, b, c in hessians]
        self.unstable_directions = [np.linalg.eigh([[a, b], [b, c]])[1][:, 0] for a, b, c in hessians]
        # About the largest slope within the well.
        at_origin = float(np.max(curvatures[int(np.argmin(distance))]))
        self.largest_slope = self.length * at_origin
        self.duration = _DURATION / max(float(np.min(curvatures)), 1e-6 * at_origin)

    def find_ends(self, saddle: int, side: float) -> set[int]:
        """Indices of the critical points where the descent on one side of a saddle ends, −1 for infinity.

        There is more than one if the line ends at another saddle, which happens in symmetric potentials.
        """
        pending, visited, ends = [(saddle, side)], {saddle}, set[int]()
        while pending:
            end = self._descend(*pending.pop())
            if end >= 0 and self.is_saddle[end]:
                pending += [(end, 1.0), (end, -1.0)] if end not in visited else []
                visited.add(end)
            else:
                ends.add(end)
        return ends

    def _descend(self, saddle: int, side: float) -> int:
        """Index of the critical point where one line of steepest descent ends, −1 for infinity."""
        from scipy.integrate import solve_ivp

        distance = np.hypot(*(self.points - self.points[saddle]).T)
        others = self.points[distance > 0.0]
        first_step = _START_DISTANCE * distance[distance > 0.0].min()
        start = self.points[saddle] + side * first_step * self.unstable_directions[saddle]

        def downhill(_t: float, place: np.ndarray) -> np.ndarray:
            slope = np.array(self.gradient(*place))
            # Bounded, as otherwise a polynomial can reach minus infinity in finite time; proportional to the distance far away.
            speed = (1.0 + np.hypot(*place) / self.length) / (1.0 + np.hypot(*slope) / self.largest_slope)
            velocity: np.ndarray = -slope * speed
            return velocity

        def near_critical_point(_t: float, place: np.ndarray) -> float:
            return float(np.hypot(*(others - place).T).min() - _END_DISTANCE * self.length)

        def far_away(_t: float, place: np.ndarray) -> float:
            return float(self.far - np.hypot(*place))

        events = (near_critical_point, far_away)
        for event in events:
            event.terminal = True  # type: ignore[attr-defined]
        line = solve_ivp(downhill, (0.0, self.duration), start, "LSODA", events=events, rtol=1e-9, atol=self.length * 1e-9)
        end: np.ndarray = line.y[:, -1]
        if line.t_events[1].size:
            return -1
        return int(np.argmin(np.hypot(*(self.points - end).T)))
