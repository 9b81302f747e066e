"""What V is: the interface of the two kinds of formulas, `PolynomialForm` and `ExpressionForm`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

from engine.expressions.polynomials import Terms
from engine.integrator.source.recurrence import Definition

Velocity = Callable[[float, np.ndarray], np.ndarray]
"""The velocity (2,) of a line of steepest descent at a time and a place (2,)."""


class Form(Protocol):
    """A function V(x, y) with its derivatives, immutable and hashable; equal forms have equal results to the bit."""

    @property
    def definition(self) -> Definition:
        """V as `engine.integrator` takes it."""

    @property
    def text(self) -> str:
        """V in plain values, for files; with as many digits as it needs to be read back exactly."""

    @property
    def length(self) -> float:
        """A length over which V changes, a power of 2; used only where there is no exit saddle."""

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
        """V at (x, y); arrays broadcast."""

    def gradient(self, x: Any, y: Any) -> tuple[Any, Any]:
        """(V_x, V_y) at (x, y); arrays broadcast."""

    def hessian(self, x: Any, y: Any) -> tuple[Any, Any, Any]:
        """(V_xx, V_xy, V_yy) at (x, y); arrays broadcast."""

    def force(self, axis: int) -> Form:
        """−∂V/∂x (axis 0) or −∂V/∂y (axis 1)."""

    def find_critical_points(self) -> np.ndarray:
        """(n, 3) x and y of the points with ∇V = 0, and 1 for a minimum or a maximum, −1 for a saddle, 0 for a degenerate one.

        The origin, if it is one, is exactly (0, 0).
        """

    def downhill(self, length: float, sign: float) -> Velocity:
        """The flow along −sign ∇V, whose lines are those of steepest descent; it is slower where V is steep at large scales."""

    @property
    def singular_points(self) -> np.ndarray:
        """(n, 2) isolated points at which V is not defined: poles, zeros of the argument of a logarithm or a root."""

    def is_singular_on_curve(self, x: np.ndarray, y: np.ndarray) -> bool:
        """Whether V is not defined along a curve between points of any shape, as 1/x is not."""

    def plus(self, terms: Terms) -> Form:
        """V and a polynomial {(i, j): c}."""

    def scaled(self, length: float, energy: float) -> Form:
        """V(length x, length y) / energy."""

    def with_parameters(self, omega_1: float, omega_2: float, epsilon: float) -> Form:
        """See `Potential.with_parameters`."""

    def moved(self, x: float, y: float) -> Form:
        """V with the origin moved to its critical point (x, y), where its slope is exactly 0 if it is a polynomial."""

    def count_rotations(self) -> int:
        """See `PotentialReview.rotations`."""

    def limits_refusal(self) -> str | None:
        """Why V cannot be used, before anything is searched; None if it can."""


def hessian_matrix(form: Form, x: float, y: float) -> np.ndarray:
    """(2, 2) the Hessian matrix of V at one point."""
    vxx, vxy, vyy = form.hessian(x, y)
    return np.array([[vxx, vxy], [vxy, vyy]])
