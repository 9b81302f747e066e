"""Output files of a map."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cli.arguments import find_palette
from cli.files import Content, add_ending
from engine import EscapeMap
from plots.pictures.map_analyses import MapAnalyses
from plots.pictures.map_images import TITLES
from plots.pictures.palette import Palette
from plots.printed.figure_files import map_figure_bytes
from plots.printed.figure_style import FigureFormat, FigureStyle
from plots.texts.exports import netcdf_bytes


@dataclass(frozen=True)
class Drawing:
    """Pictures to draw, their palette and style."""

    pictures: tuple[str, ...]
    palette: Palette
    style: FigureStyle

    @classmethod
    def of(cls, pictures: Sequence[str], palette: str, style: FigureStyle) -> Drawing:
        """Check the options; ValueError if one is invalid."""
        for picture in pictures:
            if picture not in TITLES:
                raise ValueError(f"picture={picture!r}: must be one of {', '.join(TITLES)}")
        return cls(tuple(dict.fromkeys(pictures)), find_palette(palette), style)


def contents(
    stem: Path, formats: Sequence[str], frame: EscapeMap, analyses: MapAnalyses, drawing: Drawing
) -> dict[Path, Content]:
    """Return the content of each output file: the map in the given formats, and its manifolds, if any, as CSV."""
    files: dict[Path, Content] = {}
    if "nc" in formats:
        files[add_ending(stem, "nc")] = netcdf_bytes(frame, analyses)
    for format in FigureFormat:
        if format in formats:
            figure = map_figure_bytes(frame, drawing.pictures, drawing.palette, format, drawing.style, analyses=analyses)
            files[add_ending(stem, format)] = figure
    if analyses.manifolds is not None:
        files[stem.with_name(f"{stem.name}-manifolds.csv")] = analyses.manifolds.to_pandas().to_csv(index=False)
    return files
