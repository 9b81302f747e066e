"""The interior of a potential at an energy h: all points that a path with V ≤ h joins to the origin without crossing an exit.

With an escape radius, the interior consists of all points within that radius, except points beyond another end.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from math import comb
from typing import NamedTuple

import numpy as np

from engine.exits.exit_rows import exit_curves
from engine.exits.exit_shapes import find_barrier_end, points_along
from engine.foundations.arrays import read_only
from engine.integrator.kernels import exit_geometry as geometry
from engine.integrator.kernels import interior
from engine.systems.forms.expression_form import ExpressionForm
from engine.systems.forms.polynomial_form import PolynomialForm
from engine.systems.landscape.hill_component import FARTHEST
from engine.systems.potential import Potential

# Number of points along a side of the lattice of `find_joined_points`, odd so that the origin is one of them, and along an exit.
_LATTICE_SIDE, _EXIT_POINTS = 301, 4001


def find_outside_channels(potential: Potential, energy: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return int8 codes, shaped like x and y: 0 for points inside or forbidden, otherwise the number of an outcome.

    For points beyond the exits over saddles, the outcome is the channel nearest in direction.
    """
    units = potential.units
    return find_outside_in_well_units(potential.in_well_units, energy / units.energy, x / units.length, y / units.length)


def find_outside_in_well_units(potential: Potential, energy: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Apply `find_outside_channels` to a potential in units of its well."""
    energies, curve_row = np.full(x.size, energy), np.zeros(x.size, np.int64)
    curves = exit_curves(potential, energy)[None]
    return find_outside_starts(potential, x.ravel(), y.ravel(), energies, curves, curve_row).reshape(x.shape)


def find_outside_starts(
    potential: Potential, x: np.ndarray, y: np.ndarray, energy: np.ndarray, curves: np.ndarray, curve_row: np.ndarray
) -> np.ndarray:
    """Apply `find_outside_channels` to n points of several energies, in units of the well; int8, of shape (n,).

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    x, y, energy
        Positions and energies of the points, (n,) each.
    curves
        (rows, outcomes, columns) exits, see `exit_curves`. If all exits of a row are absent, no point lies beyond an exit.
    curve_row
        (n,) the row of `curves` for each point.
    """
    outcomes = np.zeros(x.size, np.int8)
    # The kernel writes the outcomes, which are channels or other ends.
    _finder(potential)(x, y, energy, curves, curve_row, outcomes)
    is_other_end = outcomes > potential.channels
    channels = np.where(is_other_end, 0, outcomes).astype(np.int64)
    # Channels that form one exit share its number.
    exit_numbers = np.take_along_axis(potential.well.exit_numbers(energy), channels[:, None], axis=1)[:, 0]
    return np.where(is_other_end, outcomes, exit_numbers)


def find_joined_points(potential: Potential, energy: float, radius: float) -> tuple[np.ndarray, float]:
    """Return the points of a lattice that paths with V ≤ h join to the origin inside the exits, and the distance between points.

    Steps along the paths are as long as this distance, so narrow parts of an interior, and beyond them others, may be left out,
    and a thin wall may be missed.

    Parameters
    ----------
    potential, energy
        The potential in units of its well, and h.
    radius
        Half the side of the lattice around the origin. It is doubled while the interior extends to the edge of the lattice.

    Returns
    -------
    x and y of the points, (2, n), and their distance; no points if the interior extends too far.
    """
    curves = exit_curves(potential, energy)
    barriers = [
        points_along(curve, find_barrier_end(curve) * np.linspace(-1.0, 1.0, _EXIT_POINTS))
        for curve in curves
        if geometry.is_open_channel(curve)
    ]
    while radius <= 2.0 * FARTHEST:
        side = np.linspace(-radius, radius, _LATTICE_SIDE)
        allowed = potential.value(side[:, None], side) <= energy
        for points in barriers:
            places = np.rint((points + radius) / (side[1] - side[0]))
            within = ((places >= 0) & (places < _LATTICE_SIDE)).all(axis=0)
            allowed[tuple(places[:, within].astype(int))] = False
        joined = _part_around_middle(allowed)
        if not (joined[[0, -1]].any() or joined[:, [0, -1]].any()):
            return side[np.argwhere(joined).T], float(side[1] - side[0])
        radius *= 2.0
    return np.empty((2, 0)), 0.0


def _part_around_middle(allowed: np.ndarray) -> np.ndarray:
    """Return the part of a lattice (n, n) that steps along rows and columns join to its middle."""
    # `scipy.ndimage.label` would do, but importing SciPy takes a third of a second.
    runs_along_rows, runs_along_columns = _run_numbers(allowed), _run_numbers(allowed.T).T
    joined = np.zeros_like(allowed)
    middle = len(allowed) // 2
    joined[middle, middle] = allowed[middle, middle]
    before = np.zeros_like(joined)
    while not np.array_equal(joined, before):
        before = joined
        for numbers in (runs_along_rows, runs_along_columns):
            is_joined = np.zeros(allowed.size + 1, bool)
            is_joined[numbers[joined]] = True
            joined = allowed & is_joined[numbers]
    return joined


def _run_numbers(allowed: np.ndarray) -> np.ndarray:
    """Return a number for each point of a lattice that neighbours in a row share if both are allowed."""
    begins = ~allowed
    begins[:, 0] = True
    return np.cumsum(begins).reshape(allowed.shape)


def find_inner_radius(potential: Potential) -> float:
    """Return the radius of the gap at the origin; 0.0 without a gap there."""
    return max((gap.radius for gap in potential.gaps if gap.x == gap.y == 0.0), default=0.0)


def _finder(potential: Potential) -> Callable[..., None]:
    """Return the kernel of the interior test for a potential, with its first arguments bound."""
    if isinstance(potential.form, ExpressionForm):
        return functools.partial(potential.well.kernels.find_outside, find_inner_radius(potential))
    polynomial = tabulate_polynomial(potential.form)
    # The zeros are work space.
    return functools.partial(interior.find_outside_polynomial, *polynomial, np.zeros((3, len(polynomial.bernstein))))


class PolynomialTable(NamedTuple):
    """A polynomial as `engine.integrator.kernels.interior` takes it.

    `powers`, (terms, 2), and `coefficients`, (terms,), describe V. `bernstein`, (n, n), converts the coefficients of a power
    series on [0, 1] to those of Bernstein polynomials.
    """

    powers: np.ndarray
    coefficients: np.ndarray
    bernstein: np.ndarray


def tabulate_polynomial(form: PolynomialForm) -> PolynomialTable:
    """Return the terms of a polynomial for kernels."""
    powers = np.array([term[:2] for term in form.terms], np.int64).reshape(-1, 2)
    coefficients = np.array([term[2] for term in form.terms])
    degree = max(int(powers.sum(axis=1).max(initial=0)), int(powers.max(initial=0)))
    return PolynomialTable(powers, coefficients, _bernstein_matrix(degree))


@functools.cache
def _bernstein_matrix(degree: int) -> np.ndarray:
    """Return the (degree + 1, degree + 1) matrix `PolynomialTable.bernstein`."""
    n = degree + 1
    return read_only(np.array([[comb(i, k) / comb(degree, k) for k in range(n)] for i in range(n)]))
