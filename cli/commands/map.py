"""Compute a map of the exit, the escape time and the crossings of each start, and write it to STEM.nc and STEM.png.

The NetCDF file contains all results and the request; curves of layers are written to tables named STEM-LAYER.csv.

Examples:

escape-explorer map I --energy 0.19 --output first

escape-explorer map II --energy 0.2 --axes y,py --fix x=0.1

escape-explorer map I --energy 0.2 --axes x,epsilon=0.5:2

escape-explorer map III --energies 0.25 1 --plane x_h --resolution 400x300 --format png --json

escape-explorer map II --energy 0.2 --picture basins --output basins.pdf --width 8.5 --no-titles

escape-explorer map II --energy 0.2 --resolution 4000 --format nc --store large.nc --scheduler tcp://node1:8786
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer

from cli.arguments import Case, file_name_part
from cli.execution import Place
from cli.layer_options import LayerOptions
from cli.map_analyses import compute_map_with_layers
from cli.options import with_options
from cli.output_files import Content, Stem, add_ending, reserve_output, split_ending, write_files
from cli.printing import AsJson, Table, print_result
from engine import EscapeMap, Fate, MapSpec
from engine.propagation.fates import UNRESOLVED, name_fate
from plots.layers.layer import Analyses
from plots.layers.table import LAYERS, TITLES
from plots.pictures.palette import Palette
from plots.printed.figure_files import map_figure_bytes
from plots.printed.figure_style import FigureFormat, FigureStyle
from plots.texts.exports import file_stem, netcdf_bytes

FIRST_PICTURES = ("basins", "times", "crossings")
"""Pictures drawn by default, before those of requested layers."""

PICTURE_HELP = f"Picture to draw: {', '.join(TITLES)}; can be repeated; by default {', '.join(FIRST_PICTURES)}."


class Format(StrEnum):
    """Output format, by file ending."""

    NC = "nc"
    PNG = FigureFormat.PNG
    SVG = FigureFormat.SVG
    PDF = FigureFormat.PDF


DEFAULT_FORMATS: Sequence[str] = (Format.NC, Format.PNG)


@dataclass(frozen=True)
class Drawing:
    """Pictures to draw, with their palette and style."""

    pictures: tuple[str, ...]
    palette: Palette
    style: FigureStyle

    def __post_init__(self) -> None:
        for picture in self.pictures:
            if picture not in TITLES:
                raise ValueError(f"picture={picture!r}: must be one of {', '.join(TITLES)}")


@with_options
def run(
    *,
    case: Case,
    spec: MapSpec,
    layers: LayerOptions,
    count_outside: bool = False,
    picture: Annotated[list[str] | None, typer.Option(help=PICTURE_HELP)] = None,
    palette: Palette,
    style: FigureStyle,
    formats: Annotated[list[Format] | None, typer.Option("--format")] = None,
    output: Stem = None,
    store: Annotated[Path | None, typer.Option(metavar="FILE")] = None,
    place: Place,
    as_json: AsJson = False,
) -> None:
    """Compute and write a map.

    Parameters
    ----------
    count_outside
        Count starts beyond an exit as escaped.
    formats
        Output format, by default the ending of --output, or else nc and png; can be repeated.
    store
        File, with the ending nc, that keeps the finished blocks of the map; the same command continues after an interruption.
    """
    requested_layers = layers.with_pictures(picture or ())
    requested_layers.check(spec)
    pictures = dict.fromkeys(picture or [*FIRST_PICTURES, *requested_layers.pictures])
    drawing = Drawing(tuple(pictures), palette, style)
    stem = Path(file_stem(spec, file_name_part(case)))
    endings = DEFAULT_FORMATS
    if output is not None:
        stem, endings = split_ending(output, list(Format), DEFAULT_FORMATS)
    with reserve_output(stem):
        with place.run() as context:
            frame, analyses = compute_map_with_layers(spec, requested_layers, context, store)
        # The cluster is closed now: with a Dask client, xarray would use locks that in-memory files do not support.
        with Place().run() as context:
            context.start_stage("writing")
            contents = _make_contents(stem, formats or endings, frame, analyses, drawing)
        files = write_files(contents)
    _print(frame, analyses, files, count_outside, as_json)


def _make_contents(
    stem: Path, endings: Sequence[str], frame: EscapeMap, analyses: Analyses, drawing: Drawing
) -> dict[Path, Content]:
    """Return the content of each output file: the map in some formats, and tables as CSV."""
    contents: dict[Path, Content] = {}
    for ending in endings:
        path = add_ending(stem, ending)
        if ending == "nc":
            contents[path] = netcdf_bytes(frame, analyses)
        else:
            contents[path] = map_figure_bytes(
                frame, drawing.pictures, drawing.palette, FigureFormat(ending), drawing.style, analyses=analyses
            )
    for name, result in analyses.items():
        if LAYERS[name].has_table:
            contents[stem.with_name(f"{stem.name}-{name}.csv")] = result.to_pandas().to_csv(index=False)
    return contents


def _print(frame: EscapeMap, analyses: Analyses, files: Sequence[str], count_outside: bool, as_json: bool) -> None:
    fractions = frame.fractions(count_outside=count_outside)
    shares = {name_fate(code, frame.spec.outcomes): share for code, share in fractions.items() if code != Fate.NOT_COMPUTED}
    sentences = [result.describe() for result in analyses.values()]
    rows = [(name, f"{100 * share:.2f} %") for name, share in shares.items() if share or name != UNRESOLVED]
    answer = {"request": frame.provenance(), "shares": shares, "findings": sentences}
    print_result(as_json, answer, Table(("outcome", "share"), rows), *sentences, files=files)
