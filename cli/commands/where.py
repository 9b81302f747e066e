"""Find the energy, or the value of a parameter, at which a measure of the basins reaches a value.

With --output STEM, STEM.nc and STEM.csv contain the measures of all maps.

Examples:

escape-explorer where I --quantity share_bounded --value 0.1 --low 0.15 --high 0.2

escape-explorer where III --quantity s_b --value 0.6 --against epsilon --energy 0.3 --low 0.5 --high 1.5 --resolution 224
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

from cli.execution import THREADS_ONLY, Place
from cli.option_marks import DocumentedBy, OptionChanges
from cli.options import with_options
from cli.output_files import Content, Stem, name_files, reserve_output, write_files
from cli.printing import AsJson, Table, list_rows, print_result
from engine import SweepSpec, find_where
from plots.texts.exports import dataset_bytes, table_csv


@with_options
def run(
    *,
    spec: Annotated[SweepSpec, OptionChanges(defaults={"count": 2})],
    quantity: Annotated[str, DocumentedBy(find_where)],
    value: Annotated[float, DocumentedBy(find_where)],
    tolerance: Annotated[float | None, DocumentedBy(find_where)] = None,
    most_maps: Annotated[int, DocumentedBy(find_where)] = 40,
    last: Annotated[bool, DocumentedBy(find_where)] = False,
    output: Stem = None,
    place: Annotated[Place, THREADS_ONLY],
    as_json: AsJson = False,
) -> None:
    """Find the place, and write and print the measures of all maps."""
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
    table = Table((found.axis, quantity, "95 % interval"), rows)
    print_result(as_json, found.numbers() | {"points": maps}, table, found.describe(), files=files)


def _interval(row: Mapping[str, float]) -> str:
    return f"{row['measured_low']:.6g} to {row['measured_high']:.6g}"
