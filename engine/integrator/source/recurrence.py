"""Straight-line programs of the Taylor kernels of a potential.

Along an orbit every quantity is a power series in time, and the series of a product is a Cauchy product. With ẍ = −V_x, ÿ = −V_y
and V a polynomial, coefficient k + 2 of x and y follows from coefficients 0 … k of the monomials in V_x and V_y (Jorba & Zou
2005, Experimental Mathematics 14, 99). Written as one assignment per coefficient inside one loop over orbits, this recurrence has
neither branches nor calls, so the compiler vectorises all of it. Formulas with other functions have the recurrences of
`engine.integrator.source.graph_series`; the following functions are the same for all formulas.

For each potential there are four functions with a loop over lanes `i`, and one or two for a single point:

``step``             one step of each orbit with a size chosen from the last coefficients, and flags for steps that may
                     contain an event;
``limited_step``     one step as ``step`` takes, without flags, and no longer than until a given time of each lane;
``jets``             the coefficients of x and y: the dense output of a step;
``tangent``          propagates a deviation vector over a given time by the linearised recurrence;
``potential_value``  V at one point; for expressions, ``potential_slopes`` also gives V and its gradient.

The code depends only on the structure of V: the graph of an expression, or the exponents of a polynomial and a few facts about
its coefficients that save work (`find_difference`, `PolynomialStructure.can_hide_crossings`). The numbers are passed at run
time in a table, the first argument of every function. Potentials of the same structure therefore share compiled code.
"""

from __future__ import annotations

import functools
import hashlib
import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from engine.expressions.nodes import Expression
from engine.foundations.arrays import read_only
from engine.integrator.source.expression_recurrence import ExpressionStructure, structure_of_expression
from engine.integrator.source.generated_functions import GeneratedFunction, Place, lane_loop, point_function
from engine.integrator.source.polynomial_recurrence import PolynomialStructure, Terms, structure_of_polynomial
from engine.integrator.source.section_crossings import flag_crossings, section_places
from engine.integrator.source.section_numbers import COLUMNS
from engine.integrator.source.series import LONGEST_STEP, ORDER, ROTATION, Series, Setting, add_coriolis, cauchy, total
from engine.integrator.source.step_flags import CROSSES, OVERSHOOT, flag_gates, flag_hidden_crossings
from engine.integrator.source.straight_line import StraightLine, Value, where

TOLERANCE = 3e-15
"""Norm of the last coefficients of a step's series times the 16th power of the step size."""

# Weight of the third coefficient from the end in the norm, found together with ORDER and TOLERANCE by `benchmarks/steps.py`.
_EARLIER_WEIGHT = 0.3
# Size of the steps for which this weight was found.
_USUAL_STEP = 0.35
# Factor of the norm in potentials with bodies: a power of 10 with which energies are conserved to 1e-11. The factor is above 1
# because coefficients near singularities decrease more slowly than elsewhere.
_BODY_FACTOR = 10.0
# Speed that is added to the speed that limits a step, so that no step is longer than 16.
_ADDED_SPEED = 1.0 / 16.0
# Number of orders of the last coefficients in the norm.
_ORDERS_OF_NORM = 3

LANES = 64
"""Length of the rows of arrays with one column per orbit; a step computes the first columns."""

ROWS = 8
"""Rows of the arrays of lanes ``now`` and ``new``: x, y, px, py, t, the size of the last step, and the remainders of x and y,
which are their rounding errors; the remainders are 0 for structures whose steps do not carry them."""

TIME_ROW = 4
"""The row with the time."""

SIZE_ROW = 5
"""The row with the size of the last step."""

REMAINDER_ROW = 6
"""The first of the two rows with the remainders of x and y."""

# Number of structures whose functions are cached, of 3 MB each with eight terms of degree 8.
_CACHED_STRUCTURES = 4

Definition = Terms | Expression
"""A potential: ((i, j, c), …) of V = Σ c x^i y^j in any order, or an expression."""

Structure = PolynomialStructure | ExpressionStructure
"""The facts on which the generated code of a potential depends, hashable, with the recurrence of its orbits."""


class GeneratedCode(NamedTuple):
    """The generated functions of all potentials of one structure.

    Attributes
    ----------
    functions
        ``step``, ``limited_step``, ``jets``, ``tangent`` and ``potential_value``; only ``step`` for a section other than y = 0,
        upward. Besides the programs, their kernels refer to ``kernel`` and ``read_table``.
    entries
        The entries of the table, as defined by the structure.
    """

    functions: tuple[GeneratedFunction, ...]
    entries: tuple[Any, ...]


@dataclass(frozen=True, eq=False)
class CodeOutline:
    """Generated functions without their programs, which take megabytes. It suffices to load functions that are compiled.

    Outlines are equal if all their programs and kernels are equal.

    Attributes
    ----------
    structure
        The structure of the potentials.
    digest
        A hash of all programs and kernels as text.
    operations
        Total number of operations of the programs.
    entries
        The entries of the table, see `GeneratedCode`.
    sources
        Name, name of the program, and Python source of each kernel.
    """

    structure: Structure
    digest: str
    operations: int
    entries: tuple[Any, ...]
    sources: tuple[tuple[str, str, str], ...]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, CodeOutline) and self.digest == other.digest

    def __hash__(self) -> int:
        return hash(self.digest)

    def tabulate(self, definition: Definition, rotation: float = 0.0) -> np.ndarray:
        """Return the table of a potential, of shape (m,) and read-only, which every function takes as its first argument."""
        own = [entry for entry in self.entries if entry != ROTATION]
        values = {**dict(zip(own, self.structure.tabulate(definition, own), strict=True)), ROTATION: 2.0 * rotation}
        return read_only(np.array([values[entry] for entry in self.entries], dtype=float))


def _step_size(program: StraightLine, x: Series, y: Series, structure: Structure) -> Value:
    """Return the h whose 16th power times a norm of the last coefficients is the tolerance, without calls and branches.

    The norm contains three orders of both coordinates, so that a step is not too long if one coefficient happens to vanish. In a
    well of one frequency, this h is the size of the step. Where frequencies differ from place to place, this h defines units of
    time and length: in these units h is 0.35, and the orbit moves by about 1 in a unit of time. The size is found in these units,
    so steps and their errors become smaller near bodies. NaN marks an orbit that has failed.
    """
    last, second_last, third_last = (abs(x[-k]) + abs(y[-k]) for k in range(1, _ORDERS_OF_NORM + 1))
    norm = last + second_last + _EARLIER_WEIGHT * third_last
    h = _root_of_tolerance(program, norm)
    longest: Value | float = LONGEST_STEP
    if structure.has_many_scales:
        unit = h * (1.0 / _USUAL_STEP)
        scaled_norm = _EARLIER_WEIGHT * third_last + unit * (second_last + unit * last)
        speed, force = abs(x[1]) + abs(y[1]), abs(x[2]) + abs(y[2])
        relative_norm = program.apply("/", scaled_norm, speed + unit * force)
        h = _root_of_tolerance(program, _BODY_FACTOR * relative_norm if structure.carries_remainders else relative_norm)
        longest = 1.0 / (speed + program.apply("sqrt", force) + _ADDED_SPEED)
    h = where(h < longest, h, longest)
    return where(norm < structure.largest_norm, h, math.nan)


def _root_of_tolerance(program: StraightLine, norm: Value) -> Value:
    """Return (tolerance / norm)^(1/16), up to 6 % too large, the same on every machine.

    The bits of a double, read as an integer, are its binary logarithm with a piecewise linear mantissa; a shift by four bits
    divides this logarithm by 16.
    """
    # The bits of 1.0.
    one_bits = 1023 << 52
    bits = program.apply("bits_of", norm * (1.0 / program.input("tolerance")))
    return program.apply("double_of", (one_bits + one_bits // 16) - (bits >> 4))


def _horner(series: Series, h: Value) -> tuple[Value, Value]:
    """Return the value and the time derivative of a series at h."""
    slope = series[-1]
    value = slope * h + series[-2]
    for coefficient in reversed(series[:-2]):
        slope = slope * h + value
        value = value * h + coefficient
    return value, slope


_AxisEnd = tuple[Value, Value, list[Value]]


def _end_of_step(series: Series, h: Value, remainder: Value | None) -> _AxisEnd:
    """Return value and slope as `_horner` does, with a remainder added to the first coefficient, and [new remainder].

    The new remainder is the rounding error of the last sum, computed exactly (Knuth's TwoSum). Without a remainder, the list is
    empty.
    """
    if remainder is None:
        return *_horner(series, h), []
    change, slope = _horner([remainder, *series[1:]], h)
    end = series[0] + change
    rounded = end - series[0]
    return end, slope, [(series[0] - (end - rounded)) + (change - rounded)]


# Inputs of the recurrence, read from separate arrays.
_START = {"x0": Place("x"), "y0": Place("y"), "x1": Place("px"), "y1": Place("py")}


def _lane_reads(structure: Structure) -> dict[str, Place]:
    """Return the inputs of a step of lanes, read from the rows of the array `now`."""
    reads = {name: Place("now", row) for row, name in enumerate(_START)} | {"t0": Place("now", TIME_ROW)}
    if structure.carries_remainders:
        reads |= {f"{axis}_remainder": Place("now", REMAINDER_ROW + row) for row, axis in enumerate("xy")}
    return reads


def _remainders(structure: Structure, program: StraightLine) -> dict[str, Value]:
    """Return the remainders of x and y at the start of a step, by axis; none if steps do not carry them."""
    return {axis: program.input(f"{axis}_remainder") for axis in "xy"} if structure.carries_remainders else {}


def _end_of_lane(x_end: _AxisEnd, y_end: _AxisEnd, t_end: Value, h: Value) -> dict[Place, Value]:
    """Return the places in the array `new` of the results of a step of lanes, see `ROWS`, with their values."""
    (x, px, x_remainder), (y, py, y_remainder) = x_end, y_end
    return {Place("new", row): value for row, value in enumerate((x, y, px, py, t_end, h, *x_remainder, *y_remainder))}


def _step(structure: Structure, table: dict[Any, int]) -> GeneratedFunction:
    """Return the function ``step``, with arrays `now` and `new` as described by `ROWS`, and flags of `step_flags`."""
    program = StraightLine("_step", table)
    remainders = _remainders(structure, program)
    x, y = structure.orbit(program, remainders)
    h = _step_size(program, x, y, structure)
    x_end, y_end = _end_of_step(x, h, remainders.get("x")), _end_of_step(y, h, remainders.get("y"))
    crosses, hidden_flag = _crossings(structure, program, (x, y), (x_end, y_end), h)
    gate_places, gate_flag = flag_gates(structure.setting, program, (x, y), (x_end[0], y_end[0]), h)
    t_end = program.input("t0") + h
    flags = hidden_flag + gate_flag + where(t_end <= program.input("horizon"), 0, OVERSHOOT)
    writes = {
        Place("crossed"): where(crosses & flags.equals(0), 1, 0),
        Place("flag"): where(crosses & (flags > 0), flags + CROSSES, flags),
        **_end_of_lane(x_end, y_end, t_end, h),
    }
    arguments = "tolerance, horizon, gates, now, new, flag, crossed"
    places = gate_places | section_places(len(gate_places) // COLUMNS)
    constants = {name: Place("gates", *place) for name, place in places.items() if name in program.parameters}
    return lane_loop(program, arguments, _lane_reads(structure), writes, constants, rows=dict.fromkeys(("now", "new"), LANES))


def _crossings(
    structure: Structure, program: StraightLine, series: tuple[Series, Series], ends: tuple[_AxisEnd, _AxisEnd], h: Value
) -> tuple[Value, Value]:
    """Return whether the ends of a step are on both sides of the section, and the flag of hidden crossings."""
    (x, px, _), (y, py, _) = ends
    if structure.setting.section is not None:
        return flag_crossings(program, structure.setting.section, series, (x, y, px, py), h)
    _, y_series = series
    hidden_flag = flag_hidden_crossings(y_series, y, h) if structure.can_hide_crossings else program.constant(0)
    return (y_series[0] < 0.0) & (y >= 0.0), hidden_flag


def _limited_step(structure: Structure, table: dict[Any, int]) -> GeneratedFunction:
    """Return the function ``limited_step``, with arrays `now` and `new` as described by `ROWS`.

    No step passes the time in `limits`. A step that would pass it ends exactly at this time.
    """
    program = StraightLine("_limited_step", table)
    remainders = _remainders(structure, program)
    x, y = structure.orbit(program, remainders)
    own_size = _step_size(program, x, y, structure)
    t_start, until = program.input("t0"), program.input("until")
    time_left = until - t_start
    # Neither comparison is true for NaN, so that the size of a failed step stays NaN.
    h = where(time_left <= own_size, time_left, own_size)
    t_end = where(time_left <= own_size, until, t_start + own_size)
    results = _end_of_lane(_end_of_step(x, h, remainders.get("x")), _end_of_step(y, h, remainders.get("y")), t_end, h)
    reads = {**_lane_reads(structure), "until": Place("limits")}
    return lane_loop(program, "tolerance, limits, now, new", reads, results, rows=dict.fromkeys(("now", "new"), LANES))


def _jets(structure: Structure, table: dict[Any, int]) -> GeneratedFunction:
    """Return the function ``jets``, which writes the coefficients of x and y."""
    program = StraightLine("_jets", table)
    orbit = zip("xy", structure.orbit(program), strict=True)
    writes = {Place(f"{name}_jet", k): series[k] for name, series in orbit for k in range(ORDER + 1)}
    return lane_loop(program, "x, y, px, py, x_jet, y_jet", _START, writes)


# A deviation vector: the inputs of the recurrence, with the arrays of its components.
_DEVIATION = {"u0": "wx", "v0": "wy", "u1": "wpx", "v1": "wpy"}


def _tangent(structure: Structure, table: dict[Any, int]) -> GeneratedFunction:
    """Return the function ``tangent`` for ẅ = −(Hessian of V on the orbit) w with w = (δx, δy), see eq. 4 of Zotos (2014)."""
    program = StraightLine("_tangent", table)
    hessian = structure.hessian(program)
    # The series of the second derivatives of −V.
    second: dict[tuple[int, int], list[Value]] = {axes: [] for axes in hessian}
    u, v = ([program.input(f"{name}{k}") for k in (0, 1)] for name in "uv")
    for k in range(ORDER - 1):
        for axes, (coefficient, _) in hessian.items():
            second[axes].append(coefficient(k))
        for w, row in ((u, ((0, 0), (0, 1))), (v, ((0, 1), (1, 1)))):
            terms = (cauchy(second[axes], factor, k) for axes, factor in zip(row, (u, v), strict=True) if hessian[axes][1])
            w.append(total(program, terms) * (1.0 / ((k + 1) * (k + 2))))
        if structure.setting.rotates:
            add_coriolis(program, u, v)
    h = program.input("h")
    (u_end, pu_end), (v_end, pv_end) = _horner(u, h), _horner(v, h)
    reads = {**_START, **{name: Place(array) for name, array in _DEVIATION.items()}, "h": Place("duration")}
    writes = dict(zip(map(Place, _DEVIATION.values()), (u_end, v_end, pu_end, pv_end), strict=True))
    return lane_loop(program, "duration, x, y, px, py, wx, wy, wpx, wpy", reads, writes)


def find_structure(definition: Definition, setting: Setting) -> Structure:
    """Return the structure of a potential, on which its generated functions depend."""
    if isinstance(definition, Expression):
        return structure_of_expression(definition, setting)
    return structure_of_polynomial(definition, setting)


@functools.lru_cache(maxsize=_CACHED_STRUCTURES)
def generate_code(structure: Structure) -> GeneratedCode:
    """Return the generated functions for all potentials of a structure; large formulas take seconds."""
    # All programs share the table, which each of them extends.
    table: dict[Any, int] = {}
    if structure.setting.section is not None:
        return GeneratedCode((_step(structure, table),), tuple(table))
    functions = [
        *(write(structure, table) for write in (_step, _limited_step, _jets, _tangent)),
        *(point_function(name, append, table) for name, append in structure.point_functions().items()),
    ]
    return GeneratedCode(tuple(functions), tuple(table))


def outline_code(structure: Structure) -> CodeOutline:
    """Generate the functions for all potentials of a structure, and return their outline."""
    functions, entries = generate_code(structure)
    text = "\n\n".join(f"{function.program}\n\n{function.source}" for function in functions)
    return CodeOutline(
        structure,
        digest=hashlib.sha256(text.encode()).hexdigest(),
        operations=sum(len(function.program.operations) for function in functions),
        entries=entries,
        sources=tuple((function.name, function.program.name, function.source) for function in functions),
    )
