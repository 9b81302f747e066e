"""Command ``map``: a map of escapes as data and pictures."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli import options
from cli.options import DEFAULT_PLANE, DEFAULT_STYLE

if TYPE_CHECKING:
    from engine import EscapeMap
    from plots.pictures.map_analyses import MapAnalyses

EXAMPLES = """Examples:

escape-explorer map I --energy 0.19 --output first

escape-explorer map II --energy 0.2 --axes y,py --fix x=0.1

escape-explorer map I --energy 0.2 --axes x,epsilon=0.5:2

escape-explorer map III --energies 0.25 1 --plane x_h --resolution 400x300 --format png --json

escape-explorer map II --energy 0.2 --picture basins --output basins.pdf --width 8.5 --no-titles

escape-explorer map II --energy 0.2 --resolution 4000 --format nc --scheduler tcp://node1:8786
"""

FIRST_PICTURES = ("basins", "times", "crossings")
"""Pictures drawn by default; those of requested analyses follow."""


class Format(StrEnum):
    """Output format, by file ending."""

    NC = "nc"
    PNG = "png"
    SVG = "svg"
    PDF = "pdf"


DEFAULT_FORMATS = (Format.NC, Format.PNG)


def draw_map(
    case: options.Case,
    energy: options.Energy = None,
    energies: options.Energies = None,
    plane: options.Plane = DEFAULT_PLANE,
    fix: options.Fix = None,
    window: options.Window = None,
    resolution: options.Resolution = "224",
    t_max: options.TMax = 1e5,
    use_evidence: options.UseEvidence = True,
    backward: options.Backward = False,
    trust: Annotated[
        bool, typer.Option("--trust", help="Find and mark doubtful pixels, whose fate depends on rounding.")
    ] = False,
    judge: Annotated[bool, typer.Option("--judge", help="Classify bounded orbits as regular or chaotic.")] = False,
    origins: Annotated[bool, typer.Option("--origins", help="Find the exit that each orbit entered by.")] = False,
    manifolds: Annotated[
        int,
        typer.Option(
            "--manifolds", metavar="IMAGES", help="Number of images of the stable manifolds, on x_px: 1 to 6; 0 for none."
        ),
    ] = 0,
    count_outside: Annotated[bool, typer.Option("--count-outside", help="Count starts beyond an exit as escaped.")] = False,
    picture: Annotated[
        list[str] | None,
        typer.Option(
            "--picture", help="Picture to draw: curves, basins, times, crossings, characters or origins; repeat for several."
        ),
    ] = None,
    palette: options.PaletteName = "paper",
    width: options.Width = DEFAULT_STYLE.width,
    dpi: options.Dpi = DEFAULT_STYLE.dpi,
    font_size: options.FontSize = DEFAULT_STYLE.font_size,
    titles: options.Titles = DEFAULT_STYLE.titles,
    formats: Annotated[
        list[Format] | None,
        typer.Option("--format", help="Output format; repeat for several. By default that of --output, or else nc and png."),
    ] = None,
    output: options.Output = None,
    threads: options.Threads = None,
    scheduler: options.Scheduler = None,
    local_cluster: options.LocalCluster = None,
    as_json: options.AsJson = False,
) -> None:
    """Compute a map: exit channel, escape time and crossings of each start, written to STEM.nc and STEM.png.

    The NetCDF file contains all results and the request; stable manifolds go to STEM-manifolds.csv.
    """
    from cli import map_output
    from cli.arguments import build_map_spec
    from cli.clusters import cluster_executor
    from cli.files import reserve_output, split_ending, write_files
    from cli.map_analyses import AnalysisOptions, compute_map_with_analyses
    from cli.potential_argument import file_name_part
    from cli.run_context import cancellable_run
    from plots.printed.figure_style import FigureStyle
    from plots.texts.exports import file_stem

    spec = build_map_spec(case, plane, fix, energy, energies, window, resolution, t_max, use_evidence, backward)
    wanted = AnalysisOptions(judge or "characters" in (picture or ()), origins or "origins" in (picture or ()), trust, manifolds)
    wanted.check(spec)
    style = FigureStyle(width, dpi, font_size, titles)
    drawing = map_output.Drawing.of(picture or [*FIRST_PICTURES, *wanted.pictures], palette, style)
    stem = output or Path(file_stem(spec, file_name_part(case)))
    endings: Sequence[str] = formats or ()
    if not endings:
        stem, endings = split_ending(stem, list(Format), DEFAULT_FORMATS)
    with reserve_output(stem):
        with cluster_executor(scheduler, local_cluster, threads) as executor, cancellable_run(threads, executor) as run:
            frame, analyses = compute_map_with_analyses(spec, wanted, run)
        # After the cluster is closed: with a Dask client, xarray uses distributed locks, which in-memory files do not support.
        with cancellable_run() as run:
            run.start_stage("writing")
            files = map_output.contents(stem, endings, frame, analyses, drawing)
        written = write_files(files)
    _print_result(frame, analyses, written, count_outside, as_json)


def _print_result(frame: EscapeMap, analyses: MapAnalyses, files: Sequence[str], count_outside: bool, as_json: bool) -> None:
    from cli.map_analyses import describe_analyses
    from cli.output import outcome_shares, print_json, print_sentences, print_table
    from engine.propagation.fates import UNRESOLVED

    shares = outcome_shares(frame, count_outside=count_outside)
    sentences = describe_analyses(analyses)
    if as_json:
        answer: dict[str, Any] = {"request": frame.provenance(), "shares": shares, "findings": sentences, "files": files}
        print_json(answer)
        return
    print_table(
        ("outcome", "share"), [(name, f"{100 * share:.2f} %") for name, share in shares.items() if share or name != UNRESOLVED]
    )
    print_sentences(*sentences, f"Written: {', '.join(files)}")
