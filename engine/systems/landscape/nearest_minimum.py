"""The minimum of V nearest to a place.

The critical points of an expression are known in a disc about the origin, see `engine.systems.forms.stationary_points`. If the
origin is near one of them, the disc is small, and need not contain the place. Points are therefore searched about the place, too.
"""

from __future__ import annotations

import numpy as np

from engine.systems.forms.expression_form import ExpressionForm, Form
from engine.systems.forms.form import NotIsolatedError, UndecidedError
from engine.systems.forms.stored_points import stored_points

# Difference of two distances from the place that counts as rounding, relative to the larger of the place and of the distance.
_ROUNDING = 1e-9


def find_nearest_minimum(form: Form, points: np.ndarray, indices: np.ndarray, place: np.ndarray) -> np.ndarray | None:
    """Return the minimum nearest to a place, of shape (2,); None if no minimum is found.

    Parameters
    ----------
    form
        The function V.
    points, indices
        The known critical points, of shape (n, 2), and their indices, see `Well.critical_indices`.
    place
        The place, of shape (2,).
    """
    found = np.vstack([np.column_stack([points, indices]), _search_about(form, place)])
    vxx, _, vyy = form.hessian(*found[:, :2].T)
    minima = found[(found[:, 2] > 0.0) & (vxx + vyy > 0.0), :2]
    if not len(minima):
        return None
    distance = np.hypot(*(minima - place).T)
    # Of a point that is found twice, the known place is used.
    is_nearest = distance <= distance.min() + _ROUNDING * max(distance.min(), float(np.hypot(*place)))
    nearest: np.ndarray = minima[np.argmax(is_nearest)]
    return nearest


def _search_about(form: Form, place: np.ndarray) -> np.ndarray:
    """Return x, y and index of critical points in a disc about a place; none for a polynomial, whose points are all known."""
    if not isinstance(form, ExpressionForm) or not place.any():
        return np.empty((0, 3))
    moved = form.moved(*place.tolist())
    try:
        points = stored_points("critical_points", moved, moved.find_critical_points)
    except (NotIsolatedError, UndecidedError):
        return np.empty((0, 3))
    return points + np.append(place, 0.0)
