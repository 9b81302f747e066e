"""Saddles of a potential that lead out of the well at the origin, and the maxima beside them.

From a saddle two lines of steepest descent start, one on each side along its unstable direction. If one ends at the origin and
the other elsewhere, at another minimum or at infinity, the saddle is an exit of the well. The two lines of steepest ascent run
along the walls of the channel; above the energy of a maximum at which one line ends, the channel has no wall there. A line that
reaches a curve where V is infinite, such as x = 3 for V = 1/(x − 3), ends there.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from engine.systems.forms.form import NO_POINTS, DescentError, Form, Velocity

# Distance from the saddle at which a descent starts, in units of the distance to the nearest other critical point.
_START_DISTANCE = 1e-3
# Distance from a critical point at which a descent ends, in units of the distance of the critical point nearest to the origin.
_END_DISTANCE = 1e-4
# Distance from the origin at which a descent counts as infinite, in units of that of the outermost critical point.
_FAR = 10.0

# Rise of V in one step of a descent, in units of the largest value at a critical point, beyond which the step has passed a curve
# where V is infinite.
_RISE = 1e-6

# Length of a step below which a descent is at rest, in units of the distance of the critical point nearest to the origin.
_AT_REST = 1e-13

# Relative error of a step.
_RELATIVE_ERROR = 1e-9
# Length of the first step, in units of the distance of the start from the saddle.
_FIRST_MOVE = 1e-6
# Limit on the steps of all descents of a potential, which take some seconds. Most potentials need about 1 000; of 600 wells, one
# needed 17 000.
_MOST_STEPS = 20_000
# Limit on the steps of one method along one line. Most lines need 200; lines through long narrow valleys need about 2 000.
_MOST_STEPS_ALONG_LINE = 5_000


def leads_out_of_well(form: Form, points: np.ndarray, indices: np.ndarray, poles: np.ndarray = NO_POINTS) -> np.ndarray:
    """Return whether each critical point is a saddle that leads out of the well or pole at the origin, of shape (n,).

    Parameters
    ----------
    form
        The function V.
    points
        (n, 2) all critical points, including the origin exactly. If the origin is neither a minimum nor a pole, no point leads
        out.
    indices
        (n,) −1 for saddles, 1 for minima and maxima.
    poles
        (m, 2) points at which V is not defined, where lines of steepest descent can end.
    """
    flags = np.zeros(len(points), bool)
    sinks = np.concatenate([points[(indices > 0) & (form.hessian(*points.T)[0] > 0.0)], poles])
    points, is_saddle = np.concatenate([points, poles]), np.concatenate([indices < 0, np.zeros(len(poles), bool)])
    origin = np.flatnonzero(np.hypot(*points.T) == 0.0)
    if not np.any(np.hypot(*sinks.T) == 0.0) or len(points) < 2:
        return flags
    descent = _Descent(form, 1.0, points, is_saddle)
    for k in np.flatnonzero(is_saddle):
        one, other = (descent.find_ends(int(k), side) for side in (1.0, -1.0))
        flags[k] = (int(origin[0]) in one) != (int(origin[0]) in other)
    return flags


def find_maxima_beside(form: Form, points: np.ndarray, indices: np.ndarray, saddles: np.ndarray) -> np.ndarray:
    """Return whether a line of steepest ascent from each saddle ends at each critical point, of shape (m, n).

    Parameters
    ----------
    form
        The function V.
    points
        (n, 2) all critical points.
    indices
        (n,) −1 for saddles, 1 for minima and maxima.
    saddles
        (m,) indices of saddles among the points.
    """
    flags = np.zeros((len(saddles), len(points)), bool)
    if not len(saddles) or not np.any((indices > 0) & (form.hessian(*points.T)[0] < 0.0)):
        return flags
    ascent = _Descent(form, -1.0, points, indices < 0)
    for row, saddle in zip(flags, saddles, strict=True):
        ends = ascent.find_ends(int(saddle), 1.0) | ascent.find_ends(int(saddle), -1.0)
        row[[end for end in ends if end >= 0]] = True
    return flags


class _Descent:
    """Lines of steepest descent of sign V from its saddles."""

    def __init__(self, form: Form, sign: float, points: np.ndarray, is_saddle: np.ndarray) -> None:
        self.form, self.sign, self.points, self.is_saddle = form, sign, points, is_saddle
        distance = np.hypot(*points.T)
        self.length = float(distance[distance > 0.0].min())
        self.flow = form.downhill(self.length, sign)
        self.far = _FAR * float(distance.max())
        entries = np.array([np.broadcast_to(sign * entry, len(points)) for entry in form.hessian(*points.T)])
        hessians = np.moveaxis(np.nan_to_num(entries), 0, -1)
        self.unstable_directions = [np.linalg.eigh([[a, b], [b, c]])[1][:, 0] for a, b, c in hessians]
        values = np.abs(form.value(*points.T))
        self.largest_rise = _RISE * float(values.max(where=np.isfinite(values), initial=0.0))
        self.steps_left = _MOST_STEPS

    def find_ends(self, saddle: int, side: float) -> set[int]:
        """Return the indices of the critical points where the descent on one side of a saddle ends, −1 for infinity.

        There are several if the line ends at another saddle, as happens in symmetric potentials.
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
        """Return the index of the critical point where one line of steepest descent ends, −1 for infinity."""
        from scipy.integrate import LSODA, Radau

        # LSODA may not detect that a long narrow valley needs an implicit method. Radau is implicit, but takes ten times as long
        # and needs a flow of constant speed: after a very slow start its steps would be shorter than the rounding error of the
        # time.
        for method, flow in ((LSODA, self.flow), (Radau, self._steady_flow)):
            with warnings.catch_warnings():
                # If LSODA fails, the other method is tried.
                warnings.filterwarnings("ignore", "lsoda: ", UserWarning)
                end = self._follow(method, flow, saddle, side)
            if end is not None:
                return end
        x, y = self.points[saddle]
        raise DescentError(f"The end of a line of steepest descent from the saddle ({x:.6g}, {y:.6g}) is not found.")

    def _steady_flow(self, time: float, place: np.ndarray) -> np.ndarray:
        """Return the flow scaled to speed 1."""
        velocity = self.flow(time, place)
        steady: np.ndarray = velocity / np.hypot(*velocity)
        return steady

    def _follow(self, method: Any, flow: Velocity, saddle: int, side: float) -> int | None:
        """Descend like `_descend`, along a flow and by one of SciPy's methods; return None if the end is not reached."""
        others = np.delete(np.arange(len(self.points)), saddle)
        distance = _START_DISTANCE * self._distances(self.points[saddle])[others].min()
        start = self.points[saddle] + side * distance * self.unstable_directions[saddle]
        # There is no final time, because a descent in a flat valley can take arbitrarily long.
        tolerances = {"rtol": _RELATIVE_ERROR, "atol": _RELATIVE_ERROR * self.length}
        # The first step chosen by LSODA can be too long for its corrector to converge.
        first_step = _FIRST_MOVE * distance / np.hypot(*flow(0.0, start))
        line = method(flow, 0.0, start, np.inf, first_step=first_step, **tolerances)
        last = max(self.steps_left - _MOST_STEPS_ALONG_LINE, 0)
        while self.steps_left > last and line.status == "running":
            self.steps_left -= 1
            before = line.y
            line.step()
            if line.status == "failed":
                break
            distances = self._distances(line.y)[others]
            if distances.min() < _END_DISTANCE * self.length:
                return int(others[np.argmin(distances)])
            moved = float(np.hypot(*(line.y - before)))
            # A line at rest elsewhere is at a critical point outside the searched region, which is not in the list.
            if np.hypot(*line.y) > self.far or moved < _AT_REST * self.length or self._rises(before, line.y):
                return -1
        return None

    def _rises(self, before: np.ndarray, after: np.ndarray) -> bool:
        """Return whether a step of a descent leads to a higher value, on the other side of a curve where V is infinite."""
        low, high = (self.sign * float(self.form.value(*place)) for place in (before, after))
        return high - low > self.largest_rise + _RISE * abs(low)

    def _distances(self, place: np.ndarray) -> np.ndarray:
        distances: np.ndarray = np.hypot(*(self.points - place).T)
        return distances
