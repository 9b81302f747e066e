"""Output files: reserved before the computation, written atomically."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

from engine.foundations.output_lock import hold_lock

Content = str | bytes


def add_ending(stem: Path, ending: str) -> Path:
    """Return the stem with a dot and the ending appended; dots in the stem are kept."""
    return stem.with_name(f"{stem.name}.{ending}")


def split_ending(path: Path, endings: Collection[str], default: Sequence[str]) -> tuple[Path, Sequence[str]]:
    """Return stem and ending of a file name with one of some endings; of another name, the name and the default endings.

    Examples
    --------
    >>> split_ending(Path("map.pdf"), ["nc", "pdf"], ["nc"])
    (PosixPath('map'), ['pdf'])
    >>> split_ending(Path("map-0.19"), ["nc", "pdf"], ["nc"])
    (PosixPath('map-0.19'), ['nc'])
    """
    ending = path.suffix.removeprefix(".")
    return (path.with_suffix(""), [ending]) if ending in endings else (path, default)


@contextmanager
def reserve_output(path: Path | None) -> Iterator[None]:
    """Reserve an output file, or a stem of several, from before the computation until it is written; None for no output.

    Raises
    ------
    ValueError
        If its folder does not exist.
    BlockingIOError
        If another process writes it; one sentence that names the process.
    """
    if path is None:
        yield
        return
    if not path.name or not path.parent.is_dir():
        raise ValueError(f"output='{path}': there is no folder '{path.parent}' to write to")
    with hold_lock(path):
        yield


def write_files(contents: Mapping[Path, Content]) -> list[str]:
    """Write files atomically: each is replaced as a whole or left unchanged.

    Returns
    -------
    The paths, as given.

    Raises
    ------
    OSError
        If a file cannot be written; those written before it stay.
    """
    for path, content in contents.items():
        _write(path, content.encode() if isinstance(content, str) else content)
    return [str(path) for path in contents]


def _write(path: Path, content: bytes) -> None:
    # In the same folder: replacing is atomic only within one file system.
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with part.open("xb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        part.replace(path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise OSError(error.errno, error.strerror, str(path)) from error
    except BaseException:
        part.unlink(missing_ok=True)
        raise
