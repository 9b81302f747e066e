"""Write the gallery and the catalogue of systems to a folder, as live figures with a page that lists them, index.html.

The folder needs no server and no network, and can be copied to any web server. Each file is written as soon as it is ready.

Examples:

escape-explorer gallery course

escape-explorer gallery draft --resolution 56 --only two-exits --only system-hill
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from cli.execution import THREADS_ONLY, Place
from cli.options import with_options
from cli.output_files import make_folder, reserve_output, write_files
from cli.printing import AsJson, Table, print_result
from plots.live.gallery import GalleryEntry, entry_files, gallery_entries, shared_files
from plots.pictures.palette import Palette


@with_options
def run(
    *,
    folder: Annotated[Path, typer.Argument(metavar="FOLDER")],
    only: Annotated[list[str] | None, typer.Option(metavar="KEY")] = None,
    resolution: Annotated[int | None, typer.Option(metavar="N", min=1)] = None,
    palette: Palette,
    place: Annotated[Place, THREADS_ONLY],
    as_json: AsJson = False,
) -> None:
    """Compute and write the figures.

    Parameters
    ----------
    folder
        Output folder, which is created if missing; existing files are replaced.
    only
        One view, by the stem of its file; can be repeated; by default all views of the gallery and all systems.
    resolution
        Columns and rows of all maps; by default those of each view.
    """
    entries = _choose(only or ())
    if resolution is not None:
        entries = [replace(entry, spec=replace(entry.spec, resolution=(resolution, resolution))) for entry in entries]
    make_folder(folder)
    with reserve_output(folder), place.run() as context:
        files = write_files({folder / name: content for name, content in shared_files(entries).items()})
        for entry in entries:
            made = entry_files(entry, palette, context.start_stage(entry.title))
            files += write_files({folder / name: content for name, content in made.items()})
    rows = [(entry.key, entry.title, entry.refusal or "live") for entry in entries]
    kinds = {entry.key: entry.refusal for entry in entries}
    print_result(as_json, {"stills": kinds}, Table(("view", "title", "figure"), rows), f"Written to {folder}.", files=files)


def _choose(keys: list[str] | tuple[()]) -> list[GalleryEntry]:
    """Return the entries with these keys, or all; ValueError for an unknown key."""
    entries = list(gallery_entries())
    known = [entry.key for entry in entries]
    if unknown := [key for key in keys if key not in known]:
        raise ValueError(f"only={unknown[0]!r}: must be one of {', '.join(known)}")
    return [entry for entry in entries if entry.key in keys or not keys]
