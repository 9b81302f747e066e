"""Computes the thumbnails of the gallery, app/static/gallery/<key>.png. Run with: python docs/make_gallery.py [key …]"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

sys.path.insert(0, str(Path(__file__).parents[1]))

from app.rendering.map_analyses import MapAnalyses
from app.rendering.map_images import picture_pixels
from app.rendering.palette import LIGHT, PAPER, PATCH_EDGE
from app.state.presets import PRESETS, Preset
from app.state.view_state import ViewState
from engine import (
    EscapeMap,
    StableManifolds,
    compute_map,
    compute_origin_fates,
    compute_regularity,
    compute_trust,
    find_lyapunov_orbits,
    find_stable_manifolds,
    integrate_orbit,
    start_states,
    trace_equipotentials,
)

FOLDER = Path(__file__).parents[1] / "app" / "static" / "gallery"
SIDE = 160
# Lines are drawn this much larger, then made small.
_FINER = 4
_MOST_COLOURS = 64
# In units of the escape energy.
_LEVELS = (0.1, 0.3, 0.5, 0.7, 0.9, 1.6, 2.2)

Line = tuple[np.ndarray, np.ndarray, str, float]
"""x, y, colour, and width in pixels of the thumbnail."""


def main(keys: list[str]) -> None:
    """Write the thumbnails of these presets, or of all."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for preset in PRESETS:
        if not keys or preset.key in keys:
            _paletted(_thumbnail(preset)).save(FOLDER / f"{preset.key}.png", optimize=True)


def _thumbnail(preset: Preset) -> Image.Image:
    """RGBA; transparent where nothing can start, so that it goes with a light page and with a dark one."""
    frame = compute_map(replace(ViewState(**preset.values()).map_spec(), resolution=(SIDE, SIDE)))
    findings = _findings(frame, preset)
    picture = Image.fromarray(picture_pixels(frame, preset.picture, PAPER, findings))
    return _with_lines(picture, frame, preset, findings.manifolds) if preset.picture == "curves" else picture


def _findings(frame: EscapeMap, preset: Preset) -> MapAnalyses:
    spec = frame.spec
    return MapAnalyses(
        regularity=compute_regularity(frame) if preset.judge else None,
        trust=compute_trust(frame) if preset.trust else None,
        origins=compute_origin_fates(spec) if preset.origins else None,
        manifolds=find_stable_manifolds(spec.potential, preset.energy, 2) if preset.manifolds else None,
    )


def _with_lines(picture: Image.Image, frame: EscapeMap, preset: Preset, manifolds: StableManifolds | None) -> Image.Image:
    window = frame.spec.window
    large = picture.resize((SIDE * _FINER, SIDE * _FINER), Image.Resampling.NEAREST)
    scale = SIDE * _FINER / np.array([window.x_high - window.x_low, window.ordinate_low - window.ordinate_high])
    draw = ImageDraw.Draw(large)
    threads = [(arc.x, arc.px, PAPER.channels[arc.channel - 1], 0.7) for arc in manifolds.arcs] if manifolds is not None else []
    for x, y, colour, width in threads or _lines(frame, preset):
        points = (np.column_stack([x, y]) - (window.x_low, window.ordinate_high)) * scale
        draw.line([tuple(point) for point in points.tolist()], fill=colour, width=round(width * _FINER), joint="curve")
    return large.resize((SIDE, SIDE), Image.Resampling.BOX)


def _lines(frame: EscapeMap, preset: Preset) -> list[Line]:
    """From back to front."""
    spec, escape = frame.spec, frame.spec.potential.escape_energy
    energies = (preset.energy, escape, *(level * escape for level in _LEVELS))
    limit, critical, *levels = trace_equipotentials(spec.potential, spec.plane, energies, spec.window)
    lines: list[Line] = [(*piece.T, LIGHT.equipotential, 0.6) for pieces in levels for piece in pieces]
    lines += [(*piece.T, LIGHT.critical_equipotential, 1.0) for piece in critical]
    lines += [(*piece.T, PATCH_EDGE, 1.6) for piece in limit]
    for (x, y), colour in zip(preset.starts, PAPER.orbits, strict=False):
        start = start_states(spec.potential, spec.plane, preset.energy, np.array([x]), np.array([y]))[0]
        orbit = integrate_orbit(spec.potential, start, spec.t_max)
        lines.append((orbit.x, orbit.y, colour, 1.0))
    exits = find_lyapunov_orbits(spec.potential, preset.energy)
    return lines + [(*ring.half_path.T, PAPER.channels[ring.channel - 1], 2.5) for ring in exits]


def _paletted(picture: Image.Image) -> Image.Image:
    """With few colours, exactly those of the picture where these are few already."""
    colours, codes = np.unique(np.asarray(picture).reshape(-1, 4), axis=0, return_inverse=True)
    if len(colours) > _MOST_COLOURS:
        return picture.quantize(_MOST_COLOURS, Image.Quantize.FASTOCTREE)
    exact = Image.fromarray(codes.reshape(picture.height, picture.width).astype(np.uint8), "P")
    exact.putpalette(colours.tobytes(), "RGBA")
    return exact


if __name__ == "__main__":
    main(sys.argv[1:])
