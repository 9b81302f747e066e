"""Picture of an orbit: its path between the exits, SALI and R² against time."""

from __future__ import annotations

import textwrap

from engine import Orbit, Potential
from plots.figure_axes import SMALL, new_figure, save_figure, software
from plots.orbit_curves import compute_orbit_curves, initial_state
from plots.orbit_figure import draw_path, draw_r2, draw_sali
from plots.palette import LIGHT, Palette

_LINE_LENGTH = 160


def orbit_png(potential: Potential, orbit: Orbit, palette: Palette, verdict: str) -> bytes:
    """PNG file of an orbit: path on the left, SALI and R² on the right; `verdict` below and in the metadata."""
    curves, colour = compute_orbit_curves(potential, orbit), palette.orbits[0]
    figure = new_figure(11.5, 5.9, f"Orbit at h = {orbit.energy:.6g}")
    panels = figure.subplot_mosaic([["path", "sali"], ["path", "r2"]])
    draw_path(panels["path"], potential, curves, palette)
    draw_sali(panels["sali"], curves, colour)
    draw_r2(panels["r2"], curves, colour)
    figure.supxlabel(textwrap.fill(verdict, _LINE_LENGTH), fontsize=SMALL, color=LIGHT.text)
    start = ", ".join(map(repr, initial_state(orbit)))
    about = {"potential": potential.name, "energy": repr(orbit.energy), "start": start, "verdict": verdict}
    return save_figure(figure, "png", {"Software": software(), **about})
