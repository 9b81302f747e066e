"""The picture of a link, drawn with Matplotlib for chats and social networks: the basins of escape beside the well."""

from __future__ import annotations

import textwrap

from matplotlib.figure import Figure

from engine import EscapeMap
from engine.results.wording import format_number, format_time
from engine.slices.energies import highest_energy
from plots.figure_axes import RENDER_LOCK, save_figure
from plots.figure_style import SCREEN, FigureFormat
from plots.map_figure import draw_limits, draw_pixels
from plots.map_images import picture_pixels
from plots.orbit_curves import find_well_window
from plots.palette import LIGHT, Palette
from plots.potential_figure import draw_well

WIDTH, HEIGHT = 1200, 630
"""Size in pixels, the one that they ask for."""

# Shares of the width: the map is a square as high as the picture.
_MAP = HEIGHT / WIDTH
_TEXT, _RIGHT = _MAP + 0.035, 0.965
# Shares of the height.
_TITLE, _WELL, _WELL_HEIGHT, _NOTE = 0.95, 0.1, 0.65, 0.03
# Of the title; what is longer is cut.
_LETTERS, _LINES = 29, 2


def link_picture_bytes(frame: EscapeMap, title: str, palette: Palette) -> bytes:
    """PNG file of `draw_link_picture`."""
    with RENDER_LOCK:
        return save_figure(draw_link_picture(frame, title, palette), FigureFormat.PNG, {})


def draw_link_picture(frame: EscapeMap, title: str, palette: Palette) -> Figure:
    """Draw the picture of a map, `WIDTH` × `HEIGHT` pixels at the resolution of `SCREEN`.

    Parameters
    ----------
    frame
        The map, complete.
    title
        Name of the system.
    palette
        Colours.
    """
    figure = Figure(figsize=(WIDTH / SCREEN.dpi, HEIGHT / SCREEN.dpi), dpi=SCREEN.dpi)
    _draw_map(figure, frame, palette)
    _draw_well(figure, frame, palette)
    spec = frame.spec
    energy = "" if spec.common_energy is None else f" at h = {format_number(spec.common_energy, 6)}"
    name = textwrap.fill(title, _LETTERS, max_lines=_LINES, placeholder=" …")
    _write(figure, _TITLE, f"{name}\n{spec.plane.title}{energy}", SCREEN.font_size, "top")
    note = f"Coloured: the exit of the orbit. Grey: none up to t = {format_time(spec.t_max)}."
    _write(figure, _NOTE, note, SCREEN.small_size - 3.0, "bottom")
    return figure


def _write(figure: Figure, height: float, text: str, size: float, edge: str) -> None:
    figure.text(_TEXT, height, text, fontsize=size, va=edge, color=LIGHT.text, linespacing=1.3, parse_math=False)


def _draw_map(figure: Figure, frame: EscapeMap, palette: Palette) -> None:
    spec, window = frame.spec, frame.spec.find_window()
    axes = figure.add_axes((0.0, 0.0, _MAP, 1.0))
    draw_pixels(axes, picture_pixels(frame, "basins", palette), window, window)
    draw_limits(axes, spec.potential, spec.plane, spec.energy, window, palette.channels)
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.0)
    axes.set_axis_off()


def _draw_well(figure: Figure, frame: EscapeMap, palette: Palette) -> None:
    potential, energy = frame.spec.potential, highest_energy(frame.spec.energy)
    window = find_well_window(potential, energy)
    axes = figure.add_axes((_TEXT, _WELL, _RIGHT - _TEXT, _WELL_HEIGHT))
    draw_well(axes, potential, energy, window, palette)
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.0)
    axes.set_box_aspect((window.ordinate_high - window.ordinate_low) / (window.x_high - window.x_low))
    axes.set_axis_off()
