"""Options and calls of glibc with which a server of many threads returns free memory to the operating system."""

from __future__ import annotations

import ctypes
import os
import platform
from typing import NamedTuple


class _Option(NamedTuple):
    """An option of `mallopt`."""

    variable: str
    """Environment variable that sets the option for any program."""
    parameter: int
    """Number of the option in ``malloc.h``."""
    value: int


_OPTIONS = (
    # Number of arenas. By default there are eight per core, and each keeps the memory that its threads have freed.
    _Option("MALLOC_ARENA_MAX", -8, 2),
    # Smallest size of an array with its own memory mapping, in bytes. Arrays of a map with 224 × 224 pixels are larger. By
    # default, glibc raises this size up to 32 MiB.
    _Option("MALLOC_MMAP_THRESHOLD_", -3, 2**17),
)


RETURN_SECONDS = 30.0
"""Interval between two calls of `return_free_memory`, in seconds."""


def reduce_fragmentation() -> None:
    """With glibc, set the options whose environment variables are not set. Call this before threads start."""
    library = _glibc()
    for option in _OPTIONS:
        if library is not None and option.variable not in os.environ:
            library.mallopt(option.parameter, option.value)


def return_free_memory() -> None:
    """With glibc, return the free memory between small arrays to the system. By default, glibc keeps it.

    This takes some milliseconds, in which threads that allocate memory wait.
    """
    library = _glibc()
    if library is not None:
        library.malloc_trim(0)


def _glibc() -> ctypes.CDLL | None:
    return ctypes.CDLL(None) if platform.libc_ver()[0] == "glibc" else None
