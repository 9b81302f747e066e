"""Potentials and their derived quantities: saddles, escape energy, channels, outcomes.

A potential is defined by its formula, the rotation of its frame, and what orbits end at besides its exits. Everything else,
including the compiled integrator, is derived from these.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from engine.expressions.nodes import Expression
from engine.potentials.forms.exit_saddles import find_maxima_beside, leads_out_of_well
from engine.potentials.forms.expression_form import ExpressionForm
from engine.potentials.forms.form import Form
from engine.potentials.forms.polynomial_form import PolynomialForm, checked_form
from engine.potentials.forms.stored_points import stored_points
from engine.potentials.merged_channels import ChannelMerger, MergedExit, describe_channel, exit_numbers, merged_exits
from engine.potentials.names import ByName
from engine.potentials.outcomes import Centre, Outcome, checked_radius, exit_outcome, outcomes_of
from engine.potentials.well_units import WellUnits, nearest_power_of_two
from engine.results.arrays import read_only
from engine.results.result import Result
from engine.taylor.source.series import Setting
from engine.validation import check_type, checked_number

EQUAL_ENERGY_TOLERANCE = 1e-12
"""Saddles whose energies differ by less count as equally high; in units of the well's energy."""

# Coordinates below this share of the distance are rounding errors of zero: on the +x axis the sign of such an error would change
# the channel numbers.
_ROUNDING = 1e-13

# Radius of a circle of typical size, in units of the escape radius, and points on it.
_TYPICAL_SHARE, _CIRCLE_POINTS = 0.1, 64

Terms = tuple[tuple[int, int, float], ...]

PARAMETER_RANGES: Mapping[str, tuple[float, float]] = MappingProxyType(
    {"omega_1": (0.1, 10.0), "omega_2": (0.1, 10.0), "epsilon": (0.01, 100.0)}
)
"""Legal ranges of the parameters ω1, ω2 and ε of Zotos (2014)."""


@dataclass(frozen=True, init=False)
class Potential(Result):
    """V(x, y), dimensionless, for a unit mass: H = (px² + py²)/2 + V.

    In a frame that rotates at the rate Ω, V stands for the effective potential Φ, px and py for the velocities ẋ and ẏ, and H for
    the Jacobi integral (ẋ² + ẏ²)/2 + Φ: ẍ = 2Ωẏ − Φ_x, ÿ = −2Ωẋ − Φ_y. See `in_rotating_frame`.

    Without an escape radius orbits leave a well, or a centre, at the origin through the exits over its saddles. With one, saddles
    are no exits, and orbits end beyond this radius. See `with_outcomes`.

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
    rotation
        Ω, counterclockwise for Ω > 0, at most 1e9 in magnitude, dimensionless.
    centres
        Bodies with which orbits collide.
    escape_radius
        Distance from the origin beyond which orbits have escaped, 1e-6 to 1e6, dimensionless; None for exits over saddles.
    origin
        (x, y) of the origin of the axes in the coordinates of the formula, see `at_minimum`; it has no influence on any result.

    Raises
    ------
    ValueError
        If an exponent is out of range, a coefficient is not finite, a pair of exponents occurs twice, or another number is out of
        range.

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
    rotation: float = 0.0
    centres: tuple[Centre, ...] = ()
    escape_radius: float | None = None
    origin: tuple[float, float] = (0.0, 0.0)

    def __init__(
        self,
        name: str,
        form: Form | Terms | Expression,
        lineage: str = "",
        rotation: float = 0.0,
        centres: Sequence[Centre] = (),
        escape_radius: float | None = None,
        origin: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        check_type("name", name, str)
        if isinstance(form, Expression):
            form = ExpressionForm(form)
        elif not isinstance(form, PolynomialForm | ExpressionForm):
            form = checked_form(form)
        check_type("centres", centres, Iterable)
        for centre in centres:
            check_type("centres", centre, Centre)
        values = {
            "name": name,
            "form": form,
            "lineage": lineage,
            "rotation": checked_number("rotation", rotation),
            "centres": tuple(centres),
            "escape_radius": None if escape_radius is None else checked_radius("escape_radius", escape_radius),
            "origin": (checked_number("origin", origin[0]), checked_number("origin", origin[1])),
        }
        for attribute, value in values.items():
            object.__setattr__(self, attribute, value)

    def in_rotating_frame(self, rotation: float) -> Potential:
        """The potential in a frame that rotates about the origin at the rate Ω: Φ = V − ½ Ω² (x² + y²).

        Parameters
        ----------
        rotation
            Ω, counterclockwise for Ω > 0, at most 1e9 in magnitude, dimensionless.

        Raises
        ------
        ValueError
            If the rate is out of range, or the potential is one of a rotating frame already.
        """
        if self.rotation:
            raise ValueError(f"potential={self.name}: must be one of a frame that does not rotate")
        half = -0.5 * checked_number("rotation", rotation) ** 2
        return replace(self, form=self.form.plus({(2, 0): half, (0, 2): half}), rotation=rotation) if rotation else self

    def at_minimum(self, x: float = 0.0, y: float = 0.0) -> Potential:
        """The potential with its axes moved to the minimum nearest to a place, so that orbits leave the well there.

        Energies are unchanged. A frame that rotates turns about the new origin.

        Parameters
        ----------
        x, y
            The place, dimensionless.

        Raises
        ------
        ValueError
            If V has no minimum, or it is not known.

        Examples
        --------
        >>> from escape_explorer import parse_formula
        >>> moved = parse_formula("5(x² + y²) + 3y + 0.3(x⁴ + y⁴ − 6x²y²)").at_minimum()
        >>> [round(coordinate, 6) for coordinate in moved.origin], round(max(moved.saddle_energies), 4)
        ([0.0, -0.296861], 27.0123)
        """
        place = np.array([checked_number("x", x), checked_number("y", y)])
        along_x, _, along_y = self.hessian(*self.critical_points.T)
        minima = self.critical_points[(self.critical_indices > 0.0) & (along_x + along_y > 0.0)]
        if not len(minima):
            raise ValueError(f"potential={self.name}: V must have a minimum to which its axes can be moved")
        nearest = minima[np.argmin(np.hypot(*(minima - place).T))].tolist()
        centres = tuple(replace(each, x=each.x - nearest[0], y=each.y - nearest[1]) for each in self.centres)
        origin = self.origin[0] + nearest[0], self.origin[1] + nearest[1]
        return replace(self, form=self.form.moved(*nearest), centres=centres, origin=origin)

    def with_outcomes(self, centres: Sequence[Centre] = (), escape_radius: float | None = None) -> Potential:
        """The potential with other centres and another escape radius; parameters as of the potential."""
        check_type("centres", centres, Iterable)
        return replace(self, centres=tuple(centres), escape_radius=escape_radius)

    @cached_property
    def reversed_in_time(self) -> Potential:
        """The potential whose orbits, with the velocities reversed, are those of this one backward in time: Ω is reversed."""
        return replace(self, rotation=-self.rotation) if self.rotation else self

    @property
    def setting(self) -> Setting:
        """What the compiled functions depend on besides the formula."""
        return Setting(self.channels, len(self.centres), self.escape_radius is not None, self.rotation != 0.0)

    @cached_property
    def outcomes(self) -> tuple[Outcome, ...]:
        """What orbits can end at: the exits in channel order, the centres, the escape radius; the first one is fate 1."""
        return outcomes_of(self.channels, self.centres, self.escape_radius is not None)

    def check_same_motion(self, other: Potential, what: str) -> None:
        """Raise ValueError if the equations of motion are not those of another potential, of which a result is."""
        if (self.form, self.rotation) != (other.form, other.rotation):
            raise ValueError(f"potential={self.name}: must be that of the {what}, {other.name}")

    def check_at_rest(self, what: str) -> None:
        """Raise ValueError in a rotating frame, for what rests on the symmetry of time reversal."""
        if self.rotation:
            raise ValueError(f"potential={self.name}: its frame rotates; {what} are for frames that do not rotate")

    def check_without_centres(self, what: str) -> None:
        """Raise ValueError around centres, for what is integrated with fixed steps."""
        if self.centres:
            raise ValueError(
                f"potential={self.name}: has centres; {what} are computed with fixed steps, which cannot pass close to one"
            )

    @property
    def certifies_tori(self) -> bool:
        """Whether an invariant torus counts as evidence that its orbits are bounded for ever: only in a well at rest.

        In a rotating frame, around centres and with an escape radius this evidence is not tested.
        """
        return not self.rotation and not self.centres and self.escape_radius is None

    def is_closed_at(self, energy: Any) -> Any:
        """Whether no orbit of the well at these energies ever ends: they are below all saddles, and there are no centres.

        With an escape radius never. In a rotating frame orbits cannot pass the zero-velocity curve V = h either.
        """
        return np.logical_and(np.asarray(energy) <= self.escape_energy, not self.centres)

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
        """Whether (x, px) → (−x, −px) maps orbits to orbits, exactly in floating point: V is even in x, and nothing rotates."""
        return self.form.mirror_in_x and self._mirrors_centres([-1.0, 1.0])

    @property
    def mirror_in_y(self) -> bool:
        """Whether (y, py) → (−y, −py) maps orbits to orbits, exactly in floating point: V is even in y, and nothing rotates."""
        return self.form.mirror_in_y and self._mirrors_centres([1.0, -1.0])

    def _mirrors_centres(self, signs: Sequence[float]) -> bool:
        discs = {(each.x, each.y, each.radius) for each in self.centres}
        return not self.rotation and {(signs[0] * x, signs[1] * y, radius) for x, y, radius in discs} == discs

    @property
    def critical_points(self) -> np.ndarray:
        """(n, 2) all points with ∇V = 0; the origin, if it is one, is exactly (0, 0). Raises ValueError if they form a curve.

        Those of a formula that is no polynomial are all of a region, see `engine.potentials.forms.stationary_points`.
        """
        return self._points_and_indices[:, :2]

    @property
    def critical_indices(self) -> np.ndarray:
        """(n,) the index of each critical point: 1 for a minimum or a maximum, −1 for a saddle, 0 for a degenerate one."""
        return self._points_and_indices[:, 2]

    @cached_property
    def _points_and_indices(self) -> np.ndarray:
        return read_only(stored_points("critical_points", self.form, self.form.find_critical_points))

    @cached_property
    def saddles(self) -> np.ndarray:
        """(n, 2) saddle points (∇V = 0, V_xx V_yy − V_xy² < 0) that lead out of the well at the origin.

        In counterclockwise order from the +x axis: channel k passes over ``saddles[k - 1]``. Only saddles from which exactly one
        of the two lines of steepest descent ends at the origin are exits. Zotos (2014) prints the saddle test without the
        square of V_xy, which is a misprint. With an escape radius there are none.
        """
        if self.escape_radius is not None:
            return read_only(np.empty((0, 2)))
        form, points, indices = self.form, self.critical_points, self.critical_indices
        leads_out = stored_points(
            "exit_saddles", form, lambda: leads_out_of_well(form.downhill, form.hessian, points, indices, form.singular_points)
        )
        return self._in_channel_order(points[leads_out])

    def continued(self, lineage: str, saddles: np.ndarray, mergers: Sequence[tuple[np.ndarray, tuple[int, ...]]]) -> Potential:
        """The same potential with saddles (n, 2), in any order, and maxima between exits that were found before.

        mergers: the place (2,) of each maximum, and the indices of the saddles around it.
        """
        found = replace(self, lineage=lineage)
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
        the well, see `fastest_frequency`. With an escape radius the unit of length is a tenth of it, without exits that of the
        form.
        """
        frequency = self.fastest_frequency
        time = 1.0 / nearest_power_of_two(frequency) if np.isfinite(frequency) and frequency > 0.0 else 1.0
        if self.escape_radius is not None:
            return WellUnits(nearest_power_of_two(self.typical_radius), time)
        if not self.channels:
            return WellUnits(self.form.length, time)
        return WellUnits(nearest_power_of_two(float(np.hypot(*self.saddles.T).min())), time)

    @cached_property
    def stated_units(self) -> WellUnits:
        """Units in which errors state energies and positions: those of the potential from which `in_well_units` made this one."""
        return WellUnits()

    @property
    def exact_time_unit(self) -> float:
        """The unit of time of the well before it is rounded: 1/ω of the fastest small oscillation; 1 without a frequency."""
        frequency = self.fastest_frequency
        return 1.0 / frequency if np.isfinite(frequency) and frequency > 0.0 else 1.0

    @cached_property
    def has_well(self) -> bool:
        """Whether V curves upward in all directions at the origin."""
        matrix = self.hessian_matrix(0.0, 0.0)
        return bool(np.isfinite(matrix).all() and np.linalg.eigvalsh(matrix)[0] > 0.0)

    @cached_property
    def fastest_frequency(self) -> float:
        """The higher frequency of small oscillations in the well at the origin; NaN if there is neither well nor centre.

        Without a well that of a circle of typical size about the origin: the square is the average slope of V over the radius.
        """
        if self.has_well or not self.typical_radius:
            matrix = self.hessian_matrix(0.0, 0.0)
            with np.errstate(invalid="ignore"):
                return float(np.sqrt(np.linalg.eigvalsh(matrix)[-1])) if np.isfinite(matrix).all() else np.nan
        slope = np.hypot(*self.gradient(*self._typical_circle))
        return float(np.sqrt(slope[np.isfinite(slope)].mean() / self.typical_radius))

    @property
    def typical_radius(self) -> float:
        """Half the distance of the nearest exit saddle, or a share of the escape radius; 0 without either."""
        if self.escape_radius is not None:
            return _TYPICAL_SHARE * self.escape_radius
        return 0.5 * float(np.hypot(*self.saddles.T).min(initial=0.0 if not self.channels else np.inf))

    @property
    def _typical_circle(self) -> np.ndarray:
        angle = 2.0 * np.pi / _CIRCLE_POINTS * (0.5 + np.arange(_CIRCLE_POINTS))
        circle: np.ndarray = self.typical_radius * np.array([np.cos(angle), np.sin(angle)])
        return circle

    @cached_property
    def in_well_units(self) -> Potential:
        """The same system in units of the well: V(L x, L y) / E, for units L of length and E of energy.

        The potential itself if both are 1.
        """
        units = self.units
        if units == WellUnits():
            return self
        # Not through `__init__`: legal ranges are for the potential's own units.
        scaled = object.__new__(Potential)
        values = {
            "name": self.name,
            "form": self.form.scaled(units.length, units.energy),
            "lineage": self.lineage,
            "rotation": self.rotation * units.time,
            "centres": tuple(centre.scaled(1.0 / units.length) for centre in self.centres),
            "escape_radius": None if self.escape_radius is None else self.escape_radius / units.length,
            "origin": self.origin,
        }
        for attribute, value in values.items():
            object.__setattr__(scaled, attribute, value)
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
        is_changed = not omega_1 == omega_2 == epsilon == 1.0
        if is_changed and not np.isfinite(self.hessian_matrix(0.0, 0.0)).all():
            raise ValueError(f"omega_1, omega_2, epsilon: V of {self.name} has no expansion about the origin; must be 1")
        symbols = (("ω1", omega_1), ("ω2", omega_2), ("ε", epsilon))
        changed = ", ".join(f"{symbol}={value:g}" for symbol, value in symbols if value != 1.0)
        form = self.form.with_parameters(omega_1, omega_2, epsilon)
        return replace(self, name=f"{self.name} ({changed})" if changed else self.name, form=form)

    @cached_property
    def mirror_channels(self) -> np.ndarray:
        """(outcomes + 1,) the image of each fate under x → −x; entry 0 is 0. Only valid if `mirror_in_x`."""
        places = (self.saddles, np.array([(centre.x, centre.y) for centre in self.centres]).reshape(-1, 2))
        images = [np.arange(1)]
        for points in places:
            if len(points):
                distance = np.hypot(*(points[:, None] - points * [-1.0, 1.0]).T)
                images.append(sum(map(len, images)) + np.argmin(distance, axis=0))
        own = np.arange(sum(map(len, images)), len(self.outcomes) + 1)
        return read_only(np.concatenate([*images, own]).astype(np.int8))

    @cached_property
    def saddle_energies(self) -> np.ndarray:
        """(channels,) V at each exit saddle, in channel order."""
        return read_only(np.asarray(self.value(self.saddles[:, 0], self.saddles[:, 1]), dtype=float))

    @cached_property
    def escape_energy(self) -> float:
        """The lowest energy at which orbits can escape: V at the lowest exit saddle; infinite if there is none.

        With an escape radius −∞: at every energy there may be orbits outside the saddles.
        """
        if self.escape_radius is not None:
            return -np.inf
        return float(self.saddle_energies.min(initial=np.inf))

    @cached_property
    def channel_mergers(self) -> tuple[ChannelMerger, ...]:
        """The maxima that separate exits from each other, the lowest first.

        A maximum lies between two exits if a line of steepest ascent from the saddle of each ends at it.
        """
        if not self.channels:
            return ()
        form, points, indices = self.form, self.critical_points, self.critical_indices
        saddles = np.array([np.argmin(np.hypot(*(points - saddle).T)) for saddle in self.saddles], int)
        beside = stored_points("maxima", form, lambda: find_maxima_beside(form.downhill, form.hessian, points, indices, saddles))
        mergers = []
        for k in np.flatnonzero(beside.sum(axis=0) > 1):
            (x, y), channels = points[k].tolist(), (np.flatnonzero(beside[:, k]) + 1).tolist()
            mergers.append(ChannelMerger(float(self.value(x, y)), x, y, tuple(channels)))
        return tuple(sorted(mergers))

    def merged_exits(self, energy: float) -> tuple[MergedExit, ...]:
        """The exits of several channels, above a maximum between these. Such an exit has the lowest of their numbers."""
        return merged_exits(self.channel_mergers, energy)

    def exit_numbers(self, energy: Any) -> np.ndarray:
        """(…, outcomes + 1) the number of the exit that each fate is part of at energies (…); entry 0 is 0."""
        below = np.searchsorted([merger.energy for merger in self.channel_mergers], np.asarray(energy), side="left")
        numbers: np.ndarray = exit_numbers(self.channel_mergers, len(self.outcomes))[below]
        return numbers

    def mirror_numbers(self, energy: Any) -> np.ndarray:
        """(…, outcomes + 1) the image of each fate under x → −x at energies (…); entry 0 is 0. Only valid if `mirror_in_x`."""
        numbers: np.ndarray = self.exit_numbers(energy)[..., self.mirror_channels]
        return numbers

    def outcomes_at(self, energy: float | tuple[float, float]) -> tuple[Outcome, ...]:
        """The outcomes as `outcomes`, named as exits are at an energy, or in a range of energies (low, high)."""
        low, high = energy if isinstance(energy, tuple) else (energy, energy)
        if not self.merged_exits(high):
            return self.outcomes
        lowest = self.exit_numbers(low)
        exits = [
            exit_outcome(describe_channel(channel, self.channel_mergers, low, high), occurs=bool(lowest[channel] == channel))
            for channel in range(1, self.channels + 1)
        ]
        return (*exits, *self.outcomes[self.channels :])

    @cached_property
    def bottom(self) -> float:
        """V at the origin, from which multiples of the escape energy count.

        Without a well its average on a circle with half the distance of the nearest exit saddle, or a tenth of the escape radius.
        """
        if self.has_well or not self.typical_radius:
            return float(self.value(0.0, 0.0))
        value = self.value(*self._typical_circle)
        return float(value[np.isfinite(value)].mean())

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
