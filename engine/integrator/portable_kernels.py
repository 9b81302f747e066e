"""The kernels that a visitor's browser runs, as a WebAssembly module for all potentials.

The module depends on this version of the program and on those of Numba and LLVM only. It is built once, by this module in a
process of its own, and kept with the compiled kernels.
"""

from __future__ import annotations

import functools
import logging
import os
import subprocess
import sys
import threading
from typing import Any

from numba import types

from engine.foundations.cache_files import SUFFIX, cache_folder, read_cached, write_cached
from engine.integrator.jit.disk_cache import program_digest
from engine.integrator.jit.kernel_module import SETTINGS, lower_kernels
from engine.integrator.jit.webassembly import PAIR
from engine.integrator.kernels import dense_output, ensemble, exit_curves, generated_calls, interior, propagate

log = logging.getLogger(__name__)


_void, _address, _number, _count, _flag = types.void, types.int64, types.float64, types.int64, types.boolean
_f1, _f2, _f3 = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]
_i1, _i2, _codes, _flags = types.int64[::1], types.int64[:, ::1], types.int8[::1], types.uint8[::1]
_exits = types.NamedTuple((_f2, _f3, _i1), propagate.Exits)  # type: ignore[no-untyped-call]
_orbits = types.NamedTuple((_f2, _f1, _i1, _i1, _codes, _flags, _f2), propagate.Orbits)  # type: ignore[no-untyped-call]
_ensemble = types.NamedTuple((_f2, _f1, _f3, _codes, _f1, _f1, _f2), ensemble.Ensemble)  # type: ignore[no-untyped-call]
_points = (_f1, _f1, _f1, _f3, _i1, _codes)

KERNELS: dict[str, tuple[Any, Any]] = {
    "propagate": (
        propagate.propagate,
        _count(_address, _address, _f1, _i1, _number, _flag, _number, _count, _count, _exits, _orbits, _f2),
    ),
    "advance_ensemble": (
        ensemble.advance_ensemble,
        _void(_address, _address, _f1, _number, _number, _number, _f2, _f2, _ensemble),
    ),
    "place_ensemble": (ensemble.place_ensemble, _void(_number, _ensemble, _f2, _codes)),
    "find_outside_polynomial": (interior.find_outside_polynomial, _void(_i2, _f1, _f2, _f2, *_points)),
    "find_outside": (interior.find_outside, _void(_address, _f1, _number, *_points)),
    "interpolate_exit": (exit_curves.interpolate_exit, _void(_f1, _f2, _number, _count, _f1, _f1)),
    "exit_points": (exit_curves.exit_points, _void(_f1, _f1, _f2)),
    "evaluate_series": (dense_output.evaluate_series, _void(_f3, _i1, _f1, _f2)),
    "compute_series": (generated_calls.compute_series, _void(_address, _f1, _f2, _f3)),
    "potential_at": (generated_calls.potential_at, _number(_address, _f1, _number, _number)),
}
"""Kernels by the names of the functions of the module, with the types of their results and arguments."""

_building = threading.Lock()


def module_digest() -> str:
    """A hash of all that the module depends on; it need not be built."""
    return program_digest()


def kernel_module() -> bytes:
    """The module, from the cache or built, which takes some seconds; see `engine.integrator.jit.kernel_module.lower_kernels`."""
    with _building:
        return _load_or_build()


@functools.cache
def _load_or_build() -> bytes:
    path = cache_folder() / f"{__name__}.{program_digest()}{SUFFIX}"
    try:
        stored = read_cached(path)
    except (OSError, ValueError) as error:
        log.warning("invalid compiled kernels %s: %s; compiling them again", path, error)
        stored = None
    if stored is None:
        command = [sys.executable, "-m", __name__]
        stored = subprocess.run(command, env=os.environ | SETTINGS, stdout=subprocess.PIPE, check=True).stdout
        write_cached(path, stored)
    return stored


def _main() -> None:
    """Write the module to the standard output."""
    for module in (propagate, ensemble):
        vars(module)["VECTOR"] = PAIR
    sys.stdout.buffer.write(lower_kernels(KERNELS))


if __name__ == "__main__":
    _main()
