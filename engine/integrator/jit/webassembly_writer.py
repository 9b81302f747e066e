"""Writes straight-line programs as functions of an LLVM module and compiles the module to WebAssembly."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import llvmlite.binding as llvm  # type: ignore[import-untyped]
from llvmlite import ir
from numba import types
from numba.core.registry import cpu_target

from engine.integrator.jit.function_types import SIGNATURES
from engine.integrator.jit.llvm_emitter import write_program
from engine.integrator.jit.webassembly_object import FUNCTIONS, TARGET, VECTOR_LANES, compile_module, target_machine
from engine.integrator.source.generated_functions import ACCUMULATED, GeneratedFunction, Place
from engine.integrator.source.recurrence import Structure, generate_code
from engine.integrator.source.straight_line import TABLE

# Alignment of vectors in memory, in bytes.
_ALIGNMENT = 8
_INT64 = ir.IntType(64)


def compile_functions(structures: Sequence[Structure]) -> bytes:
    """Compile the functions of the potentials of one structure; those of later structures replace those of earlier ones."""
    machine = target_machine()
    module = ir.Module("engine")
    module.triple, module.data_layout = TARGET, str(machine.target_data)
    codes = [generate_code(structure) for structure in structures]
    functions = {function.name: function for code in codes for function in code.functions}
    for name, function in functions.items():
        if name in FUNCTIONS:
            _Writer(module, function, len(codes[0].entries)).write()
    return compile_module(llvm.parse_assembly(str(module)), machine, level=2)


class _Writer:
    """Writes the function of a `GeneratedFunction` into an LLVM module; the table of coefficients has `entry_count` entries."""

    def __init__(self, module: ir.Module, generated: GeneratedFunction, entry_count: int) -> None:
        self._generated, self._entry_count = generated, entry_count
        self._signature = SIGNATURES[generated.name]
        # The context defines Numba's layout of arguments.
        self._context = context = cpu_target.target_context
        argument_types = self._signature.args
        function_type = context.call_conv.get_function_type(self._signature.return_type, argument_types)
        self._function = ir.Function(module, function_type, generated.name)
        self._builder = ir.IRBuilder(self._function.append_basic_block())
        packer, packed = context.get_arg_packer(argument_types), context.call_conv.get_arguments(self._function)
        values = packer.from_arguments(self._builder, packed)
        self._arguments = dict(zip(generated.arguments, map(self._unpack, argument_types, values), strict=True))

    def _unpack(self, argument_type: Any, value: Any) -> Any:
        """Return a number, or the address of an array and the length of its rows."""
        if not isinstance(argument_type, types.Array):
            return value
        array = self._context.make_array(argument_type)(self._context, self._builder, value)
        return array.data, self._builder.extract_value(array.shape, argument_type.ndim - 1)

    def write(self) -> None:
        """Write the function, with a loop over pairs of lanes if it has lanes."""
        if self._generated.writes:
            self._write_loop()
            self._context.call_conv.return_value(self._builder, self._context.get_dummy_value())
            return
        values = self._write_program([self._load(Place("coefficients", column=k), 1) for k in range(self._entry_count)], {}, 1)
        result = values[0] if len(values) == 1 else self._context.make_tuple(self._builder, self._signature.return_type, values)
        self._context.call_conv.return_value(self._builder, result)

    def _write_loop(self) -> None:
        """Write a loop over pairs of lanes; numbers that are the same for all lanes are loaded before the loop.

        The loop tests its condition at its end, so the number of lanes must be at least 1.
        """
        builder, reads = self._builder, self._generated.reads
        table = [self._load(Place("coefficients", column=k), VECTOR_LANES) for k in range(self._entry_count)]
        common_inputs = {name: self._load(place, VECTOR_LANES) for name, place in reads.items() if place.column is not None}
        loop, end = self._function.append_basic_block(), self._function.append_basic_block()
        entry = builder.block
        builder.branch(loop)
        builder.position_at_end(loop)
        lane = builder.phi(_INT64)
        lane.add_incoming(_INT64(0), entry)
        vector = ir.VectorType(ir.DoubleType(), VECTOR_LANES)
        lane_inputs = {
            name: builder.load(self._address(place, lane, vector), align=_ALIGNMENT)
            for name, place in reads.items()
            if place.column is None
        }
        results = self._write_program(table, common_inputs | lane_inputs, VECTOR_LANES)
        for place, result in zip(self._generated.writes, results, strict=True):
            address = self._address(place, lane, result.type)
            total = builder.add(result, builder.load(address, align=_ALIGNMENT)) if place.array in ACCUMULATED else result
            builder.store(total, address, align=_ALIGNMENT)
        next_lane = builder.add(lane, _INT64(VECTOR_LANES))
        lane.add_incoming(next_lane, loop)
        builder.cbranch(builder.icmp_signed("<", next_lane, self._arguments["n"]), loop, end)
        builder.position_at_end(end)

    def _write_program(self, table: list[Any], inputs: dict[str, Any], width: int) -> list[Any]:
        """Write the instructions of the program for `width` lanes and return its results.

        Parameters that are neither the table nor in `inputs` are arguments of the function.
        """
        program = self._generated.program
        known = {TABLE: table, **inputs}
        values = [known[name] if name in known else self._broadcast(self._arguments[name], width) for name in program.parameters]
        return write_program(program, self._builder, values, width)

    def _load(self, place: Place, width: int) -> Any:
        """Load the number at a place and repeat it in `width` lanes."""
        return self._broadcast(self._builder.load(self._address(place, _INT64(place.column), ir.DoubleType())), width)

    def _broadcast(self, value: Any, width: int) -> Any:
        """Return a vector of `width` lanes that all contain the number; for a width of 1, the number itself."""
        if width == 1:
            return value
        undefined = ir.Constant(ir.VectorType(value.type, width), ir.Undefined)
        first = self._builder.insert_element(undefined, value, ir.IntType(32)(0))
        return self._builder.shuffle_vector(first, undefined, ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width))

    def _address(self, place: Place, column: Any, value_type: ir.Type) -> Any:
        """Return the address of the value at a column of a place: a number, or a vector that begins there."""
        data, length = self._arguments[place.array]
        if place.row is not None:
            column = self._builder.add(column, self._builder.mul(length, _INT64(place.row)))
        return self._builder.bitcast(self._builder.gep(data, [column]), value_type.as_pointer())
