"""Validation of a potential before any computation: critical points, exits, symmetries, reasons for refusal, and remarks."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from enum import Enum
from functools import lru_cache
from typing import ClassVar

import numpy as np

from engine.potentials.forms.common_roots import UndecidedError
from engine.potentials.forms.critical_points import NotIsolatedError
from engine.potentials.forms.exit_saddles import DescentError
from engine.potentials.hill_region import is_open_below, is_open_without_saddle
from engine.potentials.merged_channels import name_channels
from engine.potentials.potential import Potential
from engine.potentials.singularity_check import singularity_refusal
from engine.potentials.well import EQUAL_ENERGY_TOLERANCE
from engine.results.result import Result
from engine.validation import checks_types

MOST_CHANNELS = 16
"""Largest number of exit channels that the kernels of the Lyapunov orbit search support."""

_CACHE_SIZE = 256
_MOVED = "x and y count from the well at ({:.6g}, {:.6g}) of the formula."


class PointKind(Enum):
    """The type of a critical point; the value is its name in texts."""

    MINIMUM = "minimum"
    SADDLE = "saddle"
    MAXIMUM = "maximum"
    DEGENERATE = "degenerate point"


@dataclass(frozen=True)
class CriticalPoint:
    """A point (x, y) with ∇V = 0 and V = `energy`; `channel` is the number of the channel over it, 0 if there is none."""

    x: float
    y: float
    kind: PointKind
    energy: float
    channel: int


@dataclass(frozen=True, repr=False)
class PotentialReview(Result):
    """The result of `review_potential`; lengths and energies are dimensionless.

    Attributes
    ----------
    potential
        The potential.
    critical_points
        All critical points, sorted by distance from the origin; empty if they form a curve.
    escape_energy
        Energy of the lowest exit saddle; infinite if there is none.
    channels
        Number of exits.
    highest_energy
        The energy of the lowest maximum between two exits, above which they are one; infinite if there is none. Lyapunov orbits
        may cease to exist below it: see `find_lyapunov_orbits`.
    mirror_in_x, mirror_in_y
        Whether V is even in x, in y.
    rotations
        The largest n for which a rotation by 2π/n leaves V unchanged: 1 if none does, 0 if every rotation does.
    refusal
        A sentence that says why the potential cannot be used; None if it can.
    remarks
        Unusual properties, one sentence each.
    well
        (x, y) of the nearest minimum if there is no well at the origin, see `Potential.at_minimum`; None if there is none, and
        for rotating frames, escape radii and axes that are moved already.
    """

    potential: Potential
    critical_points: tuple[CriticalPoint, ...]
    escape_energy: float
    channels: int
    highest_energy: float
    mirror_in_x: bool
    mirror_in_y: bool
    rotations: int
    refusal: str | None
    remarks: tuple[str, ...]
    well: tuple[float, float] | None
    row_dimension: ClassVar = "point"

    def columns(self) -> Mapping[str, np.ndarray]:
        """Place, kind, energy and channel of each critical point."""
        names = [field.name for field in fields(CriticalPoint)]
        columns = {name: np.array([getattr(point, name) for point in self.critical_points]) for name in names}
        return columns | {"kind": np.array([point.kind.value for point in self.critical_points], dtype=str)}

    def describe(self) -> str:
        """Why the potential cannot be used, or what is unusual about it; empty for an ordinary one."""
        return self.refusal or " ".join(self.remarks)


@checks_types(potential=Potential)
@lru_cache(maxsize=_CACHE_SIZE)
def review_potential(potential: Potential) -> PotentialReview:
    """Check whether a potential can be used, without compiling or integrating anything.

    It takes a tenth of a second usually, and about 2 s at most; repeated calls are answered from a cache. All iterations have
    limits on their steps, so that the result does not depend on the speed of the machine.

    Parameters
    ----------
    potential
        Any potential.

    Returns
    -------
    The review. No error is raised for a potential that cannot be used; its review has a `refusal`.

    Examples
    --------
    >>> from escape_explorer import parse_formula, review_potential
    >>> review = review_potential(parse_formula("½(x² + y²) + xy² + 2x³"))
    >>> review.channels, round(review.escape_energy, 6), review.refusal
    (1, 0.00463, None)
    >>> review_potential(parse_formula("½(x² + y²) + x⁴ + y⁴")).refusal
    'No saddle leads out of the well at the origin, so no orbit escapes at any energy.'
    """
    points, refusal = _critical_points_or_refusal(potential)
    return PotentialReview(
        potential=potential,
        critical_points=points,
        escape_energy=potential.escape_energy if points or potential.escape_radius is not None else float("inf"),
        channels=potential.channels if points else 0,
        highest_energy=potential.well.channel_mergers[0].energy if points and potential.well.channel_mergers else float("inf"),
        mirror_in_x=potential.form.mirror_in_x,
        mirror_in_y=potential.form.mirror_in_y,
        rotations=potential.form.count_rotations(),
        refusal=refusal,
        remarks=() if refusal else _remarks(potential, points),
        well=_other_well(potential, points),
    )


def _critical_points_or_refusal(potential: Potential) -> tuple[tuple[CriticalPoint, ...], str | None]:
    refusal = potential.form.limits_refusal() or singularity_refusal(potential)
    if refusal is not None:
        return (), refusal
    if potential.escape_radius is not None:
        return _known_critical_points(potential), None
    try:
        # Both follow lines of steepest descent or ascent, which may fail.
        points, _ = _critical_points(potential), potential.well.channel_mergers
    except DescentError as error:
        return (), f"Which saddles are exits of the well is not known. {error}"
    except UndecidedError as error:
        return (), str(error)
    except NotIsolatedError:
        return (), (
            "The force vanishes along a curve instead of at isolated points, as in an infinite valley or a circular potential, "
            "so the well at the origin is not bounded by isolated saddles. Add terms that make V vary along this curve."
        )
    refusals = (check(potential, points) for check in (_well_refusal, _degenerate_refusal, _exits_refusal))
    return points, next(filter(None, refusals), None)


def _known_critical_points(potential: Potential) -> tuple[CriticalPoint, ...]:
    """Those of a system with an escape radius, which does not need them; none where they are not found."""
    try:
        return _critical_points(potential)
    except (UndecidedError, NotIsolatedError):
        return ()


def _critical_points(potential: Potential) -> tuple[CriticalPoint, ...]:
    points = [
        CriticalPoint(x, y, _kind(potential, x, y, index), float(potential.value(x, y)), _channel(potential, x, y))
        for (x, y), index in zip(potential.critical_points.tolist(), potential.well.critical_indices.tolist(), strict=True)
    ]
    return tuple(sorted(points, key=lambda point: math.hypot(point.x, point.y)))


def _kind(potential: Potential, x: float, y: float, index: float) -> PointKind:
    if index == 0.0:
        return PointKind.DEGENERATE
    if index < 0.0:
        return PointKind.SADDLE
    return PointKind.MINIMUM if np.trace(potential.hessian_matrix(x, y)) > 0.0 else PointKind.MAXIMUM


def _channel(potential: Potential, x: float, y: float) -> int:
    near = np.flatnonzero(np.hypot(*(potential.saddles - [x, y]).T) < 1e-6 * potential.units.length)
    return int(near[0]) + 1 if near.size else 0


def _well_refusal(potential: Potential, points: tuple[CriticalPoint, ...]) -> str | None:
    at_origin = _point_at_origin(points)
    if at_origin is not None and at_origin.kind is PointKind.MINIMUM:
        return None
    if any(x == y == 0.0 for x, y in potential.form.singular_points.tolist()):
        return None
    if at_origin is None:
        problem = "There is no well at the origin: the force is not zero there, because V has linear terms."
    else:
        problem = f"There is no well at the origin: V has a {at_origin.kind.value} there."
    minima = _minima(points)
    if not minima:
        return f"{problem} Add quadratic terms that make the origin a minimum, or give an escape radius."
    place = f"({minima[0].x:.6g}, {minima[0].y:.6g})"
    which = f"The nearest of {len(minima)} minima is" if len(minima) > 1 else "The only minimum is"
    can_move = _other_well(potential, points) is not None
    hint = f": with “; well {place}” after the formula, x and y count from there" if can_move else ""
    return f"{problem} {which} at {place}{hint}."


def _point_at_origin(points: tuple[CriticalPoint, ...]) -> CriticalPoint | None:
    return next((point for point in points if point.x == point.y == 0.0), None)


def _minima(points: tuple[CriticalPoint, ...]) -> list[CriticalPoint]:
    """The minima, the nearest to the origin first."""
    return [point for point in points if point.kind is PointKind.MINIMUM]


def _other_well(potential: Potential, points: tuple[CriticalPoint, ...]) -> tuple[float, float] | None:
    """The nearest minimum that a formula can be moved to by a clause, which it may have once only."""
    nearest = next(iter(_minima(points)), None)
    is_moved = any(potential.origin)
    if nearest is None or nearest is _point_at_origin(points) or is_moved or potential.rotation:
        return None
    return (nearest.x, nearest.y) if potential.escape_radius is None else None


def _degenerate_refusal(_potential: Potential, points: tuple[CriticalPoint, ...]) -> str | None:
    for point in points:
        if point.kind is PointKind.DEGENERATE:
            return (
                f"V has a degenerate critical point at ({point.x:.6g}, {point.y:.6g}), which is neither a saddle nor a minimum "
                f"nor a maximum, so it is undefined whether orbits escape over it."
            )
    return None


def _exits_refusal(potential: Potential, points: tuple[CriticalPoint, ...]) -> str | None:
    if not potential.channels:
        return _no_exit_refusal(potential)
    if potential.channels > MOST_CHANNELS:
        return f"V has {potential.channels} channels; at most {MOST_CHANNELS} are allowed."
    if is_open_below(potential, potential.escape_energy, potential.critical_points):
        return "The well is open below its lowest saddle, so orbits can escape without crossing an exit."
    return None


def _no_exit_refusal(potential: Potential) -> str:
    if is_open_without_saddle(potential, potential.critical_points):
        return "The well is open without a saddle, or rises too slowly to be called closed, so its exits are not defined."
    return "No saddle leads out of the well at the origin, so no orbit escapes at any energy."


def _remarks(potential: Potential, points: tuple[CriticalPoint, ...]) -> tuple[str, ...]:
    remarks = [_MOVED.format(*potential.origin)] if any(potential.origin) else []
    if potential.escape_radius is not None:
        return tuple(remarks)
    energies = potential.well.saddle_energies
    if np.ptp(energies) > EQUAL_ENERGY_TOLERANCE * potential.units.energy:
        order = np.argsort(energies, kind="stable")
        listed = ", ".join(f"{k + 1} above {energies[k]:.6g}" for k in order)
        remarks.append(f"The channels open at different energies: {listed}.")
    other_saddles = sum(point.kind is PointKind.SADDLE and not point.channel for point in points)
    if other_saddles:
        remarks.append(f"Saddles that do not lead out of the well at the origin and are therefore not exits: {other_saddles}.")
    wells = [point for point in points if point.kind is PointKind.MINIMUM and (point.x or point.y)]
    if wells:
        places = ", ".join(f"({point.x:.6g}, {point.y:.6g})" for point in wells)
        remarks.append(f"There are other wells, at {places}: an orbit that enters one counts as escaped but may return.")
    if potential.well.channel_mergers:
        lowest = potential.well.channel_mergers[0]
        merged = name_channels(lowest.channels)
        remarks.append(f"The exits are separate up to h = {lowest.energy:.6g}; above it some are one exit, {merged}.")
    if not potential.form.mirror_in_y:
        remarks.append("V is not even in y: y = 0 is not a symmetry axis, and an orbit may stay on one side of it.")
    if potential.form.has_constant:
        remarks.append("The constant term has no effect on the orbits, but all energies include it.")
    return tuple(remarks)
