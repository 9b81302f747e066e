"""Results on disk: whole, or not at all."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path

Content = str | bytes


def add_ending(stem: Path, ending: str) -> Path:
    """A file's path: the stem, a dot and the ending; dots in the stem are its own."""
    return stem.with_name(f"{stem.name}.{ending}")


def check_folder(path: Path) -> None:
    """ValueError unless the folder that the file is to be written to exists: said before hours of work, not after."""
    if not path.name or not path.parent.is_dir():
        raise ValueError(f"output='{path}': there is no folder '{path.parent}' to write to")


def write_files(contents: Mapping[Path, Content]) -> list[str]:
    """Write files, each of which is at every moment absent, as it was, or whole.

    Returns
    -------
    Their paths, as they were given.

    Raises
    ------
    OSError
        When one cannot be written; those before it stay.
    """
    for path, content in contents.items():
        _write(path, content.encode() if isinstance(content, str) else content)
    return [str(path) for path in contents]


def _write(path: Path, content: bytes) -> None:
    # In the same folder: only within a file system does a file replace another at once.
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
