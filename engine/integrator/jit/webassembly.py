"""Straight-line programs as a WebAssembly module with SIMD that runs in the browser of a visitor.

The functions of a potential are those that kernels call by their addresses, with the same arguments in the same order
(`engine.integrator.jit.function_pointers`), so that kernels are compiled for WebAssembly without changes, see
`engine.integrator.jit.kernel_module`. A function with lanes runs its program for two lanes at a time;
`engine.integrator.jit.llvm_emitter` writes it for vectors of two doubles.
"""

from __future__ import annotations

import functools
from typing import Any

import llvmlite.binding as llvm  # type: ignore[import-untyped]
from llvmlite import ir
from numba import types
from numba.core.registry import cpu_target

from engine.integrator.jit.function_pointers import SIGNATURES
from engine.integrator.jit.llvm_emitter import write_program
from engine.integrator.jit.webassembly_object import TARGET, compile_module, target_machine
from engine.integrator.source.generated_functions import ADDED, GeneratedFunction, Place
from engine.integrator.source.recurrence import GeneratedCode
from engine.integrator.source.straight_line import TABLE

FUNCTIONS = ("step", "jets", "potential_value", "potential_slopes")
"""Names of the functions of a module, of which `potential_slopes` exists for expressions only."""

PAIR = 2
"""Number of doubles in a vector."""

# Alignment of vectors in memory, in bytes.
_BYTES = 8
_INT = ir.IntType(64)
# Number of cached modules, of some kB each.
_MODULES = 32


@functools.lru_cache(maxsize=_MODULES)
def webassembly_module(code: GeneratedCode) -> bytes:
    """Return the functions of the potentials of one structure (`FUNCTIONS`) as a WebAssembly module, which imports its memory.

    The functions have the arguments of Numba's calling convention. The number of lanes is rounded up to an even number, and rows
    must be long enough for this number.
    """
    machine = target_machine()
    module = ir.Module("engine")
    module.triple, module.data_layout = TARGET, str(machine.target_data)
    for function in code.functions:
        if function.name in FUNCTIONS:
            _Writer(module, function, len(code.entries)).write()
    return compile_module(llvm.parse_assembly(str(module)), machine, level=2)


class _Writer:
    """Writes a generated function, with a table of `entry_count` entries, into a module."""

    def __init__(self, module: ir.Module, generated: GeneratedFunction, entry_count: int) -> None:
        self._generated, self._entry_count = generated, entry_count
        self._signature = SIGNATURES[generated.name]
        # The context defines Numba's layout of arguments.
        self._context = context = cpu_target.target_context
        kinds = self._signature.args
        self._function = ir.Function(
            module, context.call_conv.get_function_type(self._signature.return_type, kinds), generated.name
        )
        self._builder = ir.IRBuilder(self._function.append_basic_block())
        passed = context.get_arg_packer(kinds).from_arguments(self._builder, context.call_conv.get_arguments(self._function))
        self._arguments = dict(zip(generated.arguments, map(self._unpack, kinds, passed), strict=True))

    def _unpack(self, kind: Any, value: Any) -> Any:
        """Return a number, or the address of an array and the length of its rows."""
        if not isinstance(kind, types.Array):
            return value
        array = self._context.make_array(kind)(self._context, self._builder, value)
        return array.data, self._builder.extract_value(array.shape, kind.ndim - 1)

    def write(self) -> None:
        """Write the function, with a loop over pairs of lanes if it has lanes."""
        if self._generated.writes:
            self._write_loop()
            self._context.call_conv.return_value(self._builder, self._context.get_dummy_value())
            return
        values = self._run([self._load(Place("coefficients", column=k), 1) for k in range(self._entry_count)], {}, 1)
        result = values[0] if len(values) == 1 else self._context.make_tuple(self._builder, self._signature.return_type, values)
        self._context.call_conv.return_value(self._builder, result)

    def _write_loop(self) -> None:
        """Write a loop over pairs of lanes; numbers that are the same for all lanes are loaded before the loop."""
        builder, reads = self._builder, self._generated.reads
        table = [self._load(Place("coefficients", column=k), PAIR) for k in range(self._entry_count)]
        common_inputs = {name: self._load(place, PAIR) for name, place in reads.items() if place.column is not None}
        loop, end = self._function.append_basic_block(), self._function.append_basic_block()
        entry = builder.block
        builder.branch(loop)
        builder.position_at_end(loop)
        lane = builder.phi(_INT)
        lane.add_incoming(_INT(0), entry)
        vector = ir.VectorType(ir.DoubleType(), PAIR)
        lane_inputs = {
            name: builder.load(self._address(place, lane, vector), align=_BYTES)
            for name, place in reads.items()
            if place.column is None
        }
        for place, value in zip(self._generated.writes, self._run(table, common_inputs | lane_inputs, PAIR), strict=True):
            address = self._address(place, lane, value.type)
            total = builder.add(value, builder.load(address, align=_BYTES)) if place.array in ADDED else value
            builder.store(total, address, align=_BYTES)
        next_lane = builder.add(lane, _INT(PAIR))
        lane.add_incoming(next_lane, loop)
        builder.cbranch(builder.icmp_signed("<", next_lane, self._arguments["n"]), loop, end)
        builder.position_at_end(end)

    def _run(self, table: list[Any], inputs: dict[str, Any], width: int) -> list[Any]:
        """Return the results of the program for `width` lanes; parameters that are not `inputs` are arguments."""
        program = self._generated.program
        values = {TABLE: table, **inputs}
        passed = [
            values[name] if name in values else self._in_all_lanes(self._arguments[name], width) for name in program.parameters
        ]
        return write_program(program, self._builder, passed, width)

    def _load(self, place: Place, width: int) -> Any:
        """Load a number that is the same for all lanes."""
        return self._in_all_lanes(self._builder.load(self._address(place, _INT(place.column), ir.DoubleType())), width)

    def _in_all_lanes(self, value: Any, width: int) -> Any:
        """Return a vector with a number in each of `width` lanes; for one lane, the number."""
        if width == 1:
            return value
        undefined = ir.Constant(ir.VectorType(value.type, width), ir.Undefined)
        first = self._builder.insert_element(undefined, value, ir.IntType(32)(0))
        return self._builder.shuffle_vector(first, undefined, ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width))

    def _address(self, place: Place, column: Any, kind: ir.Type) -> Any:
        """Return the address of a number, or of a vector that begins at a column."""
        data, length = self._arguments[place.array]
        if place.row is not None:
            column = self._builder.add(column, self._builder.mul(length, _INT(place.row)))
        return self._builder.bitcast(self._builder.gep(data, [column]), kind.as_pointer())
