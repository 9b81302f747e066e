"""Compute measures of the basins at many energies, or values of a parameter, and write them to STEM.nc and STEM.csv.

With --output FILE.png, FILE.svg or FILE.pdf, the measures are drawn instead.

Examples:

escape-explorer curves I --low 0.13 --high 0.5 --count 38 --output curves-I

escape-explorer curves III --plane x_y --low 0.26 --high 0.6 --count 18 --refine 12 --no-exponent --resolution 224
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from cli.arguments import Case, Slow, check_measures, file_name_part
from cli.commands.study import study_content
from cli.execution import THREADS_ONLY, Place
from cli.option_marks import DocumentedBy
from cli.options import with_options
from cli.output_files import Stem, name_files, reserve_output, write_files
from cli.printing import AsJson, Table, list_rows, print_result
from engine import SweepSpec, compute_sweep
from engine.measures.table import curve_names
from engine.results import Sweep
from plots.printed.figure_style import FigureFormat, FigureStyle
from plots.studies.against import AGAINST
from plots.texts.exports import stem_of

MEASURE_HELP = f"{', '.join(curve_names())}; all by default. Can be repeated."

# Names of the columns that are only in files and JSON, not in the printed table.
_ERROR_BAR = re.compile(r"_(low|high)(_|$)|_error$")


@with_options
def run(
    *,
    case: Case,
    spec: SweepSpec,
    refine: Annotated[int, DocumentedBy(SweepSpec)],
    measure: Annotated[list[str] | None, typer.Option(help=MEASURE_HELP)] = None,
    exponent: Slow = True,
    style: FigureStyle,
    output: Stem = None,
    place: Annotated[Place, THREADS_ONLY],
    as_json: AsJson = False,
) -> None:
    """Compute, write and print the measures."""
    measures = check_measures(measure, curve_names()) or curve_names(slow=exponent)
    spec = replace(spec, measures=measures, refine=refine)
    stem = Path(stem_of(f"curves-{file_name_part(case)}-{spec.plane.key}", spec.section))
    paths = name_files(output, ["nc", "csv", *FigureFormat], ["nc", "csv"], stem)
    with reserve_output(output or stem):
        with place.run() as context:
            curves = compute_sweep(spec, execution=context.start_stage("curves"))
        files = write_files({path: study_content(AGAINST, curves, ending, style) for ending, path in paths.items()})
    _print(curves, files, as_json)


def _print(curves: Sweep, files: Sequence[str], as_json: bool) -> None:
    columns = curves.columns()
    points = list_rows(columns)
    shown_names = [name for name in columns if not _ERROR_BAR.search(name)]
    rows = [[f"{point[name]:.4g}".replace("nan", "–") for name in shown_names] for point in points]
    table = Table([name.replace("_", " ") for name in shown_names], rows)
    print_result(as_json, {"points": points}, table, files=files)
