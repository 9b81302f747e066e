"""The interior of a potential at one energy: all points connected to the origin below the energy without crossing an exit."""

from __future__ import annotations

import functools
from collections.abc import Callable
from math import comb
from typing import Any

import numpy as np

from engine.exits.lyapunov_orbits import exit_curves
from engine.potentials.compiled import kernels_of
from engine.potentials.forms.expression_form import ExpressionForm
from engine.potentials.forms.polynomial_form import PolynomialForm
from engine.potentials.potential import Potential
from engine.results.arrays import read_only
from engine.taylor.kernels import interior


def find_outside_channels(potential: Potential, energy: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """int8, shaped like x and y: for each point outside, the channel nearest in direction; 0 for points inside or forbidden."""
    units, row = potential.units, np.zeros(x.size, np.int64)
    places = x.ravel() / units.length, y.ravel() / units.length
    well, energies = potential.in_well_units, np.full(x.size, energy / units.energy)
    return find_outside_starts(well, *places, energies, exit_curves(well, energy / units.energy)[None], row).reshape(x.shape)


def find_outside_starts(
    potential: Potential, x: np.ndarray, y: np.ndarray, energy: np.ndarray, curves: np.ndarray, curve_row: np.ndarray
) -> np.ndarray:
    """int8 (n,), as `find_outside_channels` for points of several energies, in units of the well.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    x, y, energy
        (n,) each.
    curves
        (rows, channels, columns) exit curves, see `exit_curves`.
    curve_row
        (n,) the row of `curves` for each point.
    """
    outside: np.ndarray = _finder(potential.form, potential)(x, y, energy, curves, curve_row)
    return outside


@functools.singledispatch
def _finder(form: Any, potential: Potential) -> Callable[..., np.ndarray]:
    """The kernel for a form of potentials, with its first arguments."""
    raise TypeError(form)


@_finder.register
def _finder_of_expression(_form: ExpressionForm, potential: Potential) -> Callable[..., np.ndarray]:
    finder: Callable[..., np.ndarray] = kernels_of(potential).find_outside
    return finder


@_finder.register
def _finder_of_polynomial(form: PolynomialForm, _potential: Potential) -> Callable[..., np.ndarray]:
    powers = np.array([term[:2] for term in form.terms], np.int64).reshape(-1, 2)
    coefficients = np.array([term[2] for term in form.terms])
    bernstein = _bernstein_matrix(max(int(powers.sum(axis=1).max(initial=0)), int(powers.max(initial=0))))
    return functools.partial(interior.find_outside_polynomial, powers, coefficients, bernstein)


@functools.cache
def _bernstein_matrix(degree: int) -> np.ndarray:
    """(degree + 1, degree + 1) from the coefficients of a power series on [0, 1] to those of Bernstein polynomials."""
    n = degree + 1
    return read_only(np.array([[comb(i, k) / comb(degree, k) for k in range(n)] for i in range(n)]))
