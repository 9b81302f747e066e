"""Output files of a map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cli.arguments import find_palette
from cli.files import Content, add_ending
from engine import EscapeMap
from plots.exports import netcdf_bytes, png_bytes
from plots.map_analyses import MapAnalyses
from plots.map_images import LARGEST_PICTURE, SMALLEST_PICTURE, TITLES
from plots.palette import Palette


@dataclass(frozen=True)
class Drawing:
    """Pictures to draw, their palette and size."""

    pictures: tuple[str, ...]
    palette: Palette
    side: int

    @classmethod
    def of(cls, pictures: Sequence[str], palette: str, side: int) -> Drawing:
        """Check the options; ValueError if one is invalid."""
        for picture in pictures:
            if picture not in TITLES:
                raise ValueError(f"picture={picture!r}: must be one of {', '.join(TITLES)}")
        if not SMALLEST_PICTURE <= side <= LARGEST_PICTURE:
            raise ValueError(f"side={side}: must be from {SMALLEST_PICTURE} to {LARGEST_PICTURE} pixels")
        return cls(tuple(dict.fromkeys(pictures)), find_palette(palette), side)


def contents(
    stem: Path, formats: Sequence[str], frame: EscapeMap, analyses: MapAnalyses, drawing: Drawing
) -> dict[Path, Content]:
    """Return the content of each output file: the map in the given formats, and its manifolds, if any, as CSV."""
    files: dict[Path, Content] = {}
    if "nc" in formats:
        files[add_ending(stem, "nc")] = netcdf_bytes(frame, analyses)
    if "png" in formats:
        files[add_ending(stem, "png")] = png_bytes(frame, drawing.pictures, drawing.palette, drawing.side, analyses=analyses)
    if analyses.manifolds is not None:
        files[stem.with_name(f"{stem.name}-manifolds.csv")] = analyses.manifolds.to_pandas().to_csv(index=False)
    return files
