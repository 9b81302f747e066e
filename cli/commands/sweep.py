"""Compute maps at many energies, or along other axes, into one labelled Zarr store; the same command resumes an interrupted run.

Without --window, all maps along energies use the window of the highest energy. To open the store with xarray: open_zarr(FOLDER).

Examples:

escape-explorer sweep I --low 0.13 --high 0.5 --count 38 --store sweep-I.zarr

escape-explorer sweep III --plane x_y --energy 0.26 --energy 0.3 --resolution 1024 --store III.zarr --scheduler tcp://node1:8786

escape-explorer sweep I --axis omega_1=0.9:1.1:21 --axis epsilon=0.8:1.2:21 --energy 0.2 --measure shares --store plate.zarr
"""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import CancelledError
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from cli.arguments import space_values, swept_axis
from cli.execution import Place
from cli.option_marks import DocumentedBy
from cli.options import with_options
from cli.printing import AsJson, print_result
from engine import MEASURES, MapSpec, Potential, Section, Slice, SweepSpec, System, compute_sweep, plan_sweep
from engine.slices.window import GivenWindow
from engine.sweeps.axes import SweepAxis

AXIS_HELP = (
    "Axis instead of h with its range and number of values: h, jacobi, or a parameter, such as epsilon=0.8:1.2:9; can be given "
    "twice. Along parameters alone, --energy is h of all maps."
)
MEASURE_HELP = f"{', '.join(MEASURES)}; maps by default. Can be repeated."


@with_options
def run(
    *,
    system: System,
    potential: Potential,
    store: Annotated[Path, typer.Option(metavar="FOLDER")],
    low: Annotated[float | None, DocumentedBy(space_values)] = None,
    high: Annotated[float | None, DocumentedBy(space_values)] = None,
    count: Annotated[int | None, DocumentedBy(space_values)] = None,
    energy: Annotated[list[float] | None, DocumentedBy(space_values, "listed")],
    axis: Annotated[list[str] | None, typer.Option(metavar="NAME=LOW:HIGH:COUNT", help=AXIS_HELP)] = None,
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
    spec = SweepSpec(
        potential,
        plane,
        **_read_axes(system, axis, low, high, count, energy),
        resolution=resolution,
        window=window,
        t_max=t_max,
        use_evidence=use_evidence,
        measures=measure or ("maps",),
        section=section,
    )
    try:
        with place.run() as context:
            if plan:
                cost = plan_sweep(spec, execution=context.execution)
                print_result(as_json, asdict(cost), f"{cost.describe()}.")
                return
            dataset = compute_sweep(spec, store, execution=context.start_stage("values")).dataset
    except CancelledError:
        raise CancelledError(
            f"interrupted; completed values are kept in {store}, and the same command resumes from there"
        ) from None
    sizes = {str(name): size for name, size in dataset.sizes.items()}
    sentence = f"Written: {store}, {' x '.join(f'{size} {name}' for name, size in sizes.items())}"
    print_result(as_json, {"request": dataset.attrs, "dimensions": sizes, "files": [str(store)]}, sentence)


def _read_axes(
    system: System,
    texts: Sequence[str] | None,
    low: float | None,
    high: float | None,
    count: int | None,
    energies: Sequence[float] | None,
) -> dict[str, Any]:
    """Return the axes of a sweep, the values on them, and h of all maps, as arguments of `SweepSpec`."""
    if not texts:
        return {"values": space_values(low, high, count, energies)}
    if not low is high is count is None or len(energies or ()) > 1:
        raise ValueError("axis: must be given without --low, --high and --count, and with at most one --energy")
    axes, values = zip(*(_read_axis(text, system) for text in texts), strict=True)
    return {"along": axes, "values": values if len(axes) > 1 else values[0], "energy": next(iter(energies or ()), None)}


def _read_axis(text: str, system: System) -> tuple[SweepAxis, tuple[float, ...]]:
    """Return an axis and its values."""
    name, _, numbers = text.partition("=")
    try:
        low, high, count = numbers.split(":")
        ends, number = (float(low), float(high)), int(count)
    except ValueError:
        raise ValueError(f"axis={text!r}: must be NAME=LOW:HIGH:COUNT, such as epsilon=0.8:1.2:9") from None
    return swept_axis(name, *ends, system), space_values(*ends, number)
