"""Reproduce the figures of Zotos (2014) as NAME.png and NAME.pdf, and compare its numbers with computed ones (`tables`).

Each file is written as soon as it is ready and stays after an interruption.

Examples:

escape-explorer reproduce --quick --output figures

escape-explorer reproduce I-basins-xpx III-super-sticky

escape-explorer reproduce --list
"""

from __future__ import annotations

import time
from concurrent.futures import CancelledError
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.execution import THREADS_ONLY, Place
from cli.options import with_options
from cli.output_files import make_folder, reserve_output, write_files
from cli.printing import AsJson, Table, print_result

if TYPE_CHECKING:
    from reproduction.map_cache import MapCache


@with_options
def run(
    *,
    names: Annotated[list[str] | None, typer.Argument(metavar="[NAME]...")] = None,
    quick: bool = False,
    only_list: Annotated[bool, typer.Option("--list")] = False,
    output: Annotated[Path, typer.Option(metavar="FOLDER")] = Path("zotos-2014"),
    place: Annotated[Place, THREADS_ONLY],
    as_json: AsJson = False,
) -> None:
    """Make and write the figures, or list them.

    Parameters
    ----------
    names
        Figures to draw, as listed by --list; by default all.
    quick
        Compute a ninth of the starts, in a few minutes instead of half an hour.
    only_list
        List the figures without making them.
    output
        Output folder, which is created if missing; existing files are replaced.
    """
    # Imported here, because the help needs no figures.
    from reproduction import members, quality
    from reproduction.map_cache import MapCache

    chosen = members.choose_members(names or ())
    if only_list:
        captions = {name: members.CAPTIONS[name] for name in chosen}
        print_result(as_json, {"figures": captions}, Table(("name", "shows"), list(captions.items())))
        return
    map_quality = quality.QUICK if quick else quality.FULL
    make_folder(output)
    begin = time.perf_counter()
    made_figures: list[dict[str, Any]] = []
    try:
        with reserve_output(output), place.run() as context:
            cache = MapCache(map_quality, context.execution)
            for name in chosen:
                context.start_stage(name)
                made_figures.append(_make(name, cache, output))
    except CancelledError:
        raise CancelledError(f"stopped; {len(made_figures)} of {len(chosen)} are made and stay in {output}") from None
    seconds = time.perf_counter() - begin
    side = map_quality.resolution
    rows = [
        (figure["name"], f"{figure['seconds']:.1f} s", ", ".join(Path(file).name for file in figure["files"]))
        for figure in made_figures
    ]
    sentence = f"Written to {output} in {seconds:.0f} s, {map_quality.name} quality: {side} x {side} starts a map."
    answer = {"quality": map_quality.name, "seconds": seconds, "figures": made_figures}
    print_result(as_json, answer, Table(("made", "in", "files"), rows), sentence)


def _make(name: str, cache: MapCache, folder: Path) -> dict[str, Any]:
    """Make and write a figure. Return its name, its files, and the duration in seconds."""
    from reproduction import members

    begin = time.perf_counter()
    files = write_files({folder / file: content for file, content in members.make_files(name, cache).items()})
    return {"name": name, "files": files, "seconds": time.perf_counter() - begin}
