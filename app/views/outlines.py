"""The curves over the pictures: zero-velocity curve, equipotentials, Lyapunov orbits with their channel numbers."""

from __future__ import annotations

import numpy as np
from bokeh.models import ColumnDataSource
from bokeh.plotting import figure

from app import palette
from engine import MapSpec, Plane, find_lyapunov_orbits, trace_equipotentials, trace_zero_velocity_curve

# Energies of the faint equipotentials, in units of the escape energy.
_LEVELS = (0.1, 0.3, 0.5, 0.7, 0.9, 1.2, 1.6, 2.2, 3.0)


class Outlines:
    """Sources of the curves, drawn into any number of figures."""

    def __init__(self) -> None:
        self._limit = ColumnDataSource({"xs": [], "ys": []}, name="zero_velocity_curve")
        self._levels = ColumnDataSource({"xs": [], "ys": []}, name="equipotentials")
        self._critical = ColumnDataSource({"xs": [], "ys": []}, name="critical_equipotential")
        self._exits = ColumnDataSource({"xs": [], "ys": [], "colour": []}, name="lyapunov_orbits")
        self._labels = ColumnDataSource({"x": [], "y": [], "text": [], "colour": []}, name="channel_numbers")

    def draw(self, plot: figure, *, full: bool) -> None:
        """Add the curves to a figure; the equipotentials only when `full`."""
        if full:
            plot.multi_line("xs", "ys", source=self._levels, line_color=palette.EQUIPOTENTIAL)
            plot.multi_line("xs", "ys", source=self._critical, line_color=palette.CRITICAL_EQUIPOTENTIAL, line_width=1.5)
        plot.multi_line("xs", "ys", source=self._limit, line_color=palette.LIMITING_CURVE, line_width=2 if full else 1)
        plot.multi_line("xs", "ys", source=self._exits, line_color=palette.HALO, line_width=5)
        plot.multi_line("xs", "ys", source=self._exits, line_color="colour", line_width=3, line_dash="solid")
        if full:
            plot.text(
                "x", "y", "text", source=self._labels, text_color="colour", text_align="center", text_baseline="middle",
                text_font_size="16px", text_font_style="bold",
            )  # fmt: skip

    def show(self, spec: MapSpec) -> None:
        """The curves of a map's plane, window and energy."""
        energy = 0.0 if isinstance(spec.energy, tuple) else spec.energy
        if spec.plane is Plane.X_H:
            limit, critical, levels = trace_zero_velocity_curve(spec.potential, spec.plane, energy, spec.window), [], []
        else:
            escape = spec.potential.escape_energy
            energies = (energy, escape, *(level * escape for level in _LEVELS))
            limit, critical, *levels = trace_equipotentials(spec.potential, spec.plane, energies, spec.window)
        self._limit.data = _lines(limit)
        self._critical.data = _lines(critical)
        self._levels.data = _lines([line for lines in levels for line in lines])
        self._show_exits(spec, energy)

    def _show_exits(self, spec: MapSpec, energy: float) -> None:
        orbits = find_lyapunov_orbits(spec.potential, energy) if spec.plane is Plane.X_Y else ()
        colours = [palette.CHANNELS[orbit.channel - 1] for orbit in orbits]
        self._exits.data = {**_lines([orbit.half_path for orbit in orbits]), "colour": colours}
        middles = [np.array([orbit.x, orbit.y])[:, orbit.x.size // 4] for orbit in orbits]
        self._labels.data = {
            "x": [0.86 * point[0] for point in middles],
            "y": [0.86 * point[1] for point in middles],
            "text": [str(orbit.channel) for orbit in orbits],
            "colour": colours,
        }

    @staticmethod
    def entries(spec: MapSpec) -> list[palette.Entry]:
        """Legend of the curves that this plane shows."""
        limiting = {Plane.X_Y: "V = h", Plane.X_PX: "½px² + V(x, 0) = h", Plane.X_H: "V(x, 0) = h"}[spec.plane]
        entries = [palette.Entry(f"limiting curve {limiting}", palette.LIMITING_CURVE)]
        if spec.plane is not Plane.X_H:
            entries += [palette.Entry("the same at the escape energy", palette.CRITICAL_EQUIPOTENTIAL)]
            entries += [palette.Entry("at other energies", palette.EQUIPOTENTIAL)]
        if spec.plane is Plane.X_Y:
            entries += [palette.Entry(f"Lyapunov orbit {k}", palette.CHANNELS[k - 1]) for k in _open_channels(spec)]
        return entries


def _open_channels(spec: MapSpec) -> tuple[int, ...]:
    return () if isinstance(spec.energy, tuple) else spec.potential.open_channels(spec.energy)


def _lines(pieces: list[np.ndarray]) -> dict[str, list[np.ndarray]]:
    return {"xs": [piece[:, 0] for piece in pieces], "ys": [piece[:, 1] for piece in pieces]}
