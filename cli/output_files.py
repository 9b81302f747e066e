"""Name and reserve output files before the computation, and write them atomically."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer

from cli.option_marks import DocumentedBy
from engine.foundations.output_lock import hold_lock, replaced_file

Content = str | bytes
"""Content of a file: text or bytes."""


def add_ending(stem: Path, ending: str) -> Path:
    """Return the stem with a dot and the ending appended. Dots in the stem stay."""
    return stem.with_name(f"{stem.name}.{ending}")


def split_ending(path: Path, endings: Collection[str], default: Sequence[str]) -> tuple[Path, Sequence[str]]:
    """Return the stem and the ending of a file name. For a name without an ending, return the name and the default endings.

    An ending begins with a letter, so ``map-0.19`` has none.

    Raises
    ------
    ValueError
        If the ending is not legal.

    Examples
    --------
    >>> split_ending(Path("map.pdf"), ["nc", "pdf"], ["nc"])
    (PosixPath('map'), ['pdf'])
    >>> split_ending(Path("map-0.19"), ["nc", "pdf"], ["nc"])
    (PosixPath('map-0.19'), ['nc'])
    """
    # An ending of two words is longer than the other one.
    for ending in sorted(endings, key=len, reverse=True):
        if path.name.endswith(f".{ending}") and path.name != f".{ending}":
            return path.with_name(path.name.removesuffix(f".{ending}")), [ending]
    ending = path.suffix.removeprefix(".")
    if re.fullmatch(r"[A-Za-z]\w*", ending):
        raise ValueError(f"output='{path}': the ending must be one of {', '.join(endings)}, or left out")
    return path, default


def name_files(
    output: Path | None, endings: Collection[str], default: Sequence[str], stem: Path | None = None
) -> dict[str, Path]:
    """Return the output files by ending, named after --output, or else after the stem; empty if both are None."""
    chosen_endings = default
    if output is not None:
        stem, chosen_endings = split_ending(output, endings, default)
    return {} if stem is None else {ending: add_ending(stem, ending) for ending in chosen_endings}


@contextmanager
def reserve_output(output: Path | None) -> Iterator[None]:
    """Reserve output files from before the computation until they are written.

    Parameters
    ----------
    output
        File names without ending, or the name of one file, whose ending is its format; existing files are replaced.

    Raises
    ------
    ValueError
        If the folder of the output does not exist.
    BlockingIOError
        If another process is writing the output. The message names the process.
    """
    if output is None:
        yield
        return
    if not output.name or not output.parent.is_dir():
        raise ValueError(f"output='{output}': there is no folder '{output.parent}' to write to")
    with hold_lock(output):
        yield


def make_folder(folder: Path) -> None:
    """Create an output folder unless it exists; ValueError if it cannot be created."""
    if not folder.absolute().parent.is_dir() or (folder.exists() and not folder.is_dir()):
        raise ValueError(f"output='{folder}': must be a folder, or a new folder inside an existing one")
    folder.mkdir(exist_ok=True)


Stem = Annotated[Path | None, typer.Option(metavar="STEM"), DocumentedBy(reserve_output)]
"""Type of the option for the names of output files."""


def write_files(contents: Mapping[Path, Content]) -> list[str]:
    """Write files atomically: each is replaced as a whole or left unchanged.

    Returns
    -------
    The paths as strings, in the given order.

    Raises
    ------
    OSError
        If a file cannot be written. Files that are already written remain.
    """
    for path, content in contents.items():
        _write(path, content.encode() if isinstance(content, str) else content)
    return [str(path) for path in contents]


def _write(path: Path, content: bytes) -> None:
    with replaced_file(path) as temporary, temporary.open("xb") as file:
        file.write(content)
