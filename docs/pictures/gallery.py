"""Make the thumbnails of the presets, app/static/gallery/<key>.png."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

from engine import (
    EscapeMap,
    compute_map,
    find_lyapunov_orbits,
    integrate_orbit,
    start_states,
)
from engine.foundations.execution import DEFAULT_EXECUTION
from engine.slices.limiting_curves import trace_equipotentials
from engine.systems.review.potential_review import review_system
from plots.layers.map_images import picture_pixels
from plots.layers.table import LAYERS
from plots.links.map_view import MapView
from plots.links.presets import PRESETS, Preset
from plots.live.gallery import analyse
from plots.pictures.palette import DEFAULT_COLOURS, LIGHT, PATCH_EDGE
from plots.printed.window_axes import draw_curve, draw_pixels, draw_strokes

STATIC = Path(__file__).parents[2] / "app" / "static"
PICTURES = {f"gallery/{preset.key}": preset for preset in PRESETS}
SIDE = 160
# Pixels per inch at which a point is a pixel.
_DPI = 72
# Largest number of colours of a file.
_MOST_COLOURS = 64
# Energies of equipotentials, in units of the escape energy.
_LEVELS = (0.1, 0.3, 0.5, 0.7, 0.9, 1.6, 2.2)


def make(names: Sequence[str]) -> None:
    """Draw and write the thumbnails with these names."""
    for name in names:
        _reduce_colours(_draw_thumbnail(PICTURES[name])).save(STATIC / f"{name}.png", optimize=True)


def _draw_thumbnail(preset: Preset) -> Image.Image:
    """Return a thumbnail in RGBA. It is transparent where no orbit can start, for light and dark pages."""
    view = preset.map_view
    frame = compute_map(replace(view.map_spec(review_system(view.system)), resolution=(SIDE, SIDE)))
    analyses = analyse(frame, view.layers, view.settings, DEFAULT_EXECUTION)
    pixels = picture_pixels(frame, preset.picture, DEFAULT_COLOURS, analyses)
    strokes = [
        stroke
        for name, result in analyses.items()
        if (over := LAYERS[name].over) is not None and over.strokes is not None and preset.picture in over.pictures
        for stroke in over.strokes(result)
    ]
    if preset.picture != "curves" and not strokes:
        return Image.fromarray(pixels)
    figure = Figure(figsize=(SIDE / _DPI, SIDE / _DPI), dpi=_DPI, facecolor="none")
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    draw_pixels(axes, pixels, frame.spec.find_window())
    if strokes:
        draw_strokes(axes, strokes, frame.spec.find_window(), DEFAULT_COLOURS)
    else:
        _draw_curves(axes, frame, view)
    x_range, y_range = frame.spec.find_window().ranges
    axes.set(xlim=x_range, ylim=y_range)
    file = BytesIO()
    figure.savefig(file, format="png")
    return Image.open(file).convert("RGBA")


def _draw_curves(axes: Axes, frame: EscapeMap, view: MapView) -> None:
    """Draw equipotentials, limiting curve, orbits and exits."""
    spec, escape = frame.spec, frame.spec.potential.escape_energy
    energies = (view.energy, escape, *(level * escape for level in _LEVELS))
    limit, critical, *levels = trace_equipotentials(spec.potential, spec.plane, energies, spec.find_window())
    for pieces in levels:
        draw_curve(axes, pieces, spec.find_window(), colors=LIGHT.equipotential, linewidths=0.6)
    draw_curve(axes, critical, spec.find_window(), colors=LIGHT.critical_equipotential, linewidths=1.0)
    draw_curve(axes, limit, spec.find_window(), colors=PATCH_EDGE, linewidths=1.6)
    for (x, y), colour in zip(view.starts, DEFAULT_COLOURS.orbits, strict=False):
        start = start_states(spec.potential, spec.plane, view.energy, np.array([x]), np.array([y]))[0]
        orbit = integrate_orbit(spec.potential, start, spec.t_max)
        draw_curve(axes, [np.column_stack([orbit.x, orbit.y])], spec.find_window(), colors=colour, linewidths=1.0)
    for exit_orbit in find_lyapunov_orbits(spec.potential, view.energy):
        colour = DEFAULT_COLOURS.channels[exit_orbit.channel - 1]
        draw_curve(axes, [exit_orbit.half_path], spec.find_window(), colors=colour, linewidths=2.5)


def _reduce_colours(picture: Image.Image) -> Image.Image:
    """Return the picture with a palette, with the exact colours if there are few."""
    colours, codes = np.unique(np.asarray(picture).reshape(-1, 4), axis=0, return_inverse=True)
    if len(colours) > _MOST_COLOURS:
        return picture.quantize(_MOST_COLOURS, Image.Quantize.FASTOCTREE)
    exact = Image.fromarray(codes.reshape(picture.height, picture.width).astype(np.uint8), "P")
    exact.putpalette(colours.tobytes(), "RGBA")
    return exact
