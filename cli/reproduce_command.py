"""Command ``reproduce``: the figures and numbers of the paper."""

from __future__ import annotations

import time
from collections.abc import Sequence
from concurrent.futures import CancelledError
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cli import options

if TYPE_CHECKING:
    from reproduction.map_cache import MapCache
    from reproduction.quality import Quality

EXAMPLES = """Examples:

escape-explorer reproduce --quick --output figures

escape-explorer reproduce I-basins-xpx III-super-sticky

escape-explorer reproduce --list
"""

FOLDER = Path("zotos-2014")
"""Default output folder."""


@dataclass(frozen=True)
class _WrittenFigure:
    """Files of one figure, and the seconds it took."""

    name: str
    files: list[str]
    seconds: float


def reproduce_paper(
    names: Annotated[
        list[str] | None,
        typer.Argument(metavar="[NAME]...", help="Figures to draw, as listed by --list; by default all."),
    ] = None,
    quick: Annotated[bool, typer.Option("--quick", help="A ninth of the starts: a few minutes instead of half an hour.")] = False,
    only_list: Annotated[bool, typer.Option("--list", help="Only list the figures.")] = False,
    output: Annotated[
        Path,
        typer.Option("--output", metavar="FOLDER", help="Output folder, created if missing; existing files are replaced."),
    ] = FOLDER,
    threads: options.Threads = None,
    as_json: options.AsJson = False,
) -> None:
    """Reproduce the figures of Zotos (2014) as NAME.png and NAME.pdf, and its numbers beside ours as `tables`.

    Each file is written as soon as it is ready, and is kept after an interruption.
    """
    from reproduction.map_cache import MapCache
    from reproduction.members import CAPTIONS, choose_members
    from reproduction.quality import FULL, QUICK

    chosen = choose_members(names or ())
    if only_list:
        _print_list({name: CAPTIONS[name] for name in chosen}, as_json)
        return
    from cli.files import reserve_output
    from cli.run_context import cancellable_run

    quality = QUICK if quick else FULL
    _make_folder(output)
    began, made = time.perf_counter(), list[_WrittenFigure]()
    try:
        with reserve_output(output), cancellable_run(threads) as run:
            cache = MapCache(quality, run.execution)
            for name in chosen:
                run.start_stage(name)
                made.append(_make(name, cache, output))
    except CancelledError:
        raise CancelledError(f"stopped; {len(made)} of {len(chosen)} are made and stay in {output}") from None
    _print_result(made, output, quality, time.perf_counter() - began, as_json)


def _make_folder(folder: Path) -> None:
    """Create the output folder; ValueError if that is impossible."""
    if not folder.absolute().parent.is_dir() or (folder.exists() and not folder.is_dir()):
        raise ValueError(f"output='{folder}': must be a folder, or a new folder inside an existing one")
    folder.mkdir(exist_ok=True)


def _make(name: str, cache: MapCache, folder: Path) -> _WrittenFigure:
    from cli.files import write_files
    from reproduction.members import make_files

    began = time.perf_counter()
    files = write_files({folder / file: content for file, content in make_files(name, cache).items()})
    return _WrittenFigure(name, files, time.perf_counter() - began)


def _print_list(captions: dict[str, str], as_json: bool) -> None:
    from cli.output import print_json, print_table

    if as_json:
        print_json({"figures": captions})
    else:
        print_table(("name", "shows"), list(captions.items()))


def _print_result(made: Sequence[_WrittenFigure], folder: Path, quality: Quality, seconds: float, as_json: bool) -> None:
    from cli.output import print_json, print_sentences, print_table

    if as_json:
        figures = [{"name": one.name, "files": one.files, "seconds": one.seconds} for one in made]
        print_json({"quality": quality.name, "seconds": seconds, "figures": figures})
        return
    rows = [(one.name, f"{one.seconds:.1f} s", ", ".join(Path(file).name for file in one.files)) for one in made]
    print_table(("made", "in", "files"), rows)
    side = quality.resolution
    print_sentences(f"Written to {folder} in {seconds:.0f} s, {quality.name} quality: {side} x {side} starts a map.")
