"""The kernels of the WebAssembly module for browsers; run as a program, this module builds that module and writes it."""

from __future__ import annotations

import sys
from typing import Any

from numba import types
from numba.core.typing.templates import Signature

from engine.integrator.jit.kernel_module import lower_kernels
from engine.integrator.jit.webassembly_object import VECTOR_LANES
from engine.integrator.kernels import (
    dense_output,
    ensemble,
    exit_geometry,
    interior,
    lanes,
    propagate,
    random_starts,
    slice_starts,
)

# Types of arguments: numbers; arrays of doubles and integers, by their dimensions; named tuples; and sequences of arguments.
_void, _address, _number, _count, _flag = types.void, types.int64, types.float64, types.int64, types.boolean
_f1, _f2, _f3 = types.float64[::1], types.float64[:, ::1], types.float64[:, :, ::1]
_i1, _i2, _codes, _flags = types.int64[::1], types.int64[:, ::1], types.int8[::1], types.uint8[::1]
_exits = types.NamedTuple((_f2, _f3, _i1), propagate.Exits)  # type: ignore[no-untyped-call]
_orbits = types.NamedTuple((_f2, _f1, _i1, _i1, _codes, _flags, _f2), propagate.Orbits)  # type: ignore[no-untyped-call]
_ensemble = types.NamedTuple((_f2, _f1, _f3, _codes, _f1, _f1, _f2), ensemble.Ensemble)  # type: ignore[no-untyped-call]
_potential = (_address, _f1)
_motion = (_f2, _count)
_points = (_f1, _f1, _f1, _f3, _i1, _codes)

KERNELS: dict[Any, Signature] = {
    propagate.propagate: _count(_address, _address, _f1, _i1, _number, _flag, _number, _count, _count, _exits, _orbits, _f2),
    ensemble.advance_ensemble: _void(_address, _address, _f1, _number, _number, _number, _f2, _f2, _ensemble),
    ensemble.begin_ensemble: _void(_f2, _ensemble, _f2, _codes),
    ensemble.place_ensemble: _void(_number, _ensemble, _f2, _codes),
    ensemble.reverse_ensemble: _count(_number, _ensemble, _codes, _f2),
    ensemble.measure_spread: _number(_f2, _f2, _codes),
    interior.find_outside_polynomial: _void(_i2, _f1, _f2, _f2, *_points),
    interior.find_outside: _void(_address, _f1, _number, *_points),
    exit_geometry.interpolate_exit: _void(_f1, _f2, _number, _count, _f1, _count, _f3, _f2),
    exit_geometry.exit_points: _void(_f1, _f1, _f2),
    dense_output.compute_series: _void(_address, _f1, _f2, _f3),
    dense_output.sample_steps: _void(_address, _f1, _f2, _count, _number, _f2),
    slice_starts.find_starts: _void(*_potential, *_motion, _number, _f2, _f2, _f1),
    slice_starts.find_required_energies: _void(*_potential, *_motion, _f1, _f2),
    slice_starts.interpolate_window: _flag(_f1, _f2, _number, _f1),
    slice_starts.place_pixels: _void(_f1, _count, _count, _i1, _count, _count, _f2, _i1),
    slice_starts.select_starts: _count(_f2, _codes, _i1, _codes, _i1, _f2, _i1),
    slice_starts.report_ends: _void(_orbits, _i1, _codes, _f1, _f1),
    random_starts.scatter_points: _void(_i1, _f1, _flag, _f2),
    random_starts.draw_at_exits: _count(*_potential, _f2, _number, _flag, _i1, _f2),
}
"""The kernels of the module, whose functions have the same names, with the types of their results and arguments."""


def _main() -> None:
    """Build the module and write it to the standard output."""
    # A vector of WebAssembly has two lanes. The kernels are compiled after this assignment.
    lanes.VECTOR = VECTOR_LANES
    sys.stdout.buffer.write(lower_kernels(KERNELS))


if __name__ == "__main__":
    _main()
