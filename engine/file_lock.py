"""A lock for output that takes long to write: one process holds it, and another learns which one."""

from __future__ import annotations

import os
import platform
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

_LONGEST_NOTE = 1000


@contextmanager
def hold_lock(path: Path) -> Iterator[None]:
    """Reserve a path for this process, with a file `.NAME.lock` beside it that is deleted at the end.

    The operating system releases the lock when the process ends, even if it is killed. Windows, and file systems that have no
    locks, give none: nothing is reserved there.

    Parameters
    ----------
    path
        File or folder to be written, which need not exist; its parent is created.

    Raises
    ------
    BlockingIOError
        When another process holds it; one sentence with its number, its machine and since when.
    OSError
        When the lock file cannot be written.
    """
    if sys.platform == "win32":
        yield
        return
    file = path.resolve().parent / f".{path.resolve().name}.lock"
    file.parent.mkdir(parents=True, exist_ok=True)
    descriptor = _open_locked(file, path)
    try:
        os.truncate(descriptor, 0)
        os.write(descriptor, f"process {os.getpid()} on {platform.node()} since {time.strftime('%Y-%m-%d %H:%M:%S')}".encode())
        yield
    finally:
        # While the lock is held: afterwards the file may be that of another process.
        file.unlink(missing_ok=True)
        os.close(descriptor)


if sys.platform != "win32":
    import errno
    import fcntl

    # Errors of file systems that have no locks.
    _NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP)

    def _open_locked(file: Path, path: Path) -> int:
        """A descriptor of the lock file that holds the lock; the file is opened again if its last holder has deleted it."""
        while True:
            descriptor = os.open(file, os.O_RDWR | os.O_CREAT, 0o666)
            try:
                _lock(descriptor, path)
                if file.exists() and os.path.samestat(file.stat(), os.fstat(descriptor)):
                    return descriptor
            except BaseException:
                os.close(descriptor)
                raise
            os.close(descriptor)

    def _lock(descriptor: int, path: Path) -> None:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            holder = os.read(descriptor, _LONGEST_NOTE).decode(errors="replace") or "another process"
            raise BlockingIOError(f"{path}: is being written by {holder}; wait for its end, or choose another output") from None
        except OSError as error:
            if error.errno not in _NO_LOCKS:
                raise
