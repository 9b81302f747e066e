"""Command ``sweep``: maps at many energies in one Zarr store, resumable, on this machine or a cluster."""

from __future__ import annotations

from concurrent.futures import CancelledError
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli import options
from cli.options import DEFAULT_PLANE

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
        typer.Option("--store", metavar="FOLDER", help="Zarr store: a new one, or one of the same sweep to resume."),
    ],
    low: Annotated[float | None, typer.Option("--low", help="Lowest h.")] = None,
    high: Annotated[float | None, typer.Option("--high", help="Highest h.")] = None,
    count: Annotated[int | None, typer.Option("--count", min=1, max=10_000, help="Number of evenly spaced energies.")] = None,
    energy: Annotated[
        list[float] | None, typer.Option("--energy", help="An energy; repeat for several, instead of --low, --high and --count.")
    ] = None,
    plane: options.Plane = DEFAULT_PLANE,
    fix: options.Fix = None,
    window: options.Window = None,
    resolution: options.Resolution = "224",
    t_max: options.TMax = 1e5,
    use_evidence: options.UseEvidence = True,
    measure: Annotated[
        list[str] | None,
        typer.Option(
            "--measure", help="What is kept of each map, such as shares or basin_entropy; repeat. By default its arrays."
        ),
    ] = None,
    plan: Annotated[bool, typer.Option("--plan", help="Only estimate the cost.")] = False,
    threads: options.Threads = None,
    scheduler: options.Scheduler = None,
    local_cluster: options.LocalCluster = None,
    as_json: options.AsJson = False,
) -> None:
    """Compute maps at many energies into one labelled Zarr store; an interrupted run is resumed by the same command.

    Without --window all maps use the window of the highest energy. With xarray: open_zarr(FOLDER).
    """
    from cli.arguments import find_plane, read_resolution, space_energies
    from cli.clusters import cluster_executor
    from cli.output import print_sentences
    from cli.potential_argument import find_potential
    from cli.run_context import cancellable_run
    from engine import SweepSpec, Window, compute_sweep, plan_sweep

    energies = space_energies(low, high, count, energy)
    frame = None if window is None else Window(*window)
    sides = read_resolution(resolution)
    spec = SweepSpec(
        find_potential(case), find_plane(plane, fix, case), energies, sides, frame, t_max, use_evidence, measure or ("maps",)
    )
    try:
        with cluster_executor(scheduler, local_cluster, threads) as executor, cancellable_run(threads, executor) as run:
            if plan:
                print_sentences(f"{plan_sweep(spec, execution=run.execution).describe()}.")
                return
            dataset = compute_sweep(spec, store, execution=run.start_stage("energies")).dataset
    except CancelledError:
        raise CancelledError(
            f"interrupted; completed energies are kept in {store}, and the same command resumes from there"
        ) from None
    _print_result(dataset, store, as_json)


def _print_result(dataset: xr.Dataset, store: Path, as_json: bool) -> None:
    from cli.output import print_json, print_sentences

    sizes = {str(name): size for name, size in dataset.sizes.items()}
    if as_json:
        print_json({"request": dataset.attrs, "dimensions": sizes, "files": [str(store)]})
    else:
        print_sentences(f"Written: {store}, {' x '.join(f'{size} {name}' for name, size in sizes.items())}")
