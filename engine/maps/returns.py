"""Returns of orbits to the surface of section: their first crossings of it, for all starts of a map."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.exits.exit_rows import exit_curves_at
from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.result import MapResult
from engine.foundations.validation import checked_count, checks_types
from engine.foundations.wording import format_count, format_number
from engine.maps.spec import MapSpec, read_spec
from engine.propagation.batch import OrbitBatch
from engine.propagation.fates import Fate
from engine.propagation.passages import find_passages

if TYPE_CHECKING:
    import xarray as xr

MOST_RETURNS = 100_000
"""Largest number of returns of an orbit."""

# Largest number of returns of all orbits, which take 5 numbers each.
_MOST_POINTS = 5_000_000
# Number of parts of the starts. Progress is reported, and the computation can be cancelled, after each part.
_PARTS = 16
# Numbers of a return: x, y, px, py and the time.
_COLUMNS = 5
# Names of the variables in files, in the order of the columns of `Returns.states`, and of the times.
_VARIABLES = {"return_x": "x", "return_y": "y", "return_px": "px", "return_py": "py"}
_TIME_VARIABLE = "return_time"


@dataclass(frozen=True, eq=False, repr=False)
class Returns(MapResult):
    """The first crossings of the surface of section by the orbits of a map, not counting the starts.

    Attributes
    ----------
    spec
        The request of the starts.
    states
        (returns, rows, columns, 4) x, y, px, py at each crossing of `spec.section`. NaN where an orbit has ended or reached t_max
        before, for starts that are forbidden or outside, and for orbits that are not followed yet. Read-only.
    time
        (returns, rows, columns) time of each crossing, in the units of the potential; NaN as for `states`. Read-only.
    complete
        Whether the orbits of all starts were followed.
    """

    spec: MapSpec
    states: np.ndarray
    time: np.ndarray
    complete: bool = True
    held_as: ClassVar[dict[str, str]] = {"spec": "terms", "states": "return_x", "time": _TIME_VARIABLE}

    @property
    def count(self) -> np.ndarray:
        """(rows, columns) number of returns of each start."""
        return np.isfinite(self.time).sum(axis=0)

    def points(self) -> list[np.ndarray]:
        """Return the returns of each orbit that returns, (n, 2), in the order of the pixels and of time, see `Section.axes`."""
        points = self.spec.section.axes.points(self.states).reshape(len(self.states), -1, 2)
        counts = self.count.ravel()
        return [points[: counts[k], k] for k in np.flatnonzero(counts)]

    def describe(self) -> str:
        """Return the numbers of crossings and of orbits in one sentence."""
        counts = self.count[self.count > 0]
        crossings, orbits = self.spec.section.count(int(counts.sum())), format_count(int(counts.size), "orbit")
        energy = self.spec.common_energy
        place = "" if energy is None else f" at h = {format_number(energy, 6)}"
        return f"{crossings} by {orbits}{place}{'' if self.complete else ' so far'}."

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return a table with a row for each return: pixel, number of the return from 1, time, x, y, px and py."""
        order, rows, columns = np.nonzero(np.isfinite(self.time))
        by_orbit = np.lexsort((order, columns, rows))
        order, rows, columns = order[by_orbit], rows[by_orbit], columns[by_orbit]
        states = self.states[order, rows, columns]
        return {
            "row": rows,
            "column": columns,
            "return": order + 1,
            "time": self.time[order, rows, columns],
            **{name: states[:, k] for k, name in enumerate(_VARIABLES.values())},
        }

    def to_xarray(self) -> xr.Dataset:
        """Return the states and times as a dataset with the dimensions "return" and the axes of the map."""
        attributes = {"result": type(self).__name__, **self.spec.provenance(), "complete": int(self.complete)}
        return _write_dataset(self.spec, self.spec.pixel_centres()[1], self.states, self.time).assign_attrs(attributes)

    @classmethod
    def read_parts(cls, dataset: xr.Dataset) -> dict[str, Any]:
        """Return the states and times, which files store as variables. A store may lack rows, and has them first."""
        spec = read_spec(dataset)
        (_, ordinate), names = spec.pixel_centres(), spec.plane.axis_names[::-1]
        is_whole = dataset.sizes[names[0]] == ordinate.size
        whole = dataset if is_whole else dataset.reindex({names[0]: ordinate})
        arrays = {name: whole[name].transpose("return", *names).values for name in (*_VARIABLES, _TIME_VARIABLE)}
        states = np.stack([arrays[name] for name in _VARIABLES], axis=-1)
        parts = {"states": read_only(states), "time": read_only(arrays[_TIME_VARIABLE])}
        return parts if "complete" in dataset.attrs else parts | {"complete": is_whole}


def _write_dataset(spec: MapSpec, ordinate: np.ndarray, states: np.ndarray, time: np.ndarray) -> xr.Dataset:
    """Return states (returns, rows, columns, 4) and times of the rows at some ordinates as a dataset without attributes."""
    # The import is slow and seldom needed.
    import xarray as xr

    names = ("return", *spec.plane.axis_names[::-1])
    places = {"return": np.arange(1, len(time) + 1), names[1]: ordinate, names[2]: spec.pixel_centres()[0]}
    coordinates = {name: (name, values, {"units": "1"}) for name, values in places.items()}
    arrays = {name: states[..., k] for k, name in enumerate(_VARIABLES)} | {_TIME_VARIABLE: time}
    variables = {
        name: (names, values, {"units": "1", "long_name": f"{_VARIABLES.get(name, 'time')} at the return"})
        for name, values in arrays.items()
    }
    return xr.Dataset(variables, coordinates)


@shows_progress("returns")
@checks_types(spec=MapSpec, execution=Execution)
def compute_returns(
    spec: MapSpec,
    returns: int = 1,
    *,
    on_frame: Callable[[Returns], None] | None = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> Returns:
    """Follow the orbits of all starts of a map to their first crossings of its section.

    A crossing of the default section goes from y < 0 to y ≥ 0, as in the maps (Zotos 2014). The start is not counted. For a map
    backward in time, the crossings are those of the reversed orbit.

    Parameters
    ----------
    spec
        The starts, on a slice without a parameter as axis; `use_evidence` is not used.
    returns
        Largest number of returns of each orbit, 1 to 100 000; at most 5 million of all orbits.
    on_frame
        Called in this thread with the returns so far.
    execution
        How the computation runs. When it is cancelled, orbits not followed yet have no returns. An orbit is not interrupted:
        those that seldom return are followed until t_max.

    Returns
    -------
    The `Returns`. Those of an orbit end where it escapes or collides, or at t_max. Equal to the bit for every executor.

    Raises
    ------
    ValueError
        If `returns` is out of range, or the slice has a parameter as axis.

    Examples
    --------
    >>> from escape_explorer import CASES, MapSpec, Plane, compute_returns
    >>> found = compute_returns(MapSpec(CASES["II"], Plane.X_PX, 0.15, (9, 9), t_max=100.0), returns=3)
    >>> found.states.shape, round(float(found.time[2, 4, 4]), 3)
    ((3, 9, 9, 4), 18.368)
    """
    columns, rows = spec.resolution
    check_request(spec, returns, columns * rows)
    run = _ReturnsRun(spec, returns, np.arange(rows))
    for part in np.array_split(run.inside(execution), _PARTS):
        if execution.is_cancelled:
            break
        run.follow(part, execution)
        execution.report(run.share_done)
        if on_frame is not None and part.size:
            on_frame(run.frame())
    return run.frame()


def check_request(spec: MapSpec, returns: int, starts: int) -> None:
    """Raise a ValueError for a request of `compute_returns` with this number of starts at a time, if it is not legal."""
    if spec.plane.parameter is not None:
        raise ValueError(f"spec: its plane {spec.plane.title} has a parameter as axis; must be a slice of one potential")
    checked_count("returns", returns, 1, min(MOST_RETURNS, _MOST_POINTS // starts))


def compute_row(spec: MapSpec, returns: int, row: int, execution: Execution) -> xr.Dataset:
    """Return the returns of the starts in one row of a map as a dataset without attributes, see `compute_returns`.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    """
    run = _ReturnsRun(spec, returns, np.array([row]))
    run.follow(run.inside(execution), execution)
    execution.raise_if_cancelled()
    return run.dataset()


class _ReturnsRun:
    """Follows the orbits of some rows of a map in units of the well."""

    def __init__(self, spec: MapSpec, returns: int, rows: np.ndarray) -> None:
        self._spec, self._well_spec = spec, spec.in_well_units()
        self._rows = rows
        x_axis, ordinate_axis = self._well_spec.pixel_centres()
        x, ordinate = (grid.ravel() for grid in np.meshgrid(x_axis, ordinate_axis[rows]))
        energies, self._curve_row = np.unique(self._well_spec.energies(x, ordinate), return_inverse=True)
        self._curves = exit_curves_at(self._well_spec.potential, energies)
        self._starts = self._well_spec.start_states(x, ordinate)
        self._found = np.full((x.size, returns, _COLUMNS), np.nan)
        # Number of pixels whose orbits have not been followed yet; unknown until `inside` is called.
        self._pending = len(self._found)

    def inside(self, execution: Execution) -> np.ndarray:
        """Return the numbers of the pixels whose starts are inside all exits."""
        batch = OrbitBatch.from_starts(self._starts, self._curve_row)
        allowed = np.flatnonzero(batch.fate == Fate.NOT_COMPUTED)
        tested = batch.mark_outside(self._well_spec.potential, allowed, self._curves, execution=execution)
        pixels = tested[batch.fate[tested] == Fate.NOT_COMPUTED]
        # A cancelled test leaves pixels of which it is not known whether they are inside.
        self._pending = pixels.size + allowed.size - tested.size
        return pixels

    def follow(self, pixels: np.ndarray, execution: Execution) -> None:
        """Find the returns of the orbits of some pixels."""
        spec = self._well_spec
        found = find_passages(
            spec.potential, self._starts[pixels], self._curve_row[pixels], self._curves, self._found.shape[1], spec.t_max,
            spec.section.numbers, execution=execution,
        )  # fmt: skip
        if not execution.is_cancelled:
            self._found[pixels] = found
            self._pending -= pixels.size

    def share_done(self) -> float:
        """Return the share of the pixels whose orbits have been followed."""
        return 1.0 - self._pending / max(len(self._found), 1)

    def frame(self) -> Returns:
        """Return the returns so far of all rows, in the units of the potential."""
        states, time = self._arrays()
        return Returns(self._spec, read_only(states), read_only(time), complete=self._pending == 0)

    def dataset(self) -> xr.Dataset:
        """Return the returns of the rows as a dataset without attributes, in the units of the potential."""
        return _write_dataset(self._spec, self._spec.pixel_centres()[1][self._rows], *self._arrays())

    def _arrays(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the states, (returns, rows, columns, 4), and times so far, in the units of the potential."""
        units = self._spec.potential.units
        by_return = self._found.transpose(1, 0, 2).reshape(-1, self._rows.size, self._spec.resolution[0], _COLUMNS)
        return self._spec.section.settle(by_return[..., :4] * units.state), by_return[..., 4] * units.time
