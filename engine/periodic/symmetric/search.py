"""Families of symmetric periodic orbits on a slice along the energy, as the zero lines of maps of returns."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from operator import truediv
from typing import NamedTuple

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checked_count, checks_types
from engine.maps.returns import Returns, compute_returns
from engine.maps.spec import MapSpec
from engine.periodic.nearest_orbit import MOST_RETURNS
from engine.periodic.periodic_orbit import STATE_COLUMNS
from engine.periodic.symmetric.half_orbits import HalfOrbits
from engine.periodic.symmetric.reversals import Reversal, find_reversal
from engine.periodic.symmetric.symmetric_families import SymmetricFamilies
from engine.periodic.symmetric.zero_lines import find_zeros, pieces_of_lines, primitive_parts, trace_sign_changes
from engine.slices.sections.section import Crossing

# Largest distance of the end of half an orbit from its image, in units of the well. At a jump of the returns, it is larger.
_LARGEST_GAP = 1e-8
# Columns of the table of points.
_COLUMNS = ("curve", "returns", "abscissa", "ordinate", *STATE_COLUMNS, "period", "stability_index")


@shows_progress("families")
@checks_types(spec=MapSpec, on_frame=(Callable, type(None)), execution=Execution)
def find_symmetric_families(
    spec: MapSpec,
    returns: int = 1,
    *,
    execution: Execution = DEFAULT_EXECUTION,
    on_frame: Callable[[SymmetricFamilies], None] | None = None,
) -> SymmetricFamilies:
    """Find the families of symmetric periodic orbits on a slice along the energy, up to a number of returns.

    A symmetry with reversed time must leave all starts of the slice unchanged, for instance y → −y for starts with y = 0 and
    px = 0. An orbit is then periodic if a later crossing of the section is unchanged as well, here if px = 0. The lines on which
    px vanishes at the n-th crossing, in any direction, are the families with n returns, called characteristic curves.

    Parameters
    ----------
    spec
        The request of a map on a slice with an axis h, such as (x, h). It gives the potential, the grid, the window and the
        longest time. A finer grid finds more: curves closer together than a pixel can be missed, interrupted, or joined.
    returns
        Largest number of returns of an orbit in a period, 1 to 100. To a section crossed in both directions it is even.
    execution
        How the computation runs. When it is cancelled, families that are not found yet are missing.
    on_frame
        Called with the families found so far, after each number of returns but the last.

    Returns
    -------
    The `SymmetricFamilies`. At each of its points, half the orbit ends within 1e-8 of its image, in units of the well.

    Raises
    ------
    ValueError
        If no symmetry leaves the starts unchanged, they are not on the section, it is a ray or apsides, or a parameter is out of
        range.

    Notes
    -----
    Hénon 1965, Ann. Astrophys. 28, 499 (characteristic curves); Lamb & Roberts 1998, Physica D 112, 1 (symmetric orbits).

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, find_symmetric_families
    >>> found = find_symmetric_families(MapSpec(CASES["III"], Plane.X_H, (0.1, 0.4), (40, 40), t_max=100.0))
    >>> found.describe()
    '3 curves of symmetric periodic orbits with up to 1 return to y = 0 between h = 0.1 and 0.4: 40 of 136 points stable.'
    """
    reversal = _checked_reversal(spec)
    returns = checked_count("returns", returns, 1, MOST_RETURNS)
    # A period has two crossings for each crossing of half a period, one in each direction.
    factor = 2 if spec.section.direction is Crossing.BOTH else 1
    most = returns // factor
    # The symmetry maps the past of an orbit onto its future.
    request = replace(spec, backward=False, section=replace(spec.section, direction=Crossing.BOTH))
    grid = compute_returns(request, max(most, 1), execution=execution.part(0, 2))
    search, curves = _Search(grid, reversal, execution.part(1, 2)), list[_Curve]()
    for n in range(1, most + 1):
        curves += [curve._replace(returns=factor * n) for curve in search.curves(n)]
        if execution.is_cancelled:
            break
        execution.part(1, 2).report(partial(truediv, n, most))
        if on_frame is not None and n < most:
            on_frame(_families(spec, returns, curves, complete=False))
    return _families(spec, returns, curves, complete=not execution.is_cancelled)


def _checked_reversal(spec: MapSpec) -> Reversal:
    """Return the symmetry that leaves the starts of a request unchanged; ValueError if there is none."""
    if min(spec.resolution) < 2:
        raise ValueError(f"spec: its resolution is {spec.resolution}; must be at least 2 columns and rows")
    reversal = find_reversal(spec)
    if reversal is None:
        raise ValueError(
            f"spec: its plane is {spec.plane.title} and its section {spec.section.place}; must be a slice along h whose starts "
            "are on the section, a linear form, and unchanged by a symmetry of the motion with reversed time"
        )
    return reversal


class _Curve(NamedTuple):
    """A piece of a family with n points, in units of the well: number of returns, places, starts, periods and indices."""

    returns: int
    places: np.ndarray
    starts: np.ndarray
    periods: np.ndarray
    stability_indices: np.ndarray


class _Search:
    """The zero lines on the grid of a map of returns, and the periodic orbits on them; in units of the well."""

    def __init__(self, grid: Returns, reversal: Reversal, execution: Execution) -> None:
        spec, units = grid.spec.in_well_units(), grid.spec.potential.units
        longest = float(np.nanmax(grid.time, initial=0.0)) / units.time
        self._orbits, self._execution = HalfOrbits(spec, reversal, longest, execution), execution
        self._axes = spec.pixel_centres()
        self._values = primitive_parts(self._orbits.gaps(grid.states / units.state))

    def curves(self, n: int) -> Iterator[_Curve]:
        """Yield the families whose orbits cross the section n times in half a period, at least two points of each."""
        edges = trace_sign_changes(self._values[n - 1])
        places = find_zeros(partial(self._primitive_part, n), self._places(edges.begins), self._places(edges.ends))
        gaps, times = (values[-1] for values in self._orbits.crossings(places, n))
        for piece in pieces_of_lines(edges.line, np.abs(gaps) < _LARGEST_GAP):
            if len(piece) > 1 and not self._execution.is_cancelled:
                yield self._curve(n, places[piece], times[piece])

    def _primitive_part(self, n: int, places: np.ndarray) -> np.ndarray:
        """Return, at places (m, 2), what vanishes where half a period has n crossings, but not where it has a divisor of n."""
        return primitive_parts(self._orbits.crossings(places, n)[0])[-1]

    def _places(self, corners: np.ndarray) -> np.ndarray:
        """Return the places (m, 2) of points of the grid, given by column and row."""
        return np.column_stack([axis[numbers] for axis, numbers in zip(self._axes, corners.T, strict=True)])

    def _curve(self, n: int, places: np.ndarray, times: np.ndarray) -> _Curve:
        starts = self._orbits.starts(places)
        return _Curve(n, places, starts, 2.0 * times, self._orbits.stability_indices(starts, times))


def _families(spec: MapSpec, most_returns: int, curves: list[_Curve], *, complete: bool) -> SymmetricFamilies:
    """Return the families of curves in units of the well."""
    units = spec.potential.units
    numbers = np.array([(number, curve.returns) for number, curve in enumerate(curves, 1)], int).reshape(-1, 2)
    labels = np.repeat(numbers, np.array([len(curve.places) for curve in curves], int), axis=0)
    factors = np.array([*spec.plane.axis_units(units), *units.state, units.time, 1.0])
    rows = np.vstack([np.empty((0, len(factors))), *(np.column_stack(curve[1:]) for curve in curves)]) * factors
    columns = dict(zip(_COLUMNS, map(read_only, (*labels.T.copy(), *rows.T.copy())), strict=True))
    return SymmetricFamilies(spec, most_returns, **columns, complete=complete)
