"""Command ``ensemble``: many random orbits, the shares of the exits, and a movie of the well as it drains."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli import options
from cli.options import DEFAULT_STYLE

if TYPE_CHECKING:
    import numpy as np

    from engine import DecayLaws, EscapeFlux, EscapeStatistics, Potential

EXAMPLES = """Examples:

escape-explorer ensemble III --energy 0.45 --count 100000 --t-max 1e4

escape-explorer ensemble III --energy 0.45 --count 3000 --t-max 25 --output draining.mp4

escape-explorer ensemble I --energy 0.19 --plane x_px --window 0 0.1 0 0.1 --output box.nc
"""


def follow_ensemble(
    case: options.Case,
    energy: Annotated[float, typer.Option("--energy", help="h, dimensionless.")],
    count: Annotated[int, typer.Option("--count", min=1, max=10_000_000, help="Number of orbits.")] = 3000,
    seed: Annotated[int, typer.Option("--seed", min=0, help="Equal seeds give equal starts.")] = 0,
    plane: Annotated[
        str | None,
        typer.Option("--plane", "--axes", metavar="AXES", help="Slice of the starts; by default the whole energy surface."),
    ] = None,
    fix: options.Fix = None,
    window: options.Window = None,
    entering: Annotated[
        bool, typer.Option("--entering", help="Start on the exits and go inward, distributed as the flux: gap times.")
    ] = False,
    t_max: options.TMax = 25.0,
    frames: Annotated[
        int, typer.Option("--frames", min=2, max=5000, help="Times of the movie or of the NetCDF file, evenly spaced.")
    ] = 126,
    palette: options.PaletteName = "paper",
    width: options.Width = DEFAULT_STYLE.width,
    dpi: options.Dpi = 120.0,
    font_size: options.FontSize = DEFAULT_STYLE.font_size,
    titles: options.Titles = DEFAULT_STYLE.titles,
    threads: options.Threads = None,
    output: options.Output = None,
    as_json: options.AsJson = False,
) -> None:
    """Follow random orbits, uniform on the energy surface, on a slice, or entering through the exits.

    Prints the shares of the exits, and the decay rate beside flux over volume. With --output, FILE.webp, FILE.gif or FILE.mp4 is
    a movie, FILE.nc has the paths, and FILE.csv the starts and outcomes; of a STEM, the movie as WebP and the table.
    """
    from cli.arguments import find_palette
    from cli.ensemble_output import Drawing, check_count, contents
    from cli.files import reserve_output, write_files
    from cli.potential_argument import find_potential
    from cli.run_context import cancellable_run
    from engine import classify_orbits, compute_flux, compute_statistics, fit_decay_laws
    from plots.printed.figure_style import FigureStyle

    potential, drawing = find_potential(case), Drawing(find_palette(palette), FigureStyle(width, dpi, font_size, titles), frames)
    check_count(output, count)
    starts = _draw_starts(case, potential, energy, count, seed, plane, fix, window, entering)
    files: list[str] = []
    with reserve_output(output):
        with cancellable_run(threads) as run:
            outcomes = classify_orbits(potential, energy, starts, t_max, execution=run.start_stage("orbits"))
            run.execution.raise_if_cancelled()
            laws = fit_decay_laws(outcomes)
            written = {} if output is None else contents(output, potential, starts, outcomes, drawing, run)
        files = write_files(written)
    _print_result(compute_statistics(outcomes), laws, compute_flux(potential, energy), files, as_json)


def _draw_starts(
    case: str,
    potential: Potential,
    energy: float,
    count: int,
    seed: int,
    plane: str | None,
    fix: list[str] | None,
    window: options.Edges | None,
    entering: bool,
) -> np.ndarray:
    """Return the (count, 4) states; ValueError for options that exclude each other."""
    from cli.arguments import find_plane
    from engine import sample_entrances, sample_starts

    if not entering:
        chosen = None if plane is None else find_plane(plane, fix, case)
        return sample_starts(potential, energy, count, plane=chosen, window=window, seed=seed)
    if plane is not None or window is not None:
        raise ValueError("entering: orbits start on the exits; leave --plane and --window out")
    return sample_entrances(potential, energy, count, seed=seed)


def _print_result(statistics: EscapeStatistics, laws: DecayLaws, flux: EscapeFlux, files: list[str], as_json: bool) -> None:
    from cli.output import print_json, print_sentences, print_table
    from engine import Fate
    from engine.propagation.fates import name_fate

    shares, intervals = statistics.shares, statistics.share_intervals
    shown = {code: name_fate(code, statistics.outcomes) for code in shares if code >= Fate.BOUNDED or shares[code]}
    if as_json:
        outcomes = [{"outcome": name, "share": shares[code], "interval": intervals[code]} for code, name in shown.items()]
        answer: dict[str, Any] = {"outcomes": outcomes, "mean_escape_time": statistics.mean_escape_time, "flux": flux.numbers()}
        print_json(answer | {"escape_laws": laws.describe(), "files": files})
        return
    rows = [(name, f"{shares[code]:.4f}", "{:.4f} … {:.4f}".format(*intervals[code])) for code, name in shown.items()]
    print_table(("outcome", "share", "95 % interval"), rows)
    sentences = [f"Mean time of the escapes: {statistics.mean_escape_time:.4g}.", laws.describe(), flux.describe()]
    print_sentences(*sentences, *([f"Written: {', '.join(files)}"] if files else []))
