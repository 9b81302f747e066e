"""The files that a map is written to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from app.exports import netcdf_bytes, png_bytes
from app.rendering.map_analyses import MapAnalyses
from app.rendering.map_figure import LARGEST_SIDE, SMALLEST_SIDE
from app.rendering.map_images import TITLES
from app.rendering.palette import Palette
from cli.requests import find_palette
from cli.written_files import Content, add_ending
from engine import EscapeMap, StableManifolds


@dataclass(frozen=True)
class Drawing:
    """Which pictures, in which colours, how large."""

    pictures: tuple[str, ...]
    palette: Palette
    side: int

    @classmethod
    def of(cls, pictures: Sequence[str], palette: str, side: int) -> Drawing:
        """From what was typed; ValueError, before anything is computed, when one of it is not known."""
        for picture in pictures:
            if picture not in TITLES:
                raise ValueError(f"picture={picture!r}: must be one of {', '.join(TITLES)}")
        if not SMALLEST_SIDE <= side <= LARGEST_SIDE:
            raise ValueError(f"side={side}: must be from {SMALLEST_SIDE} to {LARGEST_SIDE} pixels")
        return cls(tuple(dict.fromkeys(pictures)), find_palette(palette), side)


def contents(
    stem: Path, formats: Sequence[str], frame: EscapeMap, findings: MapAnalyses, drawing: Drawing
) -> dict[Path, Content]:
    """What to write where: the map in each of the formats nc and png, and its manifolds as a table where there are any."""
    files: dict[Path, Content] = {}
    if "nc" in formats:
        files[add_ending(stem, "nc")] = netcdf_bytes(frame, findings)
    if "png" in formats:
        files[add_ending(stem, "png")] = png_bytes(frame, drawing.pictures, drawing.palette, drawing.side, findings=findings)
    if findings.manifolds is not None:
        files[stem.with_name(f"{stem.name}-manifolds.csv")] = _manifolds_csv(findings.manifolds)
    return files


def _manifolds_csv(manifolds: StableManifolds) -> str:
    lines = ["arc,channel,image,x,px"]
    for number, arc in enumerate(manifolds.arcs, 1):
        points = zip(arc.x.tolist(), arc.px.tolist(), strict=True)
        lines += [f"{number},{arc.channel},{arc.image},{x!r},{px!r}" for x, px in points]
    return "\n".join(lines) + "\n"
