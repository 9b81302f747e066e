"""Check that V is defined wherever orbits can go. Singular points must lie where orbits have already ended."""

from __future__ import annotations

import functools

import numpy as np

from engine.foundations.wording import format_point
from engine.systems.potential import Potential

# Radii of the sample points, in units of the escape radius.
_SCANNED_RADII = np.geomspace(1e-3, 1.0, 60)
# Angles of the sample points, in radians, away from the axes.
_SCANNED_ANGLES = 0.1 + np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)
# Radii of circles around a singular point, in units of the well.
_NEAR_RADII = 10.0 ** -np.arange(2.0, 7.0)
# Smallest ratio of the rises of V on successive circles around a point of an infinite wall: 1 for a logarithm.
_LEAST_GROWTH = 0.9
# Largest ratio of the changes of V on successive circles around a point at which V is continuous: 0.1 for a kink.
_LARGEST_GROWTH = 0.5
# Number of potentials for which the check is cached.
_CACHE_SIZE = 256


@functools.lru_cache(maxsize=_CACHE_SIZE)
def check_defined(potential: Potential) -> None:
    """Raise ValueError unless V is defined everywhere within the escape radius, except in discs of centres."""
    if singularity_refusal(potential) is not None:
        raise ValueError(
            f"potential={potential.name}: must be defined everywhere within the escape radius, except in discs of centres; "
            "see review_potential"
        )


def singularity_refusal(potential: Potential) -> str | None:
    """Return a sentence if orbits can reach a point where V is not defined; otherwise None.

    Without an escape radius, only the origin is tested: orbits do not reach points beyond the exits, and other points inside the
    well are assumed to be regular.
    """
    if potential.escape_radius is None:
        return _origin_refusal(potential)
    for x, y in potential.form.singular_points.tolist():
        if not _is_beyond(potential, np.array([x]), np.array([y]))[0] and not _is_wall(potential, x, y):
            undefined = "The slope of V" if _is_bounded_near(potential, x, y) else "V"
            return f"{undefined} is not defined at {format_point(x, y)}: there must be a centre with a radius of collision."
    radius, angle = np.meshgrid(potential.escape_radius * _SCANNED_RADII, _SCANNED_ANGLES)
    x, y = radius * np.cos(angle), radius * np.sin(angle)
    curve_points = potential.form.points_on_singular_curves(x, y)
    if not all(_is_wall(potential, *point) for point in curve_points.tolist()):
        return "V is not defined along a curve within the escape radius, where a divisor changes its sign."
    is_defined = np.isfinite([potential.value(x, y), *potential.gradient(x, y)]).all(axis=0)
    is_refused = ~is_defined & ~_is_beyond(potential, x, y)
    if not is_refused.any():
        return None
    return f"V is not defined at {format_point(x[is_refused][0], y[is_refused][0])}, which is within the escape radius."


def _is_wall(potential: Potential, x: float, y: float) -> bool:
    """Return whether V rises to +∞ from all sides of a point, so that no orbit reaches it.

    On smaller and smaller circles, the lowest V must rise at least like the logarithm of the radius.
    """
    lowest = _around(potential, x, y).min(axis=1)
    if not np.isfinite(lowest).all():
        return False
    rises = np.diff(lowest)
    return bool((rises > 0.0).all() and (rises[1:] >= _LEAST_GROWTH * rises[:-1]).all())


def _is_bounded_near(potential: Potential, x: float, y: float) -> bool:
    """Return whether V tends to a finite value at a point: on smaller and smaller circles it changes less and less."""
    values = _around(potential, x, y)
    if not np.isfinite(values).all():
        return False
    changes = np.abs(np.diff(values, axis=0)).max(axis=1)
    return bool((changes[1:] < _LARGEST_GROWTH * changes[:-1]).all())


def _around(potential: Potential, x: float, y: float) -> np.ndarray:
    """Return V on circles around a point, of shape (circles, angles); the outermost circle is the first."""
    radius, angle = np.meshgrid(_NEAR_RADII * potential.units.length, _SCANNED_ANGLES, indexing="ij")
    return np.nan_to_num(potential.value(x + radius * np.cos(angle), y + radius * np.sin(angle)), nan=-np.inf, posinf=np.inf)


def _origin_refusal(potential: Potential) -> str | None:
    """Return a sentence if there is neither a smooth well nor a centre at the origin; otherwise None."""
    values = [potential.value(0.0, 0.0), *potential.gradient(0.0, 0.0), *potential.hessian(0.0, 0.0)]
    if np.isfinite(values).all() or _is_beyond(potential, np.zeros(1), np.zeros(1))[0]:
        return None
    return (
        "V, its slope or its curvature is not defined at the origin, where there must be a well, or a centre with a radius of "
        "collision."
    )


def _is_beyond(potential: Potential, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return whether points are beyond an end that is not an exit over a saddle."""
    # Without ends, only this row is left, and the result is False.
    return np.any([np.zeros(x.shape, bool), *(end.contains(x, y) for end in potential.ends)], axis=0)
