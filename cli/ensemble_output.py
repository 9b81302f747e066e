"""Output files of many orbits."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cli.files import Content, add_ending, split_ending
from cli.run_context import RunContext
from engine import Outcomes, Potential, SampledOrbits, sample_orbits
from engine.service import require_package
from plots.ensemble_movie import MovieFormat, ensemble_movie_bytes
from plots.figure_style import FigureStyle
from plots.palette import Palette

MOST_PATHS = 20_000
"""Most orbits of a movie, or of a file of paths."""


@dataclass(frozen=True)
class Drawing:
    """Colours and style of the movie, and how many times it has."""

    palette: Palette
    style: FigureStyle
    frames: int


def contents(
    output: Path, potential: Potential, starts: np.ndarray, outcomes: Outcomes, drawing: Drawing, run: RunContext
) -> dict[Path, Content]:
    """Return the content of each output file: by default the table of outcomes and the movie as WebP."""
    stem, endings = split_ending(output, ["csv", "nc", *MovieFormat], ["csv", MovieFormat.WEBP])
    if set(endings) != {"csv"} and len(starts) > MOST_PATHS:
        raise ValueError(f"count={len(starts)}: movies and files of paths have at most {MOST_PATHS} orbits")
    files: dict[Path, Content] = {}
    if "csv" in endings:
        files[add_ending(stem, "csv")] = _table(starts, outcomes)
    if set(endings) == {"csv"}:
        return files
    times = np.linspace(0.0, outcomes.t_max, drawing.frames)
    orbits = sample_orbits(potential, starts, times, execution=run.start_stage("paths"))
    for ending in endings:
        if ending == "nc":
            files[add_ending(stem, ending)] = _netcdf(orbits)
        elif ending != "csv":
            movie = ensemble_movie_bytes(potential, orbits, drawing.palette, MovieFormat(ending), drawing.style)
            files[add_ending(stem, ending)] = movie
    return files


def _netcdf(orbits: SampledOrbits) -> bytes:
    require_package("h5netcdf", "files")
    return bytes(orbits.to_xarray().to_netcdf(engine="h5netcdf"))


def _table(starts: np.ndarray, outcomes: Outcomes) -> str:
    """Return a line for each orbit: its start at full precision, fate, escape time and crossings."""
    ends = (column.tolist() for column in (outcomes.fate, outcomes.escape_time, outcomes.crossings))
    rows = (",".join(map(repr, (*start, *end))) for start, *end in zip(starts.tolist(), *ends, strict=True))
    return "\n".join(["x,y,px,py,fate,escape_time,crossings", *rows]) + "\n"
