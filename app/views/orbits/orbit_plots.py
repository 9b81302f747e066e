"""Histories of the orbits, which are curves of values against time: a figure for each of `ORBIT_QUANTITIES`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from bokeh.events import DoubleTap, SelectionGeometry
from bokeh.models import (
    BasicTicker,
    BasicTickFormatter,
    BoxSelectTool,
    FixedTicker,
    LinearScale,
    LogScale,
    LogTicker,
    LogTickFormatter,
    MultiLine,
    Patches,
    Range1d,
    Span,
)
from bokeh.plotting import figure

from app.state.view_state import ViewState
from app.views.components.collapsible_section import Build
from app.views.components.orbit_lines import (
    band_columns,
    band_style,
    in_front,
    line_columns,
    line_source,
    line_style,
    opacities,
    orbit_colours,
)
from app.views.components.plots import FigurePane, changing_models, history_figure, moving_line, set_range
from engine import CASES, integrate_orbit, start_states
from engine.slices.planes import SECTION
from plots.pictures.histories import has_log_time
from plots.pictures.orbit_curves import OrbitCurves, compute_orbit_curves
from plots.pictures.orbit_quantities import ORBIT_QUANTITIES, OrbitQuantity
from plots.pictures.palette import THRESHOLD

# The history from which times are read: all histories have the same times.
_FIRST_HISTORY = ORBIT_QUANTITIES[0].name


class OrbitPlots:
    """Draws the histories, each in the colour of its orbit. The functions of `parts` make the figures.

    Parameters
    ----------
    state
        View state, whose palette has the colours of the orbits.
    on_brush
        Shows the interval of time that the user has drawn over a history; None, after a double click, is the whole duration.
    """

    def __init__(self, state: ViewState, on_brush: Callable[[tuple[float, float] | None], None]) -> None:
        self._on_brush = on_brush
        self._state = state
        self._x_range = Range1d(0.1, 1e4)
        self._y_ranges = {quantity.name: Range1d(quantity.least or 0.0, 1.0) for quantity in ORBIT_QUANTITIES}
        self._mapper = orbit_colours(state)
        self._histories = {name: line_source(f"{name}_histories") for name in self._y_ranges}
        self._bands = {name: line_source(f"{name}_bands") for name in self._y_ranges}
        self._plots: dict[str, figure] = {}
        self._time_mark = moving_line("height", location=0.0, line_dash="dotted", visible=False)
        self._orbits: list[tuple[int, OrbitCurves]] = []

    def parts(self) -> list[Build]:
        """Return functions that make the figures, one of each of `ORBIT_QUANTITIES`."""
        return [partial(self._build, quantity) for quantity in ORBIT_QUANTITIES]

    def _build(self, quantity: OrbitQuantity) -> list[FigurePane]:
        events = {SelectionGeometry: self._select_interval, DoubleTap: lambda event: self._on_brush(None)}
        return [FigurePane(self._draw(quantity), events)]

    def show(self, orbits: Sequence[OrbitCurves | None], chosen: int, interval: tuple[float, float] | None = None) -> None:
        """Draw the known orbits and highlight the chosen orbit; None stands for an orbit that is not known yet.

        The axis of time covers `interval`; None is the whole duration.
        """
        self._orbits = in_front(orbits, chosen)
        alphas = opacities(self._orbits, chosen)
        for name in self._y_ranges:
            histories = [curves.histories[name] for _, curves in self._orbits]
            self._histories[name].data = line_columns(self._orbits, [history.line for history in histories], alphas)
            self._bands[name].data = band_columns(self._orbits, [history.outline for history in histories], alphas)
        self._set_ranges(interval)

    def set_time(self, t: float | None) -> None:
        """Mark a time on all histories; None removes the mark."""
        self._time_mark.update(visible=t is not None and bool(self._orbits), location=t or 0.0)

    def _draw(self, quantity: OrbitQuantity) -> figure:
        name, scale = quantity.name, "log" if quantity.logarithmic else "linear"
        time_axis: dict[str, Any] = {"x_axis_type": "log", "x_range": self._x_range}
        value_axis: dict[str, Any] = {"y_axis_type": scale, "y_range": self._y_ranges[name]}
        # With renderers, the tool would change the look of the curves.
        brush = BoxSelectTool(dimensions="width", renderers=[])
        plot = history_figure(name, quantity.title, tools=[brush], **time_axis, **value_axis)
        # With touch input, a drag over a history scrolls the page.
        plot.toolbar.active_drag = None if self._state.touch else brush
        plot.add_glyph(self._bands[name], Patches(**band_style(self._mapper)))
        plot.add_glyph(self._histories[name], MultiLine(**line_style(self._mapper)))
        plot.add_layout(self._time_mark)
        if quantity.ticks:
            plot.yaxis.ticker = FixedTicker(ticks=list(quantity.ticks))
        if quantity.threshold is not None:
            style = {"line_color": THRESHOLD, "line_dash": "dashed", "line_width": 1.5}
            plot.add_layout(Span(location=quantity.threshold, dimension="width", **style))
        self._plots[name] = plot
        self._set_time_scales()
        return plot

    def _select_interval(self, event: SelectionGeometry) -> None:
        begin, end = event.geometry["x0"], event.geometry["x1"]
        if event.final and begin < end:
            self._on_brush((max(begin, 0.0), end))

    def _set_ranges(self, interval: tuple[float, float] | None) -> None:
        """Set the ranges of the axes. The axis of time covers the interval; without an interval, the longest orbit."""
        drawn = [curves for _, curves in self._orbits if curves.histories[_FIRST_HISTORY].line[0].size]
        if not drawn:
            return
        earliest = min(float(curves.histories[_FIRST_HISTORY].line[0][0]) for curves in drawn)
        begin, end = interval or (earliest, max(float(curves.orbit.t[-1]) for curves in drawn))
        if end > earliest:
            set_range(self._x_range, max(begin, earliest), end)
        for quantity in ORBIT_QUANTITIES:
            histories = [curves.histories[quantity.name] for curves in drawn]
            set_range(self._y_ranges[quantity.name], *quantity.limits(histories))
        self._set_time_scales()

    def _set_time_scales(self) -> None:
        """Give the figures linear or logarithmic axes of time, as the range of the time demands."""
        scales = {q.name: has_log_time(self._x_range.end, logarithmic=q.logarithmic) for q in ORBIT_QUANTITIES}
        changed_plots = [plot for name, plot in self._plots.items() if isinstance(plot.x_scale, LogScale) != scales[name]]
        with changing_models(changed_plots):
            for plot in changed_plots:
                is_log = scales[plot.name]
                plot.x_scale = LogScale() if is_log else LinearScale()
                plot.xaxis.ticker = LogTicker() if is_log else BasicTicker()
                plot.xaxis.formatter = LogTickFormatter() if is_log else BasicTickFormatter()


def prepare() -> None:
    """Compute the curves of a long orbit, so that datashader compiles its code now."""
    potential = CASES["III"]
    state = start_states(potential, SECTION, 0.2, np.zeros(1), np.full(1, 0.1))[0]
    compute_orbit_curves(potential, integrate_orbit(potential, state, 5000.0))
