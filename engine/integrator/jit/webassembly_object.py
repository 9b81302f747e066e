"""Compilation of LLVM instructions to a WebAssembly module without a linker, by adding exports to an object file."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import llvmlite.binding as llvm  # type: ignore[import-untyped]

TARGET = "wasm32-unknown-unknown"
"""LLVM's name of 32-bit WebAssembly."""

FUNCTIONS = ("step", "jets", "potential_value", "potential_slopes")
"""Names of the functions of the module of a potential. Only the modules of expressions have `potential_slopes`."""

VECTOR_LANES = 2
"""Number of lanes, and so of doubles, in a vector."""

HEAP_CELL = 16
"""Address of the cell that contains the start of the free memory. The caller of a kernel restores the value of the cell."""

# Features of WebAssembly that the code uses.
_FEATURES = "+simd128,+bulk-memory"
# Number of bytes before the first section of a module.
_HEADER_BYTES = 8
# Numbers of sections, from the specification of WebAssembly.
_CUSTOM, _IMPORT, _EXPORT, _CODE = 0, 2, 7, 10
# Kinds of imports and exports.
_FUNCTION, _TABLE, _MEMORY, _GLOBAL = range(4)


def target_machine() -> Any:
    """Return LLVM's code generator for `TARGET`."""
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    return llvm.Target.from_triple(TARGET).create_target_machine(opt=3, features=_FEATURES, reloc="static")


def compile_module(source: Any, machine: Any, level: int, inlining_threshold: int | None = None) -> bytes:
    """Compile an LLVM module to a WebAssembly module that exports its external functions by their names.

    source: a parsed module of llvmlite, which is optimised in place; level: the level of optimisation, 2 or 3;
    inlining_threshold: largest size of functions that are inlined, None for the default of the level.
    """
    options = llvm.create_pipeline_tuning_options(speed_level=level)
    # Without unrolling, the module has a third fewer bytes and is as fast.
    options.loop_unrolling = False
    if inlining_threshold is not None:
        options.inlining_threshold = inlining_threshold
    passes = llvm.create_pass_builder(machine, options)
    # The second run optimises what the first run has made constant.
    for _ in range(2):
        passes.getModulePassManager().run(source, passes)
    defined = [function for function in source.functions if not function.is_declaration]
    exports = {function.name: index for index, function in enumerate(defined) if function.linkage == llvm.Linkage.external}
    return _with_exports(machine.emit_object(source), exports)


def _with_exports(compiled: bytes, indices: dict[str, int]) -> bytes:
    """Add exports of functions, {name: index among the defined functions}, to an object file, and remove sections for linkers."""
    sections = list(_sections(compiled))
    # Imported functions are numbered before the functions of the module.
    offset = sum(_count_imported_functions(compiled, begin) for number, begin, _ in sections if number == _IMPORT)
    exports = b"".join(_encode_name(name) + bytes([_FUNCTION]) + _leb128(offset + index) for name, index in indices.items())
    export_section = _encode_section(_EXPORT, _leb128(len(indices)) + exports)
    # The section of exports precedes the section of code.
    contents = [
        (export_section if number == _CODE else b"") + compiled[begin:end] for number, begin, end in sections if number != _CUSTOM
    ]
    return compiled[:_HEADER_BYTES] + b"".join(contents)


def _sections(module: bytes) -> Iterator[tuple[int, int, int]]:
    """Yield (number, begin, end) of each section of a module, with its header."""
    begin = _HEADER_BYTES
    while begin < len(module):
        size, content_begin = _read_leb128(module, begin + 1)
        end = content_begin + size
        yield module[begin], begin, end
        begin = end


def _count_imported_functions(module: bytes, begin: int) -> int:
    """Return the number of functions in the import section, which begins at a position in the module."""
    _, position = _read_leb128(module, begin + 1)
    import_count, position = _read_leb128(module, position)
    function_count = 0
    for _ in range(import_count):
        # An import begins with the names of its module and of the object.
        for _ in range(2):
            length, position = _read_leb128(module, position)
            position += length
        kind = module[position]
        function_count += kind == _FUNCTION
        position = _skip_type(module, kind, position + 1)
    return function_count


def _skip_type(module: bytes, kind: int, position: int) -> int:
    """Return the position at which the type of an import ends."""
    if kind == _FUNCTION:
        return _read_leb128(module, position)[1]
    if kind == _GLOBAL:
        # One byte for the type, and one that tells whether the value can change.
        return position + 2
    if kind == _TABLE:
        # The type of the elements.
        position += 1
    # A table or a memory has limits: a flag, the minimum and, according to the flag, the maximum.
    has_maximum, position = module[position] & 1, position + 1
    for _ in range(1 + has_maximum):
        _, position = _read_leb128(module, position)
    return position


def _encode_section(number: int, content: bytes) -> bytes:
    """Encode a section of a module: its number, its size in bytes and its content."""
    return bytes([number]) + _leb128(len(content)) + content


def _encode_name(name: str) -> bytes:
    """Encode a text as its size in bytes and its characters."""
    return _leb128(len(name)) + name.encode()


def _leb128(value: int) -> bytes:
    """Encode a number in the format LEB128: seven bits per byte, the lowest first."""
    digits = bytearray()
    while value > 0x7F:
        digits.append(value & 0x7F | 0x80)
        value >>= 7
    return bytes([*digits, value])


def _read_leb128(data: bytes, begin: int) -> tuple[int, int]:
    """Decode a number in the format LEB128; return the number and the position at which it ends."""
    value = length = 0
    while True:
        byte = data[begin + length]
        value |= (byte & 0x7F) << 7 * length
        length += 1
        if byte < 0x80:
            return value, begin + length
