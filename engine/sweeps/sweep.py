"""Sweeps: maps at many values of the energy or of parameters, measured one after the other into one labelled dataset."""

from __future__ import annotations

import itertools
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.exits.lyapunov_orbits import find_lyapunov_orbits
from engine.foundations.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.foundations.result import Result
from engine.foundations.validation import checked_path, checks_types, short_repr
from engine.foundations.wording import format_count
from engine.measures.compute import compute_point
from engine.measures.measured_map import SweepPoint
from engine.sweeps.axes import AXIS_SEPARATOR, axis_names, coarse_to_fine
from engine.sweeps.spec import VALUE_ATTRIBUTES, SweepSpec
from engine.sweeps.store import SweepStore, check_same_sweep, open_store
from engine.sweeps.stored_metadata import without_values
from engine.systems.outcomes import Outcome, read_outcomes

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Result):
    """The measures of a sweep at the values so far, in ascending order.

    Attributes
    ----------
    dataset
        The measures along the axes of the sweep, whose names are "h", "jacobi" or those of the parameters. Shares also have the
        dimension "outcome", 0 for bounded orbits, and maps have the dimensions of their axes. The attributes are the request.
    """

    dataset: xr.Dataset = field(repr=False)

    @property
    def axes(self) -> tuple[str, ...]:
        """The names of the axes of the sweep, one or two: "h", "jacobi", or the name of a parameter."""
        return axis_names(self.dataset.attrs)

    @property
    def symbols(self) -> tuple[str, ...]:
        """The symbols of the axes."""
        return tuple(str(self.dataset.attrs["symbol"]).split(AXIS_SEPARATOR))

    @property
    def name(self) -> str:
        """The name of the first axis."""
        return self.axes[0]

    @property
    def symbol(self) -> str:
        """The symbol of the first axis."""
        return self.symbols[0]

    @property
    def values(self) -> np.ndarray:
        """(n,) values on the first axis."""
        return np.asarray(self.dataset[self.name].values)

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcomes whose shares are measured, besides bounded orbits."""
        return read_outcomes(self.dataset.attrs["outcomes"])

    @property
    def complete(self) -> bool:
        """Whether all values have been measured."""
        return self.values.size == int(self.dataset.attrs["count"])

    def __getitem__(self, name: str) -> np.ndarray:
        """Return a measure as an array, by the name of its variable."""
        return np.asarray(self.dataset[name].values)

    def interval(self, name: str) -> tuple[np.ndarray, np.ndarray]:
        """Return the ends of the error bars of a measure: of the 95 % interval, or the measure minus and plus its error.

        For a measure without an error, both ends are the measure.
        """
        if f"{name}_low" in self.dataset:
            return self[f"{name}_low"], self[f"{name}_high"]
        error = self[f"{name}_error"] if f"{name}_error" in self.dataset else 0.0
        return self[name] - error, self[name] + error

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return all numbers by name, the axes first, with a row for each map.

        A share has a column for each outcome, such as ``share_bounded`` and ``share_exit_1``.
        """
        labels = share_names(self.outcomes)
        grid = np.meshgrid(*(self[axis] for axis in self.axes), indexing="ij")
        columns = {axis: values.ravel() for axis, values in zip(self.axes, grid, strict=True)}
        for name in map(str, self.dataset.data_vars):
            if self.dataset[name].dims == self.axes:
                columns[name] = self[name].ravel()
            elif self.dataset[name].dims == (*self.axes, "outcome"):
                shares = self[name].reshape(-1, len(labels)).T
                columns |= {f"{name}_{label}": share for label, share in zip(labels, shares, strict=True)}
        return columns

    def to_xarray(self) -> xr.Dataset:
        """Return the dataset, which can be written as NetCDF and Zarr."""
        return self.dataset

    def describe(self) -> str:
        """Return the number of measured values, in a sentence."""
        attributes = self.dataset.attrs
        further = "".join(
            f", each at {format_count(self.dataset.sizes.get(axis, 0), 'value')} of {symbol},"
            for axis, symbol in zip(self.axes[1:], self.symbols[1:], strict=True)
        )
        return f"{self.values.size} of {attributes['count']} values of {self.symbol}{further} on {attributes['plane']}."


def share_names(outcomes: Sequence[Outcome]) -> list[str]:
    """Return the names of bounded starts and of outcomes in columns, such as "exit_1"."""
    return ["bounded", *(re.sub(r"\W+", "_", outcome.label) for outcome in outcomes)]


@shows_progress("sweep")
@checks_types(
    spec=SweepSpec,
    store=(str, os.PathLike, type(None)),
    earlier=(Sweep, type(None)),
    on_frame=(Callable, type(None)),
    measure=(Callable, type(None)),
    execution=Execution,
)
def compute_sweep(
    spec: SweepSpec,
    store: str | os.PathLike[str] | None = None,
    *,
    earlier: Sweep | None = None,
    on_frame: Callable[[Sweep], None] | None = None,
    measure: Callable[[SweepPoint], xr.Dataset] | None = None,
    execution: Execution = DEFAULT_EXECUTION,
) -> Sweep:
    """Compute the maps of a sweep one after the other, each on all workers, and their measures.

    Along a pair of axes, all maps at a value on the first axis are measured together. In memory, values are measured from coarse
    to fine, so that curves take shape early; in a store, in ascending order.

    Parameters
    ----------
    spec
        The request.
    store
        Folder of a Zarr group (format 3): new, empty, or of an earlier call with the same request, which is resumed. Each value
        on the first axis is on the disk before the next is computed, and only the maps of one value are in memory. None for a
        sweep in memory.
    earlier
        A sweep in memory whose values are not measured again: the last sweep that `on_frame` received in an interrupted call, or
        the sweep of a file (`open_result`). Its request must be the same except for `values` and `refine`.
    on_frame
        Called in this thread after each value on the first axis with the values so far.
    measure
        Replaces the function that measures one map, for example to use a cache.
    execution
        How the computation runs.

    Returns
    -------
    The `Sweep`; its maps are bit-identical to those of `compute_map`. With a store, its dataset is read from the disk on access.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled; a store keeps the finished values.
    ValueError
        When no exit is defined at one of the values, `earlier` has another request, or the store holds another request or other
        files.
    OSError
        When the store cannot be written to; finished values stay valid. BlockingIOError when another process computes into the
        store, with one sentence that names the process.

    Examples
    --------
    >>> from escape_explorer import CASES, Plane, SweepSpec, compute_sweep
    >>> spec = SweepSpec(CASES["III"], Plane.X_PX, (0.4, 0.5, 0.6), (40, 40), t_max=1e3, measures=("shares", "basin_entropy"))
    >>> compute_sweep(spec).to_pandas()[["h", "share_exit_1", "s_b"]].round(3)
         h  share_exit_1    s_b
    0  0.4         0.354  0.585
    1  0.5         0.399  0.494
    2  0.6         0.441  0.314
    """
    if not spec.parameters:
        for energy in spec.energy_range:
            # Undefined exits are an error before anything is computed.
            find_lyapunov_orbits(spec.potential, energy)
    measure_all = partial(_measure_all, spec, on_frame=on_frame, measure=measure, execution=execution)
    values = spec.axis_values[0]
    if store is None:
        return measure_all(_MemoryStorage(spec, earlier), coarse_to_fine(values))
    with open_store(checked_path("store", store), spec.attributes()) as sweep_store:
        return measure_all(sweep_store, values)


def _measure_all(
    spec: SweepSpec,
    storage: _MemoryStorage | SweepStore,
    order: Sequence[float],
    *,
    on_frame: Callable[[Sweep], None] | None,
    measure: Callable[[SweepPoint], xr.Dataset] | None,
    execution: Execution,
) -> Sweep:
    """Measure the values missing in the storage: values of the request in the given order, then values that refine it."""
    dataset = storage.read()
    while (value := _next_value(spec, dataset, order)) is not None:
        part = execution.part(dataset.sizes[spec.name], spec.count)
        part.report(lambda: 0.0)
        storage.append(_measure_value(spec, value, measure, part))
        dataset = storage.read()
        if on_frame is not None:
            on_frame(Sweep(dataset))
    execution.report(lambda: 1.0)
    return Sweep(dataset)


def _measure_value(
    spec: SweepSpec, value: float, measure: Callable[[SweepPoint], xr.Dataset] | None, execution: Execution
) -> xr.Dataset:
    """Return the measures of all maps at a value on the first axis."""
    places, measured = [(value, *others) for others in itertools.product(*spec.axis_values[1:])], []
    for number, place in enumerate(places):
        point, part = spec.point(*place), execution.part(number, len(places))
        measured.append(compute_point(point, execution=part) if measure is None else _checked_measured(measure(point)))
    return _join(measured, spec.axes[-1].key)


def _checked_measured(found: Any) -> xr.Dataset:
    """Return what the `measure` of a caller returned; ValueError unless it is a dataset."""
    # This import is slow.
    import xarray as xr

    if not isinstance(found, xr.Dataset):
        raise ValueError(f"measure: returned {short_repr(found)}; must return an xarray.Dataset, as the measures of one map")
    return found


def _join(parts: Sequence[xr.Dataset], axis: str) -> xr.Dataset:
    """Return measures at different values on an axis in one dataset."""
    # This import is slow.
    import xarray as xr

    joined: xr.Dataset = xr.concat(
        parts, axis, data_vars="all", coords="minimal", compat="override", join="override", combine_attrs="override"
    )
    return joined


class _MemoryStorage:
    """Keeps the measures at each value in memory, as `SweepStore` does on disk."""

    def __init__(self, spec: SweepSpec, earlier: Sweep | None) -> None:
        self._name, self._attributes = spec.name, spec.attributes()
        self._points = [] if earlier is None else _known_points(spec, earlier, self._attributes)

    def append(self, point: xr.Dataset) -> None:
        self._points.append(point)

    def read(self) -> xr.Dataset:
        if not self._points:
            return without_values(self._attributes)
        return _join(self._points, self._name).sortby(self._name).assign_attrs(self._attributes)


def _known_points(spec: SweepSpec, earlier: Sweep, attributes: Mapping[str, object]) -> list[xr.Dataset]:
    """Return the points of an earlier sweep at the values of the request, and at other values up to the number to refine."""
    check_same_sweep("earlier", earlier.dataset.attrs, attributes, ignored=VALUE_ATTRIBUTES)
    earlier_values = earlier.values.tolist()
    given_values = spec.axis_values[0]
    other_values = [value for value in earlier_values if value not in given_values]
    used_values = {*given_values, *other_values[: spec.count - len(given_values)]}
    return [earlier.dataset.isel({spec.name: [k]}) for k, value in enumerate(earlier_values) if value in used_values]


def _next_value(spec: SweepSpec, dataset: xr.Dataset, order: Sequence[float]) -> float | None:
    """Return the next value to measure; None at the end.

    The values of the request come first, then the middle of the two neighbours between which shares change most.
    """
    values = dataset[spec.name].values
    next_given = next((value for value in order if value not in values), None)
    if next_given is not None:
        return next_given
    if values.size >= spec.count:
        return None
    changes = np.abs(np.diff(dataset["share"].values, axis=0))
    largest_changes = changes.max(axis=tuple(range(1, changes.ndim)))
    steepest = int(np.argmax(largest_changes))
    return float(0.5 * (values[steepest] + values[steepest + 1]))
