"""Draw pixels, curves, exits, and marks of starts in the coordinates of a plane."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import shapely
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Colormap, Normalize
from matplotlib.image import AxesImage
from matplotlib.patheffects import withStroke

from engine import Potential, Slice, Window
from engine.exits.lyapunov_orbits import find_known_exits
from engine.slices.axes import common_energy
from engine.slices.limiting_curves import trace_zero_velocity_curve
from plots.layers.layer import Stroke
from plots.pictures.axis_labels import label_axis
from plots.pictures.palette import LIGHT, MARK_EDGE, Palette
from plots.printed.figure_axes import label_axes, label_width, size_in_points, style_axes
from plots.printed.figure_style import SCREEN, FigureStyle

# Dashes of exits without colours.
_EXIT_DASHES = (0, (2.0, 1.5))
# Width of the curves of layers in a figure, relative to their width on the web page.
_LINE_SCALE = 0.6
# Drawing order of halos: over pixels, below curves.
_HALO_ORDER = 1.5
# Distance outside the window at which curves are cut, as a share of its sides.
_CLIP_MARGIN = 0.02
# Largest distance from the right or upper edge, as a share of a side, at which the number of a start is moved to the inner side.
_LABEL_MARGIN = 0.06


def draw_pixels(
    axes: Axes, pixels: np.ndarray, window: Window, cmap: Colormap | None = None, norm: Normalize | None = None
) -> AxesImage:
    """Draw the pixels of a window, row 0 on top: RGBA colours, or numbers in the colours of `cmap`. Limits that are set stay."""
    return axes.imshow(
        pixels, cmap, norm, aspect=axes.get_aspect(), extent=window.edges, origin="upper", interpolation="none", zorder=1
    )


def draw_limits(
    axes: Axes,
    potential: Potential,
    plane: Slice,
    energy: float | tuple[float, float],
    shown_window: Window,
    channel_colours: Sequence[str] | None = None,
) -> list[Artist]:
    """Draw the limiting curve of a slice and, on (x, y), the known Lyapunov orbits. Return the drawn curves.

    `energy` is h, or the range (low, high) of an axis h. Without `channel_colours`, the orbits are black and dashed.
    """
    limit_style: dict[str, Any] = {"colors": LIGHT.limiting_curve, "linewidths": 1.0}
    limiting_curve = trace_zero_velocity_curve(potential, plane, energy, shown_window)
    curves = draw_curve(axes, limiting_curve, shown_window, "limiting curve", **limit_style)
    h = common_energy(energy)
    orbits = find_known_exits(potential, h) if plane.shows_positions and h is not None else ()
    if channel_colours is None:
        paths = [orbit.half_path for orbit in orbits]
        return curves + draw_curve(axes, paths, shown_window, "Lyapunov orbits", linestyles=[_EXIT_DASHES], **limit_style)
    for orbit in orbits:
        style: dict[str, Any] = {"colors": channel_colours[orbit.channel - 1], "linewidths": 2.2}
        curves += draw_curve(axes, [orbit.half_path], shown_window, f"Lyapunov orbit {orbit.name}", halo=True, **style)
    return curves


def draw_strokes(axes: Axes, strokes: Sequence[Stroke], shown_window: Window, palette: Palette) -> list[Artist]:
    """Draw curves of a layer, from back to front, in their colours. Return the drawn curves."""
    curves = []
    for stroke in strokes:
        if stroke.halo_width:
            halo: dict[str, Any] = {"colors": LIGHT.halo, "linewidths": _LINE_SCALE * stroke.halo_width}
            curves += draw_curve(axes, stroke.lines, shown_window, zorder=_HALO_ORDER, **halo)
    for stroke in strokes:
        line: dict[str, Any] = {"colors": stroke.colour(palette), "linewidths": _LINE_SCALE * stroke.width}
        curves += draw_curve(axes, stroke.lines, shown_window, alpha=stroke.alpha, **line)
    return curves


def draw_curve(
    axes: Axes, pieces: Iterable[np.ndarray], shown_window: Window, label: str = "", *, halo: bool = False, **style: Any
) -> list[Artist]:
    """Draw the part of a curve that is inside the window. The curve consists of pieces.

    Nothing is drawn, and the returned list is empty, if no part is inside.

    Parameters
    ----------
    axes
        Axes in the coordinates of the plane.
    pieces
        Points of each piece in the plane, of shape (n, 2). Pieces of a single point are skipped.
    shown_window
        The window.
    label
        Label in the legend.
    halo
        Whether the curve has a light border, which makes it visible on any colour.
    style
        Properties of `matplotlib.collections.LineCollection`.
    """
    # In shares of the window, clipping has all digits in a deep zoom.
    lines = [shapely.LineString(_to_shares(shown_window, piece)) for piece in pieces if len(piece) > 1]
    visible_parts = shapely.get_parts(
        shapely.clip_by_rect(lines, -_CLIP_MARGIN, -_CLIP_MARGIN, 1.0 + _CLIP_MARGIN, 1.0 + _CLIP_MARGIN)
    )
    if not len(visible_parts):
        return []
    if halo:
        style["path_effects"] = [withStroke(linewidth=1.8 * style["linewidths"], foreground=LIGHT.halo)]
    points = [_from_shares(shown_window, shapely.get_coordinates(part)) for part in visible_parts]
    return [axes.add_collection(LineCollection(points, label=label, **({"zorder": 2} | style)), autolim=False)]


def labelled(artists: Iterable[Artist]) -> list[Artist]:
    """Return the artists that have a label. Matplotlib gives artists without a label names such as "_child0"."""
    return [artist for artist in artists if str(artist.get_label() or "_")[0] != "_"]


def mark_starts(
    axes: Axes, starts: Sequence[tuple[float, float]], palette: Palette, shown_window: Window, style: FigureStyle = SCREEN
) -> None:
    """Mark starts (x, ordinate) with numbered crosses in the colours of their orbits. Starts outside the window are skipped."""
    scale = style.font_size / SCREEN.font_size
    for number, start in enumerate(starts, 1):
        x_share, y_share = _to_shares(shown_window, np.array(start))
        if not (0.0 <= x_share <= 1.0 and 0.0 <= y_share <= 1.0):
            continue
        # From back to front: a light line for dark pictures, a dark one for light pictures, and the colour of the orbit.
        for colour, width in ((LIGHT.halo, 7.0), (MARK_EDGE, 4.8), (palette.orbits[(number - 1) % len(palette.orbits)], 2.4)):
            size: dict[str, Any] = {"markersize": scale * (9.6 + width), "markeredgewidth": scale * width}
            axes.plot(*start, "+", color=colour, zorder=3, **size)
        is_right, is_high = x_share > 1.0 - _LABEL_MARGIN, y_share > 1.0 - _LABEL_MARGIN
        offset = (-6.0 * scale if is_right else 6.0 * scale, -3.6 * scale if is_high else 3.6 * scale)
        axes.annotate(
            str(number), start, offset, textcoords="offset points",
            ha="right" if is_right else "left", va="top" if is_high else "bottom",
            fontsize=style.font_size, color=LIGHT.text, zorder=4,
            path_effects=[withStroke(linewidth=4.0, foreground=LIGHT.halo)],
        )  # fmt: skip


def show_window(
    axes: Axes, shown_window: Window, x_name: str, y_name: str, style: FigureStyle = SCREEN, *, equal: bool = False
) -> None:
    """Set limits, ticks and labels of axes that show a window. `equal` gives both axes the same scale."""
    style_axes(axes, style)
    x_axis = label_axis(x_name, shown_window.x_low, shown_window.x_high)
    y_axis = label_axis(y_name, shown_window.ordinate_low, shown_window.ordinate_high)
    x_ticks = _thin_out(x_axis.ticks, size_in_points(axes)[0] / style.small_size)
    axes.set_xticks(*zip(*x_ticks, strict=True))
    axes.set_yticks(*zip(*y_axis.ticks, strict=True))
    axes.set_xlim(shown_window.ranges[0])
    axes.set_ylim(shown_window.ranges[1])
    if equal:
        axes.set_box_aspect(shown_window.height / shown_window.width)
    label_axes(axes, x_axis.name, y_axis.name, style)


def _thin_out(ticks: list[tuple[float, str]], width: float) -> list[tuple[float, str]]:
    """Return every k-th tick so that labels do not touch. The width of the axis is in units of the font size of the labels."""
    needed_width = sum(label_width(label) for _, label in ticks)
    return ticks[:: max(1, math.ceil(needed_width / width))]


def _to_shares(shown_window: Window, points: np.ndarray) -> np.ndarray:
    """Convert points of the plane, of shape (n, 2), to shares of a window's width and height."""
    low, high = _corners(shown_window)
    return (points - low) / (high - low)


def _from_shares(shown_window: Window, shares: np.ndarray) -> np.ndarray:
    low, high = _corners(shown_window)
    return low + shares * (high - low)


def _corners(window: Window) -> np.ndarray:
    """Return the lower left and the upper right corner, of shape (2, 2)."""
    return np.array([[window.x_low, window.ordinate_low], [window.x_high, window.ordinate_high]])
