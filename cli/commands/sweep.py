"""Compute maps at many energies into one labelled Zarr store; the same command resumes an interrupted run.

Without --window, all maps use the window of the highest energy. To open the store with xarray: open_zarr(FOLDER).

Examples:

escape-explorer sweep I --low 0.13 --high 0.5 --count 38 --store sweep-I.zarr

escape-explorer sweep III --plane x_y --energy 0.26 --energy 0.3 --resolution 1024 --store III.zarr --scheduler tcp://node1:8786
"""

from __future__ import annotations

from concurrent.futures import CancelledError
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from cli.arguments import space_values
from cli.execution import Place
from cli.option_marks import DocumentedBy
from cli.options import with_options
from cli.printing import AsJson, print_result
from engine import MEASURES, MapSpec, Potential, Section, Slice, SweepSpec, compute_sweep, plan_sweep
from engine.slices.window import GivenWindow

MEASURE_HELP = f"{', '.join(MEASURES)}; maps by default. Can be repeated."


@with_options
def run(
    *,
    potential: Potential,
    store: Annotated[Path, typer.Option(metavar="FOLDER")],
    low: Annotated[float | None, DocumentedBy(space_values)] = None,
    high: Annotated[float | None, DocumentedBy(space_values)] = None,
    count: Annotated[int | None, DocumentedBy(space_values)] = None,
    energy: Annotated[list[float] | None, DocumentedBy(space_values, "listed")],
    plane: Slice,
    window: Annotated[GivenWindow | None, DocumentedBy(MapSpec)],
    resolution: Annotated[tuple[int, int], DocumentedBy(SweepSpec)],
    t_max: Annotated[float, DocumentedBy(SweepSpec)],
    use_evidence: Annotated[bool, DocumentedBy(MapSpec)],
    section: Section,
    measure: Annotated[list[str] | None, typer.Option(help=MEASURE_HELP)] = None,
    plan: bool = False,
    place: Place,
    as_json: AsJson = False,
) -> None:
    """Compute the maps, or estimate their cost.

    Parameters
    ----------
    store
        Zarr store: a new one, or a store of the same sweep, which is resumed.
    plan
        Estimate the cost without computing.
    """
    energies = space_values(low, high, count, energy)
    spec = SweepSpec(potential, plane, energies, resolution, window, t_max, use_evidence, measure or ("maps",), section=section)
    try:
        with place.run() as context:
            if plan:
                cost = plan_sweep(spec, execution=context.execution)
                print_result(as_json, asdict(cost), f"{cost.describe()}.")
                return
            dataset = compute_sweep(spec, store, execution=context.start_stage("energies")).dataset
    except CancelledError:
        raise CancelledError(
            f"interrupted; completed energies are kept in {store}, and the same command resumes from there"
        ) from None
    sizes = {str(name): size for name, size in dataset.sizes.items()}
    sentence = f"Written: {store}, {' x '.join(f'{size} {name}' for name, size in sizes.items())}"
    print_result(as_json, {"request": dataset.attrs, "dimensions": sizes, "files": [str(store)]}, sentence)
