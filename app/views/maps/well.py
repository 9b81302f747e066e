"""The first picture: the well in (x, y) with its exits and equipotentials, and the chosen orbits in it."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from bokeh.models import ColumnDataSource, ImageRGBA, LinearColorMapper, MultiLine, Range1d, Scatter

from app.views.components.legends import legend_items
from app.views.components.orbit_lines import in_front, line_columns, line_style, lines, opacities
from app.views.components.plots import FigurePane, annotate_picture, batched_additions, map_figure, set_range
from app.views.maps.curve_layers import CurveLayers
from engine import MapSpec, Potential, Window
from engine.slices.axes import highest_energy
from engine.slices.planes import SPACE
from plots.pictures.orbit_curves import OrbitCurves, find_well_window, moment
from plots.pictures.palette import LIGHT, MARK_EDGE, PAPER, Palette

TITLE = "The well in (x, y)"

# The line of a long path: none, because an image shows the path.
_NO_LINE = np.zeros(0), np.zeros(0)


def well_spec(potential: Potential, energy: float) -> MapSpec:
    """Return the specification of the map in (x, y) whose curves are the curves of the well."""
    return MapSpec(potential, SPACE, energy, window=find_well_window(potential, energy))


class WellView:
    """Draws the whole interior at the energy of the map. With an axis h, the energy is the chosen orbit's, or the highest."""

    def __init__(self) -> None:
        self._ranges = Range1d(-1.0, 1.0), Range1d(-1.0, 1.0)
        self._mapper = LinearColorMapper(palette=list(PAPER.orbits), low=-0.5, high=len(PAPER.orbits) - 0.5)
        self._paths, self._trails = lines("paths"), lines("trails")
        self._shades = ColumnDataSource({name: [] for name in ("image", "x", "y", "dw", "dh", "alpha")}, name="shades")
        self._points = ColumnDataSource({"x": [], "y": [], "slot": []}, name="points")
        self.outlines = CurveLayers()
        self._palette = PAPER
        self._spec: MapSpec | None = None
        self._orbits: list[tuple[int, OrbitCurves]] = []
        self._time: float | None = None
        self._has_orbits = False
        # Map and palette of the drawn curves. Maps of other windows, and most orbits, need no new curves.
        self._outline_key: tuple[MapSpec, Palette] | None = None
        self.plot = map_figure("well", TITLE, *self._ranges)
        self.outlines.draw(self.plot, full=True)
        self.pane = FigurePane(self.plot)

    def _draw_orbits(self) -> None:
        """Add the glyphs of paths, trails and points to the figure."""
        style = line_style(self._mapper)
        with batched_additions([self.plot]):
            self.plot.add_glyph(self._shades, ImageRGBA(dw="dw", dh="dh", global_alpha="alpha"))
            self.plot.add_glyph(self._paths, MultiLine(**style))
            self.plot.add_glyph(self._trails, MultiLine(line_color=LIGHT.halo, line_width=5, line_alpha=0.7))
            self.plot.add_glyph(self._trails, MultiLine(**style | {"line_width": 2.5}))
            point = Scatter(size=11, fill_color=style["line_color"], line_color=MARK_EDGE, line_width=1.5)
            self.plot.add_glyph(self._points, point)

    def set_palette(self, palette: Palette) -> None:
        """Set the colours of exits and orbits."""
        self._palette = palette
        self._mapper.palette = list(palette.orbits)
        self.outlines.set_palette(palette)
        self._outline()

    def show_map(self, spec: MapSpec) -> None:
        """Show the well of a map."""
        self._spec = spec
        self._outline()

    def show_orbits(self, orbits: Sequence[OrbitCurves | None], chosen: int) -> None:
        """Draw the known orbits in the well of the chosen orbit, which is highlighted; None stands for an unknown orbit."""
        if chosen < len(orbits) and (chosen_orbit := orbits[chosen]) is not None:
            well = chosen_orbit.orbit.potential
            orbits = [each if each is not None and each.orbit.potential == well else None for each in orbits]
        if not any(orbits) and not self._orbits:
            return
        if not self._has_orbits:
            self._has_orbits = True
            self._draw_orbits()
        self._orbits = in_front(orbits, chosen)
        alphas = opacities(self._orbits, chosen)
        path_lines = [_NO_LINE if one.visits is not None else one.path for _, one in self._orbits]
        self._paths.data = line_columns(self._orbits, path_lines, alphas)
        long_paths = [(slot, one) for slot, one in self._orbits if one.visits is not None]
        self._shades.data = {
            "image": [one.shaded(self._palette.orbits[slot]) for slot, one in long_paths],
            "x": [one.window.x_low for _, one in long_paths],
            "y": [one.window.ordinate_low for _, one in long_paths],
            "dw": [one.window.x_high - one.window.x_low for _, one in long_paths],
            "dh": [one.window.ordinate_high - one.window.ordinate_low for _, one in long_paths],
            "alpha": opacities(long_paths, chosen),
        }
        self._outline()
        self.set_time(self._time)

    def set_time(self, t: float | None) -> None:
        """Mark each orbit at a time, with its trail; None marks the starts."""
        self._time = t
        moments = [(slot, moment(one.orbit, 0.0 if t is None else t)) for slot, one in self._orbits]
        slots = [slot for slot, _ in moments]
        self._points.data = {"x": [now.x[-1] for _, now in moments], "y": [now.y[-1] for _, now in moments], "slot": slots}
        trails = {"xs": [now.x for _, now in moments], "ys": [now.y for _, now in moments]}
        self._trails.data = {**trails, "slot": slots, "alpha": [1.0] * len(slots)}

    def describe(self) -> None:
        """Write title, legend and names of the axes around the frame."""
        if self._outline_key is not None:
            spec = self._outline_key[0]
            annotate_picture(self.plot, TITLE, spec.plane.axis_symbols, legend_items(self.outlines.entries(spec)))

    def _outline(self) -> None:
        """Draw the curves of the well, unless they are already drawn."""
        spec = self._spec
        if spec is None:
            return
        # The chosen orbit is the last.
        chosen = self._orbits[-1][1] if self._orbits else None
        potential, energy = spec.potential, highest_energy(spec.energy)
        if chosen is not None and (spec.common_energy is None or spec.plane.parameter is not None):
            # On a slice of several energies or potentials, the chosen orbit determines the well.
            potential, energy = chosen.orbit.potential or potential, chosen.orbit.energy
        key = well_spec(potential, energy), self._palette
        if key == self._outline_key:
            return
        self._outline_key = key
        self.outlines.show(key[0])
        self._go_to(key[0].find_window())
        self.describe()

    def _go_to(self, window: Window) -> None:
        x, y = self._ranges
        set_range(x, window.x_low, window.x_high)
        set_range(y, window.ordinate_low, window.ordinate_high)
