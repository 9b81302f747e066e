"""Reasons why a potential cannot be used, as sentences."""

from __future__ import annotations

import numpy as np

from engine.foundations.wording import format_point
from engine.systems.forms.form import DescentError, NotIsolatedError, UndecidedError
from engine.systems.landscape.closed_energy import HIGHEST_TRIED
from engine.systems.landscape.hill_component import Extent
from engine.systems.potential import Potential
from engine.systems.review.classified_points import (
    CriticalPoint,
    PointKind,
    classify_points,
    find_new_origin,
    minima_of,
    point_at_origin,
)
from engine.systems.review.singularity_check import singularity_refusal

MOST_CHANNELS = 32
"""Largest number of exit channels of a potential. The kernels support more."""


# Hint for a potential whose critical points are not known.
_WITHOUT_POINTS = "With an escape radius, such as “; escape 10” after the formula, they are not needed."
# Energy at which a well that is not shown to be closed is tested for an opening, in depths of the well. At the saddle itself, the
# opening of the saddle would count.
_TESTED_DEPTH = 0.9


def find_points_or_refusal(potential: Potential) -> tuple[tuple[CriticalPoint, ...], str | None]:
    """Return the critical points (empty if unknown) and the reason why the potential cannot be used (None if it can)."""
    refusal = potential.form.limits_refusal() or singularity_refusal(potential)
    if refusal is not None:
        return (), refusal
    if not potential.escapes_over_saddles:
        return _known_points(potential), None
    try:
        # Both statements need the ends of lines of steepest descent or ascent, which may not be found.
        points = classify_points(potential)
        _ = potential.well.channel_mergers
    except DescentError as error:
        return (), f"Which saddles are exits of the well is not known. {error}"
    except UndecidedError as error:
        return (), None if _is_closed_well(potential) else f"{error} {_WITHOUT_POINTS}"
    except NotIsolatedError:
        return (), None if _is_closed_well(potential) else (
            "The force vanishes along a curve instead of at isolated points, as in an infinite valley or a circular potential, "
            "so the well at the origin is not bounded by isolated saddles. Add terms that make V vary along this curve, or an "
            "escape radius, such as “; escape 10” after the formula."
        )
    refusals = (check(potential, points) for check in (_well_refusal, _degenerate_refusal, _exits_refusal))
    return points, next(filter(None, refusals), None)


def _is_closed_well(potential: Potential) -> bool:
    """Return whether the origin is a minimum in a well that is closed at all energies tried, so that saddles are not exits."""
    well = potential.well
    is_minimum = well.is_convex_at_origin and not np.any(potential.gradient(0.0, 0.0))
    return is_minimum and well.closed_energy >= well.bottom + HIGHEST_TRIED * potential.units.energy


def _known_points(potential: Potential) -> tuple[CriticalPoint, ...]:
    """Return the critical points; empty if they are not found. A system with an escape radius does not need them."""
    try:
        return classify_points(potential)
    except (UndecidedError, NotIsolatedError):
        return ()


def _well_refusal(potential: Potential, points: tuple[CriticalPoint, ...]) -> str | None:
    at_origin = point_at_origin(points)
    if at_origin is not None and at_origin.kind is PointKind.MINIMUM:
        return None
    if any(x == y == 0.0 for x, y in potential.form.singular_points.tolist()):
        return None
    if at_origin is None:
        problem = "There is no well at the origin: the force is not zero there, because V has linear terms."
    else:
        problem = f"There is no well at the origin: V has a {at_origin.kind.value} there."
    minima = minima_of(points)
    if not minima:
        return f"{problem} Add quadratic terms that make the origin a minimum, or give an escape radius."
    place = f"({minima[0].x:.6g}, {minima[0].y:.6g})"
    subject = f"The nearest of {len(minima)} minima is" if len(minima) > 1 else "The only minimum is"
    can_move = find_new_origin(potential, points) is not None
    hint = f": with “; well {place}” after the formula, x and y count from there" if can_move else ""
    return f"{problem} {subject} at {place}{hint}."


def _degenerate_refusal(potential: Potential, points: tuple[CriticalPoint, ...]) -> str | None:
    for point in points:
        if point.kind is not PointKind.DEGENERATE:
            continue
        # Rounding of the coefficients makes critical points far away, where rounding errors of V exceed the depth of the well.
        error = float(np.finfo(float).eps * potential.form.magnitude(point.x, point.y))
        if error < potential.units.energy:
            return (
                f"V has a degenerate critical point at {format_point(point.x, point.y)}, which is neither a saddle nor a minimum "
                f"nor a maximum, so it is undefined whether orbits escape over it."
            )
    return None


def _exits_refusal(potential: Potential, _points: tuple[CriticalPoint, ...]) -> str | None:
    well = potential.well
    if potential.channels > MOST_CHANNELS:
        return f"V has {potential.channels} channels; at most {MOST_CHANNELS} are allowed."
    if not potential.channels:
        is_closed = well.closed_energy > well.bottom
        problem = "The well is open without a saddle, or is not shown to be closed at any energy, so its exits are not defined."
        return None if is_closed else problem
    is_shown = well.closed_energy >= potential.escape_energy
    if not is_shown and well.component_search.examine(well.energy_at(_TESTED_DEPTH)) is Extent.UNBOUNDED:
        return "The well is open below its lowest saddle, so orbits can escape without crossing an exit."
    return None
