"""Curves over the pictures: limiting curve, equipotentials, and Lyapunov orbits with the numbers of their exits."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from bokeh.models import ColumnDataSource, MultiLine, Text
from bokeh.plotting import figure

from app.browser.browser_system import EXIT_NUMBER_DISTANCE
from app.state.view_state import ViewState
from app.views.components.plots import LaterGlyphs
from engine import LyapunovOrbit, MapSpec, find_lyapunov_orbits
from engine.slices.limiting_curves import trace_equipotentials, trace_zero_velocity_curve
from engine.systems.review.energy_ranges import depth_levels
from engine.systems.review.potential_review import critical_energies
from plots.pictures.palette import MOST_CHANNELS, Entry

# Number of maps whose curves are cached.
_CACHED_MAPS = 64
# Energies of the faint equipotentials, in units of the escape energy.
_LEVELS = (0.1, 0.3, 0.5, 0.7, 0.9, 1.2, 1.6, 2.2, 3.0)


class TracedCurves(NamedTuple):
    """Lines of the zero-velocity curve, of the equipotentials at critical energies, and of the faint equipotentials."""

    limit: list[np.ndarray]
    critical: list[np.ndarray]
    levels: list[np.ndarray]


@functools.lru_cache(maxsize=_CACHED_MAPS)
def trace_curves(spec: MapSpec) -> TracedCurves:
    """Return the curves of a map. They can take time, so the job of the map calls this first, and the result is cached."""
    window, h = spec.find_window(), spec.common_energy
    limit = trace_zero_velocity_curve(spec.potential, spec.plane, spec.energy, window)
    if h is None:
        return TracedCurves(limit, [], [])
    critical = critical_energies(spec.potential)
    energies = [*critical, *depth_levels(spec.potential, _LEVELS)]
    traced = trace_equipotentials(spec.potential, spec.plane, energies, window)
    split = len(critical)
    return TracedCurves(limit, _joined(traced[:split]), _joined(traced[split:]))


def _joined(levels: Iterable[Sequence[np.ndarray]]) -> list[np.ndarray]:
    return [line for lines in levels for line in lines]


class CurveLayers:
    """Draws the curves of a map into any number of figures, in the colours of the view state."""

    def __init__(self, state: ViewState) -> None:
        self._state = state
        self._limit = ColumnDataSource({"xs": [], "ys": []}, name="zero_velocity_curve")
        self._levels = ColumnDataSource({"xs": [], "ys": []}, name="equipotentials")
        self._critical = ColumnDataSource({"xs": [], "ys": []}, name="critical_equipotential")
        self._exits = ColumnDataSource({"xs": [], "ys": [], "colour": []}, name="lyapunov_orbits")
        self._labels = ColumnDataSource({"x": [], "y": [], "text": [], "colour": []}, name="channel_numbers")
        self._exit_lines, self._exit_numbers = LaterGlyphs(self._add_exit_lines), LaterGlyphs(self._add_exit_numbers)
        # Glyphs whose colour depends on the theme, by the name of the colour in `LineColours`.
        self._themed_glyphs: dict[str, list[Any]] = {"limiting_curve": [], "critical_equipotential": [], "equipotential": []}
        state.param.watch(lambda event: self._follow_theme(), "dark")

    def draw(self, plot: figure, *, full: bool) -> None:
        """Add the curves to a figure. Only `full` figures get equipotentials and the numbers of exits."""
        if full:
            self._draw_themed(plot, self._levels, "equipotential", 1.0)
            self._draw_themed(plot, self._critical, "critical_equipotential", 1.5)
        self._draw_themed(plot, self._limit, "limiting_curve", 2.0 if full else 1.0)
        self._exit_lines.expect(plot)
        if full:
            self._exit_numbers.expect(plot)

    def _add_exit_lines(self, plot: figure) -> None:
        plot.add_glyph(self._exits, MultiLine(line_color=self._state.line_colours.halo, line_width=5))
        plot.add_glyph(self._exits, MultiLine(line_color="colour", line_width=3))

    def _add_exit_numbers(self, plot: figure) -> None:
        number = Text(text_color="colour", text_align="center", text_baseline="middle", text_font_size="16px")
        number.text_font_style = "bold"
        plot.add_glyph(self._labels, number)

    def _draw_themed(self, plot: figure, source: ColumnDataSource, name: str, width: float) -> None:
        line = MultiLine(line_color=getattr(self._state.line_colours, name), line_width=width)
        plot.add_glyph(source, line)
        self._themed_glyphs[name].append(line)

    def _follow_theme(self) -> None:
        for name, glyphs in self._themed_glyphs.items():
            for glyph in glyphs:
                glyph.line_color = getattr(self._state.line_colours, name)

    def show(self, spec: MapSpec) -> None:
        """Draw the curves of a map."""
        h, traced = spec.common_energy, trace_curves(spec)
        self._limit.data = _lines(traced.limit)
        orbits = find_lyapunov_orbits(spec.potential, h) if spec.plane.shows_positions and h is not None else ()
        # No data is sent if there were no orbits before.
        if orbits or self._exits.data["xs"]:
            self._show_exits(orbits)
        self._critical.data = _lines(traced.critical)
        self._levels.data = _lines(traced.levels)

    def _show_exits(self, orbits: Sequence[LyapunovOrbit]) -> None:
        if orbits:
            self._exit_lines.draw()
            self._exit_numbers.draw()
        palette = self._state.colours
        colours = [palette.channels[orbit.channel - 1] for orbit in orbits]
        self._exits.data = {**_lines([orbit.half_path for orbit in orbits]), "colour": colours}
        middles = [np.array([orbit.x, orbit.y])[:, orbit.x.size // 4] for orbit in orbits]
        # There are always `MOST_CHANNELS` texts, some without a position: Bokeh fails if texts with own colours become fewer.
        missing = MOST_CHANNELS - len(orbits)
        self._labels.data = {
            "x": [*(EXIT_NUMBER_DISTANCE * point[0] for point in middles), *[np.nan] * missing],
            "y": [*(EXIT_NUMBER_DISTANCE * point[1] for point in middles), *[np.nan] * missing],
            "text": [*(orbit.name for orbit in orbits), *[""] * missing],
            "colour": [*colours, *[palette.bounded] * missing],
        }

    def entries(self, spec: MapSpec) -> list[Entry]:
        """Return the legend entries of the curves of a map."""
        lines = self._state.line_colours
        entries = [Entry(spec.plane.limiting_curve(spec.potential.mass), lines.limiting_curve)]
        if spec.common_energy is not None:
            has_exits = spec.potential.escape_radius is None
            entries += [Entry("escape energy" if has_exits else "through saddles", lines.critical_equipotential)]
            entries += [Entry("others", lines.equipotential)] if has_exits else []
        return entries


def _lines(pieces: list[np.ndarray]) -> dict[str, list[np.ndarray]]:
    return {"xs": [piece[:, 0] for piece in pieces], "ys": [piece[:, 1] for piece in pieces]}
