"""The scales of a well, by which energies, lengths and times are chosen: its frequency, its units, its bottom and its depth."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from engine.foundations.arrays import ReadOnlyArrays
from engine.systems.forms.expression_form import Form
from engine.systems.forms.form import hessian_matrix
from engine.systems.well_units import WellUnits, nearest_power_of_two

# Typical radius of orbits in units of the escape radius.
_TYPICAL_RADIUS_SHARE = 0.1
# Number of points on a circle of the typical radius.
_CIRCLE_POINTS = 64


class WellScales(ReadOnlyArrays):
    """Base of `Well`, with its scales. The subclass finds the saddles."""

    form: Form
    mass: float

    @property
    def escape_radius(self) -> float | None:
        """Radius of the escape circle; None for exits over saddles."""
        raise NotImplementedError

    @property
    def escapes_over_saddles(self) -> bool:
        """Whether orbits escape through exits over saddles, if at all, and not beyond an escape radius."""
        return self.escape_radius is None

    @property
    def channels(self) -> int:
        """The number of exit channels."""
        raise NotImplementedError

    @cached_property
    def saddles(self) -> np.ndarray:
        """Saddles that lead out of the well, of shape (channels, 2)."""
        raise NotImplementedError

    @cached_property
    def escape_energy(self) -> float:
        """V at the lowest exit saddle; infinite if there is none, −∞ with an escape radius."""
        raise NotImplementedError

    @cached_property
    def is_convex_at_origin(self) -> bool:
        """Whether V curves upward in all directions at the origin."""
        matrix = hessian_matrix(self.form, 0.0, 0.0)
        return bool(np.isfinite(matrix).all() and np.linalg.eigvalsh(matrix)[0] > 0.0)

    @property
    def typical_radius(self) -> float:
        """Half the distance of the nearest exit saddle, or a tenth of the escape radius; 0 without either."""
        if self.escape_radius is not None:
            return _TYPICAL_RADIUS_SHARE * self.escape_radius
        return 0.5 * float(np.hypot(*self.saddles.T).min()) if self.channels else 0.0

    @property
    def _typical_circle(self) -> np.ndarray:
        """Points on the circle of `typical_radius`, of shape (2, n)."""
        angle = 2.0 * np.pi / _CIRCLE_POINTS * (0.5 + np.arange(_CIRCLE_POINTS))
        return self.typical_radius * np.array([np.cos(angle), np.sin(angle)])

    @cached_property
    def fastest_frequency(self) -> float:
        """The higher frequency ω of small oscillations in the well at the origin; NaN if there is none.

        Without a well, this is the frequency of a circular orbit of `typical_radius`. The square of this frequency is the mean
        slope of V divided by the radius.
        """
        return self._unit_mass_frequency / float(np.sqrt(self.mass))

    @cached_property
    def _unit_mass_frequency(self) -> float:
        """The value of `fastest_frequency` with a mass of 1."""
        if self.is_convex_at_origin or not self.typical_radius:
            matrix = hessian_matrix(self.form, 0.0, 0.0)
            if not np.isfinite(matrix).all():
                return np.nan
            # Without a well, the square root of a negative eigenvalue is NaN.
            with np.errstate(invalid="ignore"):
                return float(np.sqrt(np.linalg.eigvalsh(matrix)[-1]))
        slope = np.hypot(*self.form.gradient(*self._typical_circle))
        return float(np.sqrt(slope[np.isfinite(slope)].mean() / self.typical_radius))

    @property
    def exact_time_unit(self) -> float:
        """The unit of time of the well before rounding: 1/ω of the fastest small oscillation; 1 without a frequency."""
        frequency = self.fastest_frequency
        return 1.0 / frequency if np.isfinite(frequency) and frequency > 0.0 else 1.0

    @cached_property
    def units(self) -> WellUnits:
        """The units of the well; all are 1 for the three cases of Zotos (2014).

        The unit of length is the distance of the nearest exit saddle; with an escape radius, a tenth of this radius; without
        exits, the length of the form. With a mass of 1, the unit of time is 1/ω of the fastest small oscillation in the well, see
        `fastest_frequency`. Both are rounded to powers of 2. The unit of mass is the mass.
        """
        frequency = self._unit_mass_frequency
        time = 1.0 / nearest_power_of_two(frequency) if np.isfinite(frequency) and frequency > 0.0 else 1.0
        return WellUnits(self._length_unit, time, self.mass)

    @property
    def _length_unit(self) -> float:
        if not self.escapes_over_saddles:
            return nearest_power_of_two(self.typical_radius)
        if not self.channels:
            return self.form.length
        return nearest_power_of_two(float(np.hypot(*self.saddles.T).min()))

    @property
    def stated_units(self) -> WellUnits:
        """Units in which error messages state energies and positions: those of the original potential, see `ScaledWell`."""
        return WellUnits()

    @cached_property
    def bottom(self) -> float:
        """V at the origin, the zero of `energy_at`.

        Without a well, this is the mean of V on a circle of `typical_radius`.
        """
        if self.is_convex_at_origin or not self.typical_radius:
            return float(self.form.value(0.0, 0.0))
        value = self.form.value(*self._typical_circle)
        return float(value[np.isfinite(value)].mean())

    @property
    def depth(self) -> float:
        """The height of the escape energy above the bottom; in a well without exits, the unit of energy."""
        has_exits = self.channels or not self.escapes_over_saddles
        return self.escape_energy - self.bottom if has_exits else self.units.energy

    def energy_at(self, multiple: float) -> float:
        """Return the energy at a multiple of the depth of the well: 0 at the bottom, 1 at the escape energy."""
        return self.bottom + multiple * self.depth
