"""Exits tabulated over a range of energies, for programs that interpolate exits because they cannot compute Lyapunov orbits.

The Lyapunov orbit over a saddle of energy E depends smoothly on σ = √(h − E). The width of the orbit is proportional to σ, its
height to σ². The table holds the columns of the exit curve, in the axes of the orbit's chord, at Chebyshev nodes in σ. They are
meant for barycentric interpolation (Berrut & Trefethen 2004, SIAM Review 46, 501).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from engine.exits.exit_shapes import curve_along, exit_gates, find_reach, points_along
from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.exits.lyapunov_orbits import find_orbits_in_well_units
from engine.exits.saddle_orbits.brake_orbits import chord_axes
from engine.foundations.arrays import ReadOnlyArrays
from engine.integrator.kernels import exit_geometry as geometry
from engine.integrator.kernels.exit_geometry import MIDDLE_COLUMN, interpolate_exit
from engine.systems.potential import Potential

LARGEST_ERROR = 1e-6
"""Largest distance of an interpolated exit from the exit, in units of the well."""

# Numbers of nodes to try, in turn, until the error measured between the nodes is small enough.
_NODE_COUNTS = (10, 20, 40)
# Shares of the range of energies to try. A smaller share is needed near a maximum between two exits, where exits change too fast.
_SHARES = (1.0, 0.9, 0.75, 0.5)
# The error between the nodes must be below this share of the largest error.
_SAFETY = 0.1
# Coefficients below this limit are dropped from the end of the series, in units of the well.
_NEGLIGIBLE = 1e-9
# Values of s at which exits are compared.
_POSITIONS = np.linspace(-1.0, 1.0, 21)
# Columns of an exit curve that follow gate and reach in a row of a table, see `engine.integrator.kernels.exit_geometry`.
_CURVE_COLUMNS = np.r_[geometry.ORIGIN_X : geometry.OUTWARD_Y + 1, geometry.MIDDLE : geometry.CURVE_COLUMNS]

# A function of the energy that returns the exit curves by channel.
_CurvesAt = Callable[[float], dict[int, np.ndarray]]


@dataclass(frozen=True, eq=False)
class ExitTable(ReadOnlyArrays):
    """The exits of one channel, in units of the well. The arrays are read-only.

    Attributes
    ----------
    saddle
        Energy at which the channel opens.
    highest
        Energy up to which the table is valid, at least `saddle`.
    nodes
        (n,) σ, rising: Chebyshev nodes of the first kind; empty if there is no energy between `saddle` and `highest`.
    rows
        (n, columns) gate, reach, origin, outward direction, middle, half width, slopes at both ends and Chebyshev coefficients of
        the exit curve.
    """

    saddle: float
    highest: float
    nodes: np.ndarray
    rows: np.ndarray

    def points_at(self, energy: float, positions: np.ndarray) -> np.ndarray:
        """Return m points of the exit, at s from −1 to 1, at an energy above the saddle, of shape (2, m)."""
        return points_along(_interpolate(self.nodes, self.rows, energy - self.saddle), positions)


def tabulate_exits(potential: Potential, highest: float) -> tuple[ExitTable, ...]:
    """Tabulate the exits of all channels for energies up to `highest`.

    Parameters
    ----------
    potential
        The potential in units of its well, `Potential.in_well_units`.
    highest
        The highest energy, dimensionless.

    Returns
    -------
    One table for each channel, valid up to `highest` or as far as its exits can be interpolated. No table is valid above the
    lowest maximum between exits, where several channels form one exit. Interpolated exits differ from the computed exits by at
    most `LARGEST_ERROR`, as tested at energies between the nodes.
    """
    curves: dict[float, dict[int, np.ndarray]] = {}

    def curves_at(energy: float) -> dict[int, np.ndarray]:
        if energy not in curves:
            curves[energy] = _find_curves(potential, energy)
        return curves[energy]

    highest = min([highest, *(merger.energy for merger in potential.well.channel_mergers)])
    saddles = enumerate(potential.well.saddle_energies.tolist(), start=1)
    return tuple(_tabulate(curves_at, channel, saddle, highest) for channel, saddle in saddles)


def _find_curves(potential: Potential, energy: float) -> dict[int, np.ndarray]:
    """Return the exit curves at one energy, by channel; ValueError if exits are undefined or no graphs over their chords."""
    curves = {}
    for orbit in find_orbits_in_well_units(potential, energy):
        curve = _exit_over_chord(orbit)
        if curve is None:
            raise ValueError(f"energy={energy}: exit {orbit.channel} is not a smooth graph over its chord")
        curves[orbit.channel] = curve
    return curves


def _exit_over_chord(orbit: LyapunovOrbit) -> np.ndarray | None:
    """Return the row of the exit of an orbit, in the axes of its chord; None if the path is not a smooth graph over the chord.

    The axes of the chord depend smoothly on the energy. In a rotating frame, the exit is a parabola in the axes of the saddle.
    """
    potential = orbit.potential
    if potential.rotation:
        return orbit.curve
    path = orbit.half_path.T
    if chord_axes(path).outward @ potential.well.outward_directions[orbit.channel - 1] < 0.0:
        # A mirrored orbit has the well on the other side of its path.
        path = path[:, ::-1]
    curve = curve_along(chord_axes(path), potential.saddles[orbit.channel - 1], path)
    if curve is not None:
        curve[geometry.REACH] = find_reach(potential, orbit.energy, curve)
    return curve


def _tabulate(curves_at: _CurvesAt, channel: int, saddle: float, highest: float) -> ExitTable:
    """Return the table of one channel: of the widest range of `_SHARES` with an accurate interpolation, or an empty table."""
    no_nodes, no_rows = np.zeros(0), np.zeros((0, MIDDLE_COLUMN))
    if highest <= saddle:
        return ExitTable(saddle, highest, no_nodes, no_rows)
    for share, count in itertools.product(_SHARES, _NODE_COUNTS):
        largest_sigma = np.sqrt(share * (highest - saddle))
        nodes, test_sigmas = _chebyshev_nodes(count, largest_sigma), _test_sigmas(count, largest_sigma)
        try:
            # The end of the range is tried first: if an exit is undefined anywhere, it is undefined there.
            curves_at(saddle + largest_sigma**2)
            node_curves = [curves_at(saddle + sigma**2)[channel] for sigma in nodes.tolist()]
            test_curves = [curves_at(saddle + sigma**2)[channel] for sigma in test_sigmas.tolist()]
        except ValueError:
            # An exit is undefined in this range: try the next range.
            continue
        rows = np.array([_row(curve) for curve in node_curves])
        interpolated = [points_along(_interpolate(nodes, rows, sigma**2), _POSITIONS) for sigma in test_sigmas.tolist()]
        exact = [points_along(curve, _POSITIONS) for curve in test_curves]
        if np.abs(np.array(interpolated) - exact).max() < _SAFETY * LARGEST_ERROR:
            column_count = np.flatnonzero(np.abs(rows).max(axis=0) > _NEGLIGIBLE).max() + 1
            # In this order the whole range ends exactly at `highest`.
            return ExitTable(saddle, highest - (1.0 - share) * (highest - saddle), nodes, rows[:, :column_count].copy())
    return ExitTable(saddle, saddle, no_nodes, no_rows)


def _chebyshev_nodes(count: int, largest_sigma: float) -> np.ndarray:
    """Return the Chebyshev nodes of the first kind between σ = 0 and the largest σ."""
    return 0.5 * largest_sigma * (1.0 - np.cos(np.pi * (2 * np.arange(count) + 1) / (2 * count)))


def _test_sigmas(count: int, largest_sigma: float) -> np.ndarray:
    """Return values of σ between the nodes, and the end of the range."""
    return 0.5 * largest_sigma * (1.0 - np.cos(np.pi * (np.arange(count) + 1) / count))


def _row(curve: np.ndarray) -> np.ndarray:
    """Return the row of a table for an exit curve."""
    return np.concatenate([[exit_gates(curve[None])[0, 2], curve[geometry.REACH]], curve[_CURVE_COLUMNS]])


def _interpolate(nodes: np.ndarray, rows: np.ndarray, height: float) -> np.ndarray:
    """Return the row of the exit at an energy with a given height above the saddle."""
    curves, gates = np.zeros((1, 1, geometry.CURVE_COLUMNS)), np.zeros((1, 3))
    # The kernel writes into `curves` and `gates`.
    interpolate_exit(nodes, rows, 0.0, geometry.CURVE, np.array([height]), 0, curves, gates)
    return curves[0, 0]
