"""The figures that can be made of the content of the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial

from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from engine import EscapeMap
from engine.slices.axes import highest_energy
from plots.layers.table import LAYER_OF, TITLES
from plots.printed.figure_files import (
    curves_figure_bytes,
    map_figure_bytes,
    orbits_figure_bytes,
    statistics_figure_bytes,
    well_figure_bytes,
)
from plots.printed.figure_style import FigureFormat, FigureStyle

Make = Callable[[FigureFormat, FigureStyle], bytes]
"""Makes the file of a figure, which takes seconds."""

ALL_MAPS, WELL, ORBITS, STATISTICS, CURVES = "All maps", "The well in (x, y)", "Orbits", "Statistics", "Curves against energy"
FIGURES = (ALL_MAPS, *(title for name, title in TITLES.items() if name != "curves"), WELL, ORBITS, STATISTICS, CURVES)
"""Titles of all figures."""


def figure_choices(shown: ShownResults, state: ViewState) -> dict[str, Make]:
    """Return the figures by title; they use the present results, even if the page changes afterwards."""
    choices: dict[str, Make] = {}
    drawings = [one.drawing for one in shown.orbits if one.drawing is not None]
    frame = shown.whole_map
    if frame is not None:
        choices |= _map_choices(frame, shown, state)
        spec = frame.spec
        energy = highest_energy(spec.energy)
        choices[WELL] = partial(well_figure_bytes, spec.potential, energy, drawings, state.colours)
    if drawings:
        verdicts = [one.describe() for one in shown.orbits if one.drawing is not None]
        choices[ORBITS] = partial(orbits_figure_bytes, state.potential, drawings, state.colours, verdicts)
    if frame is not None:
        choices[STATISTICS] = partial(statistics_figure_bytes, frame, state.box)
    if shown.curves is not None and shown.curves.values.size:
        choices[CURVES] = partial(curves_figure_bytes, shown.curves)
    return choices


def _map_choices(frame: EscapeMap, shown: ShownResults, state: ViewState) -> dict[str, Make]:
    analyses, orbits = shown.analyses, shown.orbits
    pictures = [name for name in TITLES if name != "curves" and (name not in LAYER_OF or LAYER_OF[name].name in analyses)]

    def make(names: Sequence[str], format: FigureFormat, style: FigureStyle) -> bytes:
        return map_figure_bytes(frame, names, palette, format, style, analyses=analyses, starts=starts, times=times)

    palette, times, starts = state.colours, state.lock_times, tuple(one.start for one in orbits)
    choices: dict[str, Make] = {ALL_MAPS: partial(make, pictures)}
    return choices | {TITLES[name]: partial(make, [name]) for name in pictures}
