"""Starts of deep zooms, found in exact arithmetic and rounded to pairs of doubles."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from fractions import Fraction

import numpy as np

from engine.maps.spec import MapSpec
from engine.polynomials import Powers
from engine.potentials.forms.polynomial_form import PolynomialForm
from engine.slices.axes import MOMENTA, STATE, Coordinate, Direction
from engine.taylor.source.deep_step import pair_of

_LARGEST_DENOMINATOR = 10**6
# Bits after the point of a square root.
_ROOT_BITS = 256
# The order in which kernels take a state.
_KERNEL_ORDER = (Coordinate.X, Coordinate.PX, Coordinate.Y, Coordinate.PY)

Start = Mapping[Coordinate, Fraction]


def simplest_number(value: float) -> Fraction:
    """A number that rounds to a double: the fraction with a denominator up to 10⁶ if there is one, else its shortest decimal.

    So −0.3333333333333333 is −1/3, and 0.19 is 19/100.
    """
    simple = Fraction(value).limit_denominator(_LARGEST_DENOMINATOR)
    return simple if float(simple) == value else Fraction(repr(float(value)))


class DeepStarts:
    """The exact starts of a request: a polynomial in a frame at rest whose exits are over saddles, on a slice of one energy.

    Raises
    ------
    ValueError
        For other potentials and slices.

    Attributes
    ----------
    coefficients
        {(i, j): c} of V = Σ c x^i y^j.
    energy
        h.
    """

    def __init__(self, spec: MapSpec) -> None:
        potential, plane = spec.potential, spec.plane
        if not isinstance(potential.form, PolynomialForm) or potential.well.setting.needs_whole_steps:
            raise ValueError(f"potential={potential.name}: must be a polynomial, at rest and without centres, in a deep map")
        if plane.decided not in MOMENTA or not all(plane.free_axes):
            raise ValueError(f"plane={plane.title}: must have no axis but x, y, px, py or a direction in these, in a deep map")
        assert spec.common_energy is not None
        self.coefficients = {(i, j): simplest_number(c) for i, j, c in potential.form.terms}
        self.energy = simplest_number(spec.common_energy)
        self._plane, self._sign = plane, -1 if spec.backward else 1
        self._units = np.repeat([getattr(potential.units, name) for name in ("length", "momentum") * 2], 2)
        self._scale = Fraction(potential.units.length), Fraction(potential.units.energy)

    @property
    def well_coefficients(self) -> dict[Powers, Fraction]:
        """The coefficients of V in units of the well."""
        length, energy = self._scale
        return {(i, j): c * length ** (i + j) / energy for (i, j), c in self.coefficients.items()}

    def states(self, abscissae: Sequence[Fraction], ordinates: Sequence[Fraction]) -> np.ndarray:
        """(rows · columns, 8) x, px, y, py of pixels as pairs, in units of the well; NaN where forbidden."""
        pixels = (self._state(x, ordinate) for ordinate, x in itertools.product(ordinates, abscissae))
        states: np.ndarray = np.array(list(pixels)) / self._units
        return states

    def _state(self, abscissa: Fraction, ordinate: Fraction) -> list[float]:
        start = dict.fromkeys(STATE, Fraction(0)) | {c: simplest_number(value) for c, value in self._plane.fixed}
        axes = zip(self._plane.axes, (abscissa, ordinate), strict=True)
        # Coordinates are set, directions move from there.
        for axis, along in sorted(axes, key=lambda pair: isinstance(pair[0], Direction)):
            if isinstance(axis, Direction):
                start |= {c: start[c] + simplest_number(component) * along for c, component in axis.components.items()}
            elif isinstance(axis, Coordinate):
                start[axis] = along
        squared = 2 * (self.energy - self._hamiltonian(start))
        if squared < 0:
            return [math.nan] * len(self._units)
        start[self._plane.decided] = self._plane.sign * _root(squared)
        start |= {momentum: self._sign * start[momentum] for momentum in MOMENTA}
        return [part for coordinate in _KERNEL_ORDER for part in pair_of(start[coordinate])]

    def _hamiltonian(self, state: Start) -> Fraction:
        value = sum(c * state[Coordinate.X] ** i * state[Coordinate.Y] ** j for (i, j), c in self.coefficients.items())
        return Fraction(value) + sum((state[momentum] ** 2 for momentum in MOMENTA), Fraction(0)) / 2

    def energy_errors(self, states: np.ndarray) -> Iterable[float]:
        """|H − h| / |h| of states (n, 8) in units of the well; NaN for states that are not finite."""
        for row in states * self._units:
            if not np.isfinite(row).all():
                yield math.nan
                continue
            parts = [Fraction(part) for part in row.tolist()]
            pairs = (high + low for high, low in zip(parts[::2], parts[1::2], strict=True))
            error = self._hamiltonian(dict(zip(_KERNEL_ORDER, pairs, strict=True))) - self.energy
            yield float(abs(error / self.energy)) if self.energy else float(abs(error))


def _root(value: Fraction) -> Fraction:
    """The square root, rounded down."""
    return Fraction(math.isqrt((value.numerator << 2 * _ROOT_BITS) // value.denominator), 1 << _ROOT_BITS)
