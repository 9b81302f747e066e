"""Compute a map and write a live figure, OUTPUT.html, in which the browser computes the map again while its reader changes it.

The file needs no server and no network.

Examples:

escape-explorer live III --plane x_px --energy 0.45 --output figure

escape-explorer live II --energy 0.2 --start 0.1 -0.2 --caption "An orbit of case II."
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from cli.arguments import Case, file_name_part
from cli.execution import Place
from cli.option_marks import DocumentedBy
from cli.options import with_options
from cli.output_files import Stem, add_ending, reserve_output, split_ending, write_files
from cli.printing import AsJson, print_result
from engine import MapSpec, compute_map
from plots.pictures.palette import Palette
from plots.printed.live_figure import live_figure, live_refusal
from plots.texts.exports import file_stem

Energies = Annotated[tuple[float, float] | None, typer.Option(metavar="LOW HIGH"), DocumentedBy(live_figure, "energies")]
"""Type of the option for the energies that a reader can choose."""


@with_options
def run(
    *,
    case: Case,
    spec: MapSpec,
    shown_energies: Energies = None,
    start: Annotated[tuple[float, float] | None, typer.Option(metavar="X ORDINATE")] = None,
    caption: Annotated[str, DocumentedBy(live_figure)] = "",
    link: Annotated[str, DocumentedBy(live_figure)] = "",
    palette: Palette,
    output: Stem = None,
    place: Place,
    as_json: AsJson = False,
) -> None:
    """Compute a map and write a live figure.

    Parameters
    ----------
    start
        Start of a chosen orbit on the plane.
    """
    if refusal := live_refusal(spec):
        raise ValueError(f"plane: {refusal}")
    stem = Path(file_stem(spec, file_name_part(case)))
    if output is not None:
        stem, _ = split_ending(output, ["html"], ["html"])
    with reserve_output(stem):
        with place.run() as context:
            found = compute_map(spec, execution=context.start_stage("map"))
        page = live_figure(
            found, energies=shown_energies, starts=[] if start is None else [start], caption=caption, link=link, palette=palette,
        )  # fmt: skip
        files = write_files({add_ending(stem, "html"): page})
    print_result(as_json, {"request": found.provenance(), "bytes": len(page.encode())}, files=files)
