"""The kernels as a WebAssembly module that runs in the browser of a visitor; Numba compiles the same functions for Python.

Numba lowers a kernel to LLVM instructions that hardly depend on the machine: only the data layout contains the size of an
address, and this layout is replaced. Numba must not optimise the code for this machine. Only environment variables prevent that,
so `lower_kernels` is called in a separate process (`engine.integrator.portable_kernels`).

This module uses parts of Numba 0.68 that are not public: the context of the target, for its calling convention and the layout of
arrays (`populate_array`), and the functions of its memory management to which code refers (`_RUNTIME`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import llvmlite.binding as llvm  # type: ignore[import-untyped]
from llvmlite import ir
from numba import types
from numba.core.registry import cpu_target
from numba.core.typing.templates import Signature
from numba.np.arrayobj import populate_array

from engine.integrator.jit.decorator import make_dispatcher
from engine.integrator.jit.webassembly_object import HEAP_CELL, TARGET, compile_module, target_machine

_INT32, _DOUBLE, _INT64 = ir.IntType(32), ir.DoubleType(), ir.IntType(64)

# Replaces the functions of Numba's memory management. Arrays are allocated at the start of the free memory, without reference
# counts. An array of Numba begins with the address of its metadata, which contain the address of its numbers. Here both addresses
# are equal.
_RUNTIME = f"""
define void @NRT_incref(ptr %info) alwaysinline {{ ret void }}
define void @NRT_decref(ptr %info) alwaysinline {{ ret void }}
define ptr @NRT_MemInfo_data_fast(ptr %info) alwaysinline {{ ret ptr %info }}
define noalias nonnull ptr @NRT_MemInfo_alloc_aligned(i64 %size, i32 %alignment) alwaysinline {{
  %cell = inttoptr i32 {HEAP_CELL} to ptr
  %begin = load i32, ptr %cell
  %bytes = trunc i64 %size to i32
  %end = add i32 %begin, %bytes
  %above = add i32 %end, 15
  %next = and i32 %above, -16
  store i32 %next, ptr %cell
  %array = inttoptr i32 %begin to ptr
  ret ptr %array
}}
"""
# Options of Numba for kernels that Python does not call.
_OPTIONS = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
# Functions above this size, in LLVM's units, are not inlined. By default they would be, which gives 10 % more bytes and no speed.
_INLINING_THRESHOLD = 100
_RUNTIME_NAMES = "|".join(re.findall(r"@(NRT_\w+)", _RUNTIME))


def lower_kernels(kernels: Mapping[Any, Signature]) -> bytes:
    """Return a WebAssembly module of kernels, each compiled for its signature; its functions have the names of the kernels.

    Each array is passed as its address and its shape, a tuple as its elements, and an integer or a boolean as 32 bits. The module
    imports ``env.__linear_memory``, ``env.__stack_pointer`` and ``env.__indirect_function_table``, and functions such as
    ``env.cos``. Where kernels take addresses of functions, these are indices into the function table.
    """
    machine = target_machine()
    module = _parse(_RUNTIME, machine)
    names = {kernel: kernel.py_func.__name__ for kernel in kernels}
    for kernel, signature in kernels.items():
        compiled = make_dispatcher(kernel.py_func, **_OPTIONS)
        compiled.compile(signature)
        symbol = compiled.overloads[signature.args].fndesc.llvm_func_name
        module.link_in(_parse(_without_runtime(compiled.inspect_llvm(signature.args)), machine))
        module.link_in(_parse(str(_wrapper(names[kernel], symbol, signature)), machine))
    _make_internal(module, exported=set(names.values()))
    return compile_module(module, machine, level=2, inlining_threshold=_INLINING_THRESHOLD)


def _parse(text: str, machine: Any) -> Any:
    """Parse LLVM instructions as instructions for `TARGET`."""
    text = re.sub(r"^target (triple|datalayout) = .*$", "", text, flags=re.MULTILINE)
    text = re.sub(r'"target-(cpu|features)"="[^"]*"', "", text)
    return llvm.parse_assembly(f'target triple = "{TARGET}"\ntarget datalayout = "{machine.target_data}"\n{text}')


def _without_runtime(text: str) -> str:
    """Return the instructions of a kernel, with declarations in place of the functions of `_RUNTIME`."""
    definition = rf"^define (?:linkonce_odr )?([^\n]*@({_RUNTIME_NAMES})\([^\n]*\)).*?^}}$"
    return re.sub(definition, r"declare \1", text, flags=re.MULTILINE | re.DOTALL)


def _make_internal(module: Any, exported: set[str]) -> None:
    """Make all functions except the exported ones, and all variables, internal, so that unused ones are removed."""
    for function in module.functions:
        if not function.is_declaration:
            function.linkage = "external" if function.name in exported else "internal"
    for variable in module.global_variables:
        if not variable.is_declaration:
            variable.linkage = "internal"


def _wrapper(name: str, symbol: str, signature: Signature) -> ir.Module:
    """Return a module with a function that takes numbers and calls a kernel."""
    context = cpu_target.target_context
    module = ir.Module(name)
    argument_types = [passed for argument in signature.args for passed in _passed_types(argument)]
    # The list has one element, or none if the kernel has no result.
    result_types = _passed_types(signature.return_type)
    function = ir.Function(module, ir.FunctionType(result_types[0] if result_types else ir.VoidType(), argument_types), name)
    builder = ir.IRBuilder(function.append_basic_block())
    values = iter(function.args)
    arguments = [_read_argument(context, builder, argument, values) for argument in signature.args]
    kernel = ir.Function(module, context.call_conv.get_function_type(signature.return_type, signature.args), symbol)
    _, value = context.call_conv.call_function(builder, kernel, signature.return_type, signature.args, arguments)
    if not result_types:
        builder.ret_void()
    else:
        builder.ret(value if result_types == [_DOUBLE] else _to_int32(builder, value))
    return module


def _to_int32(builder: ir.IRBuilder, value: ir.Value) -> ir.Value:
    """Return an integer or a boolean in 32 bits."""
    return builder.trunc(value, _INT32) if value.type.width > _INT32.width else builder.zext(value, _INT32)


def _passed_types(numba_type: Any) -> list[ir.Type]:
    """Return the types of the numbers that stand for an argument or a result of a Numba type."""
    if isinstance(numba_type, types.NamedTuple):
        return [passed for element in numba_type.types for passed in _passed_types(element)]
    if isinstance(numba_type, types.Array):
        return [_INT32] * (1 + numba_type.ndim)
    if numba_type == types.none:
        return []
    return [_DOUBLE if numba_type == types.float64 else _INT32]


def _read_argument(context: Any, builder: ir.IRBuilder, numba_type: Any, values: Any) -> ir.Value:
    """Return the next argument of a kernel in Numba's representation, from an iterator of the passed numbers."""
    if isinstance(numba_type, types.NamedTuple):
        elements = [_read_argument(context, builder, element, values) for element in numba_type.types]
        return context.make_tuple(builder, numba_type, elements)
    if isinstance(numba_type, types.Array):
        return _make_array(context, builder, numba_type, next(values), [next(values) for _ in range(numba_type.ndim)])
    if numba_type == types.float64:
        return next(values)
    if numba_type == types.boolean:
        return builder.icmp_signed("!=", next(values), _INT32(0))
    return builder.sext(next(values), _INT64)


def _make_array(context: Any, builder: ir.IRBuilder, array_type: Any, address: ir.Value, shape: list[ir.Value]) -> ir.Value:
    """Return Numba's representation of a contiguous array that owns no memory."""
    lengths = [builder.zext(length, _INT64) for length in shape]
    item_size = array_type.dtype.bitwidth // 8
    strides = [_INT64(item_size)]
    for length in reversed(lengths[1:]):
        strides.insert(0, builder.mul(strides[0], length))
    array = context.make_array(array_type)(context, builder)
    data = builder.inttoptr(address, array.data.type)
    populate_array(array, data, lengths, strides, item_size, meminfo=None)  # type: ignore[no-untyped-call]
    return array._getvalue()
