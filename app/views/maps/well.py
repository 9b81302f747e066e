"""The first picture: the well in (x, y) as a relief, with its exits and equipotentials, and the chosen orbits in it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from bokeh.models import ColumnDataSource, ImageRGBA, MultiLine, Range1d, Scatter

from app.state.view_state import ViewState
from app.views.components.orbit_lines import in_front, line_columns, line_source, line_style, opacities, orbit_colours
from app.views.components.plots import FigurePane, LaterGlyphs, PictureTexts, SourcedGlyphs, map_figure, set_range
from app.views.maps.map_curves import MapCurves, trace_curves
from app.views.maps.relief import Relief, shade_relief
from engine import MapSpec, Potential, Window
from engine.slices.axes import highest_energy
from engine.slices.planes import SPACE
from plots.pictures.orbit_curves import OrbitCurves, find_trail, find_well_window
from plots.pictures.palette import LIGHT, MARK_EDGE, Palette
from plots.texts.legends import legend_items

TITLE = "The well in (x, y)"
SKETCH_TITLE = "The well as typed"
SHORT_TITLE = "Well"

# Half of the width of a sketch, in units of the distance of the furthest saddle.
_SKETCH_MARGIN = 1.5
# The line of a long path: none, because an image shows the path.
_NO_LINE = np.zeros(0), np.zeros(0)


def well_spec(potential: Potential, energy: float) -> MapSpec:
    """Return the specification of the map in (x, y) whose curves are the curves of the well."""
    return MapSpec(potential, SPACE, energy, window=find_well_window(potential, energy))


def sketch_spec(potential: Potential, energy: float) -> MapSpec:
    """Return a specification as `well_spec` does, with a window that needs no integration: the saddles and their surroundings."""
    distance = float(np.hypot(*potential.saddles.T).max(initial=0.0)) or potential.units.length
    half = _SKETCH_MARGIN * distance
    return MapSpec(potential, SPACE, energy, window=Window(-half, half, -half, half))


def prepare_sketch(spec: MapSpec) -> MapSpec:
    """Trace the curves and shade the relief of a sketch, which caches keep, and return its specification."""
    trace_curves(spec)
    shade_relief(spec)
    return spec


class WellView:
    """Draws the whole interior at the energy of the map. With an axis h, the energy is the chosen orbit's, or the highest.

    Parameters
    ----------
    state
        View state, whose palette has the colours of exits and orbits.
    write
        Writes the texts around the picture of a name.
    """

    def __init__(self, state: ViewState, write: Callable[[str, PictureTexts], None]) -> None:
        self._state, self._write = state, write
        self._ranges = Range1d(-1.0, 1.0), Range1d(-1.0, 1.0)
        self._line_style = line_style(orbit_colours(state))
        self._paths, self._trails = line_source("paths"), line_source("trails")
        self._paths.data["colour"] = []
        # Density images of long paths.
        self._shades = ColumnDataSource({name: [] for name in ("image", "x", "y", "dw", "dh", "alpha")}, name="shades")
        self._points = ColumnDataSource({"x": [], "y": [], "slot": []}, name="points")
        self._outlines = MapCurves(state, full=True)
        self._spec: MapSpec | None = None
        # A potential without exits that is drawn in place of the map's.
        self._sketch: MapSpec | None = None
        self._given_orbits: tuple[Sequence[OrbitCurves | None], int] = (), 0
        self._orbits: list[tuple[int, OrbitCurves]] = []
        self._time: float | None = None
        # Map and palette of the drawn curves. Maps of other windows, and most orbits, need no new curves.
        self._outline_key: tuple[MapSpec, Palette] | None = None
        self.plot = map_figure("well", TITLE, *self._ranges)
        self._relief = Relief(self.plot)
        self._outlines.draw(self.plot)
        self._orbit_glyphs = LaterGlyphs(self._make_orbits)
        self._orbit_glyphs.add_figure(self.plot)
        self.pane = FigurePane(self.plot)
        state.param.watch(lambda event: self._outline(), "palette")

    def _make_orbits(self) -> SourcedGlyphs:
        """Return the glyphs of paths, trails and points."""
        style = self._line_style
        return [
            (self._shades, ImageRGBA(dw="dw", dh="dh", global_alpha="alpha")),
            (self._paths, MultiLine(**style | {"line_color": "colour"})),
            (self._trails, MultiLine(line_color=LIGHT.halo, line_width=5, line_alpha=0.7)),
            (self._trails, MultiLine(**style | {"line_width": 2.5})),
            (self._points, Scatter(size=11, fill_color=style["line_color"], line_color=MARK_EDGE, line_width=1.5)),
        ]

    def show_map(self, spec: MapSpec) -> None:
        """Show the well at the energy of a map."""
        self._spec = spec
        if self._sketch is not None and self._sketch.potential == spec.potential:
            self.show_sketch(None)
        self._outline()

    def show_sketch(self, sketch: MapSpec | None) -> None:
        """Show a potential in place of the map's, without orbits and exits, until a map has this potential; None ends that."""
        if sketch != self._sketch:
            self._sketch = sketch
            self.show_orbits(*self._given_orbits)
            self._outline()

    def show_orbits(self, orbits: Sequence[OrbitCurves | None], chosen: int) -> None:
        """Draw the known orbits in the well of the chosen orbit, which is highlighted; None stands for an unknown orbit."""
        self._given_orbits = orbits, chosen
        if self._sketch is not None:
            orbits = ()
        if chosen < len(orbits) and (chosen_orbit := orbits[chosen]) is not None:
            well = chosen_orbit.orbit.potential
            orbits = [each if each is not None and each.orbit.potential == well else None for each in orbits]
        if not any(orbits) and not self._orbits:
            return
        self._orbit_glyphs.draw()
        self._orbits = in_front(orbits, chosen)
        alphas = opacities(self._orbits, chosen)
        path_lines = [_NO_LINE if one.visits is not None else one.path for _, one in self._orbits]
        colours = [self._path_colour(slot, one) for slot, one in self._orbits]
        self._paths.data = line_columns(self._orbits, path_lines, alphas) | {"colour": colours}
        long_paths = [(slot, one) for slot, one in self._orbits if one.visits is not None]
        self._shades.data = {
            "image": [one.shaded(self._path_colour(slot, one)) for slot, one in long_paths],
            "x": [one.window.x_low for _, one in long_paths],
            "y": [one.window.ordinate_low for _, one in long_paths],
            "dw": [one.window.width for _, one in long_paths],
            "dh": [one.window.height for _, one in long_paths],
            "alpha": opacities(long_paths, chosen),
        }
        self._outline()
        self.set_time(self._time)

    def _path_colour(self, slot: int, curves: OrbitCurves) -> str:
        return self._state.colours.path_colour(curves.orbit.fate, curves.orbit.outcomes, slot)

    def set_time(self, t: float | None) -> None:
        """Mark each orbit at a time, with its trail; None marks the starts."""
        self._time = t
        trails = [(slot, find_trail(one.orbit, 0.0 if t is None else t)) for slot, one in self._orbits]
        slots = [slot for slot, _ in trails]
        self._points.data = {"x": [trail.x[-1] for _, trail in trails], "y": [trail.y[-1] for _, trail in trails], "slot": slots}
        trail_lines = {"xs": [trail.x for _, trail in trails], "ys": [trail.y for _, trail in trails]}
        self._trails.data = {**trail_lines, "slot": slots, "alpha": [1.0] * len(slots)}

    def describe(self) -> None:
        """Write title, legend and names of the axes."""
        if self._outline_key is not None:
            spec, _ = self._outline_key
            title = TITLE if self._sketch is None else SKETCH_TITLE
            legend = legend_items(self._outlines.entries(spec))
            self._write("well", PictureTexts(title, SHORT_TITLE, spec.plane.axis_symbols, legend))

    def _outline(self) -> None:
        """Draw the curves of the well, unless they are already drawn."""
        spec = self._sketch or self._spec
        if spec is None:
            return
        # The chosen orbit is the last.
        chosen = self._orbits[-1][1] if self._orbits else None
        potential, energy = spec.potential, highest_energy(spec.energy)
        if chosen is not None and (spec.common_energy is None or spec.plane.parameter is not None):
            # On a slice of several energies or potentials, the chosen orbit determines the well.
            potential, energy = chosen.orbit.potential or potential, chosen.orbit.energy
        outlined_spec = self._sketch or well_spec(potential, energy)
        if (outlined_spec, self._state.colours) == self._outline_key:
            return
        self._outline_key = outlined_spec, self._state.colours
        self._relief.show(outlined_spec)
        self._outlines.show(outlined_spec, exits=self._sketch is None)
        self._outlines.show_marks(outlined_spec.potential)
        self._go_to(outlined_spec.find_window())
        self.describe()

    def _go_to(self, window: Window) -> None:
        x, y = self._ranges
        set_range(x, window.x_low, window.x_high)
        set_range(y, window.ordinate_low, window.ordinate_high)
