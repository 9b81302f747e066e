"""A map drawn without a browser: the picture of the page on white, with its axes, its legend and where it comes from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely
from PIL import Image, ImageDraw

from app.rendering.figure_axes import WHITE, draw_colour_bar, draw_flow, draw_panel, font_of
from app.rendering.figure_lines import stroke
from app.rendering.map_analyses import NO_ANALYSES, MapAnalyses
from app.rendering.map_images import DOUBTED, TITLES, picture_pixels
from app.rendering.palette import DOUBT, LIGHT, MANIFOLD, MARK_EDGE, Entry, Palette
from engine import CASES, EscapeMap, Fate, Plane, StableManifolds, find_lyapunov_orbits, trace_zero_velocity_curve

SMALLEST_SIDE, LARGEST_SIDE = 100, 4000
"""Sides in pixels that the map itself may have."""


class _Curve(NamedTuple):
    """Pieces of a curve, (n, 2) in shares of the window, and how it is drawn; its weight is in letter heights."""

    pieces: list[np.ndarray]
    entry: Entry
    weight: float
    halo: bool


def draw_picture(
    frame: EscapeMap,
    picture: str,
    palette: Palette,
    side: int,
    *,
    findings: MapAnalyses = NO_ANALYSES,
    starts: Sequence[tuple[float, float]] = (),
) -> Image.Image:
    """A picture to print or to send: title, map, axes, curves, legend and provenance, in RGB on white.

    All pictures of a map are equally wide, and their maps are in the same place.

    Parameters
    ----------
    frame
        The map, finished or not. Its window is stretched to a square.
    picture
        One of `TITLES`.
    side
        Of the map itself, 100 to 4000 pixels; everything else grows with it.
    findings
        What second looks have found: which bounded orbits are chaotic, where orbits come from, which pixels are doubtful, and the
        stable manifolds; without them, what the map says by itself.
    starts
        (x, ordinate) of each chosen orbit, numbered from 1; those outside the window keep their number.

    Raises
    ------
    ValueError
        Naming the picture or the side, and what is legal.
    """
    if not SMALLEST_SIDE <= side <= LARGEST_SIDE:
        raise ValueError(f"side={side}: must be from {SMALLEST_SIDE} to {LARGEST_SIDE} pixels")
    pixels, curves = picture_pixels(frame, picture, palette, findings), _curves(frame, palette)
    if picture == "basins" and findings.manifolds is not None:
        curves += _manifold_curves(frame, findings.manifolds)
    size = max(12, side // 38)
    square = _square(pixels, curves, side, size)
    for number, start in enumerate(starts):
        _mark(square, _shares(frame, np.array([start]))[0], str(number + 1), palette.orbits[number % len(palette.orbits)], size)
    panel, left = draw_panel(frame, square, TITLES[picture], size)
    parts = [panel]
    if picture == "times":
        parts += [draw_colour_bar(frame, palette, side, left, panel.width, size)]
    classes = _entries(frame, picture, palette, findings)
    parts += [draw_flow([*classes, *(curve.entry for curve in curves)], size, left, panel.width, size)]
    words = [Entry(word, "") for word in provenance_line(frame).split()]
    parts += [draw_flow(words, max(12, size * 3 // 4), left, panel.width, size // 4)]
    page = Image.new("RGB", (panel.width, sum(part.height for part in parts)), WHITE)
    for k, part in enumerate(parts):
        page.paste(part, (0, sum(above.height for above in parts[:k])))
    return page


def _shares(frame: EscapeMap, points: np.ndarray) -> np.ndarray:
    """(n, 2) points of the plane, as shares of the window's width and height."""
    window = frame.spec.window
    low, high = np.array([[window.x_low, window.ordinate_low], [window.x_high, window.ordinate_high]])
    shares: np.ndarray = (points - low) / (high - low)
    return shares


def _curves(frame: EscapeMap, palette: Palette) -> list[_Curve]:
    """The limiting curve and the Lyapunov orbits, where the window shows any of them."""
    spec = frame.spec
    energy = 0.0 if isinstance(spec.energy, tuple) else spec.energy
    limit = trace_zero_velocity_curve(spec.potential, spec.plane, energy, spec.window)
    orbits = find_lyapunov_orbits(spec.potential, energy) if spec.plane is Plane.X_Y else ()
    curves = [_Curve(_clipped(frame, limit), Entry("limiting curve", LIGHT.limiting_curve), weight=0.1, halo=False)]
    for orbit in orbits:
        entry = Entry(f"Lyapunov orbit {orbit.channel}", palette.channels[orbit.channel - 1])
        curves.append(_Curve(_clipped(frame, [orbit.half_path]), entry, weight=0.2, halo=True))
    return [curve for curve in curves if curve.pieces]


def _manifold_curves(frame: EscapeMap, manifolds: StableManifolds) -> list[_Curve]:
    pieces = _clipped(frame, [np.column_stack([arc.x, arc.px]) for arc in manifolds.arcs if arc.x.size > 1])
    return [_Curve(pieces, Entry("stable manifolds", MANIFOLD), weight=0.04, halo=True)] if pieces else []


def _clipped(frame: EscapeMap, pieces: list[np.ndarray]) -> list[np.ndarray]:
    """What the window shows of a curve, with a rim: in a deep zoom the rest is further away than a pixel number can say."""
    shown = shapely.clip_by_rect([shapely.LineString(_shares(frame, piece)) for piece in pieces], -0.02, -0.02, 1.02, 1.02)
    return [shapely.get_coordinates(part) for part in shapely.get_parts(shown)]


def _square(pixels: np.ndarray, curves: list[_Curve], side: int, size: int) -> Image.Image:
    """The map with its curves."""
    square = Image.new("RGB", (side, side), WHITE)
    raster = Image.fromarray(pixels).resize((side, side), Image.Resampling.NEAREST)
    square.paste(raster, mask=raster)
    for curve in curves:
        if curve.halo:
            stroke(square, curve.pieces, LIGHT.halo, 1.8 * curve.weight * size)
        stroke(square, curve.pieces, curve.entry.colour, curve.weight * size)
    return square


def _mark(square: Image.Image, place: np.ndarray, number: str, colour: str, size: int) -> None:
    """A cross with its number, both with a rim; nothing where the start is outside."""
    if not np.all((place >= 0) & (place <= 1)):
        return
    # From the back: light for a dark picture, dark for a light one, and the orbit's own colour.
    for ink, width in ((LIGHT.halo, 0.6), (MARK_EDGE, 0.4), (colour, 0.2)):
        arm = (0.4 + width / 2) * size / square.width
        bars = [place + arm * np.array([[-1, 0], [1, 0]]), place + arm * np.array([[0, -1], [0, 1]])]
        stroke(square, bars, ink, width * size)
    x, y = place[0] * square.width, (1 - place[1]) * square.width
    # The number stays on the picture: left of a cross at the right edge, below one at the top.
    anchor, dx = ("r", -0.5) if x > square.width - 2 * size else ("l", 0.5)
    anchor, dy = (anchor + "t", 0.3) if y < 2 * size else (anchor + "b", -0.3)
    rim, at = max(1, size // 6), (x + dx * size, y + dy * size)
    ImageDraw.Draw(square).text(at, number, LIGHT.text, font_of(size), anchor, stroke_width=rim, stroke_fill=LIGHT.halo)


def _entries(frame: EscapeMap, picture: str, palette: Palette, findings: MapAnalyses) -> list[Entry]:
    """What the colours mean: all classes of the picture, and the outcomes that occur."""
    judged = findings.regularity is not None and findings.regularity.complete
    occurring = set(np.unique(frame.fate).tolist())
    outcomes = [entry for fate, entry in reversed(palette.outcomes.items()) if fate in occurring]
    if picture == "characters":
        characters = palette.character_entries[:-1] if judged else palette.character_entries
        return [*characters, *(entry for entry in outcomes if entry != palette.outcomes[Fate.BOUNDED])]
    channels = frame.spec.potential.channels
    if picture == "origins":
        return [*palette.passage_entries(channels), *outcomes]
    classes = {"basins": palette.channel_entries(channels), "crossings": palette.crossing_entries}
    doubt = [Entry("not to be trusted", DOUBT)] if picture in DOUBTED and findings.trust is not None else []
    return [*classes.get(picture, []), *outcomes, *doubt]


def provenance_line(frame: EscapeMap) -> str:
    """What made the map, in a line: potential, h, plane, window, resolution, t_max and version."""
    facts, plane = frame.provenance(), frame.spec.plane
    x_low, x_high, low, high = (repr(float(edge)) for edge in facts["window"])
    name, (columns, rows) = facts["potential"], facts["resolution"]
    energy = "" if plane is Plane.X_H else f"h = {facts['energy']!r}, "
    return (
        f"{'Case' if name in CASES else 'Potential'} {name}, {energy}plane {plane.value}, x from {x_low} to {x_high}, "
        f"{plane.ordinate} from {low} to {high}, {columns} × {rows} starts, t_max = {facts['t_max']:g}, "
        f"{'' if frame.complete else 'not finished, '}escape-explorer {facts['version']}"
    )
