"""Make movies of many orbits that leave the well, with a chart of the share inside."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import rc_context
from matplotlib.animation import AbstractMovieWriter, FFMpegWriter, PillowWriter
from matplotlib.axes import Axes
from matplotlib.collections import PathCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.ticker import LogLocator

from engine import Fate, Potential, compute_flux
from engine.foundations.extras import require_package
from engine.foundations.wording import format_number
from engine.results import SampledOrbits
from plots.pictures.orbit_curves import find_well_window
from plots.pictures.palette import LIGHT, Palette
from plots.printed.figure_axes import RENDER_LOCK, new_figure, set_font, style_axes
from plots.printed.figure_style import FigureStyle, MovieFormat
from plots.printed.potential_figure import draw_well
from plots.printed.window_axes import show_window

FRAMES_PER_SECOND = 25
"""Frames per second of all movies."""

# Height of the figure in units of its width.
_HEIGHT = 0.55
# Area of a particle in square points.
_PARTICLE_AREA = 3.0
# Lower end of the axis of shares, in units of the share of one orbit.
_LEAST_SHARE = 0.5
# Dashes of the exponential law for motion that mixes.
_LAW_DASHES = (0, (4, 3))


@dataclass(frozen=True)
class _Stage:
    """The figure, and the artists that change from frame to frame."""

    figure: Figure
    particles: PathCollection
    survival_line: Line2D
    count_title: Text


def make_ensemble_movie(
    potential: Potential, orbits: SampledOrbits, palette: Palette, format: MovieFormat, style: FigureStyle
) -> bytes:
    """Return the content of the file of a movie, with one frame for each of the common times of the orbits.

    Parameters
    ----------
    potential
        The potential of the orbits.
    orbits
        Orbits of one energy, at common times.
    palette
        Colours of the orbits: of the exits through which they leave, or of bounded orbits.
    format
        File format. MP4 needs the extra ``movies``.
    style
        Width, resolution and font size.

    Raises
    ------
    ModuleNotFoundError
        If the encoder of MP4 is not installed.
    """
    with tempfile.TemporaryDirectory() as folder, RENDER_LOCK, _encoder_settings(format):
        path = Path(folder, f"movie.{format}")
        stage = _draw_stage(potential, orbits, palette, style)
        writer = _make_writer(format)
        with writer.saving(stage.figure, str(path), style.dpi):
            for index in range(orbits.t.shape[1]):
                _show_frame(stage, orbits, index)
                writer.grab_frame()
        return path.read_bytes()


def _encoder_settings(format: MovieFormat) -> Any:
    """Return a context with Matplotlib's settings for the encoder of a format."""
    if format is not MovieFormat.MP4:
        return rc_context()
    require_package("imageio_ffmpeg", "movies")
    import imageio_ffmpeg

    return rc_context({"animation.ffmpeg_path": imageio_ffmpeg.get_ffmpeg_exe()})


def _make_writer(format: MovieFormat) -> AbstractMovieWriter:
    writer_class = FFMpegWriter if format is MovieFormat.MP4 else PillowWriter
    return writer_class(fps=FRAMES_PER_SECOND, metadata={"title": "Escape Explorer"})


def _draw_stage(potential: Potential, orbits: SampledOrbits, palette: Palette, style: FigureStyle) -> _Stage:
    energy = float(orbits.energy[0])
    figure = new_figure(style, _HEIGHT * style.width, f"{potential.name}, h = {format_number(energy, 6)}")
    well_axes, chart_axes = figure.subplots(1, 2, width_ratios=[1.15, 1.0])
    window = find_well_window(potential, energy)
    draw_well(well_axes, potential, energy, window, palette)
    show_window(well_axes, window, "x", "y", style, equal=True)
    count_title = well_axes.set_title(" ", loc="left", fontsize=style.font_size, color=LIGHT.text)
    colours = [palette.entry(max(fate, Fate.BOUNDED), orbits.outcomes).colour for fate in orbits.fate.tolist()]
    particles = well_axes.scatter(
        np.zeros(len(colours)), np.zeros(len(colours)), s=_PARTICLE_AREA, c=colours, linewidths=0, zorder=3
    )
    survival_line = _draw_chart(chart_axes, potential, orbits, style)
    set_font(figure)
    # One layout is enough, because the axes do not move between frames.
    figure.draw_without_rendering()
    figure.set_layout_engine("none")
    return _Stage(figure, particles, survival_line, count_title)


def _draw_chart(axes: Axes, potential: Potential, orbits: SampledOrbits, style: FigureStyle) -> Line2D:
    """Draw the chart of the share inside, and its exponential law, at the rate flux over volume, for motion that mixes.

    Return the line that `_show_frame` extends.
    """
    last_time = float(orbits.t[0, -1])
    least_share = _LEAST_SHARE / len(orbits.fate)
    times = np.linspace(0.0, last_time, 200)
    rate = compute_flux(potential, float(orbits.energy[0])).decay_rate
    axes.plot(times, np.exp(-rate * times), color=LIGHT.quiet, linewidth=1.0, linestyle=_LAW_DASHES, label="flux over volume")
    (survival,) = axes.plot([], [], color=LIGHT.text, linewidth=1.5, drawstyle="steps-post", label="share inside")
    axes.set_yscale("log")
    axes.set_xlim(0.0, last_time)
    axes.set_ylim(max(least_share, 0.5 * np.exp(-rate * last_time)), 1.2)
    axes.yaxis.set_major_locator(LogLocator())
    style_axes(axes, style, grid=True, labels=("t", "share inside"), title="Share still inside")
    axes.legend(loc="upper right", fontsize=style.small_size, frameon=False)
    return survival


def _show_frame(stage: _Stage, orbits: SampledOrbits, index: int) -> None:
    """Show the orbits at the time with this index."""
    t = float(orbits.t[0, index])
    stage.particles.set_offsets(np.column_stack([orbits.x[:, index], orbits.y[:, index]]))
    escape_times = np.sort(orbits.escape_time[orbits.fate > Fate.BOUNDED])
    past_times = escape_times[escape_times <= t]
    count = len(orbits.fate)
    shares = np.concatenate([[1.0], 1.0 - np.arange(1, len(past_times) + 1) / count])
    stage.survival_line.set_data(np.concatenate([[0.0], past_times, [t]]), np.append(shares, shares[-1]))
    stage.count_title.set_text(f"t = {t:.1f}: {count - len(past_times)} of {count} inside")
