"""Potentials: a formula, the rotation of its frame, and the ends of orbits other than exits.

All else is derived from these data: critical points, exits and units by `engine.systems.well`, kernels by `engine.integrator`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.expressions.nodes import Expression
from engine.foundations.result import Result
from engine.foundations.validation import LONGEST_TIME, check_type, checked_between, checked_items, checked_number, checked_t_max
from engine.integrator.source.polynomial_recurrence import Terms
from engine.integrator.source.recurrence import TOLERANCE
from engine.integrator.source.series import ORDER
from engine.systems.escape_arcs import end_kinds
from engine.systems.forms.expression_form import Form, as_form
from engine.systems.landscape.nearest_minimum import find_nearest_minimum
from engine.systems.motion import MASS_RANGE, Motion
from engine.systems.outcomes import KINDS, Centre, End, EscapeCircle, Outcome
from engine.systems.related_wells import SEARCHED, ContinuedWell, Lineage, scaled_to_well
from engine.systems.well import Well
from engine.systems.well_units import WellUnits

if TYPE_CHECKING:
    from engine.systems.system import System

# Default t_max if bounded orbits are integrated to the end, in units of 1/|Ω|, or of 1 without rotation.
_SHORT_TIME = 1000.0


@dataclass(frozen=True, init=False)
class Potential(Motion):
    """V(x, y), dimensionless: H = (px² + py²)/2m + V, with a mass m of 1 by default.

    In a frame that rotates at the rate Ω, V stands for the effective potential Φ, px and py for mẋ and mẏ, and H for the Jacobi
    integral m(ẋ² + ẏ²)/2 + Φ. Then mẍ = 2mΩẏ − Φ_x and mÿ = −2mΩẋ − Φ_y. See `in_rotating_frame`.

    Orbits with a mass m are orbits with a mass of 1 at the same energy, with momenta and times multiplied by √m, and are computed
    in this way. The multiplication by √m rounds, unless √m is a power of 2.

    Without an escape radius, orbits leave the well, or the body, at the origin through exits over saddles. With an escape
    radius, saddles are not exits, and orbits end beyond this radius. See `with_outcomes`.

    Parameters
    ----------
    name
        Display name. It has no influence on any result, and potentials with different names can be equal.
    form
        The function V. For a polynomial Σ c x^i y^j, its terms ((i, j, c), …), with exponents from 0 to 12, coefficients of at
        most 1e90 in magnitude, and each (i, j) only once. `parse_formula` makes the forms of other formulas.
    rotation
        Ω, counterclockwise for Ω > 0, at most 1e9 in magnitude, dimensionless.
    ends
        Ends of orbits other than exits, such as a `Centre`, see `with_outcomes`.
    origin
        (x, y) of the origin of the axes in the coordinates of the formula, see `at_minimum`. It has no influence on any result.
    lineage
        The way in which the well of the potential is found.
    system
        The `System` that made this potential; None without one.
    exit_names
        Names of the exits in channel order, such as ("L2", "L1"). They have no influence on any result, and are used if there are
        as many exits as names.
    mass
        m, 1e-6 to 1e6, dimensionless.

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
    mass: float = 1.0
    inner_names: ClassVar = Result.inner_names | {
        "check_at_rest", "check_without_gaps", "checked_t_max", "continued", "describe_run", "exit_names", "form", "gaps",
        "hessian_matrix", "in_well_units", "lineage", "reversed_in_time", "tori_are_evidence", "units", "well",
    }  # fmt: skip
    held_as: ClassVar = dict.fromkeys(("form", "rotation", "ends", "origin", "lineage", "system", "exit_names", "mass"), "terms")

    def __init__(
        self,
        name: str,
        form: Form | Terms | Expression,
        rotation: float = 0.0,
        *,
        ends: Sequence[End] = (),
        origin: tuple[float, float] = (0.0, 0.0),
        lineage: Lineage = SEARCHED,
        system: System | None = None,
        exit_names: Sequence[str] = (),
        mass: float = 1.0,
    ) -> None:
        check_type("name", name, str)
        values = {
            "name": name,
            "form": as_form(form),
            "rotation": checked_number("rotation", rotation),
            "ends": tuple(sorted(checked_items("ends", ends, End), key=lambda end: list(KINDS).index(end.key))),
            "origin": (checked_number("origin", origin[0]), checked_number("origin", origin[1])),
            "lineage": lineage,
            "system": system,
            "exit_names": checked_items("exit_names", exit_names, str),
            "mass": checked_between("mass", mass, *MASS_RANGE),
        }
        for attribute, value in values.items():
            object.__setattr__(self, attribute, value)

    @cached_property
    def well(self) -> Well:
        """Quantities derived from the potential: critical points, exits, symmetries, units."""
        return self.lineage.make_well(self.form, self.rotation, self.ends, self.mass)

    @property
    def centres(self) -> tuple[Centre, ...]:
        """Bodies with which orbits collide."""
        return tuple(end for end in self.ends if isinstance(end, Centre))

    @property
    def escape_radius(self) -> float | None:
        """Distance from the origin beyond which orbits have escaped; None for exits over saddles."""
        return self.well.escape_radius

    @property
    def escapes_over_saddles(self) -> bool:
        """Whether orbits escape through exits over saddles, if at all, and not beyond an escape radius."""
        return self.well.escapes_over_saddles

    @property
    def gaps(self) -> tuple[End, ...]:
        """The ends that are gaps in the interior, such as the discs of centres. V may be singular there."""
        return tuple(end for end in self.ends if end.side < 0)

    @property
    def critical_points(self) -> np.ndarray:
        """All points with ∇V = 0, of shape (n, 2). A point at the origin is exactly (0, 0). ValueError for a curve of points."""
        return self.well.critical_points

    @property
    def saddles(self) -> np.ndarray:
        """The saddles that lead out of the well at the origin, of shape (n, 2), in channel order; none with an escape radius."""
        return self.well.saddles

    @property
    def channels(self) -> int:
        """The number of exit channels. Channels are numbered from 1, counterclockwise from the +x axis."""
        return self.well.channels

    @property
    def escape_energy(self) -> float:
        """The lowest energy at which orbits can escape: V at the lowest exit saddle; infinite if there is none.

        With an escape radius, the value is −∞, because orbits can start outside the saddles at every energy.
        """
        return self.well.escape_energy

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The possible ends of orbits: the exits in channel order, then `ends`. The first has the fate 1."""
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
        """The potential in units L of length and E of energy of the well: V(L x, L y) / E with a mass of 1.

        If all units are 1, this is the potential itself.
        """
        return self if self.units == WellUnits() else scaled_to_well(self)

    def continued(
        self, family: str, saddles: np.ndarray, maxima: np.ndarray, saddle_indices: Sequence[Sequence[int]]
    ) -> Potential:
        """Return the potential as a member of a family, with exits at known saddles, see `ContinuedWell`."""
        make_well = partial(ContinuedWell, exit_saddles=saddles, maxima=maxima, saddle_indices=saddle_indices)
        return replace(self, lineage=Lineage(family, make_well))

    def _copy_with(self, *, factors: Mapping[str, float] | None = None, **values: Any) -> Potential:
        """Return a copy with other values of some attributes. The exits of its well are searched again.

        It keeps a system, whose parameters have these factors, only if it is the potential of this system.
        """
        copy = replace(self, lineage=SEARCHED, system=None, **values)
        if self.system is None or factors is None:
            return copy
        system = self.system.with_factors(factors)
        try:
            return replace(copy, system=system) if system.potential == copy else copy
        except ValueError:
            return copy

    def at_minimum(self, x: float = 0.0, y: float = 0.0) -> Potential:
        """Return the potential with its axes moved to the minimum nearest to a place. Its exits are those of the well there.

        Energies are unchanged. A frame that rotates turns about the new origin.

        Parameters
        ----------
        x, y
            The place, dimensionless.

        Raises
        ------
        ValueError
            If V has no minimum, or none is found.

        Examples
        --------
        >>> from escape_explorer import parse_formula
        >>> moved = parse_formula("5(x² + y²) + 3y + 0.3(x⁴ + y⁴ − 6x²y²)").at_minimum()
        >>> [round(coordinate, 6) for coordinate in moved.origin], round(max(moved.well.saddle_energies), 4)
        ([0.0, -0.296861], 27.0123)
        """
        place = np.array([checked_number("x", x), checked_number("y", y)])
        minimum = find_nearest_minimum(self.form, self.well.critical_points, self.well.critical_indices, place)
        if minimum is None:
            raise ValueError(f"potential={self.name}: V must have a minimum to which its axes can be moved")
        nearest = minimum.tolist()
        ends = tuple(end.moved(*nearest) for end in self.ends)
        origin = self.origin[0] + nearest[0], self.origin[1] + nearest[1]
        return self._copy_with(form=self.form.moved(*nearest), ends=ends, origin=origin, exit_names=())

    def with_outcomes(self, centres: Sequence[Centre] = (), escape_radius: float | None = None) -> Potential:
        """Return the potential with other centres and another escape radius.

        Parameters
        ----------
        centres
            Bodies with which orbits collide.
        escape_radius
            Distance from the origin beyond which orbits have escaped, 1e-6 to 1e6, dimensionless; None for exits over saddles.
        """
        others = [end for end in self.ends if not isinstance(end, Centre | EscapeCircle)]
        circles = [] if escape_radius is None else [EscapeCircle(escape_radius)]
        return self._copy_with(ends=[*others, *checked_items("centres", centres, Centre), *circles])

    def checked_t_max(self, t_max: Any, longest: float = LONGEST_TIME, *, name: str = "t_max") -> float:
        """Return `t_max`, above 0, as a float. If the time unit of the well exceeds 1, the limit `longest` is in this unit.

        None stands for 1e5, or for a shorter time if bounded orbits are integrated to the end.
        """
        if t_max is None:
            t_max = 1e5 if self.tori_are_evidence else _SHORT_TIME / (abs(self.rotation) or 1.0)
        return checked_t_max(t_max, longest, lambda: self.well.exact_time_unit, name=name)

    def check_without_gaps(self, what: str) -> None:
        """Raise ValueError if there are `gaps`. `what` names, in the plural, results of SALI."""
        if self.gaps:
            raise ValueError(
                f"potential={self.name}: has {self.gaps[0].word}s; "
                f"{what} are not told apart, because near them SALI falls and rises again"
            )

    @property
    def tori_are_evidence(self) -> bool:
        """Whether an invariant torus counts as evidence that its orbits are bounded for ever: only in a well at rest.

        In a rotating frame, and with ends other than exits, this evidence has not been tested.
        """
        return not self.rotation and not self.ends

    def provenance(self) -> dict[str, Any]:
        """Return the potential in plain values, with all digits, and the version."""
        return {
            "potential": self.name,
            "terms": self.form.text,
            "rotation": self.rotation,
            "mass": self.mass,
            **{kind.attribute: kind.write([end for end in self.ends if type(end) is kind]) for kind in end_kinds()},
            "origin": json.dumps(self.origin),
            **({"exit_names": json.dumps(self.exit_names)} if self.exit_names else {}),
            **super().provenance(),
        }

    def describe_run(self, **request: Any) -> dict[str, Any]:
        """Return the provenance of a computation: that of the potential, the request and the integrator."""
        energy = request.get("energy")
        constant = {"jacobi_constant": self.jacobi_constant(energy)} if self.rotation and isinstance(energy, float) else {}
        integrator = f"Taylor series of order {ORDER}, tolerance {TOLERANCE:g}"
        return {**self.provenance(), **request, **constant, "integrator": integrator}

    def numbers(self) -> dict[str, Any]:
        """Return the name, the escape energy and the number of channels."""
        return {"name": self.name, "escape_energy": self.escape_energy, "channels": self.channels}

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return the channel, place and energy of each exit saddle."""
        x, y = self.saddles.T
        return {"channel": np.arange(1, self.channels + 1), "x": x, "y": y, "energy": self.well.saddle_energies}
