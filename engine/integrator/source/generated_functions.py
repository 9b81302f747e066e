"""Kernels as Python source: functions that call a straight-line program for each lane, or for one point."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from engine.integrator.source.straight_line import TABLE, StraightLine, Value

ADDED = ("crossed", "sums")
"""Arrays to whose numbers kernels add; they replace those of others."""


class Place(NamedTuple):
    """A number in an array that a kernel takes: ``array[row, column]``, where the column is that of the lane if it is None.

    An array without rows has the row None.
    """

    array: str
    row: int | None = None
    column: int | None = None

    def __str__(self) -> str:
        column = "i" if self.column is None else self.column
        return f"{self.array}[{column}]" if self.row is None else f"{self.array}[{self.row}, {column}]"


class GeneratedFunction(NamedTuple):
    """A kernel as Python source, and the straight-line program that it calls by the program's name.

    Attributes
    ----------
    name, program, kernel
        Name of the kernel; its program; its source.
    arguments
        Names of its arguments.
    reads
        Where the inputs of the program are that are not arguments.
    writes
        Where its results go, in order; none for those that the kernel returns.
    """

    name: str
    program: StraightLine
    kernel: str
    arguments: tuple[str, ...]
    reads: Mapping[str, Place] = MappingProxyType({})
    writes: tuple[Place, ...] = ()


def lane_loop(
    program: StraightLine,
    arguments: str,
    reads: Mapping[str, Place],
    writes: Mapping[Place, Value | str],
    constants: Mapping[str, Place] | None = None,
    rows: Mapping[str, int] = MappingProxyType({}),
) -> GeneratedFunction:
    """A kernel with a loop over lanes that reads inputs from arrays, runs a straight-line program and writes its results.

    reads, constants: where inputs are; writes: values of the program, or source. Constants are read before the loop: read in it,
    each would be checked for overlap with every array that the loop writes, and beyond some 100 checks nothing is vectorised.
    rows: the arrays whose rows have a length that the compiler knows, with it, so that it sees that they do not overlap; the
    checks of separate arrays take as long as 16 lanes.
    """
    program.results = [value.index for value in writes.values() if isinstance(value, Value)]
    sources = {place: f"r{value.index}" if isinstance(value, Value) else value for place, value in writes.items()}
    name = program.name.removeprefix("_")
    constants = constants or {}
    lines = [
        "@kernel",
        f"def {name}(coefficients, n, {arguments}):",
        *(f"    if {each}.shape[1] != {n}: raise ValueError('{each}: must have {n} columns')" for each, n in rows.items()),
        *(f"    {each} = {source}" for each, source in {TABLE: "read_table(coefficients)", **constants}.items()),
        "    for i in range(n):",
        *(f"        {each} = {place}" for each, place in reads.items()),
        f"        ({''.join(f'r{index}, ' for index in program.results)}) = {program.name}({', '.join(program.parameters)})",
        *(f"        {place} {'+=' if place.array in ADDED else '='} {source}" for place, source in sources.items()),
    ]
    written = tuple(place for place, value in writes.items() if isinstance(value, Value))
    names = ("coefficients", "n", *arguments.split(", "))
    return GeneratedFunction(name, program, "\n".join(lines) + "\n", names, {**constants, **reads}, written)


def point_function(name: str, append: Callable[[StraightLine], Mapping[str, Value]], table: dict[Any, int]) -> GeneratedFunction:
    """A function of one point (x, y)."""
    program = StraightLine(f"_{name}", table)
    values = append(program)
    program.results = [value.index for value in values.values()]
    lines = [
        "@kernel",
        f"def {name}(coefficients, x, y):",
        f"    {TABLE} = read_table(coefficients)",
        f"    ({', '.join(values)},) = {program.name}({', '.join(program.parameters)})",
        f"    return {', '.join(values)}",
    ]
    return GeneratedFunction(name, program, "\n".join(lines) + "\n", ("coefficients", "x", "y"))
