"""The review of a potential before any computation: critical points, exits, symmetries, reasons for refusal, and remarks."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np

from engine.foundations.result import Result
from engine.foundations.validation import checks_types
from engine.foundations.wording import format_point
from engine.systems.catalogue.entry import EnergyRange
from engine.systems.forms.polynomial_form import PolynomialForm
from engine.systems.formulas.formula_writer import write_formula
from engine.systems.merged_channels import name_channels
from engine.systems.potential import Potential
from engine.systems.review.classified_points import CriticalPoint, PointKind, find_new_origin
from engine.systems.review.energy_ranges import energy_range
from engine.systems.review.refusals import find_points_or_refusal
from engine.systems.system import System
from engine.systems.well import EQUAL_ENERGY_TOLERANCE

# Number of cached reviews.
_CACHE_SIZE = 256
# Remark on moved axes.
_SHIFT_REMARK = "x and y count from the well at {} of the formula."
# Distance within which a line of steepest descent ends at a minimum, in units of the distance of the minimum from the origin.
_SAME_PLACE = 1e-2


@dataclass(frozen=True, repr=False)
class PotentialReview(Result):
    """The result of `review_potential`. Lengths and energies are dimensionless.

    Attributes
    ----------
    potential
        The potential.
    formula
        V(x, y) as text, with the values of the parameters.
    critical_points
        All critical points, sorted by distance from the origin; empty if unknown, for example because they form a curve.
    escape_energy
        Energy of the lowest exit saddle; infinite if there is none.
    closed_energy
        The energy up to which the well is shown to be closed, so that no orbit leaves it; at most the escape energy. −∞ if this
        is not shown at any energy, for a refused potential, or with an escape radius.
    channels
        Number of exit channels over saddles.
    highest_energy
        The energy of the lowest maximum between two exits; infinite if there is none. Above it, both form one exit. Lyapunov
        orbits need not exist up to this energy, see `find_lyapunov_orbits`.
    mirror_in_x, mirror_in_y
        Whether V is even in x, and in y.
    rotations
        The largest n for which a rotation by 2π/n leaves V unchanged; 0 if every rotation does.
    refusal
        A sentence with the reason why the potential cannot be used; None if it can be used.
    remarks
        Unusual properties, one sentence each.
    well
        (x, y) of the nearest minimum if there is no well at the origin, see `Potential.at_minimum`. None without a minimum, in a
        rotating frame, with an escape radius, or if the axes have already been moved.
    """

    potential: Potential
    formula: str
    critical_points: tuple[CriticalPoint, ...]
    escape_energy: float
    closed_energy: float
    channels: int
    highest_energy: float
    mirror_in_x: bool
    mirror_in_y: bool
    rotations: int
    refusal: str | None
    remarks: tuple[str, ...]
    well: tuple[float, float] | None
    row_dimension: ClassVar = "point"

    @cached_property
    def energies(self) -> EnergyRange:
        """Energies to explore, derived from the potential; ValueError for a refused potential."""
        if self.refusal is not None:
            raise ValueError(f"energies: not defined for a refused potential. {self.refusal}")
        energies = [point.energy for point in self.critical_points]
        return energy_range(self.potential, self.highest_energy, self.closed_energy, energies)

    def provenance(self) -> dict[str, Any]:
        """Return the potential and the version."""
        return self.potential.provenance()

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return place, kind, energy and channel of each critical point."""
        names = [field.name for field in fields(CriticalPoint)]
        columns = {name: np.array([getattr(point, name) for point in self.critical_points]) for name in names}
        return columns | {"kind": np.array([point.kind.value for point in self.critical_points], dtype=str)}

    def describe(self) -> str:
        """Describe why the potential cannot be used, or its unusual properties; empty for an ordinary potential."""
        return self.refusal or " ".join(self.remarks)


@dataclass(frozen=True, repr=False)
class SystemReview(PotentialReview):
    """The review of a system, with the formula of its definition and the energies of the catalogue.

    Attributes
    ----------
    system
        The system.
    """

    system: System

    @cached_property
    def energies(self) -> EnergyRange:
        """Energies to explore: from the catalogue at its values of parameters, otherwise derived from the potential."""
        catalogue_energies = self.system.entry.energies
        return super().energies if catalogue_energies is None or self.system.parameters else catalogue_energies


@checks_types(potential=Potential)
@lru_cache(maxsize=_CACHE_SIZE)
def review_potential(potential: Potential) -> PotentialReview:
    """Check whether a potential can be used, without compiling or integrating anything.

    This usually takes a tenth of a second, and at most about 2 s. Results are cached. All iterations have limits on their steps,
    so the result does not depend on the speed of the machine.

    Parameters
    ----------
    potential
        Any potential.

    Returns
    -------
    The review. For a potential that cannot be used, the review has a `refusal`, and no error is raised.

    Examples
    --------
    >>> from escape_explorer import parse_formula, review_potential
    >>> review = review_potential(parse_formula("½(x² + y²) + xy² + 2x³"))
    >>> review.channels, round(review.escape_energy, 6), review.refusal
    (1, 0.00463, None)
    >>> review_potential(parse_formula("½(x² + y²) + x + x⁴")).refusal[:41]
    'There is no well at the origin: the force'
    """
    points, refusal = find_points_or_refusal(potential)
    return PotentialReview(
        potential=potential,
        formula=write_formula(potential),
        critical_points=points,
        escape_energy=potential.escape_energy if points or not potential.escapes_over_saddles else float("inf"),
        closed_energy=-np.inf if refusal or not potential.escapes_over_saddles else potential.well.closed_energy,
        channels=potential.channels if points else 0,
        highest_energy=potential.well.channel_mergers[0].energy if points and potential.well.channel_mergers else float("inf"),
        mirror_in_x=potential.form.is_even_in(0),
        mirror_in_y=potential.form.is_even_in(1),
        rotations=potential.form.count_rotations(),
        refusal=refusal,
        remarks=() if refusal else _remarks(potential, points),
        well=find_new_origin(potential, points),
    )


def _remarks(potential: Potential, points: tuple[CriticalPoint, ...]) -> tuple[str, ...]:
    """Return the unusual properties of a potential that can be used, one sentence each."""
    remarks = [_SHIFT_REMARK.format(format_point(*potential.origin))] if any(potential.origin) else []
    if not potential.escapes_over_saddles:
        return tuple(remarks)
    energies, closed_energy = potential.well.saddle_energies, potential.well.closed_energy
    exits_unknown = potential.well.exits_unknown
    if not potential.channels:
        exits = f"The exits are not known: {exits_unknown}" if exits_unknown else "No saddle leads out of the well at the origin."
        closed = f"The well is shown to be closed up to h = {closed_energy:.6g}, so no orbit escapes up to this energy."
        remarks.append(f"{exits} {closed}")
    elif closed_energy < potential.escape_energy:
        limit = f"only up to h = {closed_energy:.6g}" if np.isfinite(closed_energy) else "at no energy"
        remarks.append(f"Below its lowest saddle, the well is probably closed, but this is shown {limit}.")
    if potential.channels and np.ptp(energies) > EQUAL_ENERGY_TOLERANCE * potential.units.energy:
        order = np.argsort(energies, kind="stable")
        listed = ", ".join(f"{k + 1} above {energies[k]:.6g}" for k in order)
        remarks.append(f"The exits open at different energies: {listed}.")
    other_saddles = sum(point.kind is PointKind.SADDLE and not point.channel for point in points)
    if other_saddles and not exits_unknown:
        remarks.append(f"Saddles that do not lead out of the well at the origin and are therefore not exits: {other_saddles}.")
    wells_beyond = _wells_beyond_exits(potential, points)
    if wells_beyond:
        places = ", ".join(format_point(point.x, point.y) for point in wells_beyond)
        remarks.append(f"Exits lead into other wells, at {places}: an orbit that enters one counts as escaped but may return.")
    if potential.well.channel_mergers:
        lowest = potential.well.channel_mergers[0]
        merged = name_channels(lowest.channels)
        remarks.append(f"The exits are separate up to h = {lowest.energy:.6g}; above it some are one exit, {merged}.")
    if not potential.form.is_even_in(1):
        remarks.append("V is not even in y: y = 0 is not a symmetry axis, and an orbit may stay on one side of it.")
    if potential.form.has_constant:
        remarks.append("The constant term has no effect on the orbits, but all energies include it.")
    degrees = _degrees_above_two(potential)
    if len(degrees) == 1 and not potential.rotation:
        remarks.append(
            f"All terms beyond the quadratic ones have degree {degrees.pop()}: ε, and a common factor of ω1 and ω2, only change "
            "the units of length, time and energy."
        )
    return tuple(remarks)


def _degrees_above_two(potential: Potential) -> set[int]:
    """Return the degrees above 2 of the terms of a polynomial; empty for other potentials."""
    terms = potential.form.terms if isinstance(potential.form, PolynomialForm) else ()
    return {i + j for i, j, _ in terms if i + j > 2}


def _wells_beyond_exits(potential: Potential, points: tuple[CriticalPoint, ...]) -> list[CriticalPoint]:
    """Return the minima where lines of steepest descent over the exit saddles end."""
    well = potential.well
    ends = [line[-1] for line in (() if well.exits_unknown else well.exit_lines)]
    others = [point for point in points if point.kind is PointKind.MINIMUM and (point.x or point.y)]
    return [
        point
        for point in others
        if any(math.dist((point.x, point.y), end) < _SAME_PLACE * math.hypot(point.x, point.y) for end in ends)
    ]


def review_system(system: System) -> SystemReview:
    """Review the potential of a system; ValueError if the formula or a parameter is invalid."""
    review = review_potential(system.potential)
    values = {each.name: getattr(review, each.name) for each in fields(review)}
    return SystemReview(**{**values, "formula": system.formula_shown}, system=system)


def critical_energies(potential: Potential) -> tuple[float, ...]:
    """Return the energies above which separate regions of motion become connected.

    With exits, this is the energy of the lowest exit; with an escape radius, the energies of all saddles.
    """
    if potential.escapes_over_saddles:
        return (potential.escape_energy,)
    points = review_potential(potential).critical_points
    return tuple(sorted({point.energy for point in points if point.kind is PointKind.SADDLE}))
