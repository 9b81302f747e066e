"""Arithmetic expressions and straight-line programs: built by the code generator, compiled by `engine.taylor.jit.llvm_emitter`.

Expressions are built with Python's operators, as in ``0.5*variable("x0") + entry(3)``. Integers are 64-bit integers, floats
are doubles. Printed, expressions and programs read like Python.
"""

from __future__ import annotations

import functools
import operator
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

TABLE = "table"
"""Name of the parameter that holds the numbers `entry` refers to."""


def _binary(symbol: str, *, swapped: bool = False) -> Callable[[Expression, Expression | float], Expression]:
    def method(one: Expression, other: Expression | float) -> Expression:
        return operation(symbol, other, one) if swapped else operation(symbol, one, other)

    return method


@dataclass(frozen=True, slots=True)
class Expression:
    """A symbol and its operands; operators and comparisons return new expressions.

    Attributes
    ----------
    symbol
        ``variable``, ``constant`` or ``entry`` of the table, or an operation: + − · / on doubles, + − · >> on integers,
        < <= > >= == on two operands of one type, & on booleans, ``abs``, ``where`` (condition, value, other value),
        ``bits_of`` and ``double_of``, which reinterpret a double as an integer and back.
    operands
        Expressions; for the first three symbols a name, a number and the number of an entry.
    """

    symbol: str
    operands: tuple[Any, ...]

    __add__, __sub__, __mul__, __rshift__, __and__ = map(_binary, ("+", "-", "*", ">>", "&"))
    __lt__, __le__, __gt__, __ge__ = map(_binary, ("<", "<=", ">", ">="))
    __rsub__, __rmul__, __rtruediv__ = (_binary(symbol, swapped=True) for symbol in "-*/")

    def __abs__(self) -> Expression:
        return operation("abs", self)

    def __str__(self) -> str:
        operands = tuple(map(str, self.operands))
        if self.symbol in ("variable", "constant"):
            return operands[0]
        if self.symbol == "entry":
            return f"{TABLE}[{operands[0]}]"
        return f"{self.symbol}({', '.join(operands)})" if self.symbol.isidentifier() else f"({f' {self.symbol} '.join(operands)})"

    def variables(self) -> Iterator[str]:
        """Names of the variables and the table, from left to right, with repetitions."""
        match self.symbol:
            case "variable":
                yield self.operands[0]
            case "entry":
                yield TABLE
            case "constant":
                pass
            case _:
                for operand in self.operands:
                    yield from operand.variables()


def variable(name: str) -> Expression:
    """A parameter, or a variable assigned before."""
    return Expression("variable", (name,))


def entry(number: int) -> Expression:
    """A number of the table that is passed at run time."""
    return Expression("entry", (number,))


def constant(value: float) -> Expression:
    """An integer or a double."""
    return Expression("constant", (value,))


def operation(symbol: str, *operands: Expression | float) -> Expression:
    """An operation, of which numbers among the operands become constants."""
    return Expression(symbol, tuple(each if isinstance(each, Expression) else constant(each) for each in operands))


def total(parts: Iterable[Expression]) -> Expression:
    """The sum from left to right; 0.0 for no parts."""
    parts = list(parts)
    return functools.reduce(operator.add, parts) if parts else constant(0.0)


class Assignment(NamedTuple):
    """``target = value``; a variable may be assigned more than once."""

    target: str
    value: Expression


@dataclass(frozen=True)
class StraightLine:
    """A function without branches: assignments in order, then the values of the variables `results` are returned."""

    name: str
    assignments: tuple[Assignment, ...]
    results: tuple[str, ...]

    @functools.cached_property
    def parameters(self) -> tuple[str, ...]:
        """Variables that are never assigned, in the order of their first use."""
        assigned = {target for target, _ in self.assignments}
        used = dict.fromkeys(name for _, value in self.assignments for name in value.variables())
        return tuple(name for name in used if name not in assigned)

    def __str__(self) -> str:
        lines = [*(f"{target} = {value}" for target, value in self.assignments), f"return ({', '.join(self.results)},)"]
        return f"def {self.name}({', '.join(self.parameters)}):\n" + "".join(f"    {line}\n" for line in lines)
