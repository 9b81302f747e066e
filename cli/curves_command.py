"""Command ``curves``: shares, entropies, exponent and escape times against energy."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli import options
from cli.options import DEFAULT_PLANE

if TYPE_CHECKING:
    from engine import EnergyCurves

EXAMPLES = """Examples:

escape-explorer curves I --low 0.13 --high 0.5 --count 38 --output curves-I

escape-explorer curves III --plane x_y --low 0.26 --high 0.6 --count 18 --no-exponent --resolution 224
"""


def draw_curves(
    case: options.Case,
    low: Annotated[float, typer.Option("--low", help="Lowest h.")],
    high: Annotated[float, typer.Option("--high", help="Highest h.")],
    count: Annotated[int, typer.Option("--count", min=1, max=1000, help="Number of evenly spaced energies.")],
    plane: options.Plane = DEFAULT_PLANE,
    resolution: options.Resolution = "112",
    t_max: options.TMax = 1e5,
    exponent: Annotated[
        bool, typer.Option("--exponent/--no-exponent", help="Whether to compute the uncertainty exponent, which takes longest.")
    ] = True,
    output: options.Output = None,
    threads: options.Threads = None,
    as_json: options.AsJson = False,
) -> None:
    """Compute measures of the basins at many energies, written to STEM.nc and STEM.csv."""
    from cli.arguments import find_plane, read_resolution, space_energies
    from cli.files import add_ending, reserve_output, write_files
    from cli.potential_argument import file_name_part, find_potential
    from cli.run_context import cancellable_run
    from engine import EnergyCurvesSpec, compute_energy_curves

    energies = space_energies(low, high, count)
    spec = EnergyCurvesSpec(find_potential(case), find_plane(plane), energies, read_resolution(resolution), t_max, exponent)
    stem = output or Path(f"curves-{file_name_part(case)}-{plane}")
    with reserve_output(stem):
        with cancellable_run(threads) as run:
            curves = compute_energy_curves(spec, execution=run.start_stage("energies"))
        netcdf = bytes(curves.to_xarray().to_netcdf(engine="h5netcdf"))
        head, rows = _tabulate(curves)
        table = "\n".join([",".join(head), *(",".join(map(repr, row)) for row in rows)]) + "\n"
        files = write_files({add_ending(stem, "nc"): netcdf, add_ending(stem, "csv"): table})
    _print_result(head, rows, files, as_json)


def _tabulate(curves: EnergyCurves) -> tuple[list[str], list[list[float]]]:
    """Return column names and rows: h, the shares, then the other curves; missing numbers are NaN."""
    dataset = curves.to_xarray()
    others = [str(name) for name in dataset.data_vars if name != "share"]
    head = ["h", "bounded", *(f"channel_{k}" for k in range(1, curves.shares.shape[1])), *others]
    columns = [curves.energies, *curves.shares.T, *(curves.curve(name) for name in others)]
    return head, [list(row) for row in zip(*(column.tolist() for column in columns), strict=True)]


def _print_result(head: list[str], rows: list[list[float]], files: list[str], as_json: bool) -> None:
    from cli.output import print_json, print_sentences, print_table

    if as_json:
        print_json({"points": [dict(zip(head, row, strict=True)) for row in rows], "files": files})
        return
    print_table(
        [name.replace("_", " ") for name in head], [[f"{number:.4g}".replace("nan", "–") for number in row] for row in rows]
    )
    print_sentences(f"Written: {', '.join(files)}")
