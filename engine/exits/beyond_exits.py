"""What orbits do beyond the exits: some can leave for infinity without passing an exit, and some come back through one.

Where they can leave without passing an exit, the exits do not define who escapes. With the exits as barriers, the region of
motion around the origin must be bounded (`engine.systems.landscape.hill_component`). A potential can have a channel to infinity
that no saddle closes: two wells below V(∞), or a bond that breaks.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from engine.exits.exit_shapes import absent_channel, exit_gates, find_barrier_end, points_along, reversed_curve
from engine.exits.lyapunov_orbit import LyapunovOrbit
from engine.exits.saddle_orbits.brake_orbits import saddle_axes
from engine.integrator.kernels import exit_geometry as geometry
from engine.integrator.kernels.events import NOT_COMPUTED
from engine.integrator.kernels.propagate import NO_TRACE, Exits, Orbits
from engine.integrator.source.recurrence import LANES, TOLERANCE
from engine.systems.forms.stored_points import stored_points
from engine.systems.landscape.hill_component import Barrier, Extent
from engine.systems.potential import Potential

# Numbers of positions along an exit, and of directions there, from which orbits leave.
_POSITIONS, _DIRECTIONS = 24, 12

LEAVING_ORBITS = _POSITIONS * _DIRECTIONS
"""Number of orbits that leave through an exit in `returning_share`."""

# Difference of s by which the direction of an exit is computed.
_S_DIFFERENCE = 1e-6
# Largest mean number of steps of an orbit beyond an exit. Orbits that reach infinity in a finite time take ever smaller steps.
_MOST_STEPS = 300


def find_extent(potential: Potential, energy: float, orbits: Sequence[LyapunovOrbit]) -> Extent:
    """Return the extent of the region of motion inside the exits over these orbits, in units of the well.

    Where the proof is undecided, samples of V decide.
    """
    curves = [orbit.curve for orbit in orbits]

    def find() -> np.ndarray:
        search, barriers = potential.well.component_search, [_exit_barrier(curve) for curve in curves]
        extent = search.examine(energy, barriers)
        return np.array((search.sample(energy, barriers) if extent is Extent.UNDECIDED else extent).value)

    return Extent(str(stored_points("extent", (potential.form, energy, [curve.tolist() for curve in curves]), find)))


def _exit_barrier(curve: np.ndarray) -> Barrier:
    """Return the barrier along an exit, given by its row."""
    farthest = find_barrier_end(curve)

    def locate(x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        distance, position = np.empty(x.size), np.empty(x.size)
        # The kernel writes distances and positions.
        geometry.locate_points(curve, x.ravel(), y.ravel(), distance, position)
        return distance.reshape(x.shape), position.reshape(x.shape) / farthest

    return Barrier(locate)


def returning_share(potential: Potential, energy: float, curves: Mapping[int, np.ndarray], channel: int, t_max: float) -> float:
    """Return the share of the flux through an exit that comes back through any exit within `t_max`.

    `LEAVING_ORBITS` orbits are followed. By time reversal, an orbit that comes back is an orbit that leaves the outside through
    an exit with exchanged sides.

    Parameters
    ----------
    curves
        Rows (columns,) of the exits in a frame that does not rotate, by channel, in units of the well.
    channel
        The exit through which the orbits leave.
    """
    rows = [
        reversed_curve(curves[k]) if k in curves else absent_channel(saddle_axes(potential, k), saddle)
        for k, saddle in enumerate(potential.saddles, start=1)
    ]
    exits = np.array([*rows, *(end.row for end in potential.ends)])[None]
    states, weights = _leaving_states(potential, energy, curves[channel])
    parts = [_ends_of(potential, states[k : k + LANES], exits, t_max) for k in range(0, len(states), LANES)]
    fates = np.concatenate(parts)
    comes_back = (fates > 0) & (fates <= len(rows))
    return float(weights[comes_back].sum() / weights.sum())


def _leaving_states(potential: Potential, energy: float, curve: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return states (n, 4) that leave across an exit, and the flux (n,) that each stands for."""
    positions = -1.0 + 2.0 * (np.arange(_POSITIONS) + 0.5) / _POSITIONS
    sines = -1.0 + 2.0 * (np.arange(_DIRECTIONS) + 0.5) / _DIRECTIONS
    before, places, after = (points_along(curve, positions + shift) for shift in (-_S_DIFFERENCE, 0.0, _S_DIFFERENCE))
    dx, dy = after - before
    momentum = np.sqrt(np.maximum(2.0 * (energy - potential.value(*places)), 0.0))
    # The outside is on the right of the direction in which s rises.
    angle = (np.arctan2(dy, dx) - 0.5 * math.pi)[:, None] + np.arcsin(sines)
    x, y = (np.broadcast_to(each[:, None], angle.shape) for each in places)
    states = np.stack([x, y, momentum[:, None] * np.cos(angle), momentum[:, None] * np.sin(angle)], axis=-1)
    return states.reshape(-1, 4), np.repeat(momentum * np.hypot(dx, dy), _DIRECTIONS)


def _ends_of(potential: Potential, states: np.ndarray, exits: np.ndarray, t_max: float) -> np.ndarray:
    """Return the fates (n,) of states (n, 4), of which there are no more than lanes."""
    n = len(states)
    fate = np.full(n, NOT_COMPUTED, np.int8)
    crossings, last_crossings = np.zeros((2, n), np.int64)
    orbits = Orbits(states.copy(), np.zeros(n), crossings, last_crossings, fate, np.ones(n, np.uint8), np.zeros((n, 2)))
    rows = Exits(exit_gates(exits), exits, np.zeros(n, np.int64))
    budget = _MOST_STEPS * LANES
    potential.well.kernels.propagate(np.arange(n), t_max, True, TOLERANCE, budget, 0, rows, orbits, NO_TRACE)
    return fate
