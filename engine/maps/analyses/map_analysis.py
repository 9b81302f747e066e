"""How complete maps are analysed: those of one potential as a whole, and those along a parameter line by line."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Any

from engine.foundations.execution import Execution
from engine.maps.parameter_map import ALL_PIXELS, Line, Place, as_finished, create_coordinating_threads, find_lines
from engine.maps.pixels import PixelAnalysis
from engine.maps.result import EscapeMap, empty_arrays
from engine.maps.stages import OnChange, Stage, Staged, run_to_frame


def analyse_map[Analysis: PixelAnalysis](
    escape_map: EscapeMap,
    begin: Callable[[EscapeMap, Place], Staged[Analysis]],
    kind: type[Analysis],
    on_frame: Callable[[Analysis], None] | None,
    execution: Execution,
    **choices: Any,
) -> Analysis:
    """Analyse a complete map. A map along a parameter is analysed line by line.

    Parameters
    ----------
    escape_map
        The map.
    begin
        Returns the computation that analyses a map of one potential, or a line with its place.
    kind
        The class of the analysis, for a map along a parameter.
    on_frame
        Called with the analysis so far, see `run_stages`, and with the complete analysis.
    execution
        How the computation runs.
    **choices
        Fields of the analysis that are the same for all lines.

    Returns
    -------
    The analysis of the map. It is complete when the analyses of all lines are complete.
    """
    if escape_map.spec.plane.parameter is None:
        return run_to_frame(begin(escape_map, ALL_PIXELS), execution, on_frame)
    return run_to_frame(_LinewiseAnalysis(escape_map, begin, kind, choices), execution, on_frame)


class _LinewiseAnalysis[Analysis: PixelAnalysis]:
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
        # Number of lines whose analysis has ended, and number of these analyses that are complete.
        self._finished_count = self._complete_count = 0

    def stages(self, execution: Execution, on_change: OnChange) -> Iterator[Stage]:
        """Yield the stages, see `Staged`. All lines form one stage."""
        yield partial(self._analyse, execution, on_change)

    def _analyse(self, execution: Execution, on_change: OnChange) -> None:
        """Analyse all lines."""
        silent_execution = replace(execution, on_progress=None)
        with create_coordinating_threads() as threads:
            lines = {threads.submit(self._analyse_line, line, silent_execution): line for line in self._lines}
            for line, analysis in as_finished(lines, execution):
                for name, values in self._arrays.items():
                    values[line.place] = getattr(analysis, name)
                self._finished_count += 1
                self._complete_count += analysis.complete
                on_change(True)

    def _analyse_line(self, line: Line, execution: Execution) -> Analysis:
        """Return the analysis of one line, with the arrays of the line."""
        return run_to_frame(self._begin(line.extract(self._map), line.place), execution)

    def progress(self) -> float:
        """Return the share of the lines that are finished."""
        return self._finished_count / max(len(self._lines), 1)

    def frame(self) -> Analysis:
        """Return the analysis so far."""
        arrays: dict[str, Any] = {name: values.copy() for name, values in self._arrays.items()}
        complete = self._complete_count == len(self._lines)
        return self._kind(spec=self._map.spec, complete=complete, **arrays, **self._choices)
