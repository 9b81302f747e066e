"""Command ``curves``: shares, entropies, exponent and escape times against energy."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli import options
from cli.options import DEFAULT_PLANE, DEFAULT_STYLE

if TYPE_CHECKING:
    from cli.files import Content
    from engine import Sweep
    from plots.printed.figure_style import FigureStyle

# Columns that are in files and JSON only.
_ERROR_BAR = re.compile(r"_(low|high)(_|$)|_error$")

EXAMPLES = """Examples:

escape-explorer curves I --low 0.13 --high 0.5 --count 38 --output curves-I

escape-explorer curves III --plane x_y --low 0.26 --high 0.6 --count 18 --refine 12 --no-exponent --resolution 224
"""


def draw_curves(
    case: options.Case,
    low: Annotated[float, typer.Option("--low", help="Lowest h, or value of the parameter.")],
    high: Annotated[float, typer.Option("--high", help="Highest h, or value of the parameter.")],
    count: Annotated[int, typer.Option("--count", min=1, max=1000, help="Number of evenly spaced values.")],
    against: Annotated[
        str, typer.Option("--against", help="h, or a parameter: omega_1, omega_2, epsilon or a letter of the formula.")
    ] = "h",
    energy: Annotated[float | None, typer.Option("--energy", help="h of all maps along a parameter.")] = None,
    refine: Annotated[
        int, typer.Option("--refine", min=0, max=1000, help="Number of further values, where the shares change most.")
    ] = 0,
    plane: options.Plane = DEFAULT_PLANE,
    fix: options.Fix = None,
    resolution: options.Resolution = "112",
    t_max: options.TMax = 1e5,
    exponent: Annotated[
        bool, typer.Option("--exponent/--no-exponent", help="Whether to compute the uncertainty exponent, which takes longest.")
    ] = True,
    width: options.Width = DEFAULT_STYLE.width,
    dpi: options.Dpi = DEFAULT_STYLE.dpi,
    font_size: options.FontSize = DEFAULT_STYLE.font_size,
    titles: options.Titles = DEFAULT_STYLE.titles,
    output: options.Output = None,
    threads: options.Threads = None,
    as_json: options.AsJson = False,
) -> None:
    """Compute measures of the basins at many energies, or values of a parameter, written to STEM.nc and STEM.csv.

    With --output FILE.png, FILE.svg or FILE.pdf they are drawn instead.
    """
    from cli.arguments import find_plane, read_resolution, space_energies
    from cli.files import add_ending, reserve_output, split_ending, write_files
    from cli.potential_argument import file_name_part, find_potential, find_system
    from cli.run_context import cancellable_run
    from engine import ParameterAxis, SweepSpec, compute_sweep
    from engine.sweeps.measures import CURVES, QUICK_CURVES
    from plots.printed.figure_style import FigureFormat, FigureStyle

    style, values = FigureStyle(width, dpi, font_size, titles), space_energies(low, high, count)
    along = None if against == "h" else ParameterAxis(against, low, high, find_system(case))
    slice_of_starts, sides = find_plane(plane, fix, case), read_resolution(resolution)
    measures = CURVES if exponent else QUICK_CURVES
    spec = SweepSpec(
        find_potential(case), slice_of_starts, values, sides, t_max=t_max, measures=measures, along=along, energy=energy,
        refine=refine,
    )  # fmt: skip
    stem, endings = split_ending(
        output or Path(f"curves-{file_name_part(case)}-{spec.plane.key}"), ["nc", "csv", *FigureFormat], ["nc", "csv"]
    )
    with reserve_output(stem):
        with cancellable_run(threads) as run:
            curves = compute_sweep(spec, execution=run.start_stage("curves"))
        files = write_files({add_ending(stem, ending): _content(curves, ending, style) for ending in endings})
    _print_result(curves, files, as_json)


def _content(curves: Sweep, ending: str, style: FigureStyle) -> Content:
    """Return the content of the output file with this ending."""
    if ending == "nc":
        from plots.texts.exports import dataset_bytes

        return dataset_bytes(curves.dataset)
    if ending == "csv":
        from plots.texts.exports import curves_csv

        return curves_csv(curves)
    from plots.printed.figure_files import curves_figure_bytes
    from plots.printed.figure_style import FigureFormat

    return curves_figure_bytes(curves, FigureFormat(ending), style)


def _print_result(curves: Sweep, files: list[str], as_json: bool) -> None:
    from cli.output import print_json, print_sentences, print_table
    from plots.texts.exports import curve_columns

    columns = curve_columns(curves)
    if as_json:
        rows = zip(*(column.tolist() for column in columns.values()), strict=True)
        print_json({"points": [dict(zip(columns, row, strict=True)) for row in rows], "files": files})
        return
    shown = {name: column for name, column in columns.items() if not _ERROR_BAR.search(name)}
    cells = zip(*shown.values(), strict=True)
    print_table(
        [name.replace("_", " ") for name in shown], [[f"{number:.4g}".replace("nan", "–") for number in row] for row in cells]
    )
    print_sentences(f"Written: {', '.join(files)}")
