"""A map in the axes of a figure: its pixels as on the page, its limiting curve, its exits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure

from app.rendering.image_columns import longest_typical_time
from app.rendering.map_analyses import NO_ANALYSES, MapAnalyses
from app.rendering.map_images import SHORTEST_TIME, picture_pixels, time_colours
from app.rendering.palette import PAPER
from engine import EscapeMap, Fate, Plane, Window, find_lyapunov_orbits, trace_zero_velocity_curve
from reproduction.printing import EXIT, LIMIT, ORDINATES, label_axes, tidy_axes


def draw_map(
    axes: Axes, frame: EscapeMap, picture: str, longest: float | None = None, findings: MapAnalyses = NO_ANALYSES
) -> None:
    """The pixels of a picture of `app.rendering.map_images.TITLES`, with what limits them.

    `longest` is the end of the scale of escape times, the map's own where None. Starts outside are as white as forbidden ones, so
    that panels of different windows go together; in the picture of regular and chaotic orbits so are those that escape.
    """
    window = frame.spec.window
    pixels = picture_pixels(frame, picture, PAPER, findings)
    if picture == "times":
        _colour_times(pixels[::-1], frame, longest or longest_typical_time(frame))
    white = frame.fate == Fate.OUTSIDE
    if picture == "characters":
        white |= frame.fate > Fate.BOUNDED
    pixels[::-1][white] = 0
    edges = (window.x_low, window.x_high, window.ordinate_low, window.ordinate_high)
    axes.imshow(pixels, extent=edges, origin="upper", interpolation="none", aspect="auto", zorder=1)


def draw_limits(axes: Axes, frame: EscapeMap, shown: Window) -> None:
    """The limiting curve, black, and on (x, y) the Lyapunov orbits, in what is shown."""
    spec = frame.spec
    energy = 0.0 if isinstance(spec.energy, tuple) else spec.energy
    for piece in trace_zero_velocity_curve(spec.potential, spec.plane, energy, shown):
        axes.plot(*piece.T, zorder=2, **LIMIT)
    for orbit in find_lyapunov_orbits(spec.potential, energy) if spec.plane is Plane.X_Y else ():
        axes.plot(*orbit.half_path.T, zorder=2, **LIMIT, **EXIT)


def show_window(axes: Axes, plane: Plane, shown: Window, *, square: bool = True) -> None:
    """Axes of a plane, named and cut to a window."""
    axes.set_xlim(shown.x_low, shown.x_high)
    axes.set_ylim(shown.ordinate_low, shown.ordinate_high)
    axes.set_aspect("equal" if square else "auto")
    tidy_axes(axes)
    label_axes(axes, "$x$", ORDINATES[plane])


def common_window(frames: Sequence[EscapeMap]) -> Window:
    """The smallest window that holds those of several maps."""
    edges = np.array([[w.x_low, w.x_high, w.ordinate_low, w.ordinate_high] for w in (frame.spec.window for frame in frames)])
    return Window(edges[:, 0].min(), edges[:, 1].max(), edges[:, 2].min(), edges[:, 3].max())


def common_longest(frames: Sequence[EscapeMap]) -> float:
    """The end of a scale of escape times for several maps."""
    return max(longest_typical_time(frame) for frame in frames)


def add_time_bar(figure: Figure, panels: Sequence[Axes], longest: float) -> None:
    """The colour bar of escape times beside the panels."""
    scale = ScalarMappable(LogNorm(SHORTEST_TIME, longest), ListedColormap(list(PAPER.escape_time)))
    bar = figure.colorbar(scale, ax=list(panels), shrink=0.75, aspect=34, pad=0.015, extend="max")
    bar.set_label(r"escape time $t_{\mathrm{esc}}$", fontsize=12.0)
    bar.ax.tick_params(labelsize=10.5)


def _colour_times(pixels: np.ndarray, frame: EscapeMap, longest: float) -> None:
    known = frame.fate > Fate.BOUNDED
    pixels[known] = time_colours(frame.escape_time[known], longest, PAPER)
