"""Types of the generated functions, and of the functions by which kernels call them, for Numba."""

from __future__ import annotations

import functools
from typing import Any

from numba import types
from numba.core.registry import cpu_target
from numba.core.typing.templates import Signature
from numba.extending import intrinsic

_slopes: Any = types.UniTuple(types.float64, 3)  # type: ignore[no-untyped-call]
_table = types.Array(types.float64, 1, "C", readonly=True)
_gates = types.Array(types.float64, 2, "C", readonly=True)
_lanes = types.float64[::1]
_flags = types.int64[::1]
_rows = types.float64[:, ::1]

SIGNATURES: dict[str, Signature] = {
    "step": types.void(_table, types.int64, types.float64, types.float64, _gates, _rows, _rows, _flags, _flags),
    "limited_step": types.void(_table, types.int64, types.float64, _lanes, _rows, _rows),
    "jets": types.void(_table, types.int64, *[_lanes] * 4, _rows, _rows),
    "tangent": types.void(_table, types.int64, *[_lanes] * 9),
    "potential_value": types.float64(_table, types.float64, types.float64),
    "potential_slopes": _slopes(_table, types.float64, types.float64),
}
"""The types for which each generated function is compiled."""


@functools.cache
def find_call_type(name: str) -> Any:
    """Return the type of a function that calls the generated function of a name, given its address and its arguments."""
    callee = SIGNATURES[name]

    @intrinsic
    def call(typing_context: Any, address: Any, *arguments: Any) -> Any:
        """Return the typed call; None, which Numba reports as an error, if the arguments cannot be converted."""
        argument_types = tuple(map(types.unliteral, arguments))
        if len(argument_types) != len(callee.args) or any(
            typing_context.can_convert(source, target) is None for source, target in zip(argument_types, callee.args, strict=True)
        ):
            return None

        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            function_address, packed = values
            unpacked = [builder.extract_value(packed, i) for i in range(len(argument_types))]
            cast = [context.cast(builder, *conversion) for conversion in zip(unpacked, argument_types, callee.args, strict=True)]
            convention = context.call_conv
            pointer_type = convention.get_function_type(callee.return_type, callee.args).as_pointer()
            pointer = builder.inttoptr(function_address, pointer_type)
            return convention.call_function(builder, pointer, callee.return_type, callee.args, cast)[1]

        return Signature(callee.return_type, (types.int64, types.StarArgTuple(argument_types)), None), generate  # type: ignore[no-untyped-call]

    context = cpu_target.typing_context
    context.refresh()
    return context.resolve_value_type(call)
