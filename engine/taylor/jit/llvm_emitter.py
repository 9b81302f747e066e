"""Long formulas straight to LLVM: what takes Numba seconds, a few thousand statements without branch or call, in a tenth of that.

Numba finds the type of every name in a function, then writes it out with all that Python might mean by it. Straight lines of
arithmetic need neither: each statement becomes the two or three instructions that it names.
"""

from __future__ import annotations

import ast
import functools
import inspect
from collections.abc import Callable
from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.core.typing.templates import Signature
from numba.extending import intrinsic

_FLOAT, _INT, _BOOL = ir.DoubleType(), ir.IntType(64), ir.IntType(1)
_NUMBA_TYPES = {_FLOAT: types.float64, _INT: types.int64}
# As in `engine.taylor.jit.decorator`: a·b + c may become one multiply-add, nothing else.
_FLAGS = ("contract",)
_FLOAT_OPERATIONS = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}
_INT_OPERATIONS = {ast.Add: "add", ast.Sub: "sub", ast.Mult: "mul", ast.RShift: "ashr"}
_COMPARISONS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "=="}


def straight_line(function: Callable[..., Any]) -> Any:
    """The function, for use in kernels.

    Its arguments are doubles, integers of 64 bits and tables of `table_reader`; it returns a tuple of doubles and integers.
    Its statements assign to names; in them stand entries of a table by number, + − · / on doubles, + − · >> on integers,
    abs(), comparisons, `and`, `a if c else b` with both sides computed, and `bits_of(double)` and `double_of(bits)`.
    """
    definition = ast.parse(inspect.getsource(function)).body[0]
    assert isinstance(definition, ast.FunctionDef)
    names = [argument.arg for argument in definition.args.args]

    @functools.cache
    def returned(given: tuple[Any, ...]) -> Any:
        """The type of what it returns, which is known once it is written."""
        trial = ir.IRBuilder(ir.Function(ir.Module(), ir.FunctionType(ir.VoidType(), []), "trial").append_basic_block())
        values = _write(definition, trial, {n: ir.Constant(_llvm_type(t), None) for n, t in zip(names, given, strict=True)})
        return types.Tuple([_NUMBA_TYPES[value.type] for value in values])  # type: ignore[no-untyped-call]

    @intrinsic
    def call(_: Any, *arguments: Any) -> Any:
        given = tuple(map(types.unliteral, arguments))

        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            passed = {name: builder.extract_value(values[0], i) for i, name in enumerate(names)}
            return context.make_tuple(builder, signature.return_type, _write(definition, builder, passed))

        return Signature(returned(given), (types.StarArgTuple(given),), None), generate  # type: ignore[no-untyped-call]

    return call


def table_reader(size: int) -> Any:
    """A function, for use in kernels, from an array of `size` doubles to the table that straight lines take them from."""

    @intrinsic
    def read(_: Any, array: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            data = context.make_array(array)(context, builder, values[0]).data
            entries = [builder.load(builder.gep(data, [ir.Constant(_INT, i)])) for i in range(size)]
            return context.make_tuple(builder, signature.return_type, entries)

        return Signature(types.UniTuple(types.float64, size), (array,), None), generate  # type: ignore[no-untyped-call]

    return read


def _llvm_type(given: Any) -> Any:
    """Of an argument of a straight line."""
    if isinstance(given, types.UniTuple):
        return ir.ArrayType(_FLOAT, len(given))
    return _INT if given == types.int64 else _FLOAT


def _write(definition: ast.FunctionDef, builder: ir.IRBuilder, values: dict[str, Any]) -> list[Any]:
    """The statements' instructions; what the last one returns."""
    *statements, last = definition.body
    for statement in statements:
        assert isinstance(statement, ast.Assign)
        (target,) = statement.targets
        assert isinstance(target, ast.Name)
        values[target.id] = _evaluate(statement.value, builder, values)
    assert isinstance(last, ast.Return)
    assert isinstance(last.value, ast.Tuple)
    return [_evaluate(element, builder, values) for element in last.value.elts]


def _evaluate(node: ast.expr, builder: ir.IRBuilder, values: dict[str, Any]) -> Any:
    """The instructions for an expression, and its value."""

    def evaluated(*nodes: ast.expr) -> list[Any]:
        return [_evaluate(each, builder, values) for each in nodes]

    match node:
        case ast.Name(name):
            return values[name]
        case ast.Constant(float(number)):
            return ir.Constant(_FLOAT, number)
        case ast.Constant(int(number)):
            return ir.Constant(_INT, number)
        case ast.Subscript(ast.Name(table), ast.Constant(int(number))):
            return builder.extract_value(values[table], number)
        case ast.UnaryOp(ast.USub(), operand):
            return builder.fneg(*evaluated(operand), flags=_FLAGS)
        case ast.BinOp(left, operator, right):
            one, other = evaluated(left, right)
            if one.type == _FLOAT:
                return getattr(builder, _FLOAT_OPERATIONS[type(operator)])(one, other, flags=_FLAGS)
            return getattr(builder, _INT_OPERATIONS[type(operator)])(one, other)
        case ast.Compare(left, [operator], [right]):
            one, other = evaluated(left, right)
            if one.type == _FLOAT:
                return builder.fcmp_ordered(_COMPARISONS[type(operator)], one, other, flags=_FLAGS)
            return builder.icmp_signed(_COMPARISONS[type(operator)], one, other)
        case ast.BoolOp(ast.And(), [left, right]):
            return builder.and_(*evaluated(left, right))
        case ast.IfExp(test, body, orelse):
            return builder.select(*evaluated(test, body, orelse))
        case ast.Call(ast.Name("abs"), [argument]):
            return builder.call(builder.module.declare_intrinsic("llvm.fabs", [_FLOAT]), evaluated(argument))
        case ast.Call(ast.Name("bits_of"), [argument]):
            return builder.bitcast(*evaluated(argument), _INT)
        case ast.Call(ast.Name("double_of"), [argument]):
            return builder.bitcast(*evaluated(argument), _FLOAT)
        case ast.Attribute(ast.Name("np"), "nan"):
            return ir.Constant(_FLOAT, float("nan"))
    raise NotImplementedError(ast.unparse(node))
