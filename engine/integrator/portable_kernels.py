"""A WebAssembly module with the kernels that a visitor's browser runs, for all potentials.

The module depends only on this version of the program and on the versions of Numba and LLVM. It is built once, in a separate
process, and stored with the compiled kernels.
"""

from __future__ import annotations

import functools
import os
import subprocess
import sys
import threading

from engine.foundations.cache_files import SUFFIX, cache_folder, read_or_make
from engine.integrator.jit.source_digests import program_digest

# The program that builds the module, and its environment, which Numba reads when it is imported.
_PROGRAM = f"{__package__}.portable_table"
_SETTINGS = {
    "NUMBA_OPT": "0",
    "NUMBA_LOOP_VECTORIZE": "0",
    "NUMBA_SLP_VECTORIZE": "0",
    "NUMBA_CPU_NAME": "generic",
    "NUMBA_CPU_FEATURES": "",
    "NUMBA_DISABLE_INTEL_SVML": "1",
}
_building = threading.Lock()


def module_digest() -> str:
    """Return a hash of everything on which the module depends, without building the module."""
    return program_digest()


def kernel_module() -> bytes:
    """Return the module of the kernels in `portable_table`, from the cache or built, which takes seconds."""
    with _building:
        return _load_or_build()


@functools.cache
def _load_or_build() -> bytes:
    return read_or_make(cache_folder() / f"{__name__}.{program_digest()}{SUFFIX}", "compiled kernels", _build)


def _build() -> bytes:
    """Build the module in another process."""
    command = [sys.executable, "-m", _PROGRAM]
    return subprocess.run(command, env=os.environ | _SETTINGS, stdout=subprocess.PIPE, check=True).stdout
