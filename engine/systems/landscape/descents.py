"""Lines of steepest descent of a potential from its saddles, and of steepest ascent.

If V is even in y, no line crosses y = 0. In a long narrow valley along y = 0, the distance of a line from y = 0 falls to very
small values, and it grows again on a ridge that follows. Its relative error is controlled, so that rounding does not decide where
the line leaves the ridge. Lines from mirror images of a saddle are not followed, because they are mirror images of lines. The
same holds for x.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from engine.systems.forms.expression_form import Form
from engine.systems.forms.form import DescentError, Flow
from engine.systems.landscape.mirror_images import Signs, find_images, mirrors_of

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
# Distance from a line of symmetry up to which the relative error of this distance is controlled, in units of the distance of the
# nearest critical point. A smaller value would let stiff valleys need too many steps.
_SMALLEST_DISTANCE = 1e-100
# Length of the first step, in units of the distance of the start of the descent from the saddle.
_FIRST_STEP = 1e-6
# Limit on the steps of all descents of a potential. This many steps take a few seconds. Most potentials need about 1 000 steps;
# of 600 wells, one needed 17 000.
_MOST_STEPS = 20_000
# Limit on the steps of one solver along a line. Most lines need 200 steps. Lines through long narrow valleys need about 2 000.
_MOST_STEPS_ALONG_LINE = 5_000


Lines = dict[int, np.ndarray]
"""The places (n, 2) of lines from a saddle, by the index of the critical point where each ends; −1 for infinity."""


class Descents:
    """Lines of steepest descent of sign · V from saddles; with a sign of −1, they are lines of steepest ascent of V."""

    def __init__(self, form: Form, sign: float, points: np.ndarray, is_saddle: np.ndarray) -> None:
        self._form, self._sign, self._points, self._is_saddle = form, sign, points, is_saddle
        distance = np.hypot(*points.T)
        self._length = float(distance[distance > 0.0].min())
        smallest = [_SMALLEST_DISTANCE if is_even else 1.0 for is_even in (form.mirror_in_x, form.mirror_in_y)]
        self._absolute_error = _RELATIVE_ERROR * self._length * np.array(smallest)
        # The index −1, for infinity, is its own image.
        self._images = {signs: np.append(find_images(points, signs), -1) for signs in mirrors_of(form)}
        self._flow = form.descent_flow(self._length, sign)
        self._infinite_distance = _INFINITE_DISTANCE * float(distance.max())
        entries = np.array([np.broadcast_to(sign * entry, len(points)) for entry in form.hessian(*points.T)])
        hessians = np.moveaxis(np.nan_to_num(entries), 0, -1)
        self._unstable_directions = [np.linalg.eigh([[a, b], [b, c]])[1][:, 0] for a, b, c in hessians]
        values = np.abs(form.value(*points.T))
        self._largest_rise = _LARGEST_RISE * float(values.max(where=np.isfinite(values), initial=0.0))
        self._steps_left = _MOST_STEPS

    def find_all(self, saddles: np.ndarray) -> list[tuple[Lines, Lines]]:
        """Return, for each saddle, the lines on its two sides. Only one of two lines that are mirror images is followed."""
        known: dict[int, tuple[Lines, Lines]] = {}
        for saddle in saddles.tolist():
            if saddle not in known:
                known[saddle] = self._find_both(saddle)
            lines, other_lines = known[saddle]
            for signs, images in self._images.items():
                known.setdefault(int(images[saddle]), (_mirror(lines, signs, images), _mirror(other_lines, signs, images)))
        return [known[saddle] for saddle in saddles.tolist()]

    def _find_both(self, saddle: int) -> tuple[Lines, Lines]:
        """Return the lines on both sides of a saddle."""
        lines = self._find(saddle, 1.0)
        direction = self._unstable_directions[saddle]
        for signs, images in self._images.items():
            if images[saddle] == saddle and np.array_equal(direction * signs, -direction):
                return lines, _mirror(lines, signs, images)
        return lines, self._find(saddle, -1.0)

    def _find(self, saddle: int, side: float) -> Lines:
        """Return the lines on one side of a saddle: one, unless it leads to another saddle, as in symmetric potentials."""
        pending, visited, lines = [(saddle, side, self._points[[saddle]])], {saddle}, Lines()
        while pending:
            start, start_side, places = pending.pop()
            end, line = self._descend(start, start_side)
            places = np.concatenate([places, line])
            if end < 0 or not self._is_saddle[end]:
                lines[end] = places
            elif end not in visited:
                visited.add(end)
                pending += [(end, 1.0, places), (end, -1.0, places)]
        return lines

    def _descend(self, saddle: int, side: float) -> tuple[int, np.ndarray]:
        """Return the index of the critical point where a line from a saddle ends, −1 for infinity, and its places (n, 2)."""
        from scipy.integrate import LSODA, Radau

        # LSODA may not detect that a long narrow valley needs an implicit method. Radau is implicit, but takes ten times as long,
        # and needs a flow of constant speed: after a very slow start, the steps of Radau would be shorter than the rounding error
        # of the time.
        for solver_class, flow in ((LSODA, self._flow), (Radau, self._steady_flow)):
            with warnings.catch_warnings():
                # If LSODA fails, Radau is tried.
                warnings.filterwarnings("ignore", "lsoda: ", UserWarning)
                end, places = self._follow(solver_class, flow, saddle, side)
            if end is not None:
                return end, np.array(places)
        x, y = self._points[saddle]
        raise DescentError(f"The end of a line of steepest descent from the saddle ({x:.6g}, {y:.6g}) is not found.")

    def _steady_flow(self, time: float, place: np.ndarray) -> np.ndarray:
        """Return the flow scaled to speed 1."""
        velocity = self._flow(time, place)
        return velocity / np.hypot(*velocity)

    def _follow(self, solver_class: Any, flow: Flow, saddle: int, side: float) -> tuple[int | None, list[np.ndarray]]:
        """Descend along a flow with one of SciPy's solvers; see `_descend`. The end is None if it is not reached."""
        other_indices = np.delete(np.arange(len(self._points)), saddle)
        distance = _START_DISTANCE * self._distances(self._points[saddle])[other_indices].min()
        start = self._points[saddle] + side * distance * self._unstable_directions[saddle]
        # There is no final time, because a descent in a flat valley can take arbitrarily long.
        tolerances = {"rtol": _RELATIVE_ERROR, "atol": self._absolute_error}
        # The first step chosen by LSODA can be too long for its corrector to converge.
        first_step = _FIRST_STEP * distance / np.hypot(*flow(0.0, start))
        solver = solver_class(flow, 0.0, start, np.inf, first_step=first_step, **tolerances)
        value, places = self._value(start), [start]
        fewest_steps_left = max(self._steps_left - _MOST_STEPS_ALONG_LINE, 0)
        while self._steps_left > fewest_steps_left and solver.status == "running":
            self._steps_left -= 1
            previous_place, previous_value = solver.y, value
            try:
                solver.step()
            except ValueError:
                # The slope of V is not a finite number at a place that Radau tries.
                break
            if solver.status == "failed":
                break
            places.append(solver.y)
            distances = self._distances(solver.y)[other_indices]
            if distances.min() < _END_DISTANCE * self._length:
                return int(other_indices[np.argmin(distances)]), places
            step_length = float(np.hypot(*(solver.y - previous_place)))
            value = self._value(solver.y)
            # A line at rest elsewhere is at a critical point outside the searched region. The list does not contain this point.
            is_at_rest = step_length < _REST_STEP * self._length
            if np.hypot(*solver.y) > self._infinite_distance or is_at_rest or self._rises(previous_value, value):
                return -1, places
        return None, places

    def _value(self, place: np.ndarray) -> float:
        """Return sign · V at a place."""
        return self._sign * float(self._form.value(*place))

    def _rises(self, before: float, after: float) -> bool:
        """Return whether a step of a descent leads to a higher value, on the other side of a curve where V is infinite."""
        return after - before > self._largest_rise + _LARGEST_RISE * abs(before)

    def _distances(self, place: np.ndarray) -> np.ndarray:
        """Return the distances of all critical points from a place, of shape (n,)."""
        return np.hypot(*(self._points - place).T)


def _mirror(lines: Lines, signs: Signs, images: np.ndarray) -> Lines:
    """Return the mirror images of lines, given the image of each critical point."""
    return {int(images[end]): places * signs for end, places in lines.items()}
