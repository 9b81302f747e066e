"""Kernels as Python source: functions that call a straight-line program for each lane (an orbit), or for one point."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from engine.integrator.source.straight_line import TABLE, StraightLine, Value

ACCUMULATED = ("crossed",)
"""Names of the arrays to which kernels add results; in other arrays, results replace the previous numbers."""


class Place(NamedTuple):
    """The place of a number in an array: ``array[row, column]``. A column of None stands for the column of the lane.

    For a one-dimensional array, the row is None.
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
    name, program, source
        Name, program and Python source of the kernel.
    arguments
        Names of the arguments of the kernel.
    reads
        Places of those inputs of the program that are not arguments, by name.
    writes
        Places for the results of the program, in order; empty if the kernel returns the results.
    """

    name: str
    program: StraightLine
    source: str
    arguments: tuple[str, ...]
    reads: Mapping[str, Place] = MappingProxyType({})
    writes: tuple[Place, ...] = ()


def lane_loop(
    program: StraightLine,
    arguments: str,
    reads: Mapping[str, Place],
    writes: Mapping[Place, Value],
    constants: Mapping[str, Place] | None = None,
    rows: Mapping[str, int] = MappingProxyType({}),
) -> GeneratedFunction:
    """Return a kernel that, for each lane, reads inputs from arrays, runs a straight-line program and writes its results.

    The values in `writes` become the results of the program.

    reads, constants: places of the inputs, by name; writes: values of the program by place; rows: lengths of the rows
    of arrays with a fixed length. Constants are read before the loop. In the loop, the compiler would check each for overlap
    with every array that the loop writes, and beyond about 100 checks it vectorises nothing. Rows of a fixed length need no
    checks. For separate arrays, the checks would take as long as the steps of 16 lanes.
    """
    program.results = [value.index for value in writes.values()]
    name = program.name.removeprefix("_")
    constants = constants or {}
    lines = [
        "@kernel",
        f"def {name}(coefficients, n, {arguments}):",
        *(f"    if {array}.shape[1] != {n}: raise ValueError('{array}: must have {n} columns')" for array, n in rows.items()),
        *(f"    {variable} = {source}" for variable, source in {TABLE: "read_table(coefficients)", **constants}.items()),
        "    for i in range(n):",
        *(f"        {variable} = {place}" for variable, place in reads.items()),
        f"        ({''.join(f'r{index}, ' for index in program.results)}) = {program.name}({', '.join(program.parameters)})",
        *(f"        {place} {'+=' if place.array in ACCUMULATED else '='} r{value.index}" for place, value in writes.items()),
    ]
    names = ("coefficients", "n", *arguments.split(", "))
    return GeneratedFunction(name, program, "\n".join(lines) + "\n", names, {**constants, **reads}, tuple(writes))


def point_function(name: str, append: Callable[[StraightLine], Mapping[str, Value]], table: dict[Any, int]) -> GeneratedFunction:
    """Return a function of one point (x, y); `append` writes its program and returns its results by name."""
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
