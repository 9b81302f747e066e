"""The chosen orbits, each in its colour: paths over the zero-velocity curve, SALI(t), R²(t), Lyapunov exponent."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from bokeh.events import DoubleTap, SelectionGeometry
from bokeh.models import (
    BasicTickFormatter,
    BoxSelectTool,
    ColumnDataSource,
    ImageRGBA,
    LinearColorMapper,
    MultiLine,
    Range1d,
    Scatter,
    Span,
)
from bokeh.plotting import figure

from app.views.components.curve_layers import CurveLayers
from app.views.components.plots import FigurePane, set_decades, set_range, square_figure
from engine import CASES, CHAOS_THRESHOLD, MapSpec, Potential, integrate_orbit, start_states
from engine.service import SECTION, SPACE, format_number
from plots.orbit_curves import LEAST_SALI, OrbitCurves, compute_orbit_curves, moment
from plots.palette import LIGHT, MARK_EDGE, PAPER, THRESHOLD, Palette

TITLES = {
    "path": "The orbits",
    "sali": f"SALI (chaotic at or below {format_number(CHAOS_THRESHOLD)})",
    "r2": "R² = x² + y²",
    "exponent": "Lyapunov exponent until t",
}
_HISTORIES = ("sali", "exponent", "r2")
_OTHERS_ALPHA = 0.35
_NO_LINE = np.zeros(0), np.zeros(0)


class OrbitPlots:
    """Four figures of the orbits; `build` makes them when there is an orbit to draw.

    Parameters
    ----------
    on_brush
        Called with the interval of time that is drawn over a history; None, after a double click, is the whole duration.
    """

    def __init__(self, on_brush: Callable[[tuple[float, float] | None], None]) -> None:
        self._on_brush = on_brush
        self._by_touch = False
        self._place = Range1d(-1.0, 1.0), Range1d(-1.0, 1.0)
        self._times, self._sali, self._exponents = Range1d(0.1, 10.0), Range1d(LEAST_SALI, 10.0), Range1d(1e-4, 10.0)
        self._r2_times, self._r2 = Range1d(0.0, 10.0), Range1d(0.0, 1.0)
        self._mapper = LinearColorMapper(low=-0.5, high=len(PAPER.orbits) - 0.5)
        self._paths, self._histories = _lines("paths"), {name: _lines(f"{name}_histories") for name in _HISTORIES}
        self._shades = ColumnDataSource({name: [] for name in ("image", "x", "y", "dw", "dh")}, name="shades")
        self._points = ColumnDataSource({"x": [], "y": [], "slot": []}, name="points")
        self._trails = _lines("trails")
        self.outlines = CurveLayers()
        self._now = Span(location=0.0, dimension="height", line_color=MARK_EDGE, line_dash="dotted", visible=False)
        self._drawings: list[tuple[int, OrbitCurves]] = []
        self._palette = PAPER
        # What the outlines are drawn for, as several orbits share them.
        self._outlined: tuple[Potential, float, Palette] | None = None
        self.set_palette(PAPER)

    def build(self) -> list[FigurePane]:
        """Make the figures: path, SALI, R² and Lyapunov exponent."""
        events = {SelectionGeometry: self._brushed, DoubleTap: lambda event: self._on_brush(None)}
        return [FigurePane(self._draw_path()), *(FigurePane(plot, events) for plot in self._draw_histories())]

    def begin_touch(self) -> None:
        """The page is used by touch: dragging over a history scrolls the page."""
        self._by_touch = True

    def show(self, drawings: Sequence[OrbitCurves | None], chosen: int, interval: tuple[float, float] | None = None) -> None:
        """Draw orbits, highlighting the chosen one; None for orbits that are not known yet.

        The histories extend over `interval`; None is the whole duration.
        """
        self._drawings = [(slot, drawing) for slot, drawing in enumerate(drawings) if drawing is not None]
        # The chosen one is drawn last, over the others.
        self._drawings.sort(key=lambda item: item[0] == chosen)
        alphas = [1.0 if slot == chosen else _OTHERS_ALPHA for slot, _ in self._drawings]
        for name in _HISTORIES:
            self._histories[name].data = self._columns([getattr(drawing, name) for _, drawing in self._drawings], alphas)
        self._show_paths(alphas)
        self._scale_times(interval)

    def set_time(self, t: float | None) -> None:
        """Mark the position of each orbit at a time, with its trail; None removes the marks."""
        moments = [(slot, moment(drawing.orbit, t)) for slot, drawing in self._drawings] if t is not None else []
        slots = [slot for slot, _ in moments]
        self._points.data = {"x": [now.x[-1] for _, now in moments], "y": [now.y[-1] for _, now in moments], "slot": slots}
        trails = {"xs": [now.x for _, now in moments], "ys": [now.y for _, now in moments]}
        self._trails.data = {**trails, "slot": slots, "alpha": [1.0] * len(slots)}
        self._now.update(visible=bool(moments), location=t or 0.0)

    def set_palette(self, palette: Palette) -> None:
        """Set the colours of the orbits."""
        self._palette = palette
        self._mapper.palette = list(palette.orbits)
        self.outlines.set_palette(palette)

    def _style(self) -> dict[str, Any]:
        return {"line_color": {"field": "slot", "transform": self._mapper}, "line_alpha": "alpha", "line_width": 1.5}

    def _draw_path(self) -> figure:
        x, y = self._place
        path = square_figure("path", TITLES["path"], x_axis_label="x", y_axis_label="y", x_range=x, y_range=y)
        style = self._style()
        self.outlines.draw(path, full=False)
        path.add_glyph(self._shades, ImageRGBA(dw="dw", dh="dh"))
        path.add_glyph(self._paths, MultiLine(**style))
        path.add_glyph(self._trails, MultiLine(line_color=LIGHT.halo, line_width=5, line_alpha=0.7))
        path.add_glyph(self._trails, MultiLine(**style | {"line_width": 2.5}))
        path.add_glyph(self._points, Scatter(size=11, fill_color=style["line_color"], line_color=MARK_EDGE, line_width=1.5))
        return path

    def _draw_histories(self) -> list[figure]:
        log: dict[str, Any] = {"x_axis_type": "log", "y_axis_type": "log", "x_range": self._times}
        axes: dict[str, dict[str, Any]] = {
            "sali": {"y_axis_label": "SALI", "y_range": self._sali, **log},
            "r2": {"y_axis_label": "R²", "x_range": self._r2_times, "y_range": self._r2},
            "exponent": {"y_axis_label": "(1/t) ln|w|", "y_range": self._exponents, **log},
        }
        plots = {
            name: square_figure(name, TITLES[name], x_axis_label="t", tools=[_brush()], **options)
            for name, options in axes.items()
        }
        for name, plot in plots.items():
            plot.toolbar.active_drag = None if self._by_touch else plot.toolbar.tools[0]
            plot.add_glyph(self._histories[name], MultiLine(**self._style()))
            plot.add_layout(self._now)
        plots["r2"].xaxis.formatter = BasicTickFormatter(use_scientific=False)
        plots["r2"].xaxis.ticker.desired_num_ticks = 4
        threshold = Span(location=CHAOS_THRESHOLD, dimension="width", line_color=THRESHOLD, line_dash="dashed", line_width=1.5)
        plots["sali"].add_layout(threshold)
        return list(plots.values())

    def _brushed(self, event: SelectionGeometry) -> None:
        begin, end = event.geometry["x0"], event.geometry["x1"]
        if event.final and begin < end:
            self._on_brush((max(begin, 0.0), end))

    def _scale_times(self, interval: tuple[float, float] | None) -> None:
        """Set the time axes: to the interval, or that of SALI by the longest orbit and that of R² by the chosen one."""
        if not self._drawings:
            return
        everything = [drawing for _, drawing in self._drawings]
        latest = max(float(drawing.orbit.t[-1]) for drawing in everything)
        earliest = min((float(drawing.sali[0][0]) for drawing in everything if drawing.sali[0].size), default=0.1)
        widest = max((float(drawing.r2[1].max()) for drawing in everything if drawing.r2[1].size), default=1.0)
        if latest > earliest:
            set_range(self._times, earliest, latest)
            ends = [drawing.exponent[1] for drawing in everything if drawing.exponent[1].size]
            if ends:
                set_decades(self._exponents, min(float(end[-1]) for end in ends), 1.0)
        set_range(self._r2, 0.0, 1.05 * widest or 1.0)
        begin, end = interval or (0.0, float(everything[-1].orbit.t[-1]) or 1.0)
        set_range(self._r2_times, begin, end)
        if interval is not None:
            set_range(self._times, max(begin, earliest), end)

    def _show_paths(self, alphas: list[float]) -> None:
        if not self._drawings:
            self._paths.data, self._shades.data = self._columns([], []), {name: [] for name in self._shades.data}
            return
        drawn = self._drawings[-1][1]
        window, (x, y) = drawn.window, self._place
        orbit = drawn.orbit
        assert orbit.potential is not None
        outlined = (orbit.potential, orbit.energy, self._palette)
        if outlined != self._outlined:
            self.outlines.show(MapSpec(orbit.potential, SPACE, orbit.energy, window=window))
            self._outlined = outlined
        for edges, low, high in ((x, window.x_low, window.x_high), (y, window.ordinate_low, window.ordinate_high)):
            set_range(edges, low, high)
        lines = [_NO_LINE if one.visits is not None else one.path for _, one in self._drawings]
        self._paths.data = self._columns(lines, alphas)
        images = [one.shaded(self._palette.orbits[slot]) for slot, one in self._drawings if one.visits is not None]
        place = {"x": window.x_low, "y": window.ordinate_low, "dw": window.x_high - window.x_low}
        place["dh"] = window.ordinate_high - window.ordinate_low
        self._shades.data = {"image": images, **{name: [value] * len(images) for name, value in place.items()}}

    def _columns(self, lines: list[tuple[np.ndarray, np.ndarray]], alphas: list[float]) -> dict[str, list[object]]:
        slots: list[object] = [slot for slot, _ in self._drawings]
        xs, ys = ([line[axis].astype(np.float32) for line in lines] for axis in (0, 1))
        return {"xs": [*xs], "ys": [*ys], "slot": slots, "alpha": [*alphas]}


def prepare() -> None:
    """Draw a long path once, so that datashader compiles its code."""
    potential = CASES["III"]
    state = start_states(potential, SECTION.plane, 0.2, np.zeros(1), np.full(1, 0.1))[0]
    compute_orbit_curves(potential, integrate_orbit(potential, state, 5000.0))


def _brush() -> BoxSelectTool:
    """A tool to draw an interval of time; without renderers the curves keep their look."""
    return BoxSelectTool(dimensions="width", renderers=[])


def _lines(name: str) -> ColumnDataSource:
    return ColumnDataSource({"xs": [], "ys": [], "slot": [], "alpha": []}, name=name)
