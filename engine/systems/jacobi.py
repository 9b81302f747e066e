"""The axis of a rotating frame, about which the Jacobi constant of the three-body problem is counted."""

from __future__ import annotations

import math
from typing import Any

from engine.expressions.nodes import Expression, Sum, X, Y, multiply
from engine.systems.forms.form import Form

_SQUARES = tuple(multiply(axis, axis) for axis in (X, Y))
_MIXED = multiply(X, Y)


def squared_speed_of_origin(form: Form, rotation: float, mass: float) -> float:
    """Return the square of the speed Ω d with which the origin moves around the axis of the frame.

    A uniform field in Φ = … + a x + b y − ½ m Ω² (x² + y²) is the centrifugal force about an axis at (a, b)/mΩ², as in the
    three-body problem in the coordinates of one body. If there are other quadratic terms, the axis is at the origin.
    """
    definition: Any = form.definition
    if not isinstance(definition, Sum) or not rotation:
        return 0.0
    terms: dict[Expression, float] = dict(definition.terms)
    is_centrifugal = all(math.isclose(terms.get(square, 0.0), -0.5 * mass * rotation**2) for square in _SQUARES)
    if not is_centrifugal or _MIXED in terms:
        return 0.0
    return (terms.get(X, 0.0) ** 2 + terms.get(Y, 0.0) ** 2) / (mass * rotation) ** 2
