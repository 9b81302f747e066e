"""``map``: a map of escapes, as numbers and as pictures."""

from __future__ import annotations

from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli import options
from cli.options import PlaneName

if TYPE_CHECKING:
    from app.rendering.map_analyses import MapAnalyses
    from engine import EscapeMap

EXAMPLES = """Examples:

escape-explorer map I --energy 0.19 --output first

escape-explorer map III --energies 0.25 1 --plane x_h --resolution 400x300 --format png --json

escape-explorer map II --energy 0.2 --resolution 4000 --format nc --scheduler tcp://node1:8786
"""

FIRST_PICTURES = ("basins", "times", "crossings")
"""The pictures drawn unless others are asked for; those of second looks come after."""


class Format(StrEnum):
    """What is written, by its ending."""

    NC = "nc"
    PNG = "png"


def draw_map(
    case: options.Case,
    energy: options.Energy = None,
    energies: options.Energies = None,
    plane: options.Plane = PlaneName.X_PX,
    window: options.Window = None,
    resolution: options.Resolution = "225",
    t_max: options.TMax = 1e5,
    certify: options.Certify = True,
    backward: options.Backward = False,
    trust: Annotated[
        bool, typer.Option("--trust", help="Find and mark doubtful pixels, whose answer hangs on rounding.")
    ] = False,
    judge: Annotated[bool, typer.Option("--judge", help="Tell regular from chaotic bounded orbits.")] = False,
    origins: Annotated[bool, typer.Option("--origins", help="Find by which exit orbits came in, too.")] = False,
    manifolds: Annotated[
        int,
        typer.Option(
            "--manifolds", metavar="IMAGES", help="So many images of the stable manifolds, on x_px: 1 to 6; 0 for none."
        ),
    ] = 0,
    count_outside: Annotated[
        bool, typer.Option("--count-outside", help="In the shares, count starts beyond an exit as escaped by it.")
    ] = False,
    picture: Annotated[
        list[str] | None,
        typer.Option(
            "--picture", help="A picture to draw: curves, basins, times, crossings, characters or origins; once for each."
        ),
    ] = None,
    palette: Annotated[str, typer.Option("--palette", help="Colours: paper, or safe for the colour-blind.")] = "paper",
    side: Annotated[int, typer.Option("--side", help="Of each picture in pixels, 100 to 4000.")] = 600,
    formats: Annotated[
        list[Format] | None, typer.Option("--format", help="A format to write, once for each; without it, both.")
    ] = None,
    output: options.Output = None,
    threads: options.Threads = None,
    scheduler: options.Scheduler = None,
    local_cluster: options.LocalCluster = None,
    as_json: options.AsJson = False,
) -> None:
    """Where orbits escape, when, and after how many crossings: STEM.nc and STEM.png, and the shares of the exits.

    The NetCDF file holds all numbers with what made them; stable manifolds go to STEM-manifolds.csv.
    """
    from app.exports import file_stem
    from cli import map_files
    from cli.clusters import cluster_executor
    from cli.map_work import FollowUpRequests, compute_with_second_looks
    from cli.potentials import name_in_files
    from cli.requests import build_map_spec
    from cli.work import working
    from cli.written_files import check_folder, write_files

    spec = build_map_spec(case, plane, energy, energies, window, resolution, t_max, certify, backward)
    wanted = FollowUpRequests(judge or "characters" in (picture or ()), origins or "origins" in (picture or ()), trust, manifolds)
    wanted.check(spec)
    drawing = map_files.Drawing.of(picture or [*FIRST_PICTURES, *wanted.pictures], palette, side)
    stem = output or Path(file_stem(spec, name_in_files(case)))
    check_folder(stem)
    with cluster_executor(scheduler, local_cluster, threads) as executor, working(threads, executor) as work:
        frame, findings = compute_with_second_looks(spec, wanted, work)
    # Not before the cluster is left: with a Dask client about, xarray locks files by it, which no file in memory survives.
    with working() as work:
        work.begin("writing")
        files = map_files.contents(stem, [one.value for one in formats or Format], frame, findings, drawing)
    _answer(frame, findings, write_files(files), count_outside, as_json)


def _answer(frame: EscapeMap, findings: MapAnalyses, files: Sequence[str], count_outside: bool, as_json: bool) -> None:
    from cli.answers import name_shares, print_json, print_sentences, print_table
    from cli.map_work import describe_findings

    shares = name_shares(frame, count_outside=count_outside)
    sentences = describe_findings(findings)
    if as_json:
        answer: dict[str, Any] = {"request": frame.provenance(), "shares": shares, "findings": sentences, "files": files}
        print_json(answer)
        return
    print_table(
        ("outcome", "share"), [(name, f"{100 * share:.2f} %") for name, share in shares.items() if share or name != "failed"]
    )
    print_sentences(*sentences, f"Written: {', '.join(files)}")
