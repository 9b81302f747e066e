"""Output files of an orbit."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from cli.files import Content, add_ending, split_ending
from engine import Orbit, OrbitVerdict, Potential
from plots.pictures.orbit_curves import compute_orbit_curves
from plots.pictures.palette import Palette
from plots.printed.figure_files import orbits_figure_bytes
from plots.printed.figure_style import FigureFormat, FigureStyle
from plots.texts.exports import orbits_csv


@dataclass(frozen=True)
class Drawing:
    """Colours and style of the figure, and the number of rows that the table has at most."""

    palette: Palette
    style: FigureStyle
    most_rows: int


def contents(output: Path, potential: Potential, orbit: Orbit, verdict: OrbitVerdict, drawing: Drawing) -> dict[Path, Content]:
    """Return the content of each output file: by default the table as CSV and the figure as PNG."""
    stem, endings = split_ending(output, ["csv", *FigureFormat], ["csv", FigureFormat.PNG])
    files: dict[Path, Content] = {}
    if "csv" in endings:
        files[add_ending(stem, "csv")] = orbits_csv([orbit], drawing.most_rows, [verdict])
    for format in FigureFormat:
        if format in endings:
            curves, words = [compute_orbit_curves(potential, orbit)], [verdict.describe()]
            figure = orbits_figure_bytes(potential, curves, drawing.palette, words, format, drawing.style)
            files[add_ending(stem, format)] = figure
    return files
