"""Command ``deep-map``: a map of a window that double precision cannot resolve."""

from __future__ import annotations

from typing import Annotated

import typer

from cli import options

EXAMPLES = """Examples:

escape-explorer deep-map II --energy 0.25 --centre 0.171759434640462745447484517354 0.05 --width 1e-24 --resolution 32 --t-max 300
"""


def draw_deep_map(
    case: options.Case,
    energy: Annotated[float, typer.Option("--energy", help="h, dimensionless.")],
    centre: Annotated[
        tuple[str, str], typer.Option("--centre", metavar="X Y", help="Centre of the window, with all its digits.")
    ],
    width: Annotated[float, typer.Option("--width", help="Width and height of the window.")],
    plane: options.Plane = options.DEFAULT_PLANE,
    fix: options.Fix = None,
    resolution: options.Resolution = "32",
    t_max: options.TMax = 1e3,
    backward: options.Backward = False,
    output: options.Output = None,
    threads: options.Threads = None,
    as_json: options.AsJson = False,
) -> None:
    """Compute a map with about 32 digits, 50 to 120 times slower than `map`, written to STEM.nc and STEM.png."""
    from pathlib import Path

    from cli.arguments import build_map_spec
    from cli.files import add_ending, reserve_output, write_files
    from cli.output import print_json, print_sentences, print_table
    from cli.potential_argument import file_name_part
    from cli.run_context import cancellable_run
    from engine import compute_deep_map
    from plots.exports import dataset_bytes
    from plots.figure_files import deep_map_figure_bytes

    spec = build_map_spec(case, plane, fix, energy, None, None, resolution, t_max, False, backward)
    stem = output or Path(f"deep-map-{file_name_part(case)}")
    with reserve_output(stem):
        with cancellable_run(threads) as run:
            deep = compute_deep_map(spec, centre, width, execution=run.start_stage("map"))
        contents = {add_ending(stem, "nc"): dataset_bytes(deep.to_xarray()), add_ending(stem, "png"): deep_map_figure_bytes(deep)}
        files = write_files(contents)
    if as_json:
        print_json({"request": deep.provenance(), "numbers": deep.numbers(), "files": files})
        return
    print_table(("number", "value"), list(deep.shown_numbers().items()))
    print_sentences(f"Written: {', '.join(files)}")
