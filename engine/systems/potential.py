"""Potentials: a formula, the rotation of its frame, and the ends of orbits besides its exits.

Everything else is derived from these: critical points, exits and units by `engine.systems.well`, the integrator by
`engine.integrator`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.expressions.nodes import Expression
from engine.foundations.former_names import with_former_fields
from engine.foundations.result import Result
from engine.foundations.validation import LONGEST_TIME, check_type, checked_number, checked_t_max, replace_unchecked
from engine.systems.forms.expression_form import ExpressionForm
from engine.systems.forms.form import Form, hessian_matrix
from engine.systems.forms.polynomial_form import PolynomialForm, checked_form
from engine.systems.jacobi import squared_speed_of_origin
from engine.systems.outcomes import KINDS, Centre, End, EscapeCircle, Outcome
from engine.systems.parameters import WELL_PARAMETERS, symbol_of
from engine.systems.provenance import describe_potential
from engine.systems.related_wells import SEARCHED, ContinuedWell, Lineage, ScaledWell
from engine.systems.well import Well
from engine.systems.well_units import WellUnits

if TYPE_CHECKING:
    from engine.systems.system import System

Terms = tuple[tuple[int, int, float], ...]

# Marks centres or an escape radius that are given in `ends`.
_OF_ENDS: Any = ...

# In units of 1/Ω.
_SHORT_TIME = 1000.0


@with_former_fields
@dataclass(frozen=True, init=False)
class Potential(Result):
    """V(x, y), dimensionless, for a unit mass: H = (px² + py²)/2 + V.

    In a frame that rotates at the rate Ω, V stands for the effective potential Φ, px and py for the velocities ẋ and ẏ, and H for
    the Jacobi integral (ẋ² + ẏ²)/2 + Φ: ẍ = 2Ωẏ − Φ_x, ÿ = −2Ωẋ − Φ_y. See `in_rotating_frame`.

    Without an escape radius, orbits leave a well, or a centre, at the origin through the exits over its saddles. With an escape
    radius, saddles are not exits, and orbits end beyond this radius. See `with_outcomes`.

    Parameters
    ----------
    name
        Display name, which has no influence on any result; potentials with different names can be equal.
    form
        The function V. For a polynomial Σ c x^i y^j, its terms ((i, j, c), …): exponents i, j from 0 to 12 and coefficient c, at
        most 1e90 in magnitude, of each term, each (i, j) only once. `parse_formula` makes the forms of other formulas.
    rotation
        Ω, counterclockwise for Ω > 0, at most 1e9 in magnitude, dimensionless.
    centres
        Bodies with which orbits collide.
    escape_radius
        Distance from the origin beyond which orbits have escaped, 1e-6 to 1e6, dimensionless; None for exits over saddles.
    origin
        (x, y) of the origin of the axes in the coordinates of the formula, see `at_minimum`; it has no influence on any result.
    lineage
        The way in which its well is found.
    system
        The `System` of this potential; None if it was made in another way.
    ends
        Ends of orbits besides exits, such as a `Centre`; `centres` and `escape_radius` replace those of their kinds.
    exit_names
        Names of the exits in channel order, such as ("L2", "L1"), which have no influence on any result; they are used if there
        are as many exits as names.

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
    rotation: float = 0.0
    ends: tuple[End, ...] = ()
    origin: tuple[float, float] = (0.0, 0.0)
    lineage: Lineage = field(default=SEARCHED, repr=False)
    system: System | None = field(default=None, repr=False, compare=False)
    exit_names: tuple[str, ...] = field(default=(), repr=False, compare=False)
    inner_names: ClassVar = Result.inner_names | {
        "check_at_rest", "check_without_gaps", "checked_t_max", "continued", "exit_names", "form", "gaps",
        "hessian_matrix", "in_well_units", "lineage", "reversed_in_time", "tori_are_evidence", "units", "well",
    }  # fmt: skip
    held_as: ClassVar = dict.fromkeys(("form", "rotation", "ends", "origin", "lineage", "system", "exit_names"), "terms")

    def __init__(
        self,
        name: str,
        form: Form | Terms | Expression,
        rotation: float = 0.0,
        centres: Sequence[Centre] = _OF_ENDS,
        escape_radius: float | None = _OF_ENDS,
        origin: tuple[float, float] = (0.0, 0.0),
        lineage: Lineage = SEARCHED,
        *,
        ends: Sequence[End] = (),
        system: System | None = None,
        exit_names: Sequence[str] = (),
    ) -> None:
        check_type("name", name, str)
        if isinstance(form, Expression):
            form = ExpressionForm(form)
        elif not isinstance(form, PolynomialForm | ExpressionForm):
            form = checked_form(form)
        if centres is not _OF_ENDS:
            ends = [*(end for end in ends if not isinstance(end, Centre)), *_checked(centres, "centres", Centre)]
        if escape_radius is not _OF_ENDS:
            circles = [] if escape_radius is None else [EscapeCircle(escape_radius)]
            ends = [*(end for end in ends if not isinstance(end, EscapeCircle)), *circles]
        values = {
            "name": name,
            "form": form,
            "rotation": checked_number("rotation", rotation),
            "ends": tuple(sorted(_checked(ends, "ends", End), key=lambda end: list(KINDS).index(end.key))),
            "origin": (checked_number("origin", origin[0]), checked_number("origin", origin[1])),
            "lineage": lineage,
            "system": system,
            "exit_names": tuple(_checked(exit_names, "exit_names", str)),
        }
        for attribute, value in values.items():
            object.__setattr__(self, attribute, value)

    @cached_property
    def well(self) -> Well:
        """Quantities derived from the potential: critical points, exits, symmetries, units."""
        return self.lineage.make_well(self.form, self.rotation, self.ends)

    @property
    def centres(self) -> tuple[Centre, ...]:
        """Bodies with which orbits collide."""
        return tuple(end for end in self.ends if isinstance(end, Centre))

    @property
    def escape_radius(self) -> float | None:
        """Distance from the origin beyond which orbits have escaped; None for exits over saddles."""
        return self.well.escape_radius

    @property
    def gaps(self) -> tuple[End, ...]:
        """The ends that are gaps in the interior, such as the discs of centres; V may be singular there."""
        return tuple(end for end in self.ends if end.side < 0)

    @property
    def critical_points(self) -> np.ndarray:
        """(n, 2) all points with ∇V = 0; a critical point at the origin is exactly (0, 0). ValueError if they form a curve."""
        return self.well.critical_points

    @property
    def saddles(self) -> np.ndarray:
        """(n, 2) the saddles that lead out of the well at the origin, in channel order; none with an escape radius."""
        return self.well.saddles

    @property
    def channels(self) -> int:
        """The number of exit channels; they are numbered from 1, counterclockwise from the +x axis."""
        return self.well.channels

    @property
    def escape_energy(self) -> float:
        """The lowest energy at which orbits can escape: V at the lowest exit saddle; infinite if there is none.

        It is −∞ with an escape radius, because orbits can then start outside the saddles at every energy.
        """
        return self.well.escape_energy

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The possible ends of orbits: the exits in channel order, then `ends`; the first one is fate 1."""
        return self.outcomes_at(-np.inf) if self.exit_names else self.well.outcomes

    def outcomes_at(self, energy: float | tuple[float, float]) -> tuple[Outcome, ...]:
        """Return `outcomes` with the names that exits have at an energy, or in a range of energies (low, high)."""
        return self.well.outcomes_at(energy, self.exit_names if len(self.exit_names) == self.channels else ())

    @property
    def units(self) -> WellUnits:
        """The units of the well, see `Well.units`."""
        return self.well.units

    @cached_property
    def in_well_units(self) -> Potential:
        """Return the system in units of the well: V(L x, L y) / E, with units L of length and E of energy.

        If both units are 1, it is the potential itself.
        """
        units = self.units
        if units == WellUnits():
            return self
        # Legal ranges apply to the units of the potential.
        return replace_unchecked(
            self,
            form=self.form.scaled(units.length, units.energy),
            rotation=self.rotation * units.time,
            ends=tuple(end.scaled(1.0 / units.length) for end in self.ends),
            lineage=replace(self.lineage, make_well=partial(ScaledWell, stated=self.well)),
            system=None,
        )

    def continued(self, family: str, found: np.ndarray, maxima: np.ndarray, around: Sequence[Sequence[int]]) -> Potential:
        """Return the potential as a member of a family, with known exits; the parameters are those of `ContinuedWell`."""
        return replace(self, lineage=Lineage(family, partial(ContinuedWell, found=found, maxima=maxima, around=around)))

    def _changed(self, **values: Any) -> Potential:
        """Return another potential, whose well is searched."""
        return replace(self, lineage=SEARCHED, system=None, **values)

    def in_rotating_frame(self, rotation: float) -> Potential:
        """Return the potential in a frame that rotates about the origin at the rate Ω: Φ = V − ½ Ω² (x² + y²).

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
        half = -0.5 * checked_number("rotation", rotation) ** 2
        return self._changed(form=self.form.plus({(2, 0): half, (0, 2): half}), rotation=rotation) if rotation else self

    def at_minimum(self, x: float = 0.0, y: float = 0.0) -> Potential:
        """Return the potential with its axes moved to the minimum nearest to a place, so that orbits leave the well there.

        Energies are unchanged. A frame that rotates turns about the new origin.

        Parameters
        ----------
        x, y
            The place, dimensionless.

        Raises
        ------
        ValueError
            If V has no minimum, or it was not found.

        Examples
        --------
        >>> from escape_explorer import parse_formula
        >>> moved = parse_formula("5(x² + y²) + 3y + 0.3(x⁴ + y⁴ − 6x²y²)").at_minimum()
        >>> [round(coordinate, 6) for coordinate in moved.origin], round(max(moved.well.saddle_energies), 4)
        ([0.0, -0.296861], 27.0123)
        """
        place = np.array([checked_number("x", x), checked_number("y", y)])
        points = self.well.critical_points
        along_x, _, along_y = self.hessian(*points.T)
        minima = points[(self.well.critical_indices > 0.0) & (along_x + along_y > 0.0)]
        if not len(minima):
            raise ValueError(f"potential={self.name}: V must have a minimum to which its axes can be moved")
        nearest = minima[np.argmin(np.hypot(*(minima - place).T))].tolist()
        ends = tuple(end.moved(*nearest) for end in self.ends)
        origin = self.origin[0] + nearest[0], self.origin[1] + nearest[1]
        return self._changed(form=self.form.moved(*nearest), ends=ends, origin=origin, exit_names=())

    def with_outcomes(self, centres: Sequence[Centre] = (), escape_radius: float | None = None) -> Potential:
        """Return the potential with other centres and another escape radius; the parameters are those of `Potential`."""
        return self._changed(centres=centres, escape_radius=escape_radius)

    @cached_property
    def reversed_in_time(self) -> Potential:
        """Return the potential whose orbits are those of this one backward in time, with reversed velocities and Ω."""
        return self._changed(rotation=-self.rotation) if self.rotation else self

    def checked_t_max(self, t_max: Any, longest: float = LONGEST_TIME, *, name: str = "t_max") -> float:
        """Return `t_max` as a float, 0 < t_max ≤ longest, in units of the well if its unit of time is longer than 1.

        None stands for 1e5, or for a shorter time if bounded orbits are integrated to the end.
        """
        if t_max is None:
            t_max = 1e5 if self.tori_are_evidence else _SHORT_TIME / (abs(self.rotation) or 1.0)
        return checked_t_max(t_max, longest, lambda: self.well.exact_time_unit, name=name)

    def check_at_rest(self, what: str) -> None:
        """Raise ValueError in a rotating frame, for computations that rely on time-reversal symmetry."""
        if self.rotation:
            raise ValueError(f"potential={self.name}: its frame rotates; {what} are for frames that do not rotate")

    def check_without_gaps(self, what: str) -> None:
        """Raise ValueError if there are `gaps`, for computations with fixed steps."""
        if self.gaps:
            bodies = f"{self.gaps[0].word}s"
            raise ValueError(
                f"potential={self.name}: has {bodies}; {what} are computed with fixed steps, which cannot pass close to them"
            )

    @property
    def tori_are_evidence(self) -> bool:
        """Whether an invariant torus counts as evidence that its orbits are bounded for ever, which holds only in a well at rest.

        In a rotating frame, and with ends besides the exits, this evidence has not been tested.
        """
        return not self.rotation and not self.ends

    def provenance(self) -> dict[str, Any]:
        """Return the potential in plain values, and the version."""
        return super().provenance() | describe_potential(self)

    def numbers(self) -> dict[str, Any]:
        """Return the name, the escape energy and the number of channels."""
        return {"name": self.name, "escape_energy": self.escape_energy, "channels": self.channels}

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return number, place and energy of each exit saddle."""
        x, y = self.saddles.T
        return {"channel": np.arange(1, self.channels + 1), "x": x, "y": y, "energy": self.well.saddle_energies}

    @property
    def terms(self) -> Terms:
        """((i, j, c), …) of a polynomial; ValueError for other formulas."""
        if not isinstance(self.form, PolynomialForm):
            raise ValueError(f"{self.name} is not a polynomial")
        return self.form.terms

    def value(self, x: Any, y: Any) -> Any:
        """Return V at (x, y); arrays broadcast."""
        return self.form.value(x, y)

    def gradient(self, x: Any, y: Any) -> tuple[Any, Any]:
        """Return (V_x, V_y) at (x, y); arrays broadcast."""
        return self.form.gradient(x, y)

    def hessian(self, x: Any, y: Any) -> tuple[Any, Any, Any]:
        """Return (V_xx, V_xy, V_yy) at (x, y); arrays broadcast."""
        return self.form.hessian(x, y)

    def hessian_matrix(self, x: float, y: float) -> np.ndarray:
        """Return (2, 2) the Hessian matrix of V at one point."""
        return hessian_matrix(self.form, x, y)

    def energy(self, states: Any) -> Any:
        """Return H of states (…, 4) = x, y, px, py."""
        x, y, px, py = np.moveaxis(np.asarray(states, dtype=float), -1, 0)
        return 0.5 * (px * px + py * py) + self.value(x, y)

    def jacobi_constant(self, energy: Any) -> Any:
        """Return the Jacobi constant C = 2U − ẋ² − ẏ² of energies H in a rotating frame; arrays have the same shape.

        C = −2H about the axis of the frame, which is the barycentre in the three-body problem, where U = Σ m/r + ½ (x² + y²). In
        the Earth–Moon system, seen from the Moon, C = (1 − m)² − 2H. Some authors add μ(1 − μ) to C, so that their values are
        larger by this amount.

        Raises
        ------
        ValueError
            If the frame does not rotate.

        Examples
        --------
        >>> from escape_explorer import POTENTIALS
        >>> hill, earth_moon = POTENTIALS["Hill"], POTENTIALS["Earth-Moon"]
        >>> round(hill.jacobi_constant(hill.escape_energy), 5), round(earth_moon.jacobi_constant(earth_moon.escape_energy), 5)
        (4.32675, 3.18834)
        """
        return self._squared_speed_of_origin - 2.0 * energy

    def jacobi_energy(self, constant: Any) -> Any:
        """Return the energy H of Jacobi constants, see `jacobi_constant`."""
        return 0.5 * (self._squared_speed_of_origin - constant)

    @property
    def _squared_speed_of_origin(self) -> float:
        if not self.rotation:
            raise ValueError(f"potential={self.name}: its frame must rotate for a Jacobi constant")
        return squared_speed_of_origin(self.form, self.rotation)

    def with_parameters(self, omega_1: float = 1.0, omega_2: float = 1.0, epsilon: float = 1.0) -> Potential:
        """Return this potential with other frequencies of its well and another strength of its perturbation.

        V = ½ (ω1² x² + ω2² y²) + ε V1 of Zotos (2014), who uses ω1 = ω2 = ε = 1; V1 consists of the terms of degree 3 and higher.
        In general V1 is V without the constant, linear and quadratic terms of its expansion about the origin. The term with x² is
        multiplied by ω1², that with y² by ω2² and that with x y by ω1 ω2, also if the quadratic terms are not ½ (x² + y²), so
        that the default values give the potential itself. Constant and linear terms are unchanged.

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
        chosen = {"omega_1": omega_1, "omega_2": omega_2, "epsilon": epsilon}
        for name, value in chosen.items():
            low, high = WELL_PARAMETERS[name].range
            if not low <= checked_number(name, value) <= high:
                raise ValueError(f"{name}={value}: must be between {low:g} and {high:g}")
        is_changed = not omega_1 == omega_2 == epsilon == 1.0
        if is_changed and not np.isfinite(self.hessian_matrix(0.0, 0.0)).all():
            raise ValueError(f"omega_1, omega_2, epsilon: V of {self.name} has no expansion about the origin; must be 1")
        changed = ", ".join(f"{symbol_of(name)}={value:g}" for name, value in chosen.items() if value != 1.0)
        form = self.form.with_parameters(omega_1, omega_2, epsilon)
        return self._changed(name=f"{self.name} ({changed})" if changed else self.name, form=form)


def _checked[T](ends: Sequence[T], name: str, kind: type[T]) -> Sequence[T]:
    """Return the ends after checking that all are of one kind."""
    check_type(name, ends, Iterable)
    for end in ends:
        check_type(name, end, kind)
    return ends
