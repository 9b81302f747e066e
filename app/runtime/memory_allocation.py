"""Settings of glibc's memory allocation for a server with many threads: the memory of large arrays is returned to the system."""

from __future__ import annotations

import ctypes
import os
import platform
from typing import NamedTuple


class _Option(NamedTuple):
    variable: str
    """Environment variable that sets the option for any program."""
    parameter: int
    """Number of the option in ``malloc.h``."""
    value: int


_OPTIONS = (
    # By default there are eight arenas per core, each of which keeps the memory that its threads have freed.
    _Option("MALLOC_ARENA_MAX", -8, 2),
    # Size in bytes from which an array has its own memory mapping; arrays of a map with 224 × 224 pixels are larger. By default
    # this number grows to 32 MiB.
    _Option("MALLOC_MMAP_THRESHOLD_", -3, 2**17),
)


def reduce_fragmentation() -> None:
    """Set the options whose environment variables are not set; call before threads start. Without glibc this has no effect."""
    if platform.libc_ver()[0] != "glibc":
        return
    library = ctypes.CDLL(None)
    for option in _OPTIONS:
        if option.variable not in os.environ:
            library.mallopt(option.parameter, option.value)
