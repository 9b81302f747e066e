"""Straight-line programs, recorded by operations on symbolic values; `engine.integrator.jit.llvm_emitter` compiles them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

TABLE = "table"
"""Name of the parameter that contains the numbers to which `StraightLine.entry` refers."""


@dataclass
class StraightLine:
    """A function without branches: a list of operations, each on results of earlier operations.

    Attributes
    ----------
    name
        Name of the function.
    table
        {key: index} of the table that is passed at run time; programs can share it, and `entry` extends it.
    operations
        (symbol, operands): ``input`` with a name, ``constant`` with a number, ``entry`` with an index of the table, or an
        operation on the results with the given indices: + − · / on doubles, + − · >> on 64-bit integers, < <= > >= == on two
        values of the same type, & on booleans, ``abs`` and ``sqrt`` of doubles, ``where`` (condition, value, other value),
        ``bits_of``, which reinterprets a double as an integer, and its inverse ``double_of``.
    results
        Indices of the results that are returned.
    """

    name: str
    table: dict[Any, int]
    operations: list[tuple[str, tuple[Any, ...]]] = field(default_factory=list)
    results: list[int] = field(default_factory=list)

    @property
    def parameters(self) -> list[str]:
        """The table, followed by the inputs in the order of their first use."""
        return [TABLE, *dict.fromkeys(operands[0] for symbol, operands in self.operations if symbol == "input")]

    def input(self, name: str) -> Value:
        """Return a parameter, which is a double or an integer."""
        return self._append("input", name)

    def constant(self, number: float) -> Value:
        """Return a constant, which is an integer or a double."""
        return self._append("constant", number)

    def entry(self, key: Any) -> Value:
        """Return a number of the table by its key, with a new index for a new key."""
        return self._append("entry", self.table.setdefault(key, len(self.table)))

    def apply(self, symbol: str, *operands: Value | float) -> Value:
        """Return the result of an operation; numbers among the operands become constants."""
        values = [operand if isinstance(operand, Value) else self.constant(operand) for operand in operands]
        return self._append(symbol, *(value.index for value in values))

    def _append(self, symbol: str, *operands: Any) -> Value:
        self.operations.append((symbol, operands))
        return Value(self, len(self.operations) - 1)

    def __str__(self) -> str:
        lines = [f"{index}: {symbol} {' '.join(map(repr, operands))}" for index, (symbol, operands) in enumerate(self.operations)]
        return "\n".join([self.name, *lines, f"results {self.results}"])


def _binary(symbol: str, *, swapped: bool = False) -> Callable[[Value, Value | float], Value]:
    """Return the method of `Value` for an operation; `swapped` for the methods of a right operand."""

    def method(self: Value, other: Value | float) -> Value:
        return self.program.apply(symbol, *((other, self) if swapped else (self, other)))

    return method


@dataclass(frozen=True, slots=True)
class Value:
    """A result within a program. Its operators and comparisons append operations to the program and return new values."""

    program: StraightLine
    index: int

    __add__, __sub__, __mul__, __rshift__, __and__ = map(_binary, ("+", "-", "*", ">>", "&"))
    __lt__, __le__, __gt__, __ge__, equals = map(_binary, ("<", "<=", ">", ">=", "=="))
    __radd__, __rsub__, __rmul__, __rtruediv__ = (_binary(symbol, swapped=True) for symbol in "+-*/")

    def __abs__(self) -> Value:
        return self.program.apply("abs", self)


def where(condition: Value, value: Value | float, otherwise: Value | float) -> Value:
    """Return `value` if the condition holds, and `otherwise` if not; both are computed."""
    return condition.program.apply("where", condition, value, otherwise)
