"""Returns of orbits to the surface of section: their first crossings of it, for all starts of a map."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.exits.exit_rows import exit_curves_at
from engine.foundations.arrays import read_only
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.result import MapResult
from engine.foundations.validation import checks_types
from engine.foundations.wording import describe_codes, format_count, format_number
from engine.maps.spec import MapSpec, read_spec
from engine.propagation.fates import Fate
from engine.propagation.followed_orbits import FollowedOrbits, checked_returns
from engine.slices.sections.section import Section
from engine.systems.outcomes import Outcome

if TYPE_CHECKING:
    import xarray as xr

# Names of the variables in files, in the order of the columns of `Returns.states`, and of the times.
_VARIABLES = {"return_x": "x", "return_y": "y", "return_px": "px", "return_py": "py"}
_TIME_VARIABLE, _FATE_VARIABLE = "return_time", "fate"


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
    fate
        (rows, columns) int8 codes of how the orbit of each start ended, as in maps; `Fate.NOT_COMPUTED` for an orbit with all
        returns, which was followed to the last one only, and for one that is not followed yet. Read-only.
    complete
        Whether the orbits of all starts were followed.
    """

    spec: MapSpec
    states: np.ndarray
    time: np.ndarray
    fate: np.ndarray
    complete: bool = True
    codes: ClassVar = {"fate": Fate}
    held_as: ClassVar[dict[str, str]] = {"spec": "terms", "states": "return_x", "time": _TIME_VARIABLE}

    @property
    def count(self) -> np.ndarray:
        """(rows, columns) number of returns of each start."""
        return np.isfinite(self.time).sum(axis=0)

    def points(self) -> list[np.ndarray]:
        """Return the returns of each orbit that returns, (n, 2), in the order of the pixels and of time, see `Section.axes`."""
        return self.spec.section.axes.points_of_orbits(self.states.reshape(len(self.states), -1, 4))

    @property
    def fates_of_points(self) -> np.ndarray:
        """The fate of each orbit that returns, in the order of `points`."""
        return self.fate[self.count > 0]

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcomes with the fates 1, 2, …"""
        return self.spec.outcomes

    @property
    def section(self) -> Section:
        """The surface of section."""
        return self.spec.section

    @property
    def fate_labels(self) -> Sequence[str]:
        """Labels of the fates 1, 2, …"""
        return [outcome.label for outcome in self.outcomes]

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
        ordinate = self.spec.pixel_centres()[1]
        return _write_dataset(self.spec, ordinate, self.states, self.time, self.fate).assign_attrs(attributes)

    @classmethod
    def read_parts(cls, dataset: xr.Dataset) -> dict[str, Any]:
        """Return the states and times, which files store as variables. A store may lack rows, and has them first."""
        spec = read_spec(dataset)
        (_, ordinate), names = spec.pixel_centres(), spec.plane.axis_names[::-1]
        is_whole = dataset.sizes[names[0]] == ordinate.size
        absent = {_FATE_VARIABLE: Fate.NOT_COMPUTED.value}
        whole = dataset if is_whole else dataset.reindex({names[0]: ordinate}, fill_value=absent)
        arrays = {name: whole[name].transpose("return", *names).values for name in (*_VARIABLES, _TIME_VARIABLE)}
        states = np.stack([arrays[name] for name in _VARIABLES], axis=-1)
        fate = whole[_FATE_VARIABLE].transpose(*names).values.astype(np.int8)
        parts = {"states": read_only(states), "time": read_only(arrays[_TIME_VARIABLE]), "fate": read_only(fate)}
        return parts if "complete" in dataset.attrs else parts | {"complete": is_whole}


def _write_dataset(spec: MapSpec, ordinate: np.ndarray, states: np.ndarray, time: np.ndarray, fate: np.ndarray) -> xr.Dataset:
    """Return states (returns, rows, columns, 4), times and fates of rows, given by their ordinates, without attributes."""
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
    meanings = describe_codes(Fate, [outcome.label for outcome in spec.outcomes])
    return xr.Dataset({_FATE_VARIABLE: (names[1:], fate, meanings), **variables}, coordinates)


@shows_progress("returns")
@checks_types(spec=MapSpec, on_frame=(Callable, type(None)), execution=Execution)
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
    for part in run.orbits.parts(execution):
        if execution.is_cancelled:
            break
        run.orbits.follow(part, execution)
        execution.report(run.orbits.share_done)
        if on_frame is not None and part.size:
            on_frame(run.frame())
    return run.frame()


def check_request(spec: MapSpec, returns: int, starts: int) -> None:
    """Raise a ValueError for a request of `compute_returns` with this number of starts at a time, if it is not legal."""
    if spec.plane.parameter is not None:
        raise ValueError(f"spec: its plane {spec.plane.title} has a parameter as axis; must be a slice of one potential")
    checked_returns(returns, starts)


def compute_row(spec: MapSpec, returns: int, row: int, execution: Execution) -> xr.Dataset:
    """Return the returns of the starts in one row of a map as a dataset without attributes, see `compute_returns`.

    Raises
    ------
    concurrent.futures.CancelledError
        If cancelled.
    """
    run = _ReturnsRun(spec, returns, np.array([row]))
    run.orbits.follow(np.concatenate(run.orbits.parts(execution)), execution)
    execution.raise_if_cancelled()
    return run.dataset()


class _ReturnsRun:
    """The orbits of some rows of a map."""

    def __init__(self, spec: MapSpec, returns: int, rows: np.ndarray) -> None:
        self._spec, self._rows = spec, rows
        well_spec = spec.in_well_units()
        x_axis, ordinate_axis = well_spec.pixel_centres()
        x, ordinate = (grid.ravel() for grid in np.meshgrid(x_axis, ordinate_axis[rows]))
        energies, curve_row = np.unique(well_spec.energies(x, ordinate), return_inverse=True)
        self.orbits = FollowedOrbits(
            well_spec.potential, well_spec.start_states(x, ordinate), curve_row,
            exit_curves_at(well_spec.potential, energies), returns, well_spec.t_max, well_spec.section.numbers,
        )  # fmt: skip

    def frame(self) -> Returns:
        """Return the returns so far of all rows, in the units of the potential."""
        states, time, fate = map(read_only, self._arrays())
        return Returns(self._spec, states, time, fate, complete=self.orbits.complete)

    def dataset(self) -> xr.Dataset:
        """Return the returns of the rows as a dataset without attributes, in the units of the potential."""
        return _write_dataset(self._spec, self._spec.pixel_centres()[1][self._rows], *self._arrays())

    def _arrays(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the states, (returns, rows, columns, 4), times and fates so far, in the units of the potential."""
        shape = (self._rows.size, self._spec.resolution[0])
        states, time = self._spec.section.restore_returns(self.orbits.points, self._spec.potential.units)
        return states.reshape(-1, *shape, 4), time.reshape(-1, *shape), self.orbits.fate.reshape(shape).copy()
