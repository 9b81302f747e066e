"""One orbit drawn without a browser: its path between the exits, SALI and R² against time."""

from __future__ import annotations

import math
from importlib import metadata
from io import BytesIO
from typing import NamedTuple

import numpy as np
from PIL import Image, ImageDraw
from PIL.PngImagePlugin import PngInfo

from app.rendering.figure_axes import WHITE, Axis, draw_flow, font_of, label_axis, typed
from app.rendering.figure_lines import stroke
from app.rendering.orbit_curves import LEAST_SALI, OrbitCurves, compute_orbit_curves
from app.rendering.palette import LIGHT, Entry, Palette
from engine import CHAOS_THRESHOLD, Orbit, Plane, Potential, find_lyapunov_orbits, trace_zero_velocity_curve

SIDE = 600
"""Of the picture of the path, in pixels; the histories are as wide and half as high."""

# Sizes of letters and lines, in pixels.
_LETTER, _WEIGHT = 16, 1.4
# Powers of ten that an axis marks at most.
_MOST_POWERS = 6
_LARGEST_SALI, _EARLIEST_TIME = 10.0**0.5, 0.01


class _Stroke(NamedTuple):
    """A line: (n, 2) in units of its axes, both of them linear or logarithmic already."""

    points: np.ndarray
    colour: str


class _Plot(NamedTuple):
    """A rectangle with axes; ranges in units of the axes, logarithms where they are logarithmic."""

    title: str
    x: tuple[float, float]
    y: tuple[float, float]
    across: Axis
    up: Axis
    strokes: list[_Stroke]


def orbit_png(potential: Potential, orbit: Orbit, palette: Palette) -> bytes:
    """A PNG file of an orbit: path, SALI and R² on white, its verdict below and in the text fields."""
    drawing = compute_orbit_curves(potential, orbit)
    left, gap = 5 * _LETTER, 7 * _LETTER
    page = Image.new("RGB", (left + SIDE + gap + SIDE + 2 * _LETTER, SIDE + 6 * _LETTER), WHITE)
    top, low = 2 * _LETTER, (SIDE - 5 * _LETTER) // 2
    _draw(page, _path_plot(potential, drawing, palette), (left, top, SIDE, SIDE), _visits(drawing, palette))
    _draw(page, _sali_plot(drawing, palette), (left + SIDE + gap, top, SIDE, low))
    _draw(page, _r2_plot(drawing, palette), (left + SIDE + gap, top + SIDE - low, SIDE, low))
    verdict = draw_flow([Entry(word, "") for word in orbit.describe().split()], _LETTER, left, page.width, _LETTER // 4)
    whole = Image.new("RGB", (page.width, page.height + verdict.height), WHITE)
    whole.paste(page, (0, 0))
    whole.paste(verdict, (0, page.height))
    notes = PngInfo()
    notes.add_text("Software", f"escape-explorer {metadata.version('escape-explorer')}")
    for name, value in _provenance(potential, orbit).items():
        notes.add_text(name, value)
    file = BytesIO()
    whole.save(file, "PNG", pnginfo=notes)
    return file.getvalue()


def _provenance(potential: Potential, orbit: Orbit) -> dict[str, str]:
    start = ", ".join(repr(float(getattr(orbit, name)[0])) for name in ("x", "y", "px", "py"))
    return {"potential": potential.name, "energy": repr(orbit.energy), "start": start, "verdict": orbit.describe()}


def _path_plot(potential: Potential, drawing: OrbitCurves, palette: Palette) -> _Plot:
    """The path, unless it is too long for a line, with the zero-velocity curve and the Lyapunov orbits."""
    orbit, window = drawing.orbit, drawing.window
    curve = trace_zero_velocity_curve(potential, Plane.X_Y, orbit.energy, window)
    strokes = [_Stroke(piece, LIGHT.limiting_curve) for piece in curve]
    if drawing.visits is None:
        strokes.insert(0, _Stroke(np.column_stack([orbit.x, orbit.y]), palette.orbits[0]))
    exits = find_lyapunov_orbits(potential, orbit.energy)
    strokes += [_Stroke(one.half_path, palette.channels[one.channel - 1]) for one in exits]
    x, y = (window.x_low, window.x_high), (window.ordinate_low, window.ordinate_high)
    return _Plot(f"Path at h = {orbit.energy:.6g}", x, y, label_axis("x", *x), label_axis("y", *y), strokes)


def _sali_plot(drawing: OrbitCurves, palette: Palette) -> _Plot:
    t, sali = drawing.sali
    x = (math.log10(_EARLIEST_TIME), math.log10(max(float(drawing.orbit.t[-1]), 10.0 * _EARLIEST_TIME)))
    y = (math.log10(LEAST_SALI), math.log10(_LARGEST_SALI))
    threshold = _Stroke(np.column_stack([x, np.full(2, math.log10(CHAOS_THRESHOLD))]), LIGHT.equipotential)
    history = _Stroke(np.log10(np.column_stack([np.maximum(t, _EARLIEST_TIME), sali])), palette.orbits[0])
    return _Plot(
        f"SALI; chaotic from {CHAOS_THRESHOLD:g} down", x, y, _powers("t", *x), _powers("SALI", *y), [threshold, history]
    )


def _r2_plot(drawing: OrbitCurves, palette: Palette) -> _Plot:
    x = 0.0, max(float(drawing.orbit.t[-1]), _EARLIEST_TIME)
    y = 0.0, 1.05 * max(float(drawing.orbit.r2.max()), 1e-3)
    history = _Stroke(np.column_stack(drawing.r2), palette.orbits[0])
    return _Plot("R² = x² + y²", x, y, label_axis("t", *x), label_axis("R²", *y), [history])


def _powers(name: str, low: float, high: float) -> Axis:
    """Ticks at powers of ten between two logarithms."""
    exponents = range(math.ceil(low), math.floor(high) + 1)
    step = max(1, math.ceil(len(exponents) / _MOST_POWERS))
    chosen = [k for k in exponents if k % step == 0]
    return Axis(name, [((k - low) / (high - low), f"1e{k}" if k else "1") for k in chosen])


def _visits(drawing: OrbitCurves, palette: Palette) -> Image.Image | None:
    """How often a long path comes by, in its colour."""
    if drawing.visits is None:
        return None
    opacity = Image.fromarray(drawing.visits[::-1].copy()).resize((SIDE, SIDE))
    image = Image.new("RGB", (SIDE, SIDE), WHITE)
    image.paste(palette.orbits[0], (0, 0, SIDE, SIDE), opacity)
    return image


def _draw(page: Image.Image, plot: _Plot, box: tuple[int, int, int, int], ground: Image.Image | None = None) -> None:
    """A plot in a box (left, top, width, height) of the page, on a ground of its size."""
    left, top, width, height = box
    inside = ground or Image.new("RGB", (width, height), WHITE)
    low, high = np.array([plot.x, plot.y]).T
    for points, colour in plot.strokes:
        if len(points) > 1:
            stroke(inside, [(points - low) / (high - low)], colour, _WEIGHT)
    page.paste(inside, (left, top))
    draw = ImageDraw.Draw(page)
    draw.rectangle((left - 1, top - 1, left + width, top + height), outline=LIGHT.text)
    draw.text((left, top - _LETTER), typed(plot.title), LIGHT.text, font_of(_LETTER), "lm")
    _draw_across(draw, plot.across, left, top + height, width)
    _draw_up(page, draw, plot.up, left, top, height)


def _draw_across(draw: ImageDraw.ImageDraw, axis: Axis, left: int, y: int, width: int) -> None:
    for place, label in axis.ticks:
        x = left + place * width
        draw.line((x, y, x, y + _LETTER // 3), LIGHT.text)
        draw.text((x, y + _LETTER // 2), label, LIGHT.text, font_of(_LETTER), "ma")
    draw.text((left + width / 2, y + 2.2 * _LETTER), typed(axis.name), LIGHT.text, font_of(_LETTER), "mm")


def _draw_up(page: Image.Image, draw: ImageDraw.ImageDraw, axis: Axis, left: int, top: int, height: int) -> None:
    for place, label in axis.ticks:
        y = top + (1 - place) * height
        draw.line((left - _LETTER // 3, y, left, y), LIGHT.text)
        draw.text((left - _LETTER // 2, y), label, LIGHT.text, font_of(_LETTER), "rm")
    name = Image.new("RGB", (4 * _LETTER, round(1.4 * _LETTER)), WHITE)
    ImageDraw.Draw(name).text((2 * _LETTER, 0.7 * _LETTER), typed(axis.name), LIGHT.text, font_of(_LETTER), "mm")
    page.paste(name.transpose(Image.Transpose.ROTATE_90), (left - 5 * _LETTER, top + height // 2 - 2 * _LETTER))
