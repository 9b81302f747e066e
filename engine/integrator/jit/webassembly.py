"""Straight-line programs as a WebAssembly module with SIMD, for the machine of a visitor.

A function of the module runs one program for two lanes at a time, as `engine.integrator.jit.llvm_emitter` writes it for vectors
of two doubles. LLVM makes an object file, which is a module but for its exports; as the programs call nothing and have no data,
there is nothing to link.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence

import llvmlite.binding as llvm  # type: ignore[import-untyped]
from llvmlite import ir

from engine.integrator.jit.llvm_emitter import write_program
from engine.integrator.source.recurrence import LANES, GeneratedCode, GeneratedFunction
from engine.integrator.source.straight_line import TABLE

TARGET = "wasm32-unknown-unknown"

_FUNCTIONS = ("step", "jets")
_WIDTH = 2
_BYTES = 8
_SIZE, _DOUBLE = ir.IntType(32), ir.DoubleType()
_VECTOR = ir.VectorType(_DOUBLE, _WIDTH)
_HEADER_BYTES = 8
# Numbers of sections and the kind of an export, see the specification of WebAssembly.
_CUSTOM, _EXPORT, _CODE = 0, 7, 10
_FUNCTION_EXPORT = 0
# Cached modules, some kB each.
_MODULES = 32


@functools.lru_cache(maxsize=_MODULES)
def webassembly_module(code: GeneratedCode) -> bytes:
    """The functions ``step`` and ``jets`` of the potentials of one structure as a WebAssembly module, which imports its memory.

    Each takes addresses and a number of lanes, ``(table, constants, lanes, results, n)``. `table` is that of
    `GeneratedCode.tabulate`, `constants` the inputs that are the same for all lanes (`constant_inputs`). The arrays `lanes` and
    `results` have rows of `LANES` numbers, for the inputs of each lane (`GeneratedFunction.lane_inputs`) and for the results of
    the program in order: doubles or 64-bit integers. n is rounded up to an even number.
    """
    functions = [function for function in code.functions if function.name in _FUNCTIONS]
    module = ir.Module("engine")
    module.triple = TARGET
    for function in functions:
        _write_loop(module, function, len(code.entries))
    return _with_exports(_compile(module), [function.name for function in functions])


def constant_inputs(code: GeneratedCode, name: str) -> tuple[str, ...]:
    """The inputs of a function that are the same for all lanes, in order."""
    function = next(function for function in code.functions if function.name == name)
    return tuple(each for each in function.program.parameters if each != TABLE and each not in function.lane_inputs)


def _write_loop(module: ir.Module, generated: GeneratedFunction, entries: int) -> None:
    """A loop over pairs of lanes."""
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), [_SIZE] * 5), generated.name)
    table, constants, lanes, results, n = function.args
    builder = ir.IRBuilder(function.append_basic_block())
    program, lane_inputs = generated.program, generated.lane_inputs
    loop, end = function.append_basic_block(), function.append_basic_block()
    entry = builder.block
    builder.branch(loop)
    builder.position_at_end(loop)
    lane = builder.phi(_SIZE)
    lane.add_incoming(_SIZE(0), entry)
    offset = builder.mul(lane, _SIZE(_BYTES))
    uniform = [each for each in program.parameters if each != TABLE and each not in lane_inputs]
    inputs = {each: _load_same(builder, constants, index) for index, each in enumerate(uniform)}
    inputs |= {each: builder.load(_row(builder, lanes, row, offset, _VECTOR)) for row, each in enumerate(lane_inputs)}
    inputs[TABLE] = [_load_same(builder, table, index) for index in range(entries)]
    for row, value in enumerate(write_program(program, builder, [inputs[each] for each in program.parameters], _WIDTH)):
        builder.store(value, _row(builder, results, row, offset, value.type), align=_BYTES)
    following = builder.add(lane, _SIZE(_WIDTH))
    lane.add_incoming(following, loop)
    builder.cbranch(builder.icmp_signed("<", following, n), loop, end)
    builder.position_at_end(end)
    builder.ret_void()


def _load_same(builder: ir.IRBuilder, array: ir.Value, index: int) -> ir.Value:
    """An element of an array, in all lanes."""
    value = builder.load(builder.inttoptr(builder.add(array, _SIZE(index * _BYTES)), _DOUBLE.as_pointer()))
    undefined = ir.Constant(_VECTOR, ir.Undefined)
    first = builder.insert_element(undefined, value, _SIZE(0))
    return builder.shuffle_vector(first, undefined, ir.Constant(ir.VectorType(_SIZE, _WIDTH), [0] * _WIDTH))


def _row(builder: ir.IRBuilder, array: ir.Value, row: int, offset: ir.Value, kind: ir.Type) -> ir.Value:
    """The address of the present lanes in a row."""
    start = builder.add(array, _SIZE(row * LANES * _BYTES))
    return builder.inttoptr(builder.add(start, offset), kind.as_pointer())


def _compile(module: ir.Module) -> bytes:
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    machine = llvm.Target.from_triple(TARGET).create_target_machine(opt=3, features="+simd128", reloc="static")
    parsed = llvm.parse_assembly(str(module))
    passes = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(speed_level=2))
    passes.getModulePassManager().run(parsed, passes)
    compiled: bytes = machine.emit_object(parsed)
    return compiled


def _with_exports(compiled: bytes, names: Sequence[str]) -> bytes:
    """An object file with exports of its functions, and without the sections for a linker."""
    exports = [_name(name) + bytes([_FUNCTION_EXPORT, index]) for index, name in enumerate(names)]
    export = _section(_EXPORT, bytes([len(exports)]) + b"".join(exports))
    kept = [
        (export if number == _CODE else b"") + compiled[begin:end]
        for number, begin, end in _sections(compiled)
        if number != _CUSTOM
    ]
    return compiled[:_HEADER_BYTES] + b"".join(kept)


def _sections(module: bytes) -> Iterator[tuple[int, int, int]]:
    """(number, begin, end) of each section of a module, with its header."""
    begin = _HEADER_BYTES
    while begin < len(module):
        size, length = _read_number(module, begin + 1)
        end = begin + 1 + length + size
        yield module[begin], begin, end
        begin = end


def _section(number: int, content: bytes) -> bytes:
    return bytes([number]) + _number(len(content)) + content


def _name(name: str) -> bytes:
    return _number(len(name)) + name.encode()


def _number(value: int) -> bytes:
    """A number in the format LEB128: seven bits a byte, the lowest first."""
    digits = bytearray()
    while value > 0x7F:
        digits.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*digits, value])


def _read_number(data: bytes, begin: int) -> tuple[int, int]:
    """A number in the format LEB128, and how many bytes it takes."""
    value = length = 0
    while True:
        byte = data[begin + length]
        value |= (byte & 0x7F) << 7 * length
        length += 1
        if byte < 0x80:
            return value, length
