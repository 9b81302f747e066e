"""Maps along a parameter, in which each row, or each column, is a map with its own potential.

Each line has the units of its own well and its own exits, and is computed like any map of its potential. The lines of a whole map
are computed one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor, as_completed
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.execution import SERIAL_EXECUTION, Execution, count_cores
from engine.maps.pixels import PixelAnalysis
from engine.maps.result import PIXEL_ARRAYS, EscapeMap, collect_map, empty_arrays, representative_indices
from engine.maps.run import MapRun
from engine.maps.spec import MapSpec
from engine.maps.stages import OnChange, Stage, Staged, run_stages, run_to_frame
from engine.propagation.batch import OrbitBatch
from engine.propagation.evidence import Evidence
from engine.propagation.fates import Fate, renumber
from engine.slices.axes import HeldParameter, highest_energy
from engine.slices.parameter_family import ManyExitsError, parameter_family
from engine.slices.window import Window

# Up to this time, in units of the well, a line is one task of the executor, of about 50 ms at most. Dividing a line into tiles,
# for which a thread waits, takes three times as long. This pays only for orbits that are still inside.
_FIRST_HORIZON = 1000.0
# Strides between the lines of the first frames.
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
    numbers
        (outcomes + 1,) fate on the whole map of each fate of the line; entry 0 is 0.
    """

    spec: MapSpec
    place: Place
    numbers: np.ndarray

    def of(self, escape_map: EscapeMap) -> EscapeMap:
        """Return this line of a map, with the outcome numbers of the line, and with its integration state if the map has one."""
        own = np.zeros(int(self.numbers.max(initial=0)) + 1, np.int8)
        own[self.numbers] = np.arange(self.numbers.size)
        arrays: dict[str, Any] = {name: getattr(escape_map, name)[self.place] for name in PIXEL_ARRAYS}
        for name in _OUTCOME_ARRAYS:
            arrays[name] = renumber(arrays[name], own)
        x, ordinate = self.spec.pixel_centres()
        line = replace(escape_map, spec=replace(self.spec, t_max=escape_map.spec.t_max), x=x, ordinate=ordinate, **arrays)
        if escape_map.batch is None:
            return line
        pixels = np.arange(escape_map.fate.size).reshape(escape_map.fate.shape)[self.place].ravel()
        which = np.searchsorted(escape_map.continued_pixels, pixels[line.continued_pixels])
        return replace(line, batch=escape_map.batch.take(which))


def find_lines(spec: MapSpec) -> list[Line | None]:
    """Return the lines of a map along a parameter, in increasing order of its values; None where there is no potential."""
    axis, place = spec.plane.parameter, spec.plane.parameter_axis
    assert axis is not None
    window, family = spec.find_window(), parameter_family(axis)
    return [_line(spec, window, family.member, k, value) for k, value in enumerate(spec.pixel_centres()[place or 0].tolist())]


def _line(spec: MapSpec, window: Window, find_member: Callable[[float], Any], k: int, value: float) -> Line | None:
    try:
        member = find_member(value)
    except ManyExitsError:
        raise
    except ValueError:
        return None
    columns, rows = spec.resolution
    # Across the line, only the middle of the window matters.
    edges = value - 0.5, value + 0.5
    place: Place
    if spec.plane.parameter_axis == 0:
        place, size, part = np.s_[:, k : k + 1], (1, rows), Window(*edges, window.ordinate_low, window.ordinate_high)
    else:
        place, size, part = np.s_[k : k + 1, :], (columns, 1), Window(window.x_low, window.x_high, *edges)
    line_spec = replace(spec, potential=member.potential, plane=spec.plane.line(value), resolution=size, window=part)
    return Line(line_spec, place, member.numbers_at(highest_energy(spec.energy)))


class LineStack:
    """Computes the lines of a map along a parameter.

    Parameters
    ----------
    spec
        The map.
    resume
        An earlier map to continue from.
    keeps_states
        Whether the states of orbits are kept; large maps would need too much memory.
    """

    def __init__(self, spec: MapSpec, resume: EscapeMap | None = None, *, keeps_states: bool = True) -> None:
        self.spec, self._keeps_states = spec, keeps_states
        lines = find_lines(spec)
        self._count, self._lines = len(lines), {k: line for k, line in enumerate(lines) if line is not None}
        self._found: dict[int, EscapeMap] = {}
        self._stride, self._horizon = _STRIDES[0], 0.0
        self._arrays = empty_arrays(PIXEL_ARRAYS, spec.resolution[::-1])
        for k in range(self._count):
            if k not in self._lines:
                # The system has no potential at this value.
                here = (slice(None), k) if spec.plane.parameter_axis == 0 else k
                self._arrays["fate"][here], self._arrays["started"][here] = Fate.FORBIDDEN, True
            elif resume is not None:
                self._put(k, self._lines[k].of(resume))

    def stages(self, execution: Execution, on_change: OnChange) -> Iterator[Stage]:
        """Yield the stages, see `Staged`; each integrates the orbits of some lines to a horizon."""
        first, last = _FIRST_HORIZON * self.spec.potential.units.time, self.spec.t_max
        is_divided = first < last and self._keeps_states and not self._found
        for horizon in (first, last) if is_divided else (last,):
            for stride, lines in self._refinements():
                yield partial(self._advance, stride, lines, horizon, execution, on_change)
            self._horizon = horizon

    def _refinements(self) -> Iterator[tuple[int, list[int]]]:
        """Yield (stride, lines), coarse to fine, with each line once."""
        seen: set[int] = set()
        for stride in _STRIDES:
            chosen = [k for k in np.unique(representative_indices(self._count, stride)).tolist() if k not in seen]
            seen |= set(chosen)
            yield stride, [k for k in chosen if k in self._lines]

    def _advance(self, stride: int, lines: list[int], horizon: float, execution: Execution, on_change: OnChange) -> None:
        """Integrate the orbits of some lines up to a time."""
        waiting = [k for k in lines if _continues(self._found.get(k))]
        arguments = [(self._lines[k], horizon, self._found.get(k)) for k in waiting]
        with _coordinating_threads() as threads:
            if horizon <= _FIRST_HORIZON * self.spec.potential.units.time:
                futures = [execution.submit(_compute_line, *each) for each in arguments]
            else:
                alone = replace(execution, on_progress=None)
                futures = [threads.submit(_compute_line, *each, alone) for each in arguments]
            for k, found in _as_finished(dict(zip(futures, waiting, strict=True)), execution):
                self._put(k, found)
                on_change(False)
        if not execution.is_cancelled:
            self._stride = min(self._stride, stride)

    def _put(self, k: int, found: EscapeMap) -> None:
        line = self._lines[k]
        self._found[k] = found if self._keeps_states else replace(found, batch=None)
        for name, array in self._arrays.items():
            codes = getattr(found, name)
            array[line.place] = renumber(codes, line.numbers) if name in _OUTCOME_ARRAYS else codes
        if found.spec.t_max < self.spec.t_max:
            open_ended = (found.fate == Fate.BOUNDED) & (found.evidence == Evidence.INTEGRATED)
            for name, value in (("fate", Fate.NOT_COMPUTED), ("evidence", Evidence.NONE)):
                array = self._arrays[name]
                array[line.place] = np.where(open_ended, value, array[line.place])

    def progress(self) -> float:
        """Return the share of the work done, averaged over the lines."""
        done = (found.progress * min(1.0, found.spec.t_max / self.spec.t_max) for found in self._found.values())
        return sum(done) / len(self._lines) if self._lines else 1.0

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
        numbers = np.arange(frame.fate.size).reshape(frame.fate.shape)
        pixels, batches = [np.zeros(0, int)], [OrbitBatch.empty(np.zeros(0, np.int64))]
        for k, line in self._lines.items():
            found = self._found.get(k)
            if found is not None and found.batch is not None:
                pixels.append(numbers[line.place].ravel()[found.continued_pixels])
                batches.append(found.batch)
        joined = OrbitBatch(**{f.name: np.concatenate([getattr(b, f.name) for b in batches]) for f in fields(OrbitBatch)})
        return replace(frame, batch=joined.take(np.argsort(np.concatenate(pixels))))


def analyse_map[Analysis: PixelAnalysis](
    escape_map: EscapeMap,
    begin: Callable[[EscapeMap, Place], Staged[Analysis]],
    kind: type[Analysis],
    on_frame: Callable[[Analysis], None] | None,
    execution: Execution,
    **choices: Any,
) -> Analysis:
    """Analyse a complete map; a map along a parameter is analysed line by line.

    Parameters
    ----------
    escape_map
        The map.
    begin
        A function that begins the analysis of a map of one potential, or of a line with its place, and returns its computation.
    kind
        The class of the analysis.
    **choices
        Fields of the analysis that are the same for all lines.
    on_frame
        Called with the analysis so far, see `run_stages`, and with the complete analysis.
    execution
        How the computation runs.

    Returns
    -------
    The analysis of the map; it is complete when the analyses of all lines are complete.
    """
    if escape_map.spec.plane.parameter is None:
        return run_to_frame(begin(escape_map, ALL_PIXELS), execution, on_frame)
    return run_to_frame(_LineAnalyses(escape_map, begin, kind, choices), execution, on_frame)


class _LineAnalyses[Analysis: PixelAnalysis]:
    """Analyses the lines of a map concurrently, see `analyse_map`."""

    def __init__(
        self,
        escape_map: EscapeMap,
        begin: Callable[[EscapeMap, Place], Staged[Analysis]],
        kind: type[Analysis],
        choices: Mapping[str, Any],
    ) -> None:
        self._map, self._begin, self._kind, self._choices = escape_map, begin, kind, choices
        self._arrays = empty_arrays(kind.pixel_arrays, escape_map.fate.shape)
        self._lines = [line for line in find_lines(escape_map.spec) if line is not None]
        self._finished, self._complete = 0, True

    def stages(self, execution: Execution, on_change: OnChange) -> Iterator[Stage]:
        """Yield the stages, see `Staged`; all lines form one stage."""
        yield partial(self._analyse, execution, on_change)

    def _analyse(self, execution: Execution, on_change: OnChange) -> None:
        alone = replace(execution, on_progress=None)
        with _coordinating_threads() as threads:
            running = {threads.submit(self._analyse_line, line, alone): line for line in self._lines}
            for line, found in _as_finished(running, execution):
                for name, values in self._arrays.items():
                    values[line.place] = getattr(found, name)
                self._finished += 1
                self._complete = self._complete and found.complete
                on_change(True)

    def _analyse_line(self, line: Line, execution: Execution) -> Analysis:
        return run_to_frame(self._begin(line.of(self._map), line.place), execution)

    def progress(self) -> float:
        """Return the share of the lines that are finished."""
        return self._finished / max(len(self._lines), 1)

    def frame(self) -> Analysis:
        """Return the analysis so far."""
        arrays: dict[str, Any] = {name: read_only(values.copy()) for name, values in self._arrays.items()}
        complete = self._complete and self._finished == len(self._lines)
        return self._kind(spec=self._map.spec, complete=complete, **arrays, **self._choices)


def _as_finished[Key, Found](running: dict[Future[Found], Key], execution: Execution) -> Iterator[tuple[Key, Found]]:
    """Yield results as they are finished. When the computation is cancelled, calls that have not begun are dropped."""
    for future in as_completed(running):
        if execution.is_cancelled:
            for waiting in running:
                waiting.cancel()
        found = execution.collect(future)
        if found is not None:
            yield running[future], found


def _coordinating_threads() -> ThreadPoolExecutor:
    """Return threads for lines that are computed concurrently. The threads share the executor, and mostly wait for tiles."""
    return ThreadPoolExecutor(2 * count_cores(), thread_name_prefix="lines")


def _continues(earlier: EscapeMap | None) -> bool:
    """Return whether a longer time can change a line."""
    return earlier is None or not earlier.started.all() or bool(earlier.continued_pixels.size)


def _compute_line(line: Line, t_max: float, earlier: EscapeMap | None, execution: Execution = SERIAL_EXECUTION) -> EscapeMap:
    """Return a line integrated up to a time, with its integration state."""
    spec = replace(line.spec, t_max=t_max)
    run = MapRun(spec.in_well_units(), None if earlier is None else earlier.in_well_units(), coarse_first=False)
    try:
        run_stages(run, execution)
    except ValueError as error:
        held = next(axis for axis in spec.plane.axes if isinstance(axis, HeldParameter))
        raise ValueError(f"{held.key}={held.value:.6g}, {error}") from None
    return run.result().restored(spec)
