"""Write errors of the operating system as sentences: the path, the problem and what to do."""

from __future__ import annotations

import errno

_CHOOSE_WRITABLE = "choose a folder that you may write to"
_FREE_SPACE = "free some space or choose another disk, then run the same command again"
# Remedies by number of the error.
_ADVICE = {
    errno.ENOENT: "check the path",
    errno.ENOTDIR: "a part of this path is a file; choose another path",
    errno.EISDIR: "name a file",
    errno.EEXIST: "a file is in the place of this folder; choose another path",
    errno.EACCES: _CHOOSE_WRITABLE,
    errno.EPERM: _CHOOSE_WRITABLE,
    errno.EROFS: _CHOOSE_WRITABLE,
    errno.ENOSPC: _FREE_SPACE,
    errno.EDQUOT: _FREE_SPACE,
    errno.EFBIG: _FREE_SPACE,
    errno.EIO: "the disk may be failing; choose another one",
    errno.ENAMETOOLONG: "choose a shorter name",
    errno.EMFILE: "allow more open files (ulimit -n)",
    errno.ECONNREFUSED: "check that the server or scheduler is running",
    errno.EADDRINUSE: "choose another port",
}


def describe_system_error(error: OSError) -> str:
    """Return a sentence without a full stop. For an error without a number, return its text."""
    if error.errno is None or error.strerror is None:
        return str(error)
    advice = _ADVICE.get(error.errno)
    problem = f"{error.strerror}; {advice}" if advice else error.strerror
    return problem if error.filename is None else f"{error.filename}: {problem}"
