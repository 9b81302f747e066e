"""Settings of glibc's memory allocation for a server of many threads: memory of large arrays is given back."""

from __future__ import annotations

import ctypes
import os
import platform
from typing import NamedTuple


class _Option(NamedTuple):
    variable: str
    """Environment variable that sets it for any program."""
    parameter: int
    """Its number in ``malloc.h``."""
    value: int


_OPTIONS = (
    # By default eight arenas per core, each of which keeps what its threads have freed.
    _Option("MALLOC_ARENA_MAX", -8, 2),
    # Bytes from which an array has memory of its own; those of a map with 224 × 224 pixels have more. By default this number
    # grows to 32 MiB.
    _Option("MALLOC_MMAP_THRESHOLD_", -3, 2**17),
)


def reduce_fragmentation() -> None:
    """Set the options whose environment variables are not set; call before threads start. No effect without glibc."""
    if platform.libc_ver()[0] != "glibc":
        return
    library = ctypes.CDLL(None)
    for option in _OPTIONS:
        if option.variable not in os.environ:
            library.mallopt(option.parameter, option.value)
