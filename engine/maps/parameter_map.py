"""Maps along a parameter, in which each row, or each column, is a map with its own potential.

Such a line has the units of its own well and its own exits, and is computed like any map of its potential. Several lines are
computed at the same time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any

import numpy as np

from engine.foundations.execution import SERIAL_EXECUTION, Execution, count_cores
from engine.maps.result import PIXEL_ARRAYS, EscapeMap, collect_map, empty_arrays, representative_indices
from engine.maps.run import MapRun
from engine.maps.spec import MapSpec
from engine.maps.stages import OnChange, Stage, run_stages
from engine.propagation.batch import OrbitBatch
from engine.propagation.fates import Evidence, Fate, renumber
from engine.slices.axes import HeldParameter, highest_energy
from engine.slices.parameter_family import ManyExitsError, parameter_family
from engine.slices.window import Window

# Time up to which a line is one task of the executor, in units of the well. The task takes at most about 50 ms. Dividing a line
# into tiles takes three times as long, and pays only for orbits that are still inside at this time.
_FIRST_HORIZON = 1000.0
# Strides between the lines of successive frames.
_STRIDES = (8, 4, 2, 1)
# The arrays whose positive codes are numbers of outcomes.
_OUTCOME_ARRAYS = ("fate", "outside")

Place = tuple[Any, Any]
"""The index of a line in the arrays of a map."""

ALL_PIXELS: Place = np.s_[:, :]
"""The place of a map that is not divided into lines."""


@dataclass(frozen=True, eq=False)
class Line:
    """A row or a column of a map along a parameter.

    Attributes
    ----------
    spec
        The map of the line.
    place
        The index of the line in the arrays of the whole map.
    map_fates
        (outcomes + 1,) for each fate 0, 1, … of the line, the fate on the whole map; entry 0 is 0.
    """

    spec: MapSpec
    place: Place
    map_fates: np.ndarray

    def extract(self, escape_map: EscapeMap) -> EscapeMap:
        """Return this line of a map, with the fates of the line, and with the integration state if the map has one."""
        # The inverse of `map_fates`.
        line_fates = np.zeros(int(self.map_fates.max(initial=0)) + 1, np.int8)
        line_fates[self.map_fates] = np.arange(self.map_fates.size)
        arrays: dict[str, Any] = {name: getattr(escape_map, name)[self.place] for name in PIXEL_ARRAYS}
        for name in _OUTCOME_ARRAYS:
            arrays[name] = renumber(arrays[name], line_fates)
        x, ordinate = self.spec.pixel_centres()
        line = replace(escape_map, spec=replace(self.spec, t_max=escape_map.spec.t_max), x=x, ordinate=ordinate, **arrays)
        if escape_map.batch is None:
            return line
        pixels = np.arange(escape_map.fate.size).reshape(escape_map.fate.shape)[self.place].ravel()
        indices = np.searchsorted(escape_map.continued_pixels, pixels[line.continued_pixels])
        return replace(line, batch=escape_map.batch.take(indices))


def find_lines(spec: MapSpec) -> list[Line | None]:
    """Return the lines of a map along a parameter, in increasing order of its values; None where there is no potential."""
    axis, axis_index = spec.plane.parameter, spec.plane.parameter_axis
    assert axis is not None
    assert axis_index is not None
    window, family = spec.find_window(), parameter_family(axis)
    values = spec.pixel_centres()[axis_index].tolist()
    return [_make_line(spec, window, family.member, k, value) for k, value in enumerate(values)]


def _make_line(spec: MapSpec, window: Window, find_member: Callable[[float], Any], k: int, value: float) -> Line | None:
    """Return the line with index k, at a value of the parameter; None if the system has no potential there."""
    try:
        member = find_member(value)
    except ManyExitsError:
        # This ValueError concerns the whole map.
        raise
    except ValueError:
        return None
    columns, rows = spec.resolution
    # There is one pixel across the line. Its centre is the middle of this window.
    edges = value - 0.5, value + 0.5
    if spec.plane.parameter_axis == 0:
        resolution, line_window = (1, rows), Window(*edges, window.ordinate_low, window.ordinate_high)
    else:
        resolution, line_window = (columns, 1), Window(window.x_low, window.x_high, *edges)
    line_spec = replace(spec, potential=member.potential, plane=spec.plane.line(value), resolution=resolution, window=line_window)
    return Line(line_spec, _find_place(spec, k), member.numbers_at(highest_energy(spec.energy)))


def _find_place(spec: MapSpec, k: int) -> Place:
    """Return the place of the line with index k, a column if the parameter is the first axis."""
    return np.s_[:, k : k + 1] if spec.plane.parameter_axis == 0 else np.s_[k : k + 1, :]


class LinewiseRun:
    """Computes a map along a parameter line by line, each line in units of its own well.

    Parameters
    ----------
    spec
        The map.
    resume
        An earlier map to continue from.
    keeps_states
        Whether the states of orbits are kept. Those of a large map would need too much memory.
    """

    def __init__(self, spec: MapSpec, resume: EscapeMap | None = None, *, keeps_states: bool = True) -> None:
        self.spec, self._keeps_states = spec, keeps_states
        lines = find_lines(spec)
        self._line_count = len(lines)
        # The lines with a potential, and their maps so far, by index.
        self._lines = {k: line for k, line in enumerate(lines) if line is not None}
        self._line_maps: dict[int, EscapeMap] = {}
        self._first_horizon = _FIRST_HORIZON * spec.potential.units.time
        self._stride, self._horizon = _STRIDES[0], 0.0
        self._arrays = empty_arrays(PIXEL_ARRAYS, spec.resolution[::-1])
        for k in range(self._line_count):
            if k not in self._lines:
                place = _find_place(spec, k)
                self._arrays["fate"][place], self._arrays["started"][place] = Fate.FORBIDDEN, True
            elif resume is not None:
                self._store_line(k, self._lines[k].extract(resume))

    def stages(self, execution: Execution, on_change: OnChange) -> Iterator[Stage]:
        """Yield the stages, see `Staged`. Each stage integrates the orbits of some lines to a horizon."""
        first, last = self._first_horizon, self.spec.t_max
        # A second horizon continues from the states at the first. An earlier map already gives an overview.
        has_two_horizons = first < last and self._keeps_states and not self._line_maps
        for horizon in (first, last) if has_two_horizons else (last,):
            for stride, indices in self._refinements():
                yield partial(self._advance, stride, indices, horizon, execution, on_change)
            self._horizon = horizon

    def _refinements(self) -> Iterator[tuple[int, list[int]]]:
        """Yield each stride with the indices of its additional lines, coarse to fine; each line appears once."""
        yielded: set[int] = set()
        for stride in _STRIDES:
            representatives = set(representative_indices(self._line_count, stride).tolist())
            yield stride, sorted(k for k in representatives - yielded if k in self._lines)
            yielded |= representatives

    def _advance(self, stride: int, indices: list[int], horizon: float, execution: Execution, on_change: OnChange) -> None:
        """Integrate the orbits of some lines to a horizon."""
        continued_indices = [k for k in indices if _can_change(self._line_maps.get(k))]
        arguments = [(self._lines[k], horizon, self._line_maps.get(k)) for k in continued_indices]
        with create_coordinating_threads() as threads:
            if horizon <= self._first_horizon:
                futures = [execution.submit(_compute_line, *each) for each in arguments]
            else:
                silent_execution = replace(execution, on_progress=None)
                futures = [threads.submit(_compute_line, *each, silent_execution) for each in arguments]
            for k, line_map in as_finished(dict(zip(futures, continued_indices, strict=True)), execution):
                self._store_line(k, line_map)
                on_change(False)
        if not execution.is_cancelled:
            self._stride = min(self._stride, stride)

    def _store_line(self, k: int, line_map: EscapeMap) -> None:
        """Keep the map of a line, up to any time, and copy its pixels into the arrays."""
        line = self._lines[k]
        self._line_maps[k] = line_map if self._keeps_states else replace(line_map, batch=None)
        for name, array in self._arrays.items():
            values = getattr(line_map, name)
            array[line.place] = renumber(values, line.map_fates) if name in _OUTCOME_ARRAYS else values
        if line_map.spec.t_max < self.spec.t_max:
            # Orbits that are bounded only until this shorter time stay undecided on the whole map.
            is_undecided = (line_map.fate == Fate.BOUNDED) & (line_map.evidence == Evidence.INTEGRATED)
            for name, value in (("fate", Fate.NOT_COMPUTED), ("evidence", Evidence.NONE)):
                array = self._arrays[name]
                array[line.place] = np.where(is_undecided, value, array[line.place])

    def progress(self) -> float:
        """Return the share of the work done, averaged over the lines."""
        shares = (line_map.progress * min(1.0, line_map.spec.t_max / self.spec.t_max) for line_map in self._line_maps.values())
        return sum(shares) / len(self._lines) if self._lines else 1.0

    def frame(self) -> EscapeMap:
        """Return the map so far."""
        arrays = {name: array.copy() for name, array in self._arrays.items()}
        stage = {"stride": self._stride, "horizon": self._horizon, "progress": self.progress()}
        return collect_map(self.spec, self.spec.pixel_centres(), arrays, **stage)

    def result(self) -> EscapeMap:
        """Return the map so far, with the integration state for a later `resume`."""
        frame = self.frame()
        if not self._keeps_states:
            return frame
        pixel_numbers = np.arange(frame.fate.size).reshape(frame.fate.shape)
        # A map without lines has only these empty items, because `concatenate` needs at least one.
        pixels, batches = [np.zeros(0, int)], [OrbitBatch.empty(np.zeros(0, np.int64))]
        for k, line in self._lines.items():
            line_map = self._line_maps.get(k)
            if line_map is not None and line_map.batch is not None:
                pixels.append(pixel_numbers[line.place].ravel()[line_map.continued_pixels])
                batches.append(line_map.batch)
        names = [field.name for field in fields(OrbitBatch)]
        joined = OrbitBatch(**{name: np.concatenate([getattr(batch, name) for batch in batches]) for name in names})
        return replace(frame, batch=joined.take(np.argsort(np.concatenate(pixels))))


def as_finished[Key, Result](key_by_call: dict[Future[Result], Key], execution: Execution) -> Iterator[tuple[Key, Result]]:
    """Yield the key and the result of each call when it is finished.

    When the computation is cancelled, calls that have not begun are dropped and yield nothing.
    """
    for call in as_completed(key_by_call):
        if execution.is_cancelled:
            for pending in key_by_call:
                pending.cancel()
        result = execution.collect(call)
        if result is not None:
            yield key_by_call[call], result


def create_coordinating_threads() -> ThreadPoolExecutor:
    """Return a pool of threads that each compute one line at a time. They share the executor, and mostly wait for tiles."""
    return ThreadPoolExecutor(2 * count_cores(), thread_name_prefix="lines")


def _can_change(earlier: EscapeMap | None) -> bool:
    """Return whether a longer integration can change a line, given its map so far."""
    return earlier is None or not earlier.started.all() or bool(earlier.continued_pixels.size)


def _compute_line(line: Line, t_max: float, earlier: EscapeMap | None, execution: Execution = SERIAL_EXECUTION) -> EscapeMap:
    """Return a line integrated up to a time, with its integration state."""
    spec = replace(line.spec, t_max=t_max)
    run = MapRun(spec.in_well_units(), None if earlier is None else earlier.in_well_units(), coarse_first=False)
    try:
        run_stages(run, execution)
    except ValueError as error:
        # The axis across the line holds the value of the parameter.
        parameter = next(axis for axis in spec.plane.axes if isinstance(axis, HeldParameter))
        raise ValueError(f"{parameter.key}={parameter.value:.6g}, {error}") from None
    return run.result().restored(spec)
