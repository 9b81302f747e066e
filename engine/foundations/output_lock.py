"""A lock for output that takes long to write, files that are replaced as a whole, and errors that name the output.

One process holds the lock; errors in other processes name the holder.
"""

from __future__ import annotations

import errno
import glob
import os
import platform
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from filelock import FileLock

# Largest number of attempts. An attempt fails if the previous holder deletes the file after it is opened but before it is locked.
_MOST_ATTEMPTS = 100
# Error numbers of file systems without locks.
_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP)


@contextmanager
def output_named_in_errors(path: str | os.PathLike[str]) -> Iterator[None]:
    """Name an output in errors of the operating system, which can name a file beside the output, or none.

    Parameters
    ----------
    path
        The output, as the user has named it.

    Raises
    ------
    OSError
        With the number and the text of the operating system, and the path.
    """
    try:
        yield
    except OSError as error:
        if error.errno is None:
            raise
        raise OSError(error.errno, os.strerror(error.errno), os.fspath(path)) from error


@contextmanager
def replaced_file(path: Path) -> Iterator[Path]:
    """Yield the path of a temporary file to be written, which at the end replaces a file as a whole.

    Without an error, the content is on the disk before the file is replaced; with one, the file stays. Temporary files of killed
    processes of this machine are deleted when the same file is next written.

    Parameters
    ----------
    path
        The file, which need not exist.

    Raises
    ------
    OSError
        When the file cannot be written; the error names it.
    """
    # Processes of other machines that share the folder have numbers of their own.
    prefix = f".{path.name}.{platform.node()}."
    # Replacing is atomic only within one file system, so the temporary file is in the same folder.
    temporary = path.with_name(f"{prefix}{os.getpid()}.part")
    with output_named_in_errors(path):
        for left_over in path.parent.glob(f"{glob.escape(prefix)}*.part"):
            _delete_left_over(left_over, left_over.name.removeprefix(prefix).removesuffix(".part"))
        try:
            yield temporary
            sync_to_disk(temporary)
            temporary.replace(path)
        finally:
            temporary.unlink(missing_ok=True)


def _delete_left_over(file: Path, process: str) -> None:
    """Delete a temporary file, unless another process with this number lives. A file of another user stays."""
    if process.isdecimal() and (int(process) == os.getpid() or not _lives(int(process))):
        with suppress(OSError):
            file.unlink()


def _lives(process: int) -> bool:
    """Return whether a process with this number exists."""
    if sys.platform == "win32":
        # There, this call would end the process.
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        # The process belongs to another user.
        return True
    return True


def sync_to_disk(path: Path) -> None:
    """Write a file, or the names in a folder, from the cache of the operating system to the disk."""
    if path.is_dir() and os.name != "posix":
        return
    opened = os.open(path, os.O_RDONLY if path.is_dir() else os.O_RDWR)
    try:
        os.fsync(opened)
    finally:
        os.close(opened)


@contextmanager
def hold_lock(path: Path) -> Iterator[None]:
    """Reserve a path for this process by a file `.NAME.lock` beside the path; the file is deleted at the end.

    The operating system releases the lock when the process ends, even if it is killed. The file of a killed process stays until
    the next process with this output deletes it. The file is beside the output, so that the lock also protects outputs on file
    systems that several machines share. On Windows, and on file systems without locks, nothing is reserved.

    Parameters
    ----------
    path
        File or folder to be written, which need not exist; its parent is created.

    Raises
    ------
    BlockingIOError
        When another process holds the lock; the message contains its number, its machine and the time at which it took the lock.
    OSError
        When a file cannot be written beside the output; the error names the output.
    """
    if sys.platform == "win32":
        # On Windows a locked file can neither be read, to find its holder, nor be deleted by its holder.
        yield
        return
    from filelock import FileLock

    file = path.resolve().parent / f".{path.resolve().name}.lock"
    lock = FileLock(file, blocking=False, fallback_to_soft=False)
    file.parent.mkdir(parents=True, exist_ok=True)
    with output_named_in_errors(path):
        _acquire(lock, file, path)
    try:
        file.write_text(f"process {os.getpid()} on {platform.node()} since {time.strftime('%Y-%m-%d %H:%M:%S')}")
        yield
    finally:
        # The file is deleted while the lock is held, because later it may belong to another process.
        file.unlink(missing_ok=True)
        lock.release()


def _acquire(lock: FileLock, file: Path, path: Path) -> None:
    """Acquire the lock of an output, or raise BlockingIOError if another process holds it."""
    from filelock import Timeout

    for _ in range(_MOST_ATTEMPTS):
        try:
            lock.acquire()
            return
        except Timeout:
            # If the file is missing, its holder has just deleted it.
            if file.exists():
                break
        except OSError as error:
            if error.errno in _NO_LOCKS:
                return
            raise
    if not file.exists():
        # The file cannot be made. This raises the error, which the package takes for a lock of another process.
        file.touch()
    holder = _read_holder(file) or "another process"
    raise BlockingIOError(f"{path}: is being written by {holder}; wait for its end, or choose another output")


def _read_holder(file: Path) -> str:
    """Return the text that the holder has written; empty if the file is missing."""
    try:
        return file.read_text(errors="replace")
    except FileNotFoundError:
        return ""
