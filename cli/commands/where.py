"""Find the energy, or the value of a parameter, at which a measure of the basins reaches a value.

With --output STEM, STEM.nc and STEM.csv contain the measures of all maps.

Examples:

escape-explorer where I --quantity share_bounded --value 0.1 --low 0.15 --high 0.2

escape-explorer where III --quantity s_b --value 0.6 --against epsilon --energy 0.3 --low 0.5 --high 1.5 --resolution 224
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

import typer

from cli.arguments import space_values, swept_axis
from cli.commands.curves import AGAINST_HELP, ENERGY_HELP
from cli.execution import THREADS_ONLY, Place
from cli.option_marks import DocumentedBy
from cli.options import with_options
from cli.output_files import Content, Stem, name_files, reserve_output, write_files
from cli.printing import AsJson, Table, list_rows, print_result
from engine import Potential, Section, Slice, SweepSpec, System, find_where
from plots.texts.exports import dataset_bytes, table_csv


@with_options
def run(
    *,
    system: System,
    potential: Potential,
    quantity: Annotated[str, DocumentedBy(find_where)],
    value: Annotated[float, DocumentedBy(find_where)],
    low: Annotated[float, DocumentedBy(space_values)],
    high: Annotated[float, DocumentedBy(space_values)],
    count: Annotated[int, DocumentedBy(space_values)] = 2,
    against: Annotated[str, typer.Option(help=AGAINST_HELP)] = "h",
    energy: Annotated[float | None, typer.Option(help=ENERGY_HELP)] = None,
    tolerance: Annotated[float | None, DocumentedBy(find_where)] = None,
    most_maps: Annotated[int, DocumentedBy(find_where)] = 40,
    last: Annotated[bool, DocumentedBy(find_where)] = False,
    plane: Slice,
    resolution: Annotated[tuple[int, int], DocumentedBy(SweepSpec)] = (112, 112),
    t_max: Annotated[float, DocumentedBy(SweepSpec)],
    section: Section,
    output: Stem = None,
    place: Annotated[Place, THREADS_ONLY],
    as_json: AsJson = False,
) -> None:
    """Find the place, and write and print the measures of all maps."""
    spec = SweepSpec(
        potential,
        plane,
        space_values(low, high, count),
        resolution,
        t_max=t_max,
        measures=("shares",),
        along=swept_axis(against, low, high, system),
        energy=energy,
        section=section,
    )
    paths = name_files(output, ["nc", "csv"], ["nc", "csv"])
    with reserve_output(output):
        with place.run() as context:
            found = find_where(
                spec,
                quantity,
                value,
                tolerance=tolerance,
                most_maps=most_maps,
                last=last,
                execution=context.start_stage("maps"),
            )
        contents: dict[str, Content] = {"nc": dataset_bytes(found.to_xarray()), "csv": table_csv(found)} if paths else {}
        files = write_files({path: contents[ending] for ending, path in paths.items()})
    maps = list_rows(found.columns())
    rows = [(f"{row['value']:.6g}", f"{row['measured']:.6g}", _interval(row)) for row in maps]
    table = Table((against, quantity, "95 % interval"), rows)
    print_result(as_json, found.numbers() | {"points": maps}, table, found.describe(), files=files)


def _interval(row: Mapping[str, float]) -> str:
    return f"{row['measured_low']:.6g} to {row['measured_high']:.6g}"
