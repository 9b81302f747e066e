"""Kernels as a WebAssembly module, for the machine of a visitor: the same functions that Numba compiles for this machine.

Numba lowers a kernel to LLVM instructions that are almost free of the machine: sizes of addresses are in the data layout, which
is replaced. It must not optimise for this machine, which only variables of the environment tell it; so `lower_kernels` is called
in a process of its own.

What is not public in Numba is used here only, in version 0.68: the context of the target, for its calling convention and the
layout of arrays (`populate_array`); and the functions of its memory management that code refers to (`_RUNTIME`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import llvmlite.binding as llvm  # type: ignore[import-untyped]
from llvmlite import ir
from numba import njit, types
from numba.core.registry import cpu_target
from numba.core.typing.templates import Signature
from numba.np.arrayobj import populate_array

from engine.integrator.jit.decorator import OPTIONS
from engine.integrator.jit.webassembly_object import TARGET, compile_module, target_machine

SETTINGS = {
    "NUMBA_OPT": "0",
    "NUMBA_LOOP_VECTORIZE": "0",
    "NUMBA_SLP_VECTORIZE": "0",
    "NUMBA_CPU_NAME": "generic",
    "NUMBA_CPU_FEATURES": "",
    "NUMBA_DISABLE_INTEL_SVML": "1",
}
"""Environment of the process in which `lower_kernels` is called: Numba reads it when it is imported."""

_SIZE, _DOUBLE, _LONG = ir.IntType(32), ir.DoubleType(), ir.IntType(64)

HEAP_CELL = 16
"""Address of the address from which on memory is free. The caller of a kernel restores it."""

# Arrays are made where memory is free, and not counted. An array of Numba begins with the address of its information, from which
# it gets that of its numbers: here they are the same.
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
_OPTIONS: dict[str, Any] = {**OPTIONS, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
_RUNTIME_NAMES = "|".join(re.findall(r"@(NRT_\w+)", _RUNTIME))


def lower_kernels(kernels: Mapping[Any, Signature]) -> bytes:
    """A module with kernels for arguments of some types; its functions have their names.

    Each array is passed as its address and its shape, a tuple as its elements, an integer or a boolean as 32 bits. The module
    imports ``env.__linear_memory``, ``env.__stack_pointer``, ``env.__indirect_function_table`` for the functions whose addresses
    kernels take, there their places in the table, and functions such as ``env.cos``.
    """
    machine = target_machine()
    module = _parse(_RUNTIME, machine)
    names = {kernel: kernel.py_func.__name__ for kernel in kernels}
    for kernel, signature in kernels.items():
        compiled = njit(**_OPTIONS)(kernel.py_func)
        compiled.compile(signature)
        symbol = compiled.overloads[signature.args].fndesc.llvm_func_name
        module.link_in(_parse(_without_runtime(compiled.inspect_llvm(signature.args)), machine))
        module.link_in(_parse(str(_wrapper(names[kernel], symbol, signature)), machine))
    _hide(module, exported=set(names.values()))
    return compile_module(module, machine, level=3)


def _parse(text: str, machine: Any) -> Any:
    """Instructions for another machine."""
    text = re.sub(r"^target (triple|datalayout) = .*$", "", text, flags=re.MULTILINE)
    text = re.sub(r'"target-(cpu|features)"="[^"]*"', "", text)
    return llvm.parse_assembly(f'target triple = "{TARGET}"\ntarget datalayout = "{machine.target_data}"\n{text}')


def _without_runtime(text: str) -> str:
    """The instructions of a kernel with declarations for those of `_RUNTIME`."""
    definition = rf"^define (?:linkonce_odr )?([^\n]*@({_RUNTIME_NAMES})\([^\n]*\)).*?^}}$"
    return re.sub(definition, r"declare \1", text, flags=re.MULTILINE | re.DOTALL)


def _hide(module: Any, exported: set[str]) -> None:
    """Make everything internal but the exported functions, so that what none of them needs vanishes."""
    for function in module.functions:
        if not function.is_declaration:
            function.linkage = "external" if function.name in exported else "internal"
    for variable in module.global_variables:
        if not variable.is_declaration:
            variable.linkage = "internal"


def _wrapper(name: str, symbol: str, signature: Signature) -> ir.Module:
    """A function of numbers that calls a kernel."""
    context = cpu_target.target_context
    module = ir.Module(name)
    passed = [kind for argument in signature.args for kind in _passed_types(argument)]
    result = _passed_types(signature.return_type)
    function = ir.Function(module, ir.FunctionType(result[0] if result else ir.VoidType(), passed), name)
    builder = ir.IRBuilder(function.append_basic_block())
    values = iter(function.args)
    arguments = [_read_argument(context, builder, argument, values) for argument in signature.args]
    kernel = ir.Function(module, context.call_conv.get_function_type(signature.return_type, signature.args), symbol)
    _, value = context.call_conv.call_function(builder, kernel, signature.return_type, signature.args, arguments)
    if not result:
        builder.ret_void()
    else:
        builder.ret(value if result == [_DOUBLE] else _as_size(builder, value))
    return module


def _as_size(builder: ir.IRBuilder, value: ir.Value) -> ir.Value:
    """An integer or a boolean in 32 bits."""
    return builder.trunc(value, _SIZE) if value.type.width > _SIZE.width else builder.zext(value, _SIZE)


def _passed_types(kind: Any) -> list[ir.Type]:
    if isinstance(kind, types.NamedTuple):
        return [each for element in kind.types for each in _passed_types(element)]
    if isinstance(kind, types.Array):
        return [_SIZE] * (1 + kind.ndim)
    if kind == types.none:
        return []
    return [_DOUBLE if kind == types.float64 else _SIZE]


def _read_argument(context: Any, builder: ir.IRBuilder, kind: Any, values: Any) -> ir.Value:
    """The next argument of a kernel as Numba passes it."""
    if isinstance(kind, types.NamedTuple):
        return context.make_tuple(builder, kind, [_read_argument(context, builder, each, values) for each in kind.types])
    if isinstance(kind, types.Array):
        return _make_array(context, builder, kind, next(values), [next(values) for _ in range(kind.ndim)])
    if kind == types.float64:
        return next(values)
    if kind == types.boolean:
        return builder.icmp_signed("!=", next(values), _SIZE(0))
    return builder.sext(next(values), _LONG)


def _make_array(context: Any, builder: ir.IRBuilder, kind: Any, address: ir.Value, shape: list[ir.Value]) -> ir.Value:
    """A contiguous array that nobody owns."""
    lengths = [builder.zext(length, _LONG) for length in shape]
    size = kind.dtype.bitwidth // 8
    strides = [_LONG(size)]
    for length in reversed(lengths[1:]):
        strides.insert(0, builder.mul(strides[0], length))
    array = context.make_array(kind)(context, builder)
    data = builder.inttoptr(address, array.data.type)
    populate_array(array, data, lengths, strides, size, meminfo=None)  # type: ignore[no-untyped-call]
    return array._getvalue()
