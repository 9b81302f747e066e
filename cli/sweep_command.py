"""``sweep``: maps at many energies in one store, by a run that may be stopped and gone on with, here or on a cluster."""

from __future__ import annotations

from concurrent.futures import CancelledError
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli import options
from cli.options import PlaneName

if TYPE_CHECKING:
    import xarray as xr

EXAMPLES = """Examples:

escape-explorer sweep I --low 0.13 --high 0.5 --count 38 --store sweep-I.zarr

escape-explorer sweep III --plane x_y --energy 0.26 --energy 0.3 --resolution 1024 --store III.zarr --scheduler tcp://node1:8786
"""


def sweep_energies(
    case: options.Case,
    store: Annotated[
        Path,
        typer.Option("--store", metavar="FOLDER", help="The Zarr store: a new one, or that of the same sweep to go on with."),
    ],
    low: Annotated[float | None, typer.Option("--low", help="The lowest h.")] = None,
    high: Annotated[float | None, typer.Option("--high", help="The highest h.")] = None,
    count: Annotated[int | None, typer.Option("--count", min=1, max=10_000, help="How many energies, evenly spaced.")] = None,
    energy: Annotated[list[float] | None, typer.Option("--energy", help="An energy instead; once for each.")] = None,
    plane: options.Plane = PlaneName.X_PX,
    window: options.Window = None,
    resolution: options.Resolution = "225",
    t_max: options.TMax = 1e5,
    certify: options.Certify = True,
    piece: Annotated[
        int | None,
        typer.Option(
            "--piece", metavar="STARTS", help="Most starts that are computed, or lost by a kill, together: 1 to 1048576."
        ),
    ] = None,
    plan: Annotated[bool, typer.Option("--plan", help="Only say what it will cost.")] = False,
    threads: options.Threads = None,
    scheduler: options.Scheduler = None,
    local_cluster: options.LocalCluster = None,
    as_json: options.AsJson = False,
) -> None:
    """Compute maps at many energies into one labelled Zarr store; a run that was stopped goes on from what is done.

    Without --window all maps have that of the highest energy. With xarray: open_zarr(FOLDER, consolidated=False).
    """
    from cli.answers import print_sentences
    from cli.clusters import cluster_executor
    from cli.potentials import find_potential
    from cli.requests import find_plane, read_resolution, space_energies
    from cli.work import working
    from engine import SweepSpec, Window, plan_sweep, run_sweep

    energies = space_energies(low, high, count, energy)
    frame = None if window is None else Window(*window)
    sides = read_resolution(resolution)
    spec = SweepSpec(find_potential(case), find_plane(plane), energies, sides, frame, t_max, certify, piece)
    try:
        with cluster_executor(scheduler, local_cluster, threads) as executor, working(threads, executor) as work:
            if plan:
                print_sentences(f"{plan_sweep(spec, executor=work.executor, cancel=work.cancel).describe()}.")
                return
            report = work.begin("energies")
            dataset = run_sweep(spec, store, on_progress=report, cancel=work.cancel, executor=work.executor)
    except CancelledError:
        raise CancelledError(
            f"stopped; the energies and bands that are done stay in {store}, and the same command goes on from there"
        ) from None
    _answer(dataset, store, as_json)


def _answer(dataset: xr.Dataset, store: Path, as_json: bool) -> None:
    from cli.answers import print_json, print_sentences

    sizes = {str(name): size for name, size in dataset.sizes.items()}
    if as_json:
        print_json({"request": dataset.attrs, "dimensions": sizes, "files": [str(store)]})
    else:
        print_sentences(f"Written: {store}, {' x '.join(f'{size} {name}' for name, size in sizes.items())}")
