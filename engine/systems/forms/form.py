"""The interface of the two kinds of formulas, `PolynomialForm` and `ExpressionForm`, and the errors of their searches."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from engine.expressions.polynomials import Terms
from engine.foundations.arrays import read_only
from engine.integrator.source.recurrence import Definition

NO_POINTS = read_only(np.empty((0, 2)))
"""An empty array of points, of shape (0, 2)."""


class NotIsolatedError(ValueError):
    """The critical points form a curve, so they cannot be listed."""

    def __init__(self, message: str = "the force vanishes along a curve instead of at isolated points") -> None:
        super().__init__(message)


class UndecidedError(ValueError):
    """The points were not found within the limit on the work."""


class DescentError(ValueError):
    """The end of a line of steepest descent was not found."""


Velocity = Callable[[float, np.ndarray], np.ndarray]
"""The velocity of a line of steepest descent, of shape (2,), as a function of time and position."""


class Form(Protocol):
    """A function V(x, y) with its derivatives, immutable and hashable. Equal forms have results that are equal to the bit."""

    @property
    def definition(self) -> Definition:
        """V in the form that `engine.integrator` takes."""

    @property
    def text(self) -> str:
        """V as text for files, with all digits needed to read V back exactly."""

    @property
    def length(self) -> float:
        """A length over which V changes, a power of 2. It is used only if there is no exit saddle."""

    @property
    def mirror_in_x(self) -> bool:
        """Whether V(−x, y) = V(x, y), exactly in floating point."""

    @property
    def mirror_in_y(self) -> bool:
        """Whether V(x, −y) = V(x, y), exactly in floating point."""

    @property
    def has_constant(self) -> bool:
        """Whether V has a constant term that can be left out."""

    def value(self, x: Any, y: Any) -> Any:
        """Return V at (x, y). Arrays broadcast."""

    def gradient(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Return (V_x, V_y) at (x, y). Arrays broadcast."""

    def hessian(self, x: Any, y: Any) -> tuple[Any, Any, Any]:
        """Return (V_xx, V_xy, V_yy) at (x, y). Arrays broadcast."""

    def force(self, axis: int) -> Form:
        """Return −∂V/∂x (axis 0) or −∂V/∂y (axis 1)."""

    def find_critical_points(self) -> np.ndarray:
        """Find x, y and index of the points with ∇V = 0, of shape (n, 3).

        The index is 1 for a minimum or a maximum, −1 for a saddle and 0 for a degenerate point. A point at the origin is exactly
        (0, 0).
        """

    def downhill(self, length: float, sign: float) -> Velocity:
        """Return the flow along −sign ∇V on lines of steepest descent, slowed where V is steeper than at `length`."""

    @property
    def singular_points(self) -> np.ndarray:
        """Isolated points where V is not defined, of shape (n, 2): poles, and zeros of the argument of a logarithm or a root."""

    def is_singular_on_curve(self, x: np.ndarray, y: np.ndarray) -> bool:
        """Return whether V is not defined along a curve, such as 1/x along x = 0, between points in arrays of any shape."""

    def plus(self, terms: Terms) -> Form:
        """Return V plus a polynomial {(i, j): c}."""

    def scaled(self, length: float, energy: float) -> Form:
        """Return V(length x, length y) / energy."""

    def with_parameters(self, omega_1: float, omega_2: float, epsilon: float) -> Form:
        """See `Potential.with_parameters`."""

    def moved(self, x: float, y: float) -> Form:
        """Return V with the origin moved to its critical point (x, y). The slope of a polynomial there becomes exactly 0."""

    def count_rotations(self) -> int:
        """See `PotentialReview.rotations`."""

    def limits_refusal(self) -> str | None:
        """Return the reason why V cannot be used, without any search; None for a usable V."""


def hessian_matrix(form: Form, x: float, y: float) -> np.ndarray:
    """Return the Hessian matrix of V at one point, of shape (2, 2)."""
    vxx, vxy, vyy = form.hessian(x, y)
    return np.array([[vxx, vxy], [vxy, vyy]])
