"""Translation of straight-line programs to LLVM instructions, in a tenth of a second; Numba's front end would take seconds.

Numba infers a type for every variable of a function and lowers each operation with all of Python's semantics. A generated program
consists of a few thousand operations on doubles and integers without branches. Each operation is one or two instructions. The
functions of `engine.integrator.jit.webassembly` consist of the same instructions on vectors.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core.typing.templates import Signature
from numba.extending import intrinsic

from engine.integrator.source.straight_line import TABLE, StraightLine

_DOUBLE, _INT64 = ir.DoubleType(), ir.IntType(64)
_NUMBA_TYPES = {_DOUBLE: types.float64, _INT64: types.int64}
# As in `engine.integrator.jit.decorator`, a·b + c may become one multiply-add; nothing else is permitted.
_FLAGS = ("contract",)
# Attribute of functions for the full vector width. On Intel processors with AVX-512, LLVM by default uses half this width, and
# programs take 1.2 to 1.4 times as long; the results are the same. llvmlite has no attributes with values, but writes this text
# unchanged.
_WIDE_VECTORS = '"prefer-vector-width"="512"'
_DOUBLE_OPERATIONS = {"+": "fadd", "-": "fsub", "*": "fmul", "/": "fdiv"}
_INTRINSICS = {"abs": "llvm.fabs", "sqrt": "llvm.sqrt"}
_INT64_OPERATIONS = {"+": "add", "-": "sub", "*": "mul", ">>": "ashr"}


def straight_line(find_program: Callable[[], StraightLine]) -> Any:
    """Return a program as a function for use in kernels. The program is found when a kernel is compiled.

    The function takes the parameters of the program in order: doubles, 64-bit integers, and the table as returned by
    `table_reader`. It returns a tuple of doubles and integers.
    """

    @functools.cache
    def result_type(argument_types: tuple[Any, ...]) -> Any:
        """Find the type of the result by writing the program into a temporary module."""
        block = ir.Function(ir.Module(), ir.FunctionType(ir.VoidType(), []), "trial").append_basic_block()
        arguments = [ir.Constant(_llvm_type(kind), None) for kind in argument_types]
        results = write_program(find_program(), ir.IRBuilder(block), arguments)
        return types.Tuple([_NUMBA_TYPES[result.type] for result in results])  # type: ignore[no-untyped-call]

    @intrinsic
    def call(_: Any, *arguments: Any) -> Any:
        argument_types = tuple(map(types.unliteral, arguments))

        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            # `attributes.add` of llvmlite would reject the text.
            set.add(builder.function.attributes, _WIDE_VECTORS)
            unpacked = [builder.extract_value(values[0], i) for i in range(len(argument_types))]
            return context.make_tuple(builder, signature.return_type, write_program(find_program(), builder, unpacked))

        return Signature(result_type(argument_types), (types.StarArgTuple(argument_types),), None), generate  # type: ignore[no-untyped-call]

    return call


def table_reader(size: int) -> Any:
    """Return a function for use in kernels that turns an array of `size` doubles into the table of a straight-line program."""

    @intrinsic
    def read(_: Any, array: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            data = context.make_array(array)(context, builder, values[0]).data
            entries = [builder.load(builder.gep(data, [ir.Constant(_INT64, i)])) for i in range(size)]
            return context.make_tuple(builder, signature.return_type, entries)

        return Signature(types.UniTuple(types.float64, size), (array,), None), generate  # type: ignore[no-untyped-call]

    return read


def _llvm_type(numba_type: Any) -> Any:
    """Return the type of LLVM for a type of Numba: the table, an integer or a double."""
    if isinstance(numba_type, types.UniTuple):
        return ir.ArrayType(_DOUBLE, len(numba_type))
    return _INT64 if numba_type == types.int64 else _DOUBLE


def write_program(program: StraightLine, builder: ir.IRBuilder, arguments: list[Any], lanes: int = 1) -> list[Any]:
    """Append the instructions of a program, and return its results.

    arguments: the values of the program's parameters; the table is an LLVM array or a list. With two or more `lanes`, all values
    are vectors.
    """
    parameters = dict(zip(program.parameters, arguments, strict=True))
    table = parameters[TABLE]
    double_type, int_type = (_DOUBLE, _INT64) if lanes == 1 else (ir.VectorType(_DOUBLE, lanes), ir.VectorType(_INT64, lanes))
    values: list[Any] = []
    for symbol, operands in program.operations:
        match symbol, operands:
            case "input", (name,):
                values.append(parameters[name])
            case "constant", (number,):
                values.append(_constant(int_type if isinstance(number, int) else double_type, number))
            case "entry", (index,):
                values.append(table[index] if isinstance(table, list) else builder.extract_value(table, index))
            case _:
                values.append(_operate(symbol, builder, double_type, int_type, [values[index] for index in operands]))
    return [values[index] for index in program.results]


def _constant(llvm_type: Any, number: float) -> Any:
    return ir.Constant(llvm_type, [number] * llvm_type.count if isinstance(llvm_type, ir.VectorType) else number)


def _find_intrinsic(name: str, module: ir.Module, double_type: Any) -> Any:
    """Return an intrinsic of doubles or vectors of doubles, which LLVM compiles to one instruction instead of a call."""
    if not isinstance(double_type, ir.VectorType):
        return module.declare_intrinsic(name, [double_type])
    # `declare_intrinsic` does not support vectors of doubles.
    name = f"{name}.v{double_type.count}f64"
    return module.globals.get(name) or ir.Function(module, ir.FunctionType(double_type, [double_type]), name)


def _operate(symbol: str, builder: ir.IRBuilder, double_type: Any, int_type: Any, operands: list[Any]) -> Any:
    """Append the instruction of an operation on doubles or integers, and return its result."""
    is_double = operands[0].type == double_type
    match symbol:
        case "abs" | "sqrt":
            return builder.call(_find_intrinsic(_INTRINSICS[symbol], builder.module, double_type), operands)
        case "bits_of":
            return builder.bitcast(*operands, int_type)
        case "double_of":
            return builder.bitcast(*operands, double_type)
        case "where":
            return builder.select(*operands)
        case "&":
            return builder.and_(*operands)
        case "<" | "<=" | ">" | ">=" | "==":
            return builder.fcmp_ordered(symbol, *operands, flags=_FLAGS) if is_double else builder.icmp_signed(symbol, *operands)
        case _ if is_double:
            return getattr(builder, _DOUBLE_OPERATIONS[symbol])(*operands, flags=_FLAGS)
    return getattr(builder, _INT64_OPERATIONS[symbol])(*operands)
