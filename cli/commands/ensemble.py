"""Follow random orbits, uniform on the energy surface, on a slice, or entering through the exits.

Prints the share of each exit, and the decay rate next to flux over volume. For entering orbits, prints shares by entrance.
With --output FILE.webp, FILE.gif or FILE.mp4, writes a movie; with FILE.nc, the paths; with FILE.csv, the starts and outcomes.
With a STEM, writes the movie as WebP and the CSV table.

Examples:

escape-explorer ensemble III --energy 0.45 --count 100000 --t-max 1e4

escape-explorer ensemble III --energy 0.45 --count 3000 --t-max 25 --output draining.mp4

escape-explorer ensemble III --energy 0.6 --entering --t-max 1e3

escape-explorer ensemble I --energy 0.19 --plane x_px --window 0 0.1 0 0.1 --output box.nc
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
import typer

from cli.arguments import OneEnergy
from cli.execution import THREADS_ONLY, Place
from cli.option_marks import DocumentedBy, OptionChanges
from cli.options import with_options
from cli.output_files import Content, Stem, name_files, reserve_output, write_files
from cli.printing import AsJson, Table, list_rows, print_result
from engine import (
    Fate,
    Potential,
    Section,
    Slice,
    classify_orbits,
    compute_exit_matching,
    compute_flux,
    compute_statistics,
    fit_decay_laws,
    sample_entrances_by_exit,
    sample_orbits,
    sample_starts,
)
from engine.propagation.fates import name_fate
from engine.results import DecayLaws, EscapeFlux, EscapeStatistics, ExitMatching, Outcomes
from engine.slices.window import GivenWindow
from plots.pictures.palette import Palette
from plots.printed.figure_files import ensemble_movie_bytes
from plots.printed.figure_style import FigureStyle, MovieFormat
from plots.texts.exports import dataset_bytes, write_csv

MOST_PATHS = 20_000
"""Largest number of orbits in a movie or a file of paths."""


@with_options
def run(
    *,
    potential: Potential,
    energy: OneEnergy,
    count: Annotated[int, DocumentedBy(sample_starts)] = 3000,
    seed: Annotated[int, typer.Option(min=0)] = 0,
    plane: Annotated[Slice | None, OptionChanges(defaults={"plane": None})],
    window: Annotated[GivenWindow | None, DocumentedBy(sample_starts)],
    entering: bool = False,
    t_max: Annotated[float, DocumentedBy(classify_orbits)] = 25.0,
    section: Section,
    frames: Annotated[int, typer.Option(min=2, max=5000)] = 126,
    palette: Palette,
    style: Annotated[FigureStyle, OptionChanges(defaults={"dpi": 120.0})],
    place: Annotated[Place, THREADS_ONLY],
    output: Stem = None,
    as_json: AsJson = False,
) -> None:
    """Follow and count the orbits, and write or draw them.

    Parameters
    ----------
    seed
        Seed of the random numbers; equal seeds give equal starts.
    entering
        Start on the exits and move inward, distributed as the flux; the escape times are then gap times.
    frames
        Number of times in the movie or the NetCDF file, evenly spaced.
    """
    paths = name_files(output, ["csv", "nc", *MovieFormat], ["csv", MovieFormat.WEBP])
    needs_paths = bool(paths.keys() - {"csv"})
    if needs_paths and count > MOST_PATHS:
        raise ValueError(f"count={count}: movies and files of paths have at most {MOST_PATHS} orbits")
    entrances, starts = _draw_starts(potential, energy, count, seed, plane, window, entering)

    # Called only when the outcomes, and the orbits if needed, are computed below.
    def make_content(ending: str) -> Content:
        if ending == "csv":
            return _starts_csv(starts, outcomes)
        if ending == "nc":
            return dataset_bytes(orbits.to_xarray())
        return ensemble_movie_bytes(potential, orbits, palette, MovieFormat(ending), style)

    with reserve_output(output):
        with place.run() as context:
            outcomes = classify_orbits(potential, energy, starts, t_max, section=section, execution=context.start_stage("orbits"))
            context.execution.raise_if_cancelled()
            laws = fit_decay_laws(outcomes)
            if needs_paths:
                times = np.linspace(0.0, outcomes.t_max, frames)
                orbits = sample_orbits(potential, starts, times, section=section, execution=context.start_stage("paths"))
            contents = {path: make_content(ending) for ending, path in paths.items()}
        files = write_files(contents)
    matching = None if entrances is None else compute_exit_matching(entrances, outcomes)
    _print(compute_statistics(outcomes), matching, laws, compute_flux(potential, energy), files, as_json)


def _draw_starts(
    potential: Potential,
    energy: float,
    count: int,
    seed: int,
    plane: Slice | None,
    window: GivenWindow | None,
    entering: bool,
) -> tuple[np.ndarray | None, np.ndarray]:
    """Return the entrances (None unless orbits enter) and states of shape (count, 4); ValueError for contradictory options."""
    if not entering:
        return None, sample_starts(potential, energy, count, plane=plane, window=window, rng=seed)
    if plane is not None or window is not None:
        raise ValueError("entering: orbits start on the exits; leave --plane and --window out")
    return sample_entrances_by_exit(potential, energy, count, rng=seed)


def _starts_csv(starts: np.ndarray, outcomes: Outcomes) -> str:
    """Return a table with a line for each orbit: start at full precision, fate, escape time and crossings."""
    end_columns = (column.tolist() for column in (outcomes.fate, outcomes.escape_time, outcomes.crossings))
    rows = ((*start, *end) for start, *end in zip(starts.tolist(), *end_columns, strict=True))
    return write_csv(("x", "y", "px", "py", "fate", "escape_time", "crossings"), rows)


def _print(
    statistics: EscapeStatistics,
    matching: ExitMatching | None,
    laws: DecayLaws,
    flux: EscapeFlux,
    files: Sequence[str],
    as_json: bool,
) -> None:
    shares, intervals = statistics.shares, statistics.share_intervals
    names = {code: name_fate(code, statistics.outcomes) for code in shares if code >= Fate.BOUNDED or shares[code]}
    answer: dict[str, Any] = {
        "outcomes": [{"outcome": name, "share": shares[code], "interval": intervals[code]} for code, name in names.items()],
        "mean_escape_time": statistics.mean_escape_time,
        "flux": flux.numbers(),
        "escape_laws": laws.describe(),
    }
    rows = [(name, f"{shares[code]:.4f}", "{:.4f} … {:.4f}".format(*intervals[code])) for code, name in names.items()]
    parts: list[Table | str] = [Table(("outcome", "share", "95 % interval"), rows)]
    if matching is not None:
        answer["matching"] = list_rows(matching.columns())
        parts += [_matching_table(matching), matching.describe()]
    mean_time = f"Mean time of the escapes: {statistics.mean_escape_time:.4g}."
    print_result(as_json, answer, *parts, mean_time, laws.describe(), flux.describe(), files=files)


def _matching_table(matching: ExitMatching) -> Table:
    """Return a table with a row for each entrance: the share of each end with its interval."""
    low, high = matching.share_intervals
    number_rows = zip(matching.shares.tolist(), low.tolist(), high.tolist(), strict=True)
    cells = [[f"{share:.3f} ({a:.3f} … {b:.3f})" for share, a, b in zip(*row, strict=True)] for row in number_rows]
    names = [name_fate(entrance, matching.outcomes) for entrance in matching.entrances.tolist()]
    return Table(("entered through", *matching.name_ends()), [[name, *row] for name, row in zip(names, cells, strict=True)])
