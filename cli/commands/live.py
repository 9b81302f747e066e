"""Compute a map and write a live figure, OUTPUT.html, in which the browser computes the map again while its reader changes it.

The file needs no server and no network.

Examples:

escape-explorer live III --plane x_px --energy 0.45 --output figure

escape-explorer live II --energy 0.2 --start 0.1,-0.2 --start 0.3,0 --caption "Two orbits of case II."

escape-explorer live I --energy 0.19 --picture times
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from cli.arguments import Case, file_name_part
from cli.execution import Place
from cli.map_analyses import compute_whole_map
from cli.option_marks import DocumentedBy
from cli.options import with_options
from cli.output_files import Stem, add_ending, reserve_output, split_ending, write_files
from cli.printing import AsJson, print_result
from engine import MapSpec
from plots.live.live_figure import live_figure
from plots.live.live_view import LiveView
from plots.pictures.palette import Palette
from plots.texts.exports import file_stem

Energies = Annotated[tuple[float, float] | None, typer.Option(metavar="LOW HIGH"), DocumentedBy(LiveView, "energies")]
"""Type of the option for the energies that a reader can choose."""


class Point(NamedTuple):
    """A point of the plane."""

    x: float
    ordinate: float


def read_point(text: str) -> Point:
    """Return the point of the plane from ``X,ORDINATE``."""
    try:
        return Point(*map(float, text.split(",")))
    except (TypeError, ValueError):
        raise typer.BadParameter(f"{text!r} must be X,ORDINATE, two numbers") from None


@with_options
def run(
    *,
    case: Case,
    spec: MapSpec,
    shown_energies: Energies = None,
    start: Annotated[list[Point] | None, typer.Option(metavar="X,ORDINATE", parser=read_point)] = None,
    picture: Annotated[str, DocumentedBy(LiveView)],
    caption: Annotated[str, DocumentedBy(LiveView)],
    link: Annotated[str, DocumentedBy(LiveView)],
    palette: Palette,
    output: Stem = None,
    place: Place,
    as_json: AsJson = False,
) -> None:
    """Compute a map and write a live figure.

    Parameters
    ----------
    start
        Start of a chosen orbit on the plane; can be repeated, for at most five orbits.
    """
    view = LiveView(spec, shown_energies, start or [], picture, caption, link, palette)
    stem = Path(file_stem(spec, file_name_part(case)))
    if output is not None:
        stem, _ = split_ending(output, ["html"], ["html"])
    with reserve_output(stem):
        with place.run() as context:
            page = live_figure(view, compute_whole_map(spec, context))
        files = write_files({add_ending(stem, "html"): page})
    print_result(as_json, {"request": spec.provenance(), "bytes": len(page.encode())}, files=files)
