"""Straight-line programs in double-double arithmetic: each double of a program is the sum of two, with about 106 bits.

The sums and products of two doubles are found together with their rounding errors. The operations on pairs are those of Joldes,
Muller & Popescu (2017, ACM TOMS 44, 15): relative errors are below 4·10⁻³² (products 5·10⁻³²), of quotients and roots below
2·10⁻³¹. No instruction may be contracted or reordered: functions that contain them are compiled by `exact_kernel`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite import ir  # type: ignore[import-untyped]
from numba import types
from numba.extending import intrinsic

from engine.taylor.jit.llvm_emitter import INT_OPERATIONS, find_intrinsic, write_program
from engine.taylor.source.straight_line import TABLE, StraightLine

VECTOR = 8
"""Lanes that a function computes together."""

_FLOAT, _INT = ir.DoubleType(), ir.IntType(64)
_FLOATS = ir.VectorType(_FLOAT, VECTOR)
_PAIR = ir.LiteralStructType([_FLOATS, _FLOATS])
_ZERO, _UNDEFINED = (ir.Constant(_FLOATS, value) for value in ([0.0] * VECTOR, ir.Undefined))
_FIRST_LANE = ir.Constant(ir.VectorType(ir.IntType(32), VECTOR), [0] * VECTOR)
_BYTES = 8
_COMPARISONS = ("<", "<=", ">", ">=", "==")

Pair = tuple[Any, Any]


def lanes_of_pairs(program: StraightLine) -> Any:
    """The program as a function for use in kernels: ``(table, lanes, results, i)`` computes `VECTOR` lanes from lane i on.

    lanes, results: arrays with a column for each lane; two rows are a number. The rows of `lanes` are the program's inputs in
    order, those of `results` its results, all doubles. Of the table two neighbours are a number.
    """
    inputs = [name for name in program.parameters if name != TABLE]

    @intrinsic
    def call(_: Any, table: Any, lanes: Any, results: Any, i: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            given = zip(signature.args[:3], values[:3], strict=True)
            arrays = [context.make_array(each)(context, builder, value) for each, value in given]
            entries, *starts = [builder.ptrtoint(each.data, _INT) for each in arrays]
            steps = [builder.extract_value(each.strides, 0) for each in arrays[1:]]

            def place(k: int, row: int) -> Any:
                offset = builder.add(builder.mul(steps[k], _INT(row)), builder.mul(values[3], _INT(_BYTES)))
                return builder.inttoptr(builder.add(starts[k], offset), _FLOATS.as_pointer())

            def entry(index: int) -> Any:
                address = builder.add(entries, _INT(index * _BYTES))
                value = builder.load(builder.inttoptr(address, _FLOAT.as_pointer()))
                return builder.shuffle_vector(builder.insert_element(_UNDEFINED, value, _INT(0)), _UNDEFINED, _FIRST_LANE)

            numbers = [(entry(2 * k), entry(2 * k + 1)) for k in range(len(program.table))]
            rows = {name: (2 * k, 2 * k + 1) for k, name in enumerate(inputs)}
            passed = {name: tuple(builder.load(place(0, row), align=_BYTES) for row in pair) for name, pair in rows.items()}
            ordered = [numbers if name == TABLE else passed[name] for name in program.parameters]
            found = write_program(program, builder, ordered, VECTOR, _operate, _constant)
            for row, value in enumerate(part for pair in found for part in pair):
                builder.store(value, place(1, row), align=_BYTES)
            return context.get_dummy_value()

        return types.void(table, lanes, results, types.int64), generate

    return call


def _constant(kind: Any, number: float) -> Any:
    value = ir.Constant(kind, [number] * VECTOR)
    return (value, _ZERO) if kind == _FLOATS else value


def _operate(symbol: str, b: ir.IRBuilder, floats: Any, ints: Any, operands: list[Any]) -> Any:
    one, *others = operands
    match symbol:
        case "where" if isinstance(others[0], tuple):
            return tuple(b.select(one, *parts) for parts in zip(*others, strict=True))
        case "where":
            return b.select(one, *others)
        case "bits_of":
            return b.bitcast(one[0], ints)
        case "double_of":
            return b.bitcast(one, floats), _ZERO
        case "&":
            return b.and_(one, *others)
        case _ if symbol in _COMPARISONS:
            return _compare(symbol, b, one, *others) if isinstance(one, tuple) else b.icmp_signed(symbol, one, *others)
        case _ if isinstance(one, tuple):
            return _call(symbol, b, operands)
    return getattr(b, INT_OPERATIONS[symbol])(one, *others)


def _compare(symbol: str, b: ir.IRBuilder, one: Pair, other: Pair) -> Any:
    """The high parts decide; if they are equal, the low parts."""
    is_tie = b.fcmp_ordered("==", one[0], other[0])
    low = b.and_(is_tie, b.fcmp_ordered(symbol, one[1], other[1]))
    return low if symbol == "==" else b.or_(b.fcmp_ordered(symbol[0], one[0], other[0]), low)


def _call(symbol: str, b: ir.IRBuilder, operands: list[Pair]) -> Pair:
    """An operation as a call of a function: inlined, a program would be megabytes of code, and several times as slow."""
    name, write = _OPERATIONS[symbol]
    function = b.module.globals.get(name)
    if function is None:
        function = ir.Function(b.module, ir.FunctionType(_PAIR, [_FLOATS] * (2 * len(operands))), name)
        function.linkage = "internal"
        function.attributes.add("noinline")
        inside = ir.IRBuilder(function.append_basic_block())
        high, low = write(inside, *zip(function.args[::2], function.args[1::2], strict=True))
        inside.ret(inside.insert_value(inside.insert_value(ir.Constant(_PAIR, ir.Undefined), high, 0), low, 1))
    found = b.call(function, [part for pair in operands for part in pair])
    return b.extract_value(found, 0), b.extract_value(found, 1)


def _fma(b: ir.IRBuilder, x: Any, y: Any, z: Any) -> Any:
    """x y + z, rounded once."""
    return b.call(find_intrinsic("llvm.fma", b.module, _FLOATS, 3), [x, y, z])


def _two_sum(b: ir.IRBuilder, x: Any, y: Any) -> Pair:
    """x + y and its rounding error."""
    total = b.fadd(x, y)
    of_y = b.fsub(total, x)
    return total, b.fadd(b.fsub(x, b.fsub(total, of_y)), b.fsub(y, of_y))


def _joined(b: ir.IRBuilder, high: Any, low: Any) -> Pair:
    """The same for |high| ≥ |low|."""
    total = b.fadd(high, low)
    return total, b.fsub(low, b.fsub(total, high))


def _plus(b: ir.IRBuilder, x: Pair, y: Pair) -> Pair:
    high, error = _two_sum(b, x[0], y[0])
    low, rest = _two_sum(b, x[1], y[1])
    high, low = _joined(b, high, b.fadd(error, low))
    return _joined(b, high, b.fadd(rest, low))


def _minus(b: ir.IRBuilder, x: Pair, y: Pair) -> Pair:
    return _plus(b, x, (b.fneg(y[0]), b.fneg(y[1])))


def _times(b: ir.IRBuilder, x: Pair, y: Pair) -> Pair:
    high = b.fmul(x[0], y[0])
    error = _fma(b, x[0], y[0], b.fneg(high))
    low = _fma(b, x[1], y[0], _fma(b, x[0], y[1], b.fmul(x[1], y[1])))
    return _joined(b, high, b.fadd(error, low))


def _over(b: ir.IRBuilder, x: Pair, y: Pair) -> Pair:
    first = b.fdiv(x[0], y[0])
    rest, _ = _minus(b, x, _times(b, y, (first, _ZERO)))
    return _joined(b, first, b.fdiv(rest, y[0]))


def _root(b: ir.IRBuilder, x: Pair) -> Pair:
    first = b.call(find_intrinsic("llvm.sqrt", b.module, _FLOATS), [x[0]])
    rest = b.fadd(x[1], _fma(b, b.fneg(first), first, x[0]))
    is_zero = b.fcmp_ordered("==", first, _ZERO)
    return _joined(b, first, b.select(is_zero, _ZERO, b.fdiv(rest, b.fadd(first, first))))


def _magnitude(b: ir.IRBuilder, x: Pair) -> Pair:
    is_negative = b.fcmp_ordered("<", x[0], _ZERO)
    return b.select(is_negative, b.fneg(x[0]), x[0]), b.select(is_negative, b.fneg(x[1]), x[1])


_OPERATIONS: dict[str, tuple[str, Callable[..., Pair]]] = {
    "+": ("pair_sum", _plus),
    "-": ("pair_difference", _minus),
    "*": ("pair_product", _times),
    "/": ("pair_quotient", _over),
    "sqrt": ("pair_root", _root),
    "abs": ("pair_magnitude", _magnitude),
}
