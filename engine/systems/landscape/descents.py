"""Lines of steepest descent of a potential from its saddles, and of steepest ascent.

If V_y = 0 on y = 0, no line crosses y = 0. In a long narrow valley along y = 0, the distance of a line from y = 0 falls to very
small values, and it grows again on a ridge that follows. Its logarithm is integrated, so that rounding does not decide where the
line leaves the ridge. If V is even in y, lines from mirror images of a saddle are not followed, because they are mirror images of
lines. The same holds for x.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.foundations.wording import format_point
from engine.systems.forms.expression_form import Form
from engine.systems.forms.form import DescentError, Flow, hessian_matrix
from engine.systems.landscape.mirror_images import Signs, find_images, mirrors_of

# Distance from the saddle at which a descent starts, in units of the distance to the nearest other critical point.
_START_DISTANCE = 1e-3
# Distance from a critical point at which a descent ends, in units of the distance of the critical point nearest to the origin.
# Its limit is in units of the distance to the nearest other critical point.
_END_DISTANCE, _LARGEST_END_DISTANCE = 1e-4, 0.1
# Distance from the origin at which a descent counts as infinite, in units of the distance of the outermost critical point.
_INFINITE_DISTANCE = 10.0

# Rise of V in a step of a descent above which the step has passed a curve where V is infinite, in units of the magnitude of V
# before the step plus the largest magnitude at a critical point.
_LARGEST_RISE = 1e-6

# Slope below which V is flat. Smaller slopes, such as those of exp(−r²) far away, lose their digits, and then become 0.
_SMALLEST_SLOPE = 1e-290
# Distance from a critical point outside the searched region at which a descent ends, in units of its distance from the origin.
# Negative curvatures below this share of the positive one are errors of zero, as on a circle of minima.
_REST_DISTANCE = 1e-6

# Relative error of a step.
_RELATIVE_ERROR = 1e-9
# Smallest distance from an axis at which the slope of V is evaluated, in units of the distance of the nearest critical point. At
# smaller distances, the slope across the axis is proportional to the distance.
_SMALLEST_DISTANCE = 1e-7
# Distances from the origin of points of an axis, in units of the distance of the nearest critical point.
_PLACES_ON_AXIS = np.geomspace(1e-3, 1e3, 13)
# Length of the first step, in units of the distance of the start of the descent from the saddle.
_FIRST_STEP = 1e-6
# Limit on the steps of all descents of a potential. This many steps take about ten seconds. Most potentials need about 1 000
# steps; those with many saddles in long narrow valleys need 20 000.
_MOST_STEPS = 30_000
# Limit on the steps of one solver along a line. Most lines need 200 steps. Lines through long narrow valleys need about 1 000.
_MOST_STEPS_ALONG_LINE = 5_000


Lines = dict[int, np.ndarray]
"""The places (n, 2) of lines from a saddle, by the index of the critical point where each ends; −1 for infinity."""


class Descents:
    """Lines of steepest descent of sign · V from saddles; with a sign of −1, they are lines of steepest ascent of V."""

    def __init__(self, form: Form, sign: float, points: np.ndarray, is_saddle: np.ndarray) -> None:
        self._form, self._sign, self._points, self._is_saddle = form, sign, points, is_saddle
        distance = np.hypot(*points.T)
        self._length = float(distance[distance > 0.0].min())
        self._axes_never_crossed = _axes_never_crossed(form, self._length)
        apart = np.hypot(*(points[:, None] - points).T)
        np.fill_diagonal(apart, np.inf)
        self._nearest = apart.min(axis=0)
        self._end_distances = np.minimum(_END_DISTANCE * self._length, _LARGEST_END_DISTANCE * self._nearest)
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
        line = "descent" if self._sign > 0.0 else "ascent"
        raise DescentError(f"The end of a line of steepest {line} from the saddle {format_point(x, y)} is not found.")

    def _steady_flow(self, time: float, place: np.ndarray) -> np.ndarray:
        """Return the flow scaled to speed 1; 0 where V is flat to rounding."""
        velocity = self._flow(time, place)
        return velocity / (float(np.hypot(*velocity)) or 1.0)

    def _follow(self, solver_class: Any, flow: Flow, saddle: int, side: float) -> tuple[int | None, list[np.ndarray]]:
        """Descend along a flow with one of SciPy's solvers; see `_descend`. The end is None if it is not reached."""
        distance = _START_DISTANCE * self._nearest[saddle]
        start = self._points[saddle] + side * distance * self._unstable_directions[saddle]
        # The first step chosen by LSODA can be too long for its corrector to converge.
        first_step = _FIRST_STEP * distance / np.hypot(*flow(0.0, start))
        line = _Coordinates(start, [axis for axis in self._axes_never_crossed if start[axis]], self._length)
        solver = line.solver(solver_class, flow, first_step)
        place, value, places = start, self._value(start), [start]
        fewest_steps_left = max(self._steps_left - _MOST_STEPS_ALONG_LINE, 0)
        while self._steps_left > fewest_steps_left and solver.status == "running":
            self._steps_left -= 1
            previous_place, previous_value = place, value
            try:
                solver.step()
            except ValueError:
                # The slope of V is not a finite number at a place that Radau tries.
                break
            if solver.status == "failed":
                break
            place = line.place(solver.y)
            places.append(place)
            is_at_end = np.hypot(*(self._points - place).T) < self._end_distances
            is_at_end[saddle] = False
            if is_at_end.any():
                return int(np.argmax(is_at_end)), places
            value = self._value(place)
            is_far = np.hypot(*place) > self._infinite_distance or np.hypot(*self._flow(0.0, place)) < _SMALLEST_SLOPE
            # The list does not contain critical points outside the searched region.
            if is_far or self._rises(previous_value, value) or self._is_at_rest(previous_place, place):
                return -1, places
        return None, places

    def _is_at_rest(self, previous: np.ndarray, place: np.ndarray) -> bool:
        """Return whether a step of a descent leads to a minimum of sign · V, which Newton's method finds nearby."""
        distance = _REST_DISTANCE * np.hypot(*place)
        if np.hypot(*(place - previous)) > distance:
            return False
        slope = self._sign * np.array(self._form.gradient(*place))
        hessian = self._sign * hessian_matrix(self._form, *place)
        if not np.isfinite([*slope, *hessian.ravel()]).all():
            return False
        step = np.linalg.lstsq(hessian, slope)[0]
        is_solved = np.hypot(*(hessian @ step - slope)) <= 0.1 * np.hypot(*slope)
        smallest, largest = np.linalg.eigvalsh(hessian)
        return bool(is_solved and np.hypot(*step) < distance and smallest > -_REST_DISTANCE * largest)

    def _value(self, place: np.ndarray) -> float:
        """Return sign · V at a place."""
        return self._sign * float(self._form.value(*place))

    def _rises(self, before: float, after: float) -> bool:
        """Return whether a step of a descent leads to a higher value, on the other side of a curve where V is infinite."""
        return after - before > self._largest_rise + _LARGEST_RISE * abs(before)


@dataclass(frozen=True)
class _Coordinates:
    """Coordinates along a line that begins at `start`: x and y, some of them transformed.

    The distance z from an axis that the line does not cross, in units of length, becomes w = z + ln z. Near the axis, w is nearly
    the logarithm; far away, it is nearly the distance.
    """

    start: np.ndarray
    transformed_axes: list[int]
    length: float

    def solver(self, solver_class: Any, flow: Flow, first_step: float) -> Any:
        """Return a solver of SciPy. There is no final time, because a descent in a flat valley can take arbitrarily long."""
        begin, errors = self.start.copy(), np.full(2, _RELATIVE_ERROR * self.length)
        for axis in self.transformed_axes:
            distance = abs(self.start[axis]) / self.length
            begin[axis], errors[axis] = distance + np.log(distance), _RELATIVE_ERROR

        def velocity(time: float, coordinates: np.ndarray) -> np.ndarray:
            place = self.place(coordinates)
            changes = flow(time, place)
            for axis in self.transformed_axes:
                changes[axis] *= 1.0 / place[axis] + math.copysign(1.0 / self.length, place[axis])
            return changes

        return solver_class(velocity, 0.0, begin, np.inf, first_step=first_step, rtol=_RELATIVE_ERROR, atol=errors)

    def place(self, coordinates: np.ndarray) -> np.ndarray:
        """Return x and y, at least the smallest distance from an axis that the line does not cross."""
        from scipy.special import wrightomega

        place = coordinates.copy()
        for axis in self.transformed_axes:
            distance = max(float(wrightomega(coordinates[axis])), _SMALLEST_DISTANCE)
            place[axis] = math.copysign(self.length * distance, self.start[axis])
        return place


def _axes_never_crossed(form: Form, length: float) -> list[int]:
    """Return 0 if V_x = 0 on x = 0, and 1 if V_y = 0 on y = 0, exactly at points up to 1 000 lengths from the origin.

    Points where the slope is not a number do not count, because V overflows there or is not defined.
    """
    along = length * np.concatenate([_PLACES_ON_AXIS, -_PLACES_ON_AXIS])
    zeros = np.zeros_like(along)
    slopes = form.gradient(zeros, along)[0], form.gradient(along, zeros)[1]
    are_zero = [slope[np.isfinite(slope)] == 0.0 for slope in slopes]
    return [axis for axis, each in enumerate(are_zero) if each.size and each.all()]


def _mirror(lines: Lines, signs: Signs, images: np.ndarray) -> Lines:
    """Return the mirror images of lines, given the image of each critical point."""
    return {int(images[end]): places * signs for end, places in lines.items()}
