"""Errors, types and the Hessian matrix for both kinds of formulas, `PolynomialForm` and `ExpressionForm`."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from engine.foundations.arrays import read_only

if TYPE_CHECKING:
    from engine.systems.forms.expression_form import Form

NO_POINTS = read_only(np.empty((0, 2)))
"""An empty array of points, of shape (0, 2)."""


class NotIsolatedError(ValueError):
    """The critical points form a curve, so they cannot be listed."""

    def __init__(self, message: str = "the force vanishes along a curve instead of at isolated points") -> None:
        super().__init__(message)


class UndecidedError(ValueError):
    """It is not decided whether all critical points are known, for example because the limit on the work is reached."""


class DescentError(ValueError):
    """The end of a line of steepest descent was not found."""


Flow = Callable[[float, np.ndarray], np.ndarray]
"""The flow along lines of steepest descent: its velocity, of shape (2,), as a function of time and position (2,)."""


def hessian_matrix(form: Form, x: float, y: float) -> np.ndarray:
    """Return the Hessian matrix of V at one point, of shape (2, 2)."""
    vxx, vxy, vyy = form.hessian(x, y)
    return np.array([[vxx, vxy], [vxy, vyy]])
