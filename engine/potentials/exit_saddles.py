"""Which saddles of a potential lead out of the well at the origin: those from which one side runs down into it, the other not.

From a saddle the lines of steepest descent leave to both sides of its unstable direction. Where one ends at the origin and the
other elsewhere, in another minimum or at infinity, the saddle is the pass between the well and what lies beyond it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

Gradient = Callable[..., tuple[np.ndarray, np.ndarray]]
Hessian = Callable[..., tuple[np.ndarray, np.ndarray, np.ndarray]]

# In units of the distance of the critical point nearest to the origin: where a descent starts beside its saddle, where it has
# arrived at a critical point, and where it has left for good.
_BESIDE = 1e-3
_ARRIVED = 1e-4
_FAR = 10.0

# In units of the time in which the slowest descent falls by a factor of e; by then every one has arrived.
_LONGEST = 100.0


def leads_out_of_well(gradient: Gradient, hessian: Hessian, points: np.ndarray) -> np.ndarray:
    """(n,) whether each critical point (n, 2) of a potential is a saddle that leads out of the well at the origin.

    Parameters
    ----------
    gradient, hessian
        (V_x, V_y) and (V_xx, V_xy, V_yy) of the potential as functions of x and y.
    points
        All critical points, the origin among them exactly; none leads out where the origin is no minimum.
    """
    away = np.hypot(*points.T)
    origin = np.flatnonzero(away == 0.0)
    vxx, vxy, vyy = (np.broadcast_to(entry, len(points)) for entry in hessian(points[:, 0], points[:, 1]))
    with np.errstate(over="ignore", invalid="ignore"):
        # So steep a place is no saddle that anything passes.
        determinant = vxx * vyy - vxy**2
    flags = np.zeros(len(points), bool)
    if not origin.size or determinant[origin[0]] <= 0.0 or vxx[origin[0]] <= 0.0 or len(points) < 2:
        return flags
    descent = _Descent(gradient, hessian, points, determinant < 0.0)
    for k in np.flatnonzero(determinant < 0.0):
        one, other = (descent.ends(int(k), side) for side in (1.0, -1.0))
        flags[k] = (int(origin[0]) in one) != (int(origin[0]) in other)
    return flags


class _Descent:
    """Lines of steepest descent of one potential from its saddles."""

    def __init__(self, gradient: Gradient, hessian: Hessian, points: np.ndarray, is_saddle: np.ndarray) -> None:
        self.gradient, self.points, self.is_saddle = gradient, points, is_saddle
        away = np.hypot(*points.T)
        self.length = float(away[away > 0.0].min())
        self.far = _FAR * float(away.max())
        hessians = np.moveaxis(np.array([np.broadcast_to(e, len(points)) for e in hessian(*points.T)]), 0, -1)
        curvatures = [np.abs(np.linalg.eigvalsh([[a, b], [b, c]])) for a, b, c in hessians]
        self.directions = [np.linalg.eigh([[a, b], [b, c]])[1][:, 0] for a, b, c in hessians]
        self.longest = _LONGEST / max(float(np.min(curvatures)), 1e-6 * float(np.max(curvatures)))

    def ends(self, saddle: int, side: float) -> set[int]:
        """Numbers of the critical points that one side of a saddle runs down to, −1 for infinity.

        More than one where the line meets another saddle, as symmetry may have it.
        """
        waiting, seen, found = [(saddle, side)], {saddle}, set[int]()
        while waiting:
            end = self._end(*waiting.pop())
            if end >= 0 and self.is_saddle[end]:
                waiting += [(end, 1.0), (end, -1.0)] if end not in seen else []
                seen.add(end)
            else:
                found.add(end)
        return found

    def _end(self, saddle: int, side: float) -> int:
        start = self.points[saddle] + side * _BESIDE * self.length * self.directions[saddle]
        apart = np.hypot(*(self.points - self.points[saddle]).T)
        others = self.points[apart > 0.0]

        def downhill(_t: float, place: np.ndarray) -> np.ndarray:
            slope = np.array(self.gradient(*place))
            # No faster far out, where a polynomial falls to minus infinity in finite time.
            slower: np.ndarray = -slope / (1.0 + np.hypot(*slope) / self.length)
            return slower

        def arrived(_t: float, place: np.ndarray) -> float:
            return float(np.hypot(*(others - place).T).min() - _ARRIVED * self.length)

        def left(_t: float, place: np.ndarray) -> float:
            return float(self.far - np.hypot(*place))

        for event in (arrived, left):
            event.terminal = True  # type: ignore[attr-defined]
        scale = self.length * 1e-9
        line = solve_ivp(downhill, (0.0, self.longest), start, "LSODA", events=(arrived, left), rtol=1e-9, atol=scale)
        end: np.ndarray = line.y[:, -1]
        if line.t_events[1].size:
            return -1
        return int(np.argmin(np.hypot(*(self.points - end).T)))
