"""Output files of many orbits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cli.files import Content, add_ending, split_ending
from cli.run_context import RunContext
from engine import Outcomes, Potential, sample_orbits
from plots.pictures.palette import Palette
from plots.printed.ensemble_movie import MovieFormat, ensemble_movie_bytes
from plots.printed.figure_style import FigureStyle
from plots.texts.exports import dataset_bytes

MOST_PATHS = 20_000
"""Most orbits of a movie, or of a file of paths."""


@dataclass(frozen=True)
class Drawing:
    """Colours and style of the movie, and how many times it has."""

    palette: Palette
    style: FigureStyle
    frames: int


def check_count(output: Path | None, count: int) -> None:
    """Raise ValueError, before anything is computed, if the output files cannot have so many orbits."""
    if output is not None and {*_split(output)[1]} != {"csv"} and count > MOST_PATHS:
        raise ValueError(f"count={count}: movies and files of paths have at most {MOST_PATHS} orbits")


def contents(
    output: Path, potential: Potential, starts: np.ndarray, outcomes: Outcomes, drawing: Drawing, run: RunContext
) -> dict[Path, Content]:
    """Return the content of each output file: by default the table of outcomes and the movie as WebP."""
    stem, endings = _split(output)
    files: dict[Path, Content] = {}
    if "csv" in endings:
        files[add_ending(stem, "csv")] = _table(starts, outcomes)
    if set(endings) == {"csv"}:
        return files
    times = np.linspace(0.0, outcomes.t_max, drawing.frames)
    orbits = sample_orbits(potential, starts, times, execution=run.start_stage("paths"))
    for ending in endings:
        if ending == "nc":
            files[add_ending(stem, ending)] = dataset_bytes(orbits.to_xarray())
        elif ending != "csv":
            movie = ensemble_movie_bytes(potential, orbits, drawing.palette, MovieFormat(ending), drawing.style)
            files[add_ending(stem, ending)] = movie
    return files


def _split(output: Path) -> tuple[Path, Sequence[str]]:
    """Return the stem and the endings of the output files."""
    return split_ending(output, ["csv", "nc", *MovieFormat], ["csv", MovieFormat.WEBP])


def _table(starts: np.ndarray, outcomes: Outcomes) -> str:
    """Return a line for each orbit: its start at full precision, fate, escape time and crossings."""
    ends = (column.tolist() for column in (outcomes.fate, outcomes.escape_time, outcomes.crossings))
    rows = (",".join(map(repr, (*start, *end))) for start, *end in zip(starts.tolist(), *ends, strict=True))
    return "\n".join(["x,y,px,py,fate,escape_time,crossings", *rows]) + "\n"
