"""Maps drawn with Matplotlib: pixels, limiting curve, exits, manifolds, marks of starts, legend and provenance.

Maps are drawn in shares of the window that their axes show, 0 to 1 from its lower left corner: in plane coordinates the transform
to pixels would lose all digits in a deep zoom.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import shapely
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection
from matplotlib.colorbar import Colorbar
from matplotlib.colors import ListedColormap, LogNorm
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke

from engine import (
    CASES,
    EscapeMap,
    Fate,
    Potential,
    Slice,
    StableManifolds,
    Window,
    find_lyapunov_orbits,
    trace_zero_velocity_curve,
)
from engine.service import common_energy
from plots.figure_axes import (
    LETTER,
    POINTS_PER_INCH,
    SMALL,
    add_legend_below,
    figure_of,
    label_axes,
    label_axis,
    name_panel,
    patches,
    set_font,
    size_in_points,
    style_axes,
)
from plots.image_columns import longest_typical_time
from plots.manifold_strokes import Stroke, manifold_strokes
from plots.map_analyses import NO_ANALYSES, MapAnalyses
from plots.map_images import (
    CROSSED_BY_MANIFOLDS,
    DOUBTED,
    LARGEST_PICTURE,
    SHORTEST_TIME,
    SMALLEST_PICTURE,
    TITLES,
    picture_pixels,
)
from plots.palette import DOUBT, LIGHT, MARK_EDGE, Entry, Palette

# Letters have a fixed size in points. Pixels per inch grow with the side of a map, so that letters grow with it, and are never
# fewer than these, so that letters stay legible.
_MAP_INCHES, _LEAST_DPI = 7.0, 80.0
# Room for the longest entry of a legend, in inches.
_LEGEND_INCHES = 2.6
_PANEL_GAP = 0.25
# From the lower edge of the map, in points: below the tick labels and the name of the axis; and below a colour bar there, too.
_BELOW_AXIS, _BELOW_BAR, _BAR_HEIGHT = 44.0, 76.0, 9.0
_PROVENANCE_LETTER = 9.0
_EXIT_DASHES = (0, (2.0, 1.5))
# Of the widths of manifolds on the page, in a file.
_LINE_SCALE = 0.6
_HALO_ORDER = 1.5
# Curves are cut this far outside the window, in shares of it.
_RIM = 0.02
# Of a line of provenance, the share that is filled: lines of equally many letters differ in width.
_FILLED = 0.93
# Numbers of starts are moved to the inside of the picture this close to its right and upper edge, in shares of it.
_EDGE = 0.06


def draw_map_figure(
    frame: EscapeMap,
    pictures: Sequence[str],
    palette: Palette,
    side: int,
    *,
    analyses: MapAnalyses = NO_ANALYSES,
    starts: Sequence[tuple[float, float]] = (),
    longest: float | None = None,
) -> Figure:
    """Draw pictures of a map side by side, each with title, axes, curves, legend and provenance; save with ``crop=True``.

    Parameters
    ----------
    frame
        The map, finished or not. Its window is stretched to a square.
    pictures
        Some of `TITLES`.
    palette
        Colours.
    side
        Of each map, 100 to 4000 pixels; letters and lines grow with it.
    analyses
        Results of follow-up analyses: regularity, origins, doubtful pixels and stable manifolds.
    starts
        (x, ordinate) of each chosen orbit, numbered from 1; those outside the window keep their number.
    longest
        Upper end of the scale of escape times; None for `longest_typical_time`.

    Raises
    ------
    ValueError
        If no picture is given, or a picture or the side is invalid.
    """
    if not SMALLEST_PICTURE <= side <= LARGEST_PICTURE:
        raise ValueError(f"side={side}: must be from {SMALLEST_PICTURE} to {LARGEST_PICTURE} pixels")
    if not pictures:
        raise ValueError(f"pictures={pictures!r}: must be at least one of {', '.join(TITLES)}")
    dpi = max(_LEAST_DPI, side / _MAP_INCHES)
    longest = longest or longest_typical_time(frame)
    # In a figure of one square inch, positions in shares of the figure are inches.
    figure = Figure(figsize=(1.0, 1.0), dpi=dpi)
    left = 0.0
    for picture in pictures:
        axes = figure.add_axes((left, 0.0, side / dpi, side / dpi))
        draw_picture(axes, frame, picture, palette, analyses, longest)
        mark_starts(axes, starts, palette, frame.spec.find_window())
        _explain_picture(axes, frame, picture, palette, analyses, longest)
        width = max(side / dpi, _LEGEND_INCHES) + _width_of_labels(axes) + _PANEL_GAP
        left += round(width * dpi) / dpi
    return figure


def draw_picture(
    axes: Axes,
    frame: EscapeMap,
    picture: str,
    palette: Palette,
    analyses: MapAnalyses = NO_ANALYSES,
    longest: float | None = None,
) -> None:
    """Title, pixels, curves and axes of one of `TITLES`; `longest` as for `picture_pixels`."""
    spec, window = frame.spec, frame.spec.find_window()
    draw_pixels(axes, picture_pixels(frame, picture, palette, analyses, longest), window, window)
    draw_limits(axes, spec.potential, spec.plane, spec.energy, window, palette.channels)
    if picture in CROSSED_BY_MANIFOLDS and analyses.manifolds is not None:
        draw_manifolds(axes, analyses.manifolds, window, palette)
    show_window(axes, window, *spec.plane.axis_names)
    name_panel(axes, TITLES[picture])


def _explain_picture(axes: Axes, frame: EscapeMap, picture: str, palette: Palette, analyses: MapAnalyses, longest: float) -> None:
    """Colour bar, legend and provenance below a map."""
    figure, offset = figure_of(axes), _BELOW_AXIS
    map_width, map_height = size_in_points(axes)
    if picture == "times":
        bar = axes.inset_axes((0.0, -(offset + _BAR_HEIGHT) / map_height, 1.0, _BAR_HEIGHT / map_height))
        add_time_bar(figure, longest, palette, cax=bar, orientation="horizontal")
        offset = _BELOW_BAR
    width = max(map_width, _LEGEND_INCHES * POINTS_PER_INCH)
    handles = [*patches(_entries(frame, picture, palette, analyses)), *_doubt_handle(picture, analyses)]
    # Matplotlib names curves without a label "_child…".
    handles += [curve for curve in axes.collections if not str(curve.get_label()).startswith("_")]
    handles += _manifold_handles(picture, palette, analyses)
    legend = add_legend_below(axes, handles, offset, width)
    below = axes.annotate(
        provenance_line(frame), (0.0, 0.0), (0.0, -8.0), xycoords=legend, textcoords="offset points", va="top",
        fontsize=_PROVENANCE_LETTER, color=LIGHT.text, annotation_clip=False,
    )  # fmt: skip
    set_font(figure)
    share = width * figure.dpi / POINTS_PER_INCH / below.get_window_extent().width
    below.set_text(textwrap.fill(below.get_text(), int(_FILLED * share * len(below.get_text())), break_on_hyphens=False))


def _width_of_labels(axes: Axes) -> float:
    """Width of the tick labels and the name of the upright axis, in inches."""
    figure = figure_of(axes)
    set_font(figure)
    labels = axes.yaxis.get_tightbbox()
    return float(axes.get_window_extent().x0 - labels.x0) / figure.dpi if labels is not None else 0.0


def draw_pixels(axes: Axes, pixels: np.ndarray, window: Window, shown: Window) -> None:
    """Draw the pixels of a window, row 0 on top, in axes that show `shown`."""
    (left, low), (right, high) = _shares(shown, _corners(window))
    axes.imshow(pixels, extent=(left, right, low, high), origin="upper", interpolation="none", aspect="auto", zorder=1)


def draw_limits(
    axes: Axes,
    potential: Potential,
    plane: Slice,
    energy: float | tuple[float, float],
    shown: Window,
    channel_colours: Sequence[str] | None = None,
) -> None:
    """Draw the limiting curve of a slice and, on (x, y), the Lyapunov orbits.

    The orbits have the colours of their channels; without colours they are black and dashed.
    """
    limit: dict[str, Any] = {"colors": LIGHT.limiting_curve, "linewidths": 1.0}
    draw_curve(axes, trace_zero_velocity_curve(potential, plane, energy, shown), shown, "limiting curve", **limit)
    h = common_energy(energy)
    orbits = find_lyapunov_orbits(potential, h) if plane.shows_positions and h is not None else ()
    if channel_colours is None:
        paths = [orbit.half_path for orbit in orbits]
        draw_curve(axes, paths, shown, "Lyapunov orbits", linestyles=[_EXIT_DASHES], **limit)
        return
    for orbit in orbits:
        style: dict[str, Any] = {"colors": channel_colours[orbit.channel - 1], "linewidths": 2.2}
        draw_curve(axes, [orbit.half_path], shown, f"Lyapunov orbit {orbit.channel}", halo=True, **style)


def draw_manifolds(axes: Axes, manifolds: StableManifolds, shown: Window, palette: Palette) -> None:
    """Draw the manifolds in the colours of their channels."""
    strokes = manifold_strokes(manifolds)
    for stroke in strokes:
        if stroke.halo_width:
            halo: dict[str, Any] = {"colors": LIGHT.halo, "linewidths": _LINE_SCALE * stroke.halo_width}
            draw_curve(axes, _points(stroke), shown, zorder=_HALO_ORDER, **halo)
    for stroke in strokes:
        line: dict[str, Any] = {"colors": palette.channels[stroke.channel - 1], "linewidths": _LINE_SCALE * stroke.width}
        draw_curve(axes, _points(stroke), shown, alpha=stroke.alpha, **line)


def _points(stroke: Stroke) -> list[np.ndarray]:
    return [np.column_stack([arc.x, arc.px]) for arc in stroke.arcs]


def _manifold_handles(picture: str, palette: Palette, analyses: MapAnalyses) -> list[Artist]:
    """The legend of the stable manifolds."""
    if picture not in CROSSED_BY_MANIFOLDS or analyses.manifolds is None:
        return []
    entries = palette.manifold_entries(analyses.manifolds)
    return [Line2D([], [], color=entry.colour, linewidth=1.2, label=entry.label) for entry in entries]


def _doubt_handle(picture: str, analyses: MapAnalyses) -> list[Artist]:
    """The legend of doubtful pixels."""
    if picture not in DOUBTED or analyses.trust is None:
        return []
    dark, light = DOUBT
    return [Patch(facecolor=light, edgecolor=dark, hatch="xxxxx", linewidth=0.5, label="doubtful")]


def draw_curve(
    axes: Axes, pieces: Iterable[np.ndarray], shown: Window, label: str = "", *, halo: bool = False, **style: Any
) -> None:
    """Draw a curve, (n, 2) points of the plane for each piece; nothing if none of it is in view.

    Parameters
    ----------
    axes
        Axes that show `shown`.
    pieces
        (n, 2) points of the plane each; pieces of a single point are skipped.
    shown
        Window of the axes.
    label
        For the legend.
    halo
        Whether the curve has a light rim, so that it is visible on any colour.
    style
        Properties of `matplotlib.collections.LineCollection`.
    """
    # Matplotlib clips lines only after a transform to pixels, which has too few digits for what a deep zoom leaves outside.
    lines = [shapely.LineString(_shares(shown, piece)) for piece in pieces if len(piece) > 1]
    visible = shapely.get_parts(shapely.clip_by_rect(lines, -_RIM, -_RIM, 1.0 + _RIM, 1.0 + _RIM))
    if not len(visible):
        return
    if halo:
        style["path_effects"] = [withStroke(linewidth=1.8 * style["linewidths"], foreground=LIGHT.halo)]
    axes.add_collection(
        LineCollection([shapely.get_coordinates(part) for part in visible], label=label, **({"zorder": 2} | style)), autolim=False
    )


def mark_starts(axes: Axes, starts: Sequence[tuple[float, float]], palette: Palette, shown: Window) -> None:
    """Mark (x, ordinate) of starts by numbered crosses in the colours of their orbits; starts outside keep their number."""
    for number, start in enumerate(starts, 1):
        x, y = _shares(shown, np.array(start))
        if not (0.0 <= x <= 1.0 and 0.0 <= y <= 1.0):
            continue
        # From back to front: light on a dark picture, dark on a light one, and the colour of the orbit.
        for colour, width in ((LIGHT.halo, 7.0), (MARK_EDGE, 4.8), (palette.orbits[(number - 1) % len(palette.orbits)], 2.4)):
            axes.plot(x, y, "+", markersize=9.6 + width, markeredgewidth=width, color=colour, zorder=3)
        right, high = x > 1.0 - _EDGE, y > 1.0 - _EDGE
        axes.annotate(
            str(number), (x, y), (-6.0 if right else 6.0, -3.6 if high else 3.6), textcoords="offset points",
            ha="right" if right else "left", va="top" if high else "bottom", fontsize=LETTER, color=LIGHT.text, zorder=4,
            path_effects=[withStroke(linewidth=4.0, foreground=LIGHT.halo)],
        )  # fmt: skip


def show_window(axes: Axes, shown: Window, across: str, up: str, *, equal: bool = False) -> None:
    """Limit, tick and name axes that show a window; `equal` gives both axes the same scale."""
    style_axes(axes)
    x, y = label_axis(across, shown.x_low, shown.x_high), label_axis(up, shown.ordinate_low, shown.ordinate_high)
    axes.set_xticks(*zip(*x.ticks, strict=True))
    axes.set_yticks(*zip(*y.ticks, strict=True))
    axes.set_xlim(0.0, 1.0)
    axes.set_ylim(0.0, 1.0)
    if equal:
        axes.set_box_aspect((shown.ordinate_high - shown.ordinate_low) / (shown.x_high - shown.x_low))
    label_axes(axes, x.name, y.name)


def add_time_bar(figure: Figure, longest: float, palette: Palette, **place: Any) -> Colorbar:
    """Add a logarithmic colour bar of escape times; `place` as for `matplotlib.figure.Figure.colorbar`."""
    scale = ScalarMappable(LogNorm(SHORTEST_TIME, longest), ListedColormap(list(palette.escape_time)))
    bar = figure.colorbar(scale, **place)
    powers = [10.0**k for k in range(math.floor(math.log10(longest)) + 1)]
    times = list(dict.fromkeys([*powers, longest]))
    # The last colour stands for all longer times.
    bar.set_ticks(times, labels=[f"{'≥ ' if time == longest else ''}{time:.0f}" for time in times])
    bar.ax.tick_params(labelsize=SMALL)
    return bar


def _shares(shown: Window, points: np.ndarray) -> np.ndarray:
    """(n, 2) points of the plane in shares of a window's width and height."""
    low, high = _corners(shown)
    shares: np.ndarray = (points - low) / (high - low)
    return shares


def _corners(window: Window) -> np.ndarray:
    """(2, 2) lower left and upper right corner."""
    return np.array([[window.x_low, window.ordinate_low], [window.x_high, window.ordinate_high]])


def _entries(frame: EscapeMap, picture: str, palette: Palette, analyses: MapAnalyses) -> list[Entry]:
    """Legend of the colours: all classes of the picture, and the outcomes that occur."""
    judged = analyses.regularity is not None and analyses.regularity.complete
    occurring = set(np.unique(frame.fate).tolist())
    outcomes = [entry for fate, entry in reversed(palette.outcomes.items()) if fate in occurring]
    if picture == "characters":
        characters = palette.character_entries[:-1] if judged else palette.character_entries
        return [*characters, *(entry for entry in outcomes if entry != palette.outcomes[Fate.BOUNDED])]
    channels = frame.spec.potential.channels
    if picture == "origins":
        return [*palette.passage_entries(channels), *outcomes]
    classes = {"basins": palette.channel_entries(channels), "crossings": palette.crossing_entries}
    return [*classes.get(picture, []), *outcomes]


def provenance_line(frame: EscapeMap) -> str:
    """Provenance of a map in a line: potential, h, plane, window, resolution, t_max and version."""
    facts, plane = frame.provenance(), frame.spec.plane
    x_low, x_high, low, high = (repr(float(edge)) for edge in facts["window"])
    name, (columns, rows) = facts["potential"], facts["resolution"]
    energy = "" if frame.spec.common_energy is None else f"h = {facts['energy']!r}, "
    abscissa, ordinate = plane.axis_names
    return (
        f"{'Case' if name in CASES else 'Potential'} {name}, {energy}plane {plane.title}, {abscissa} from {x_low} to {x_high}, "
        f"{ordinate} from {low} to {high}, {columns} × {rows} starts, t_max = {facts['t_max']:g}, "
        f"{'' if frame.complete else 'not finished, '}escape-explorer {facts['version']}"
    )
