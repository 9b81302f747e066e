"""The cache on disk: files in a private folder of limited size, verified when they are read and written atomically.

The cache contains compiled kernels, as pickles with machine code, and critical points of potentials. The hash at the start of
each file detects accidents, such as an incomplete copy. The hash does not detect attacks, because anyone who can write a file can
also write its hash. A file is therefore read only if no other user can have written it.
"""

from __future__ import annotations

import contextlib
import functools
import hashlib
import itertools
import logging
import os
import stat
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import platformdirs

CACHE_VARIABLE = "ESCAPE_EXPLORER_CACHE"
"""Environment variable that names a folder to use instead of the user's cache folder."""

SUFFIX = ".kernel"
"""Suffix of the names of complete files."""

LARGEST_SIZE = 256 * 2**20
"""Largest total size of the files, in bytes; the kernels of one potential take about 0.2 MB."""

MOST_FILES = 4096
"""Largest number of files, to within `WRITES_PER_DELETION` for each process that writes."""

WRITES_PER_DELETION = 64
"""Number of written files after which a process lists all files and deletes the least recently used ones, in 0.01 to 0.05 s."""

# Suffix of the names of incomplete files.
_INCOMPLETE_SUFFIX = ".part"
# Number of bytes of the hash at the start of a file.
_HASH_BYTES = hashlib.sha256().digest_size
# User number of the superuser, whose files are trusted.
_SUPERUSER = 0

# Numbers of the files that this process writes.
_write_numbers = itertools.count()

log = logging.getLogger(__name__)


def cache_folder() -> Path:
    """Return the folder of the cached files, which may not exist yet."""
    return Path(os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_path("escape-explorer")) / "kernels"


def read_cached(path: Path) -> bytes | None:
    """Read a file, verify its hash, and mark the file as most recently used.

    Returns
    -------
    The content without the hash. None if the file is missing; None, with a warning in the log, if another user owns or can write
    the file or its folder.

    Raises
    ------
    OSError
        When the file cannot be read.
    ValueError
        When the content does not match its hash.
    """
    if not _is_private_folder(path.parent):
        return None
    try:
        with path.open("rb") as file:
            if problem := _describe_other_writer(os.fstat(file.fileno())):
                log.warning("the compiled kernel %s is ignored: %s", path, problem)
                return None
            content = file.read()
    except FileNotFoundError:
        return None
    payload = content[_HASH_BYTES:]
    if hashlib.sha256(payload).digest() != content[:_HASH_BYTES]:
        raise ValueError("its hash does not match")
    _mark_used(path)
    return payload


def read_or_make(path: Path, kind: str, make: Callable[[], bytes]) -> bytes:
    """Return the content of a file; if there is no valid file, make and write the content.

    Parameters
    ----------
    path
        The file.
    kind
        What the file contains, a noun in the plural, for a warning if the file is invalid.
    make
        Returns the content. Its errors are raised, and nothing is written.
    """
    try:
        content = read_cached(path)
    except (OSError, ValueError) as error:
        log.warning("invalid %s %s: %s; making them again", kind, path, error)
        content = None
    if content is None:
        content = make()
        write_cached(path, content)
    return content


def write_cached(path: Path, payload: bytes) -> None:
    """Write a file, and delete the least recently used files from time to time; log a warning if writing fails."""
    folder = path.parent
    try:
        # Only this user can access the folder.
        folder.parent.mkdir(parents=True, exist_ok=True)
        folder.mkdir(mode=stat.S_IRWXU, exist_ok=True)
        if _is_private_folder(folder):
            _write_atomically(path, hashlib.sha256(payload).digest() + payload)
            if next(_write_numbers) % WRITES_PER_DELETION == 0:
                delete_least_recently_used(folder)
    except OSError as error:
        _warn_once(f"compiled kernels cannot be stored in {folder} and are compiled at every start: {error.strerror}")


def delete_cached(name: str) -> None:
    """Delete the files whose names start with `name` and a dot."""
    for path in cache_folder().glob(f"{name}.*{SUFFIX}"):
        path.unlink(missing_ok=True)


def delete_least_recently_used(folder: Path, *, largest_size: int = LARGEST_SIZE, most_files: int = MOST_FILES) -> None:
    """Delete the least recently used files, also incomplete files of killed processes, until the limits are met."""
    files = []
    with os.scandir(folder) as entries:
        for entry in entries:
            # Another process may have deleted the file.
            with contextlib.suppress(FileNotFoundError):
                if entry.name.endswith((SUFFIX, _INCOMPLETE_SUFFIX)):
                    status = entry.stat()
                    files.append((status.st_atime_ns, status.st_size, entry.path))
    file_count, total_size = len(files), sum(size for _, size, _ in files)
    for _, size, path in sorted(files):
        if file_count <= most_files and total_size <= largest_size:
            break
        Path(path).unlink(missing_ok=True)
        file_count, total_size = file_count - 1, total_size - size


def _is_private_folder(folder: Path) -> bool:
    """Return whether only this user can write to a folder, or the folder cannot be examined; if not, log a warning."""
    try:
        problem = _describe_other_writer(folder.stat())
    except OSError:
        return True
    if problem:
        _warn_once(f"compiled kernels in {folder} are neither used nor stored: {problem}")
    return not problem


def _describe_other_writer(status: os.stat_result) -> str:
    """Describe who else can write a file or folder, and the remedy; empty if only this user and the superuser can."""
    if os.name != "posix":
        return ""
    if status.st_uid not in (os.geteuid(), _SUPERUSER):
        return f"user {status.st_uid} owns it; choose a folder of user {os.geteuid()} in {CACHE_VARIABLE}"
    if status.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
        return f"other users may write to it; take that permission away (chmod go-w) or choose another folder in {CACHE_VARIABLE}"
    return ""


def _mark_used(path: Path) -> None:
    """Set the access time to now, because many file systems do not update it when a file is read."""
    with contextlib.suppress(OSError):
        os.utime(path, ns=(time.time_ns(), path.stat().st_mtime_ns))


def _write_atomically(path: Path, content: bytes) -> None:
    """Write a temporary file in the same folder, and rename it, so that other processes never read an incomplete file."""
    handle, incomplete = tempfile.mkstemp(dir=path.parent, suffix=_INCOMPLETE_SUFFIX)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(content)
        os.replace(incomplete, path)
    except BaseException:
        Path(incomplete).unlink(missing_ok=True)
        raise


@functools.cache
def _warn_once(message: str) -> None:
    """Log a warning, unless the same warning has been logged."""
    log.warning(message)
