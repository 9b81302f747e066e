"""Quantities that follow from V, the mass and the rotation of the frame, such as H, without the ends of orbits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import Any, Self

import numpy as np

from engine.expressions.nodes import Expression, Sum, X, Y, multiply
from engine.foundations.result import Result
from engine.foundations.validation import checked_array, checked_between, checked_finite, checked_number
from engine.integrator.source.polynomial_recurrence import Terms
from engine.systems.forms.expression_form import Form
from engine.systems.forms.form import hessian_matrix
from engine.systems.forms.polynomial_form import PolynomialForm
from engine.systems.parameters import WELL_PARAMETERS, symbol_of

# x² and y².
_SQUARES = tuple(multiply(axis, axis) for axis in (X, Y))
# x y.
_PRODUCT = multiply(X, Y)

MASS_RANGE = 1e-6, 1e6
"""Smallest and largest legal mass, dimensionless."""


class Motion(Result):
    """The equations of motion of H = (px² + py²)/2m + V, in a frame that may rotate.

    Attributes
    ----------
    name
        Display name.
    form
        The function V.
    rotation
        Ω, dimensionless.
    mass
        m, dimensionless.
    """

    name: str
    form: Form
    rotation: float
    mass: float

    def _copy_with(self, *, factors: Mapping[str, float] | None = None, **values: Any) -> Self:
        """Return a copy with other values of some attributes, and those factors of the parameters of its system."""
        raise NotImplementedError

    @property
    def terms(self) -> Terms:
        """The terms ((i, j, c), …) of a polynomial; ValueError for other formulas."""
        if not isinstance(self.form, PolynomialForm):
            raise ValueError(f"{self.name} is not a polynomial")
        return self.form.terms

    def value(self, x: Any, y: Any) -> Any:
        """Return V at (x, y). Arrays broadcast."""
        return self.form.value(x, y)

    def gradient(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Return (V_x, V_y) at (x, y). Arrays broadcast."""
        return self.form.gradient(x, y)

    def hessian(self, x: Any, y: Any) -> tuple[Any, Any, Any]:
        """Return (V_xx, V_xy, V_yy) at (x, y). Arrays broadcast."""
        return self.form.hessian(x, y)

    def hessian_matrix(self, x: float, y: float) -> np.ndarray:
        """Return the Hessian matrix of V at one point, of shape (2, 2)."""
        return hessian_matrix(self.form, x, y)

    def energy(self, states: Any) -> Any:
        """Return H of states x, y, px, py, of shape (…, 4)."""
        array = checked_array("states", states)
        if array.shape[-1:] != (4,):
            raise ValueError(f"states of shape {array.shape}: must be (…, 4) with x, y, px, py")
        x, y, px, py = np.moveaxis(array, -1, 0)
        return 0.5 * (px * px + py * py) / self.mass + self.value(x, y)

    def derivatives(self, states: np.ndarray) -> np.ndarray:
        """Return the derivatives of states x, y, px, py, of shape (…, 4), with respect to time."""
        x, y, px, py = np.moveaxis(states, -1, 0)
        slope_x, slope_y = self.gradient(x, y)
        forces = 2.0 * self.rotation * py - slope_x, -2.0 * self.rotation * px - slope_y
        return np.stack([px / self.mass, py / self.mass, *forces], axis=-1)

    def jacobi_constant(self, energy: Any) -> Any:
        """Return the Jacobi constant C = 2U − ẋ² − ẏ² of energies H in a rotating frame; arrays keep their shape.

        C = (Ω d)² − 2H/m, where m is the mass, and d is the distance of the origin from the axis of the frame. In the three-body
        problem with bodies of masses μ and 1 − μ, U = (1 − μ)/r₁ + μ/r₂ + ½ (x² + y²), and the axis is at the barycentre. In
        axes at the body of mass μ, such as the Moon, d = 1 − μ. Some authors add μ(1 − μ) to C.

        Raises
        ------
        ValueError
            If the frame does not rotate, or an energy is not finite.

        Examples
        --------
        >>> from escape_explorer import POTENTIALS
        >>> hill, earth_moon = POTENTIALS["Hill"], POTENTIALS["Earth-Moon"]
        >>> round(hill.jacobi_constant(hill.escape_energy), 5), round(earth_moon.jacobi_constant(earth_moon.escape_energy), 5)
        (4.32675, 3.18834)
        """
        return self._squared_speed_of_origin - 2.0 * checked_finite("energy", energy) / self.mass

    def jacobi_energy(self, constant: Any) -> Any:
        """Return the energies H of Jacobi constants, see `jacobi_constant`."""
        return 0.5 * self.mass * (self._squared_speed_of_origin - checked_finite("constant", constant))

    @property
    def rotation_axis(self) -> np.ndarray:
        """(2,) x and y of the axis of a rotating frame: the barycentre in the three-body problem, in the coordinates of any body.

        The terms a x + b y in Φ = … + a x + b y − ½ m Ω² (x² + y²) are part of the centrifugal term for an axis at (a, b)/mΩ². If
        there are other quadratic terms, the axis is at the origin.

        Raises
        ------
        ValueError
            If the frame does not rotate.
        """
        if not self.rotation:
            raise ValueError(f"potential={self.name}: its frame must rotate")
        definition: Any = self.form.definition
        terms: dict[Expression, float] = dict(definition.terms) if isinstance(definition, Sum) else {}
        divisor = self.mass * self.rotation**2
        is_centrifugal = all(math.isclose(terms.get(square, 0.0), -0.5 * divisor) for square in _SQUARES)
        # The square of a very small rate underflows to 0.
        if not is_centrifugal or _PRODUCT in terms or not divisor:
            return np.zeros(2)
        return np.array([terms.get(X, 0.0), terms.get(Y, 0.0)]) / divisor

    @property
    def _squared_speed_of_origin(self) -> float:
        """The square of the speed Ω d with which the origin moves around the axis of the frame."""
        return float(np.sum(np.square(self.rotation * self.rotation_axis)))

    def in_rotating_frame(self, rotation: float) -> Self:
        """Return the potential in a frame that rotates about the origin at the rate Ω: Φ = V − ½ m Ω² (x² + y²).

        Parameters
        ----------
        rotation
            Ω, counterclockwise for Ω > 0, at most 1e9 in magnitude, dimensionless.

        Raises
        ------
        ValueError
            If the rate is out of range, or the frame of the potential already rotates.
        """
        if self.rotation:
            raise ValueError(f"potential={self.name}: must be one of a frame that does not rotate")
        coefficient = -0.5 * self.mass * checked_number("rotation", rotation) ** 2
        if not rotation:
            return self
        return self._copy_with(form=self.form.plus({(2, 0): coefficient, (0, 2): coefficient}), rotation=rotation)

    @cached_property
    def reversed_in_time(self) -> Self:
        """The potential with −Ω. Its orbits are those of this potential backward in time, with reversed velocities."""
        return self._copy_with(rotation=-self.rotation) if self.rotation else self

    def with_parameters(self, omega_1: float = 1.0, omega_2: float = 1.0, epsilon: float = 1.0) -> Self:
        """Return this potential with other frequencies of its well and another strength of its perturbation.

        V = ½ (ω1² x² + ω2² y²) + ε V1 as in Zotos (2014), who uses ω1 = ω2 = ε = 1. V1 is V without the constant, linear and
        quadratic terms of its expansion about the origin: the terms of degree 3 and higher of a polynomial. The terms with x², y²
        and x y are multiplied by ω1², ω2² and ω1 ω2, even if the quadratic terms are not ½ (x² + y²). The default values give the
        potential itself. Constant and linear terms are unchanged. The result can be the system of a `ParameterAxis` if this
        potential can.

        Parameters
        ----------
        omega_1, omega_2
            Frequencies along x and y, dimensionless, from 0.1 to 10.
        epsilon
            Strength of V1, dimensionless, from 0.01 to 100.

        Raises
        ------
        ValueError
            If a parameter is out of range.
        """
        parameters = {"omega_1": omega_1, "omega_2": omega_2, "epsilon": epsilon}
        for name, value in parameters.items():
            checked_between(name, value, *WELL_PARAMETERS[name].range)
        if omega_1 == omega_2 == epsilon == 1.0:
            return self
        if not np.isfinite(self.hessian_matrix(0.0, 0.0)).all():
            raise ValueError(f"omega_1, omega_2, epsilon: V of {self.name} has no expansion about the origin; must be 1")
        changes = ", ".join(f"{symbol_of(name)}={value:g}" for name, value in parameters.items() if value != 1.0)
        form = self.form.with_parameters(omega_1, omega_2, epsilon)
        return self._copy_with(name=f"{self.name} ({changes})", form=form, factors=parameters)

    def check_at_rest(self, what: str) -> None:
        """Raise ValueError if the frame rotates. `what` names, in the plural, computations that rely on time reversal."""
        if self.rotation:
            raise ValueError(f"potential={self.name}: its frame rotates; {what} are for frames that do not rotate")
