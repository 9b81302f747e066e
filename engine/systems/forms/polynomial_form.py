"""Potentials that are polynomials, V = Σ c x^i y^j."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import comb
from typing import Any, ClassVar

import numpy as np

from engine.expressions.polynomials import (
    HIGHEST_DEGREE,
    Powers,
    Terms,
    degree,
    derivative,
    evaluate,
    largest_coefficients,
    substitute,
)
from engine.foundations.validation import LARGEST_COEFFICIENT, checked_count, checked_number, short_repr
from engine.systems.forms.critical_points import find_critical_points
from engine.systems.forms.form import NO_POINTS, Flow

MOST_TERMS = 60
"""Largest number of terms of a potential after expansion."""

COEFFICIENT_RANGE = (1e-9, 1e9)
"""Smallest and largest magnitude of a coefficient of a formula."""

# Smallest coefficient, as a share of the largest, in units of `PolynomialForm.length`. Smaller coefficients have no effect in
# double precision.
_SMALLEST_RATIO = 1e-18
# Share of the largest coefficient up to which a coefficient counts as a rounding error of 0. After a shift of the origin, the
# largest coefficient of V is meant; in `_complex_terms`, that of the same degree.
_ZERO_COEFFICIENT = 1e-12


@dataclass(frozen=True)
class PolynomialForm:
    """V = Σ c x^i y^j, given by its `terms` ((i, j, c), …)."""

    terms: tuple[tuple[int, int, float], ...]

    singular_points: ClassVar = NO_POINTS
    """No points, because a polynomial has no singular points."""

    @property
    def definition(self) -> tuple[tuple[int, int, float], ...]:
        """The terms, from which kernels are generated."""
        return self.terms

    @property
    def text(self) -> str:
        """The terms, such as "0.5 x^2 y^0; …"."""
        return "; ".join(f"{c!r} x^{i} y^{j}" for i, j, c in self.terms)

    @cached_property
    def coefficients(self) -> dict[Powers, float]:
        """The terms as {(i, j): c}."""
        return {(i, j): c for i, j, c in self.terms}

    @property
    def length(self) -> float:
        """The unit of length in which the largest coefficients of the lowest and the highest degree are about equal.

        It is a power of 2, so conversion to this unit is exact.
        """
        largest = {n: c for n, c in largest_coefficients(self.coefficients).items() if n and c}
        if len(largest) < 2:
            return 1.0
        low, high = min(largest), max(largest)
        return float(2.0 ** np.round((np.log2(largest[low]) - np.log2(largest[high])) / (high - low)))

    @property
    def mirror_in_x(self) -> bool:
        """Whether all powers of x are even."""
        return all(i % 2 == 0 for i, _, _ in self.terms)

    @property
    def mirror_in_y(self) -> bool:
        """Whether all powers of y are even."""
        return all(j % 2 == 0 for _, j, _ in self.terms)

    def is_even_in(self, axis: int) -> bool:
        """Return whether all powers of x (axis 0) or y (axis 1) are even."""
        return (self.mirror_in_x, self.mirror_in_y)[axis]

    @property
    def has_constant(self) -> bool:
        """Whether there is a term without x and y."""
        return (0, 0) in self.coefficients

    def value(self, x: Any, y: Any) -> Any:
        """Return V at (x, y). Arrays broadcast."""
        return evaluate(self.coefficients, x, y)

    def magnitude(self, x: Any, y: Any) -> Any:
        """Return the sum of the magnitudes of the terms at (x, y), of which rounding errors are a share. Arrays broadcast."""
        return evaluate({powers: abs(c) for powers, c in self.coefficients.items()}, np.abs(x), np.abs(y))

    def gradient(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Return (V_x, V_y)."""
        return tuple(evaluate(slope, x, y) for slope in self.slopes)

    def hessian(self, x: Any, y: Any) -> tuple[Any, Any, Any]:
        """Return (V_xx, V_xy, V_yy)."""
        return tuple(evaluate(self.derivative(*order), x, y) for order in ((2, 0), (1, 1), (0, 2)))

    def derivative(self, nx: int, ny: int) -> dict[Powers, float]:
        """Return the nonzero terms of ∂^(nx+ny) V / ∂x^nx ∂y^ny, as {(i, j): c}."""
        terms = self.coefficients
        for axis in (0,) * nx + (1,) * ny:
            terms = derivative(terms, axis)
        return dict(terms)

    @cached_property
    def slopes(self) -> tuple[Terms, Terms]:
        """The terms of V_x and V_y."""
        return self.derivative(1, 0), self.derivative(0, 1)

    def force(self, axis: int) -> PolynomialForm:
        """Return −∂V/∂x (axis 0) or −∂V/∂y (axis 1)."""
        return PolynomialForm(tuple((i, j, -c) for (i, j), c in self.slopes[axis].items()))

    def find_critical_points(self) -> np.ndarray:
        """Find all critical points and their indices, of shape (n, 3); see `engine.systems.forms.critical_points`."""
        return find_critical_points(self.coefficients)

    def descent_flow(self, length: float, sign: float) -> Flow:
        """Return the flow −sign ∇V, slowed beyond `length`, because a line would reach infinity in a finite time."""
        highest = max(map(degree, self.slopes))
        coefficients = np.zeros((2, highest + 1, highest + 1))
        for axis, terms in enumerate(self.slopes):
            for (i, j), c in terms.items():
                coefficients[axis, i, j] = -sign * c
        # Rows 1, x, x, … and 1, y, y, …, whose cumulative products are the powers.
        factors = np.ones((2, highest + 1))

        def velocity(_time: float, place: np.ndarray) -> np.ndarray:
            factors[:, 1:] = place[:, None]
            powers_of_x, powers_of_y = np.multiply.accumulate(factors, axis=1)
            descent = coefficients @ powers_of_y @ powers_of_x
            return descent / (1.0 + (np.hypot(*place) / length) ** (highest - 1))

        return velocity

    def points_on_singular_curves(self, _x: np.ndarray, _y: np.ndarray) -> np.ndarray:
        """Return no points, because a polynomial has no singular points."""
        return NO_POINTS

    def plus(self, terms: Terms) -> PolynomialForm:
        """Add a polynomial. Terms that cancel are left out."""
        total = self.coefficients | {powers: self.coefficients.get(powers, 0.0) + c for powers, c in terms.items()}
        return checked_form(tuple((i, j, c) for (i, j), c in total.items() if c))

    def scaled(self, length: float, energy: float) -> PolynomialForm:
        """Return V(length x, length y) / energy, in units of length and energy."""
        # `checked_form` is not used, because the legal range of coefficients applies to the units of the potential.
        return PolynomialForm(tuple((i, j, c * length ** (i + j) / energy) for i, j, c in self.terms))

    def with_parameters(self, omega_1: float, omega_2: float, epsilon: float) -> PolynomialForm:
        """Multiply quadratic terms by ω1 and ω2, and higher terms by ε."""
        return checked_form(tuple((i, j, c * _parameter_factor(i, j, omega_1, omega_2, epsilon)) for i, j, c in self.terms))

    def moved(self, x: float, y: float) -> PolynomialForm:
        """Expand V about a critical point (x, y), without linear terms. Each coefficient is rounded once.

        Coefficients that are rounding errors of 0 are left out. A constant has no effect on them.
        """
        terms: dict[Powers, Fraction] = {}
        for i, j, c in self.terms:
            for k in range(i + 1):
                for m in range(j + 1):
                    part = Fraction(c) * comb(i, k) * comb(j, m) * Fraction(x) ** (i - k) * Fraction(y) ** (j - m)
                    terms[k, m] = terms.get((k, m), Fraction(0)) + part
        rounded = {powers: float(c) for powers, c in terms.items() if sum(powers) != 1}
        magnitudes = {powers: abs(c) * self.length ** sum(powers) for powers, c in rounded.items()}
        threshold = _ZERO_COEFFICIENT * max((each for powers, each in magnitudes.items() if any(powers)), default=0.0)
        kept = {powers: c for powers, c in rounded.items() if magnitudes[powers] > threshold}
        return checked_form(tuple((k, m, c) for (k, m), c in kept.items()))

    def count_rotations(self) -> int:
        """Return the largest n of the rotations 2π/n that leave V unchanged; 0 for all rotations.

        In V = Σ c z^a z̄^b with z = x + iy, a rotation by φ multiplies each term by exp(i (a − b) φ).
        """
        return math.gcd(*(a - b for a, b in self._complex_terms() if a != b))

    def _complex_terms(self) -> dict[Powers, complex]:
        """Return {(a, b): c} of V = Σ c z^a z̄^b, without rounding errors of zero coefficients."""
        # x = (z + z̄)/2 and y = (z − z̄)/2i.
        x, y = {(1, 0): 0.5 + 0j, (0, 1): 0.5 + 0j}, {(1, 0): -0.5j, (0, 1): 0.5j}
        largest = largest_coefficients(self.coefficients)
        terms = substitute(self.coefficients, x, y)
        return {(a, b): c for (a, b), c in terms.items() if abs(c) > _ZERO_COEFFICIENT * largest[a + b]}

    def limits_refusal(self) -> str | None:
        """Return a sentence if the degree, the number of terms or the range of coefficients is too large; otherwise None."""
        highest = degree(self.coefficients)
        if highest > HIGHEST_DEGREE:
            return f"V has degree {highest}; the highest allowed degree is {HIGHEST_DEGREE}."
        if len(self.terms) > MOST_TERMS:
            return f"V has {len(self.terms)} terms; at most {MOST_TERMS} are allowed."
        # Coefficients are compared in units of `length`, so that the user's units do not matter.
        magnitudes = [abs(c) * self.length ** (i + j) for i, j, c in self.terms]
        # The comparison is also False for NaN.
        if magnitudes and not min(magnitudes) >= _SMALLEST_RATIO * max(magnitudes):
            return f"V has a coefficient below {_SMALLEST_RATIO:g} of the largest one, in units in which its well has the size 1."
        return None


def checked_form(terms: Any) -> PolynomialForm:
    """Return the form of ((i, j, c), …); ValueError if the terms are not legal."""
    try:
        checked_terms = tuple(_checked_term(*term) for term in terms)
    except TypeError:
        raise ValueError(f"terms={short_repr(terms)}: must be ((i, j, c), …); parse_formula takes V as text") from None
    if len({term[:2] for term in checked_terms}) != len(checked_terms):
        raise ValueError(f"terms={short_repr(checked_terms)}: each pair of exponents must occur only once")
    return PolynomialForm(checked_terms)


def _checked_term(i: Any, j: Any, c: Any) -> tuple[int, int, float]:
    x_power, y_power = (checked_count(f"terms: exponent of {axis}", n, 0, HIGHEST_DEGREE) for axis, n in (("x", i), ("y", j)))
    return x_power, y_power, checked_number("terms: coefficient", c, largest=LARGEST_COEFFICIENT)


def _parameter_factor(i: int, j: int, omega_1: float, omega_2: float, epsilon: float) -> float:
    """Return the factor of the coefficient of x^i y^j in `Potential.with_parameters`."""
    if i + j < 2:
        return 1.0
    return epsilon if i + j > 2 else omega_1**i * omega_2**j
