"""Atomic writing of result files."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

Content = str | bytes


def add_ending(stem: Path, ending: str) -> Path:
    """Return the stem with a dot and the ending appended; dots in the stem are kept."""
    return stem.with_name(f"{stem.name}.{ending}")


def check_folder(path: Path) -> None:
    """Raise ValueError if the output folder does not exist; checked before the computation."""
    if not path.name or not path.parent.is_dir():
        raise ValueError(f"output='{path}': there is no folder '{path.parent}' to write to")


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
    except BaseException:
        part.unlink(missing_ok=True)
        raise
