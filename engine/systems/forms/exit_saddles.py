"""Saddles of a potential that lead out of the well at the origin, and the maxima beside them.

Two lines of steepest descent start at a saddle, one on each side along the unstable direction. If one line ends at the origin and
the other line ends elsewhere, at another minimum or at infinity, the saddle is an exit of the well. Two lines of steepest ascent
run along the walls of the channel. If a line ends at a maximum, the channel has no wall there above the energy of the maximum. A
line that reaches a curve where V is infinite, such as x = 3 for V = 1/(x − 3), ends there.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from engine.systems.forms.expression_form import Form
from engine.systems.forms.form import NO_POINTS, DescentError, Flow

ROUNDING = 1e-13
"""Coordinates of a point or a direction below this share of its distance from the origin are rounding errors of zero."""

# Distance from the saddle at which a descent starts, in units of the distance to the nearest other critical point.
_START_DISTANCE = 1e-3
# Distance from a critical point at which a descent ends, in units of the distance of the critical point nearest to the origin.
_END_DISTANCE = 1e-4
# Distance from the origin at which a descent counts as infinite, in units of the distance of the outermost critical point.
_INFINITE_DISTANCE = 10.0

# Rise of V in a step of a descent above which the step has passed a curve where V is infinite, in units of the magnitude of V
# before the step plus the largest magnitude at a critical point.
_LARGEST_RISE = 1e-6

# Length of a step below which a descent has come to rest, in units of the distance of the nearest critical point.
_REST_STEP = 1e-13

# Relative error of a step.
_RELATIVE_ERROR = 1e-9
# Length of the first step, in units of the distance of the start of the descent from the saddle.
_FIRST_STEP = 1e-6
# Limit on the steps of all descents of a potential. This many steps take a few seconds. Most potentials need about 1 000 steps;
# of 600 wells, one needed 17 000.
_MOST_STEPS = 20_000
# Limit on the steps of one solver along a line. Most lines need 200 steps. Lines through long narrow valleys need about 2 000.
_MOST_STEPS_ALONG_LINE = 5_000


def leads_out_of_well(form: Form, points: np.ndarray, indices: np.ndarray, poles: np.ndarray = NO_POINTS) -> np.ndarray:
    """Return whether each critical point is a saddle that leads out of the well or pole at the origin, of shape (n,).

    Parameters
    ----------
    form
        The function V.
    points
        All critical points, of shape (n, 2). A point at the origin is exactly (0, 0). If the origin is neither a minimum nor a
        pole, no point leads out.
    indices
        −1 for saddles, 1 for minima and maxima, of shape (n,).
    poles
        Points where V is not defined and lines of steepest descent can end, of shape (m, 2).
    """
    flags = np.zeros(len(points), bool)
    # Where the index is 1, the sign of V_xx tells minima from maxima.
    sinks = np.concatenate([points[(indices > 0) & (form.hessian(*points.T)[0] > 0.0)], poles])
    all_points = np.concatenate([points, poles])
    is_saddle = np.concatenate([indices < 0, np.zeros(len(poles), bool)])
    if not np.any(np.hypot(*sinks.T) == 0.0) or len(all_points) < 2:
        return flags
    origin = int(np.flatnonzero(np.hypot(*all_points.T) == 0.0)[0])
    descent = _Descent(form, 1.0, all_points, is_saddle)
    for k in np.flatnonzero(is_saddle):
        ends, ends_on_other_side = (descent.find_ends(int(k), side) for side in (1.0, -1.0))
        flags[k] = (origin in ends) != (origin in ends_on_other_side)
    return flags


def find_maxima_beside(form: Form, points: np.ndarray, indices: np.ndarray, saddles: np.ndarray) -> np.ndarray:
    """Return, for each saddle and each critical point, whether a line of steepest ascent from the saddle ends there; (m, n).

    Parameters
    ----------
    form
        The function V.
    points
        All critical points, of shape (n, 2).
    indices
        −1 for saddles, 1 for minima and maxima, of shape (n,).
    saddles
        Indices of saddles among the points, of shape (m,).
    """
    flags = np.zeros((len(saddles), len(points)), bool)
    if not len(saddles) or not np.any((indices > 0) & (form.hessian(*points.T)[0] < 0.0)):
        return flags
    ascent = _Descent(form, -1.0, points, indices < 0)
    for row, saddle in zip(flags, saddles, strict=True):
        ends = ascent.find_ends(int(saddle), 1.0) | ascent.find_ends(int(saddle), -1.0)
        row[[end for end in ends if end >= 0]] = True
    return flags


def in_channel_order(saddles: np.ndarray, *, mirror_in_x: bool) -> np.ndarray:
    """Sort exit saddles (n, 2) counterclockwise from the +x axis, and make zeros and, with `mirror_in_x`, the symmetry exact."""
    # The sign of a rounding error would change the channel numbers on the +x axis.
    rounded = np.where(np.abs(saddles) < ROUNDING * np.hypot(*saddles.T)[:, None], 0.0, saddles)
    angle = np.arctan2(rounded[:, 1], rounded[:, 0]) % (2 * np.pi)
    ordered = rounded[np.argsort(angle, kind="stable")]
    if mirror_in_x:
        _make_symmetric(ordered)
    return ordered


def _make_symmetric(points: np.ndarray) -> None:
    """Replace each point at x < 0 by the exact mirror image of its partner at x > 0, in place."""
    right_points = points[points[:, 0] > 0.0]
    for left in np.flatnonzero(points[:, 0] < 0.0):
        distance = np.hypot(*(right_points - points[left] * [-1.0, 1.0]).T)
        points[left] = right_points[np.argmin(distance)] * [-1.0, 1.0]


class _Descent:
    """Lines of steepest descent of sign · V from saddles; with a sign of −1, they are lines of steepest ascent of V."""

    def __init__(self, form: Form, sign: float, points: np.ndarray, is_saddle: np.ndarray) -> None:
        self.form, self.sign, self.points, self.is_saddle = form, sign, points, is_saddle
        distance = np.hypot(*points.T)
        self.length = float(distance[distance > 0.0].min())
        self.flow = form.descent_flow(self.length, sign)
        self.infinite_distance = _INFINITE_DISTANCE * float(distance.max())
        entries = np.array([np.broadcast_to(sign * entry, len(points)) for entry in form.hessian(*points.T)])
        hessians = np.moveaxis(np.nan_to_num(entries), 0, -1)
        self.unstable_directions = [np.linalg.eigh([[a, b], [b, c]])[1][:, 0] for a, b, c in hessians]
        values = np.abs(form.value(*points.T))
        self.largest_rise = _LARGEST_RISE * float(values.max(where=np.isfinite(values), initial=0.0))
        self.steps_left = _MOST_STEPS

    def find_ends(self, saddle: int, side: float) -> set[int]:
        """Return the indices of the critical points where the descent on one side of a saddle ends, −1 for infinity.

        There are several ends if the line leads to another saddle, as happens in symmetric potentials.
        """
        pending, visited, ends = [(saddle, side)], {saddle}, set[int]()
        while pending:
            end = self._descend(*pending.pop())
            if end >= 0 and self.is_saddle[end]:
                if end not in visited:
                    pending += [(end, 1.0), (end, -1.0)]
                visited.add(end)
            else:
                ends.add(end)
        return ends

    def _descend(self, saddle: int, side: float) -> int:
        """Return the index of the critical point where one line of steepest descent ends, −1 for infinity."""
        from scipy.integrate import LSODA, Radau

        # LSODA may not detect that a long narrow valley needs an implicit method. Radau is implicit, but takes ten times as long,
        # and needs a flow of constant speed: after a very slow start, the steps of Radau would be shorter than the rounding error
        # of the time.
        for solver_class, flow in ((LSODA, self.flow), (Radau, self._steady_flow)):
            with warnings.catch_warnings():
                # If LSODA fails, Radau is tried.
                warnings.filterwarnings("ignore", "lsoda: ", UserWarning)
                end = self._follow(solver_class, flow, saddle, side)
            if end is not None:
                return end
        x, y = self.points[saddle]
        raise DescentError(f"The end of a line of steepest descent from the saddle ({x:.6g}, {y:.6g}) is not found.")

    def _steady_flow(self, time: float, place: np.ndarray) -> np.ndarray:
        """Return the flow scaled to speed 1."""
        velocity = self.flow(time, place)
        return velocity / np.hypot(*velocity)

    def _follow(self, solver_class: Any, flow: Flow, saddle: int, side: float) -> int | None:
        """Descend along a flow with one of SciPy's solvers, and return the result of `_descend`; None if no end is reached."""
        other_indices = np.delete(np.arange(len(self.points)), saddle)
        distance = _START_DISTANCE * self._distances(self.points[saddle])[other_indices].min()
        start = self.points[saddle] + side * distance * self.unstable_directions[saddle]
        # There is no final time, because a descent in a flat valley can take arbitrarily long.
        tolerances = {"rtol": _RELATIVE_ERROR, "atol": _RELATIVE_ERROR * self.length}
        # The first step chosen by LSODA can be too long for its corrector to converge.
        first_step = _FIRST_STEP * distance / np.hypot(*flow(0.0, start))
        solver = solver_class(flow, 0.0, start, np.inf, first_step=first_step, **tolerances)
        value = self._value(start)
        fewest_steps_left = max(self.steps_left - _MOST_STEPS_ALONG_LINE, 0)
        while self.steps_left > fewest_steps_left and solver.status == "running":
            self.steps_left -= 1
            previous_place, previous_value = solver.y, value
            solver.step()
            if solver.status == "failed":
                break
            distances = self._distances(solver.y)[other_indices]
            if distances.min() < _END_DISTANCE * self.length:
                return int(other_indices[np.argmin(distances)])
            step_length = float(np.hypot(*(solver.y - previous_place)))
            value = self._value(solver.y)
            # A line at rest elsewhere is at a critical point outside the searched region. The list does not contain this point.
            is_at_rest = step_length < _REST_STEP * self.length
            if np.hypot(*solver.y) > self.infinite_distance or is_at_rest or self._rises(previous_value, value):
                return -1
        return None

    def _value(self, place: np.ndarray) -> float:
        """Return sign · V at a place."""
        return self.sign * float(self.form.value(*place))

    def _rises(self, before: float, after: float) -> bool:
        """Return whether a step of a descent leads to a higher value, on the other side of a curve where V is infinite."""
        return after - before > self.largest_rise + _LARGEST_RISE * abs(before)

    def _distances(self, place: np.ndarray) -> np.ndarray:
        """Return the distances of all critical points from a place, of shape (n,)."""
        return np.hypot(*(self.points - place).T)
