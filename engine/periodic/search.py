"""All periodic orbits of a slice: fixed points of the map of returns, found by its index and closed by Newton's method."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from operator import truediv

import numpy as np

from engine.exits.exit_rows import exit_curves
from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.validation import checked_count, checks_types
from engine.maps.returns import compute_returns
from engine.maps.spec import MapSpec
from engine.periodic.fixed_cells import cells_near_zero, cells_with_index, zero_in_cell
from engine.periodic.nearest_orbit import MOST_RETURNS, close_near, first_point
from engine.periodic.periodic_orbit import STATE_COLUMNS, PeriodicOrbit
from engine.periodic.periodic_orbits import PeriodicOrbits, energy_of
from engine.periodic.shooting import Trial
from engine.periodic.symmetries import symmetries_of
from engine.propagation.followed_orbits import FollowedOrbits

# Columns of the table of points, and those that contain numbers of orbits.
_COLUMNS = ("orbit", "time", *STATE_COLUMNS, "period", "stability_index", "action", "image_of")
_NUMBERS = ("orbit", "image_of")
# Number of parts along each side of a cell, and of each such part; odd, so that a line of symmetry through the middle is no edge.
_PARTS = 5
# Number of starts that are followed at once, which limits memory.
_STARTS_AT_ONCE = 20_000
# Number of corrections of places, distance of the starts for their derivatives, and last correction of a fixed point, in cells.
_CORRECTIONS, _DIFFERENCE, _CONVERGED = 12, 1e-6, 1e-5
# Longest correction, in cells.
_LONGEST = 0.1
# Distance within which two points of orbits are the same, in cells; Newton's method leads farther only to another orbit.
_SAME, _FARTHEST = 1e-5, 3.0
# Distance from a known point within which a place is the same point, in cells.
_SEARCHED = 1e-4


@shows_progress("periodic orbits")
@checks_types(spec=MapSpec, on_frame=(Callable, type(None)), execution=Execution)
def find_periodic_orbits(
    spec: MapSpec,
    returns: int = 1,
    *,
    execution: Execution = DEFAULT_EXECUTION,
    on_frame: Callable[[PeriodicOrbits], None] | None = None,
) -> PeriodicOrbits:
    """Find the periodic orbits with points in the window of a slice on the section, up to a number of returns.

    The displacement of the n-th return turns around a fixed point. Cells in which it can vanish are divided, and the parts around
    which it has an index that is not 0 are the starts of Newton's method. Images under the symmetries of the motion are added.

    Parameters
    ----------
    spec
        The request of a map, which gives the potential, the energy, the grid, the window and the longest time. Its plane must be
        the slice of its section, such as (x, px) for y = 0. A finer grid finds more orbits: two points in one cell can be missed.
    returns
        Largest number of returns of an orbit in a period, 1 to 100.
    execution
        How the computation runs. When it is cancelled, orbits not found yet are missing.
    on_frame
        Called with the orbits found so far, after each number of returns but the last.

    Returns
    -------
    The `PeriodicOrbits`. Each closes to 1e-10 in units of the well.

    Raises
    ------
    ValueError
        If the plane is not the slice of the section, or a parameter is out of range.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, find_periodic_orbits
    >>> found = find_periodic_orbits(MapSpec(CASES["III"], Plane.X_PX, 0.3, (20, 20), t_max=100.0), returns=1)
    >>> len(found), [(round(orbit.period, 4), orbit.stability.value) for orbit in found][:2]
    (11, [(6.2832, 'stable'), (6.8438, 'unstable')])
    """
    energy_of(spec)
    if min(spec.resolution) < 2:
        raise ValueError(f"spec: its resolution is {spec.resolution}; must be at least 2 columns and rows")
    returns = checked_count("returns", returns, 1, MOST_RETURNS)
    # A periodic orbit closes in both directions of time.
    spec = replace(spec, backward=False)
    search = _Search(spec, returns, execution.part(1, 2))
    found = compute_returns(spec, returns, execution=execution.part(0, 2))
    displacements = spec.section.axes.points(found.states) - search.starts
    for n in range(1, returns + 1):
        for place in search.places(n, displacements[n - 1]):
            if execution.is_cancelled:
                break
            search.try_place(n, place)
        if execution.is_cancelled:
            return search.result(complete=False)
        execution.part(1, 2).report(partial(truediv, n, returns))
        if on_frame is not None and n < returns:
            on_frame(search.result(complete=False))
    return search.result(complete=True)


class _Search:
    """The orbits found so far, and where their points are."""

    def __init__(self, spec: MapSpec, most_returns: int, execution: Execution) -> None:
        self._spec, self._most_returns, self._execution = spec, most_returns, execution
        x, ordinate = spec.pixel_centres()
        self.starts = np.stack(np.meshgrid(x, ordinate), axis=-1)
        self._cell = np.array([x[-1] - x[0], ordinate[-1] - ordinate[0]]) / np.maximum(np.array(spec.resolution) - 1, 1)
        self._symmetries = symmetries_of(spec.potential)
        well = spec.in_well_units()
        self._curves = exit_curves(well.potential, energy_of(well))[None]
        self._orbits: list[tuple[PeriodicOrbit, int]] = []
        self._points, self._counts = np.empty((0, 2)), np.empty(0, int)

    def places(self, n: int, displacements: np.ndarray) -> np.ndarray:
        """Return the places, (k, 2), near which the n-th return has fixed points, given its displacements on the grid.

        In a cell, the return map can be far from linear. Cells in which the displacement can vanish are therefore divided, and
        such parts again. Starts near an unstable orbit escape before they return, so cells and parts without the displacements of
        some corners are divided as well. Where the map jumps, there is no fixed point, and the corrections do not converge.
        """
        cells = cells_near_zero(displacements)
        corners, size = self.starts[cells[:, 0], cells[:, 1]], self._cell
        corners, size, _ = self._divided(n, corners, size, cells_near_zero)
        corners, size, around = self._divided(n, corners, size, cells_with_index)
        shares = np.array([zero_in_cell(part, 0, 0) for part in around]).reshape(-1, 2)
        return self._corrected(n, corners + size * shares)

    def _corrected(self, n: int, places: np.ndarray) -> np.ndarray:
        """Return places (k, 2) after Newton's method for the displacement of the n-th return, where it converges nearby.

        All places are corrected together. Derivatives are differences of neighbouring starts.
        """
        step, current = _DIFFERENCE * self._cell, places
        neighbours = step * np.array([[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
        correction = np.full(places.shape, np.inf)
        for _ in range(_CORRECTIONS):
            value = self._displacements(n, current)
            around = self._displacements(n, current[:, None] + neighbours)
            (xx, yx), (xy, yy) = ((around[:, k] - around[:, k + 1]).T / (2.0 * step[k // 2]) for k in (0, 2))
            # Places without a correction are NaN or infinite, and are left out.
            with np.errstate(divide="ignore", invalid="ignore"):
                correction = np.column_stack([yy * value[:, 0] - xy * value[:, 1], xx * value[:, 1] - yx * value[:, 0]])
                correction /= (xx * yy - xy * yx)[:, None]
            # Longer corrections are shortened.
            current = current - correction / np.maximum(np.abs(correction / (_LONGEST * self._cell)).max(axis=1), 1.0)[:, None]
        has_converged = np.all(np.abs(correction) < _CONVERGED * self._cell, axis=1)
        return current[has_converged & np.all(np.abs(current - places) <= _FARTHEST * self._cell, axis=1)]

    def _divided(
        self, n: int, corners: np.ndarray, size: np.ndarray, choose: Callable[[np.ndarray], np.ndarray]
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the chosen parts of cells: their first corners (k, 2), size (2,) and displacements at corners (k, 2, 2, 2)."""
        shares = np.linspace(0.0, 1.0, _PARTS + 1)
        grids = corners[:, None, None] + np.stack(np.meshgrid(shares, shares), axis=-1) * size
        displacements = self._displacements(n, grids)
        cell, row, column = choose(displacements).T
        around = [displacements[cell, row + i, column + j] for i in (0, 1) for j in (0, 1)]
        return grids[cell, row, column], size / _PARTS, np.stack(around, axis=1).reshape(-1, 2, 2, 2)

    def _displacements(self, n: int, places: np.ndarray) -> np.ndarray:
        """Return the displacements of the n-th return of starts at places (…, 2); NaN without this return."""
        starts = self._spec.start_states(*places.reshape(-1, 2).T) / self._spec.potential.units.state
        parts = np.array_split(starts, 1 + len(starts) // _STARTS_AT_ONCE)
        points = [self._points_after(n, part) for part in parts if len(part)]
        return np.concatenate([np.empty((0, 2)), *points]).reshape(places.shape) - places

    def _points_after(self, n: int, starts: np.ndarray) -> np.ndarray:
        """Return the points of the n-th returns of starts (k, 4) in units of the well, in the coordinates of the section."""
        spec, units, execution = self._spec, self._spec.potential.units, replace(self._execution, on_progress=None)
        orbits = FollowedOrbits(
            spec.potential.in_well_units, starts, np.zeros(len(starts), np.int64), self._curves, n,
            spec.t_max / units.time, spec.section.in_well_units(units).numbers,
        )  # fmt: skip
        orbits.follow(np.concatenate(orbits.parts(execution)), execution)
        return spec.section.axes.points(spec.section.restore_returns(orbits.points, units)[0][n - 1])

    def try_place(self, n: int, place: np.ndarray) -> None:
        """Search for an orbit with n returns near a place, unless one is known there."""
        is_near = self._distances(place) < _SEARCHED
        if np.any(is_near & (n % self._counts == 0)):
            return
        (start,) = self._spec.start_states(place[:1], place[1:])
        trial = self._close(start, n) if np.isfinite(start).all() else None
        if trial is None or self._is_known(trial.states[0], trial.durations.size):
            return
        if np.abs((self._points_of(trial) - place) / self._cell).max(axis=1).min() <= _FARTHEST:
            orbit = PeriodicOrbit.from_trial(self._spec.potential, self._spec.section, trial)
            self._add(orbit, 0)
            self._add_images(orbit)

    def _close(self, start: np.ndarray, returns: int) -> Trial | None:
        """Return the closed orbit near a start; None if there is none with a number of returns that is searched for."""
        spec = self._spec
        trial = close_near(spec.potential, spec.section, start, returns, spec.t_max)
        return trial if trial is not None and trial.durations.size <= self._most_returns else None

    def _points_of(self, trial: Trial) -> np.ndarray:
        """Return the returns of a closed orbit in the coordinates of the section, (n, 2)."""
        return self._spec.section.axes.points(trial.states[trial.returns] * self._spec.potential.units.state)

    def _is_known(self, state: np.ndarray, returns: int) -> bool:
        """Return whether a state on the section, in units of the well, is on a known orbit with this number of returns."""
        place = self._spec.section.axes.points(state * self._spec.potential.units.state)
        return bool(np.any((self._distances(place) < _SAME) & (self._counts == returns)))

    def _add_images(self, orbit: PeriodicOrbit) -> None:
        """Add the images of the orbit that was added last, unless they are known."""
        first, spec = len(self._orbits), self._spec
        for symmetry in self._symmetries:
            state = orbit.start * symmetry.factors
            point = first_point(spec.potential, spec.section, state, spec.t_max)
            if point is None or self._is_known(point, orbit.returns):
                continue
            trial = self._close(state, orbit.returns)
            if trial is None or self._is_known(trial.states[0], trial.durations.size):
                continue
            image = PeriodicOrbit.from_trial(spec.potential, spec.section, trial, orbit.stability_index, orbit.action)
            if abs(image.period - orbit.period) <= _SAME * orbit.period:
                self._add(image, first)

    def _add(self, orbit: PeriodicOrbit, image_of: int) -> None:
        self._orbits.append((orbit, image_of))
        self._points = np.vstack([self._points, orbit.points])
        self._counts = np.append(self._counts, np.full(orbit.returns, orbit.returns))

    def _distances(self, place: np.ndarray) -> np.ndarray:
        """Return the distances of all known points from a place, in cells."""
        return np.abs((self._points - place) / self._cell).max(axis=1, initial=0.0)

    def result(self, *, complete: bool) -> PeriodicOrbits:
        """Return the orbits found so far, by the number of returns and the period of the original."""
        orbits = [orbit for orbit, _ in self._orbits]
        originals = [(image_of or k) - 1 for k, (_, image_of) in enumerate(self._orbits, 1)]
        # Images follow their originals, which were found before.
        order = sorted(range(len(orbits)), key=lambda k: (orbits[k].returns, orbits[originals[k]].period, originals[k]))
        # Numbers from 1 in the new order; 0 stays 0.
        numbers = np.zeros(len(orbits) + 1, int)
        numbers[np.array(order, int) + 1] = np.arange(1, len(orbits) + 1)
        rows = [
            np.column_stack([
                np.full(orbit.returns, number), orbit.time, orbit.states,
                np.tile([orbit.period, orbit.stability_index, orbit.action, numbers[self._orbits[k][1]]], (orbit.returns, 1)),
            ])
            for number, k in enumerate(order, 1)
            for orbit in [orbits[k]]
        ]  # fmt: skip
        columns = np.vstack([np.empty((0, len(_COLUMNS))), *rows]).T.copy()
        values = {
            name: read_only(column.astype(int) if name in _NUMBERS else column)
            for name, column in zip(_COLUMNS, columns, strict=True)
        }
        return PeriodicOrbits(self._spec, self._most_returns, **values, complete=complete)
