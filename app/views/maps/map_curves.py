"""Curves over the pictures: limiting curve, equipotentials, and Lyapunov orbits with numbers; and bodies and equilibria."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from bokeh.models import ColumnDataSource, MultiLine, Scatter, Text
from bokeh.plotting import figure

from app.state.view_state import ViewState
from app.views.components.plots import LaterGlyphs, SourcedGlyphs, with_gaps
from app.views.components.theme import theme_colour, theme_line, theme_lines
from engine import LyapunovOrbit, MapSpec, Potential, find_lyapunov_orbits
from engine.slices.limiting_curves import trace_equipotentials, trace_zero_velocity_curve
from engine.systems.outcomes import Centre
from engine.systems.review.energy_ranges import depth_levels
from engine.systems.review.potential_review import critical_energies, review_potential
from plots.browser.browser_system import EXIT_NUMBER_DISTANCE
from plots.pictures.palette import LIGHT, Entry

# Number of maps whose curves are cached.
_CACHED_MAPS = 64
# Energies of the faint equipotentials, as multiples of the depth of the well.
_DEPTH_MULTIPLES = (0.1, 0.3, 0.5, 0.7, 0.9, 1.2, 1.6, 2.2, 3.0)


class TracedCurves(NamedTuple):
    """Lines of the limiting curve, of the equipotentials at critical energies, and of the faint equipotentials."""

    limit: list[np.ndarray]
    critical: list[np.ndarray]
    levels: list[np.ndarray]


class MarkedPlaces(NamedTuple):
    """Places (n, 2) of the bodies, and, if there are any, (m, 2) of the equilibria, such as the Lagrange points."""

    bodies: np.ndarray
    equilibria: np.ndarray


@functools.lru_cache(maxsize=_CACHED_MAPS)
def find_marked_places(potential: Potential) -> MarkedPlaces:
    """Return the bodies and equilibria of a potential, cached. The equilibria are known after its review."""
    bodies = [end.place for end in potential.ends if isinstance(end, Centre)]
    equilibria = review_potential(potential).critical_points if bodies else ()
    places = [(point.x, point.y) for point in equilibria]
    return MarkedPlaces(np.reshape(np.array(bodies), (-1, 2)), np.reshape(np.array(places), (-1, 2)))


@functools.lru_cache(maxsize=_CACHED_MAPS)
def trace_curves(spec: MapSpec) -> TracedCurves:
    """Return the curves of a map, cached. The job of the map calls this first, because tracing takes up to half a second."""
    window = spec.find_window()
    h = spec.common_energy
    if h is None:
        return TracedCurves(trace_zero_velocity_curve(spec.potential, spec.plane, spec.energy, window), [], [])
    critical = critical_energies(spec.potential)
    # The curve V = h is also the limiting curve.
    energies = [h, *critical, *depth_levels(spec.potential, _DEPTH_MULTIPLES)]
    limit, *others = trace_equipotentials(spec.potential, spec.plane, energies, window)
    return TracedCurves(limit, _flatten(others[: len(critical)]), _flatten(others[len(critical) :]))


def _flatten(lines_by_energy: Iterable[Sequence[np.ndarray]]) -> list[np.ndarray]:
    return [line for lines in lines_by_energy for line in lines]


class MapCurves:
    """Draws the curves of a map over any number of pictures.

    Parameters
    ----------
    state
        View state, whose palette has the colours of the exits.
    full
        Whether there are also equipotentials, numbers of exits, bodies and equilibria.
    """

    def __init__(self, state: ViewState, *, full: bool = False) -> None:
        self._state, self._full = state, full
        self._limit_source = ColumnDataSource({"xs": [], "ys": []}, name="zero_velocity_curve")
        self._level_source = ColumnDataSource({"xs": [], "ys": [], "colour": [], "width": []}, name="equipotentials")
        self._exit_source = ColumnDataSource({"xs": [], "ys": [], "colour": []}, name="lyapunov_orbits")
        self._label_source = ColumnDataSource({"x": [], "y": [], "text": []}, name="channel_numbers")
        self._mark_source = ColumnDataSource({"x": [], "y": [], "marker": []}, name="marked_places")
        self._lines, self._exit_lines = LaterGlyphs(self._make_lines), LaterGlyphs(self._make_exit_lines)
        self._exit_numbers, self._marks = LaterGlyphs(self._make_exit_numbers), LaterGlyphs(self._make_marks)
        self._lines.draw()

    def draw(self, plot: figure) -> None:
        """Add the curves to a figure."""
        for glyphs in (self._lines, self._exit_lines, *((self._exit_numbers, self._marks) if self._full else ())):
            glyphs.add_figure(plot)

    def _make_lines(self) -> SourcedGlyphs:
        limit = MultiLine(line_color=theme_line("limiting_curve"), line_width=2.0 if self._full else 1.0)
        levels = MultiLine(line_color=theme_lines("colour", "equipotential", "critical_equipotential"), line_width="width")
        return [*([(self._level_source, levels)] if self._full else []), (self._limit_source, limit)]

    def _make_exit_lines(self) -> SourcedGlyphs:
        styles = ({"line_color": LIGHT.halo, "line_width": 5}, {"line_color": "colour", "line_width": 3})
        return [(self._exit_source, MultiLine(**style)) for style in styles]

    def _make_exit_numbers(self) -> SourcedGlyphs:
        font = {"text_align": "center", "text_baseline": "middle", "text_font_size": "16px", "text_font_style": "bold"}
        return [(self._label_source, Text(text_color=theme_line("text"), **font))]

    def _make_marks(self) -> SourcedGlyphs:
        style = {"line_color": theme_line("limiting_curve"), "fill_color": theme_line("limiting_curve")}
        return [(self._mark_source, Scatter(marker="marker", size=9, **style))]

    def show(self, spec: MapSpec, *, exits: bool = True) -> None:
        """Draw the curves of a map. Without `exits`, nothing is integrated."""
        curves = trace_curves(spec)
        self._limit_source.data = _line_columns([with_gaps(curves.limit)])
        h = spec.common_energy
        orbits = find_lyapunov_orbits(spec.potential, h) if exits and spec.plane.shows_positions and h is not None else ()
        # Without orbits before and now, nothing needs to be sent.
        if orbits or self._exit_source.data["xs"]:
            self._show_exits(orbits)
        if self._full:
            levels = _line_columns([with_gaps(curves.levels), with_gaps(curves.critical)])
            colours = [LIGHT.equipotential, LIGHT.critical_equipotential]
            self._level_source.data = {**levels, "colour": colours, "width": [1.0, 1.5]}

    def show_marks(self, potential: Potential) -> None:
        """Mark the bodies with dots and the equilibria with crosses."""
        bodies, equilibria = find_marked_places(potential)
        if len(bodies) or self._mark_source.data["marker"]:
            self._marks.draw()
            x, y = np.concatenate([bodies, equilibria]).T
            self._mark_source.data = {"x": x, "y": y, "marker": ["circle"] * len(bodies) + ["cross"] * len(equilibria)}

    def _show_exits(self, orbits: Sequence[LyapunovOrbit]) -> None:
        if orbits:
            self._exit_lines.draw()
            self._exit_numbers.draw()
        colours = [self._state.colours.channels[orbit.channel - 1] for orbit in orbits]
        self._exit_source.data = {**_line_columns([orbit.half_path for orbit in orbits]), "colour": colours}
        # An orbit goes along the exit and back, so its middle is after a quarter of the period.
        middles = [np.array([orbit.x, orbit.y])[:, orbit.x.size // 4] for orbit in orbits]
        self._label_source.data = {
            "x": [EXIT_NUMBER_DISTANCE * x for x, _ in middles],
            "y": [EXIT_NUMBER_DISTANCE * y for _, y in middles],
            "text": [orbit.name for orbit in orbits],
        }

    def entries(self, spec: MapSpec) -> list[Entry]:
        """Return the legend entries of the curves of a map."""
        entries = [Entry(spec.plane.limiting_curve(spec.potential.mass), theme_colour("limiting_curve"))]
        if spec.common_energy is not None:
            is_well, has_exits = spec.potential.escapes_over_saddles, bool(spec.potential.channels)
            if has_exits or not is_well:
                entries.append(Entry("escape energy" if has_exits else "through saddles", theme_colour("critical_equipotential")))
            if is_well:
                entries.append(Entry("others", theme_colour("equipotential")))
        return entries


def _line_columns(lines: list[np.ndarray]) -> dict[str, list[np.ndarray]]:
    """Return the columns of lines, each of one style."""
    return {"xs": [line[:, 0] for line in lines], "ys": [line[:, 1] for line in lines]}
