"""Potentials with a well at the origin, and their derived quantities: saddles, escape energy, channels.

A potential is defined by its formula alone. Everything else, including the compiled integrator, is derived from it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from engine.expressions.nodes import Expression
from engine.potentials.forms.exit_saddles import find_maxima_beside, leads_out_of_well
from engine.potentials.forms.expression_form import ExpressionForm
from engine.potentials.forms.form import Form
from engine.potentials.forms.polynomial_form import PolynomialForm, checked_form
from engine.potentials.forms.stored_points import stored_points
from engine.potentials.names import ByName
from engine.potentials.well_units import WellUnits, nearest_power_of_two
from engine.results.arrays import read_only
from engine.results.result import Result
from engine.validation import check_type, checked_number

EQUAL_ENERGY_TOLERANCE = 1e-12
"""Saddles whose energies differ by less count as equally high; in units of the well's energy."""

# Coordinates below this share of the distance are rounding errors of zero: on the +x axis the sign of such an error would change
# the channel numbers.
_ROUNDING = 1e-13

Terms = tuple[tuple[int, int, float], ...]

PARAMETER_RANGES: Mapping[str, tuple[float, float]] = MappingProxyType(
    {"omega_1": (0.1, 10.0), "omega_2": (0.1, 10.0), "epsilon": (0.01, 100.0)}
)
"""Legal ranges of the parameters ω1, ω2 and ε of Zotos (2014)."""


class ChannelMerger(NamedTuple):
    """A maximum (x, y) between exits: above V = `energy` there, the `channels` around it are one channel."""

    energy: float
    x: float
    y: float
    channels: tuple[int, ...]

    def describe(self) -> str:
        """The channels in words, such as "channels 1 and 3"."""
        *first, last = self.channels
        return f"channels {', '.join(map(str, first))} and {last}"


@dataclass(frozen=True, init=False)
class Potential(Result):
    """V(x, y), dimensionless, for a unit mass: H = (px² + py²)/2 + V.

    Parameters
    ----------
    name
        Display name; it has no influence on any result, and potentials of different name can be equal.
    form
        What V is. For a polynomial Σ c x^i y^j its terms ((i, j, c), …): exponents i, j from 0 to 12 and coefficient c, at most
        1e90 in magnitude, of each term, each (i, j) only once. `parse_formula` makes the forms of other formulas.
    lineage
        Empty, or from which family the saddles of this potential were continued (`ParameterFamily`). They may differ in the last
        bit from those of an equal potential, and so may results, which are therefore kept apart.

    Raises
    ------
    ValueError
        If an exponent is out of range, a coefficient is not finite, or a pair of exponents occurs twice.

    Examples
    --------
    >>> from escape_explorer import CASES
    >>> potential = CASES["III"].with_parameters(epsilon=0.5)
    >>> potential.channels, potential.escape_energy
    (4, 0.5)
    >>> potential.saddles.round(6).tolist()
    [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]
    """

    name: str = field(compare=False)
    form: Form
    lineage: str = field(default="", repr=False)

    def __init__(self, name: str, form: Form | Terms | Expression, lineage: str = "") -> None:
        check_type("name", name, str)
        if isinstance(form, Expression):
            form = ExpressionForm(form)
        elif not isinstance(form, PolynomialForm | ExpressionForm):
            form = checked_form(form)
        for attribute, value in (("name", name), ("form", form), ("lineage", lineage)):
            object.__setattr__(self, attribute, value)

    def numbers(self) -> dict[str, Any]:
        """The name, the escape energy and the number of channels."""
        return {"name": self.name, "escape_energy": self.escape_energy, "channels": self.channels}

    def columns(self) -> Mapping[str, np.ndarray]:
        """Number, place and energy of each exit saddle."""
        x, y = self.saddles.T
        return {"channel": np.arange(1, self.channels + 1), "x": x, "y": y, "energy": self.saddle_energies}

    @property
    def terms(self) -> Terms:
        """((i, j, c), …) of a polynomial; ValueError for other formulas."""
        if not isinstance(self.form, PolynomialForm):
            raise ValueError(f"{self.name} is no polynomial")
        return self.form.terms

    def value(self, x: Any, y: Any) -> Any:
        """V at (x, y); arrays broadcast."""
        return self.form.value(x, y)

    def gradient(self, x: Any, y: Any) -> tuple[Any, Any]:
        """(V_x, V_y) at (x, y); arrays broadcast."""
        return self.form.gradient(x, y)

    def hessian(self, x: Any, y: Any) -> tuple[Any, Any, Any]:
        """(V_xx, V_xy, V_yy) at (x, y); arrays broadcast."""
        return self.form.hessian(x, y)

    def hessian_matrix(self, x: float, y: float) -> np.ndarray:
        """(2, 2) the Hessian matrix of V at one point."""
        vxx, vxy, vyy = self.hessian(x, y)
        return np.array([[vxx, vxy], [vxy, vyy]])

    def energy(self, states: Any) -> Any:
        """H of states (…, 4) = x, y, px, py."""
        x, y, px, py = np.moveaxis(np.asarray(states, dtype=float), -1, 0)
        return 0.5 * (px * px + py * py) + self.value(x, y)

    @property
    def mirror_in_x(self) -> bool:
        """Whether V(−x, y) = V(x, y): then (x, px) → (−x, −px) maps orbits to orbits, exactly in floating point."""
        return self.form.mirror_in_x

    @property
    def mirror_in_y(self) -> bool:
        """Whether V(x, −y) = V(x, y): then (y, py) → (−y, −py) maps orbits to orbits."""
        return self.form.mirror_in_y

    @cached_property
    def critical_points(self) -> np.ndarray:
        """(n, 2) all points with ∇V = 0; the origin, if it is one, is exactly (0, 0). Raises ValueError if they form a curve.

        Those of a formula that is no polynomial are all of a region, see `engine.potentials.forms.stationary_points`.
        """
        return read_only(stored_points("critical_points", self.form, self.form.find_critical_points))

    @cached_property
    def saddles(self) -> np.ndarray:
        """(n, 2) saddle points (∇V = 0, V_xx V_yy − V_xy² < 0) that lead out of the well at the origin.

        In counterclockwise order from the +x axis: channel k passes over ``saddles[k - 1]``. Only saddles from which exactly one
        of the two lines of steepest descent ends at the origin are exits. Zotos (2014) prints the saddle test without the
        square of V_xy, which is a misprint.
        """
        points = self.critical_points
        leads_out = stored_points("exit_saddles", self.form, lambda: leads_out_of_well(self.form.downhill, self.hessian, points))
        return self._in_channel_order(points[leads_out])

    def continued(self, lineage: str, saddles: np.ndarray, mergers: Sequence[tuple[np.ndarray, tuple[int, ...]]]) -> Potential:
        """The same potential with saddles (n, 2), in any order, and maxima between exits that were found before.

        mergers: the place (2,) of each maximum, and the indices of the saddles around it.
        """
        found = Potential(self.name, self.form, lineage)
        ordered = found._in_channel_order(saddles)
        channel = [1 + int(np.argmin(np.hypot(*(ordered - saddle).T))) for saddle in saddles]
        found.__dict__["saddles"] = ordered
        found.__dict__["channel_mergers"] = tuple(
            sorted(
                ChannelMerger(float(self.value(x, y)), float(x), float(y), tuple(sorted(channel[k] for k in around)))
                for (x, y), around in mergers
            )
        )
        return found

    def _in_channel_order(self, points: np.ndarray) -> np.ndarray:
        """Exit saddles (n, 2), counterclockwise from the +x axis, without rounding errors of zero and exactly symmetric."""
        points = np.where(np.abs(points) < _ROUNDING * np.hypot(*points.T)[:, None], 0.0, points)
        angle = np.arctan2(points[:, 1], points[:, 0]) % (2 * np.pi)
        points = points[np.argsort(angle, kind="stable")]
        if self.mirror_in_x:
            _make_symmetric(points)
        return read_only(points)

    @cached_property
    def units(self) -> WellUnits:
        """The units of the well, rounded to powers of 2; both are 1 for the three cases of Zotos (2014).

        The unit of length is the distance of the nearest exit saddle, the unit of time 1/ω of the fastest small oscillation in
        the well. Without an exit, the unit of length is that of the form.
        """
        frequency = self.fastest_frequency
        time = 1.0 / nearest_power_of_two(frequency) if np.isfinite(frequency) and frequency > 0.0 else 1.0
        if not self.channels:
            return WellUnits(self.form.length, time)
        return WellUnits(nearest_power_of_two(float(np.hypot(*self.saddles.T).min())), time)

    @cached_property
    def stated_units(self) -> WellUnits:
        """Units in which errors state energies and positions: those of the potential from which `in_well_units` made this one."""
        return WellUnits()

    @property
    def exact_time_unit(self) -> float:
        """The unit of time of the well before it is rounded: 1/ω of the fastest small oscillation; 1 without a well."""
        frequency = self.fastest_frequency
        return 1.0 / frequency if np.isfinite(frequency) and frequency > 0.0 else 1.0

    @cached_property
    def fastest_frequency(self) -> float:
        """The higher frequency of small oscillations in the well at the origin; NaN if there is no well."""
        with np.errstate(invalid="ignore"):
            return float(np.sqrt(np.linalg.eigvalsh(self.hessian_matrix(0.0, 0.0))[-1]))

    @cached_property
    def in_well_units(self) -> Potential:
        """The same system in units of the well: V(L x, L y) / E, for units L of length and E of energy.

        The potential itself if both are 1.
        """
        units = self.units
        if units == WellUnits():
            return self
        scaled = Potential(self.name, self.form.scaled(units.length, units.energy), self.lineage)
        derived = {
            "units": WellUnits(),
            "stated_units": units,
            "saddles": self.saddles / units.length,
            "outward_directions": self.outward_directions,
            "channel_mergers": tuple(
                ChannelMerger(m.energy / units.energy, m.x / units.length, m.y / units.length, m.channels)
                for m in self.channel_mergers
            ),
        }
        scaled.__dict__.update(derived, in_well_units=scaled)
        return scaled

    def with_parameters(self, omega_1: float = 1.0, omega_2: float = 1.0, epsilon: float = 1.0) -> Potential:
        """This potential with other frequencies of its well and another strength of its perturbation.

        V = ½ (ω1² x² + ω2² y²) + ε V1 of Zotos (2014), who uses ω1 = ω2 = ε = 1; V1 is the terms of degree 3 and higher.
        In general V1 is all but the constant, linear and quadratic terms of the expansion about the origin, x² is multiplied by
        ω1², y² by ω2² and x y by ω1 ω2, also if the quadratic terms are not ½ (x² + y²), so that the default values give the
        potential itself. Constant and linear terms are unchanged.

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
        for (name, (low, high)), value in zip(PARAMETER_RANGES.items(), (omega_1, omega_2, epsilon), strict=True):
            if not low <= checked_number(name, value) <= high:
                raise ValueError(f"{name}={value}: must be between {low:g} and {high:g}")
        symbols = (("ω1", omega_1), ("ω2", omega_2), ("ε", epsilon))
        changed = ", ".join(f"{symbol}={value:g}" for symbol, value in symbols if value != 1.0)
        form = self.form.with_parameters(omega_1, omega_2, epsilon)
        return Potential(f"{self.name} ({changed})" if changed else self.name, form)

    @cached_property
    def mirror_channels(self) -> np.ndarray:
        """(channels + 1,) the image of each channel number under x → −x; entry 0 is 0. Only valid if `mirror_in_x`."""
        if not self.channels:
            return read_only(np.zeros(1, np.int8))
        distance = np.hypot(*(self.saddles[:, None] - self.saddles * [-1.0, 1.0]).T)
        return read_only(np.concatenate([[0], 1 + np.argmin(distance, axis=0)]).astype(np.int8))

    @cached_property
    def saddle_energies(self) -> np.ndarray:
        """(channels,) V at each exit saddle, in channel order."""
        return read_only(np.asarray(self.value(self.saddles[:, 0], self.saddles[:, 1]), dtype=float))

    @cached_property
    def escape_energy(self) -> float:
        """The lowest energy at which orbits can escape: V at the lowest exit saddle; infinite if there is none."""
        return float(self.saddle_energies.min(initial=np.inf))

    @cached_property
    def channel_mergers(self) -> tuple[ChannelMerger, ...]:
        """The maxima that separate exits from each other, the lowest first.

        A maximum lies between two exits if a line of steepest ascent from the saddle of each ends at it.
        """
        points = self.critical_points
        saddles = np.array([np.argmin(np.hypot(*(points - saddle).T)) for saddle in self.saddles], int)
        beside = stored_points("maxima", self.form, lambda: find_maxima_beside(self.form.downhill, self.hessian, points, saddles))
        mergers = []
        for k in np.flatnonzero(beside.sum(axis=0) > 1):
            (x, y), channels = points[k].tolist(), (np.flatnonzero(beside[:, k]) + 1).tolist()
            mergers.append(ChannelMerger(float(self.value(x, y)), x, y, tuple(channels)))
        return tuple(sorted(mergers))

    @cached_property
    def bottom(self) -> float:
        """V at the origin, from which multiples of the escape energy count."""
        return float(self.value(0.0, 0.0))

    def energy_at(self, multiple: float) -> float:
        """The energy at a multiple of the depth of the well: 0 at the bottom, 1 at the escape energy."""
        return self.bottom + multiple * (self.escape_energy - self.bottom)

    @property
    def channels(self) -> int:
        """The number of exit channels; they are numbered from 1, counterclockwise from the +x axis."""
        return len(self.saddles)

    @cached_property
    def outward_directions(self) -> np.ndarray:
        """(channels, 2) unit vectors along the unstable direction of each exit saddle, pointing away from the well."""
        directions = np.array([self._unstable_direction(saddle) for saddle in self.saddles]).reshape(-1, 2)
        if self.mirror_in_x:
            for k in np.flatnonzero(self.saddles[:, 0] < 0.0):
                directions[k] = directions[self.mirror_channels[k + 1] - 1] * [-1.0, 1.0]
        return read_only(directions)

    def _unstable_direction(self, saddle: np.ndarray) -> np.ndarray:
        direction: np.ndarray = np.linalg.eigh(self.hessian_matrix(*saddle))[1][:, 0]
        direction = np.where(np.abs(direction) < _ROUNDING, 0.0, direction)
        return direction if direction @ saddle > 0 else -direction

    def open_channels(self, energy: float) -> tuple[int, ...]:
        """Numbers of the channels whose saddle lies below `energy`; empty at or below the escape energy."""
        return tuple(
            int(k) + 1 for k in np.flatnonzero(self.saddle_energies < energy - EQUAL_ENERGY_TOLERANCE * self.units.energy)
        )


def _make_symmetric(points: np.ndarray) -> None:
    """Replace each point at x < 0 by the exact mirror image of its partner at x > 0, in place."""
    right = points[points[:, 0] > 0.0]
    for left in np.flatnonzero(points[:, 0] < 0.0):
        points[left] = right[np.argmin(np.hypot(*(right - points[left] * [-1.0, 1.0]).T))] * [-1.0, 1.0]


_HARMONIC = ((2, 0, 0.5), (0, 2, 0.5))

CASES: Mapping[str, Potential] = ByName(
    "case",
    {
        "I": Potential("I", (*_HARMONIC, (1, 2, -1.0))),
        "II": Potential("II", (*_HARMONIC, (3, 0, -1.0 / 3.0), (1, 2, 1.0))),
        "III": Potential("III", (*_HARMONIC, (2, 2, -1.0))),
    },
)
"""The three cases of Zotos (2014): V = (x² + y²)/2 + V1 with V1 = −x y², −x (x²/3 − y²) and −x² y²."""
