"""Straight-line programs for the Taylor kernels of an expression: the graphs of V and of its derivatives, and their series."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from engine.expressions.calculus import curvatures, slopes
from engine.expressions.graph import Graph, make_graph
from engine.expressions.nodes import Expression, as_number
from engine.integrator.source.graph_series import GraphSeries, value_of
from engine.integrator.source.series import NO_REMAINDERS, ORDER, Hessian, PointFunctions, Series, Setting
from engine.integrator.source.straight_line import StraightLine, Value

# Axes of the second derivatives of V.
_HESSIAN = ((0, 0), (0, 1), (1, 1))

Entry = tuple[str, int]
"""(graph, index): an entry of the table with number `index` of one of the graphs of a structure."""


@dataclass(frozen=True)
class ExpressionStructure:
    """The graphs of V (`value`), gradient (`motion`), gradient and Hessian (`variations`), and V and gradient (`slopes`).

    `is_zero` tells which second derivatives, in the order of `_HESSIAN`, are zero everywhere.
    """

    setting: Setting
    value: Graph
    motion: Graph
    variations: Graph
    slopes: Graph
    is_zero: tuple[bool, ...]

    can_hide_crossings: ClassVar[bool] = True
    """Whether the signs of y at the ends of a step can miss two crossings: yes, no bound on the frequency of y is known."""
    has_many_scales: ClassVar[bool] = True
    """Whether frequencies can differ strongly from place to place: yes, near singularities."""
    largest_norm: ClassVar[float] = 1e180
    """Norm of the last coefficients above which an orbit fails. It belongs to a step of 1e-12, which is needed near bodies."""

    @property
    def carries_remainders(self) -> bool:
        """Whether steps carry the rounding errors of x and y along: yes if there are bodies, near which every digit matters."""
        return min(self.setting.sides, default=0) < 0

    def orbit(self, program: StraightLine, remainders: Mapping[str, Value] = NO_REMAINDERS) -> tuple[Series, Series]:
        """Append the recurrence of the gradient to a program, and return the series of x and y."""
        recurrence = GraphSeries(program, "motion", self.motion, self.setting.rotates, remainders)
        for k in range(ORDER - 1):
            recurrence.advance(k)
        return recurrence.x, recurrence.y

    def hessian(self, program: StraightLine) -> Hessian:
        """Append the recurrence of the gradient and the Hessian to a program, and return the second derivatives of −V."""
        recurrence = GraphSeries(program, "variations", self.variations, self.setting.rotates)

        def coefficients(index: int) -> Callable[[int], Value]:
            def coefficient(k: int) -> Value:
                recurrence.advance_to(k)
                return -1.0 * recurrence.series[index][k]

            return coefficient

        indices = self.variations.results[2:]
        return {axes: (coefficients(index), not zero) for axes, index, zero in zip(_HESSIAN, indices, self.is_zero, strict=True)}

    def point_functions(self) -> PointFunctions:
        """Return the functions V, and V with its gradient."""
        names = ("value", "slope_x", "slope_y")
        return {
            "potential_value": lambda program: {"value": _graph_values(program, "value", self.value)[0]},
            "potential_slopes": lambda program: dict(zip(names, _graph_values(program, "slopes", self.slopes), strict=True)),
        }

    def tabulate(self, expression: Any, entries: Sequence[Entry]) -> list[float]:
        """Return the values of entries for an expression, see `Entry`."""
        numbers = {name: values for name, (_, values) in _graphs(expression).items()}
        return [numbers[graph][index] for graph, index in entries]


def structure_of_expression(expression: Expression, setting: Setting) -> ExpressionStructure:
    """Return the structure of a potential that is an expression."""
    is_zero = tuple(as_number(curvature) == 0.0 for curvature in curvatures(expression))
    return ExpressionStructure(setting, is_zero=is_zero, **{name: graph for name, (graph, _) in _graphs(expression).items()})


def _graphs(expression: Expression) -> dict[str, tuple[Graph, tuple[float, ...]]]:
    """Return the graphs of an `ExpressionStructure`, by name, each with its numbers."""
    gradient = slopes(expression)
    return {
        "value": make_graph((expression,)),
        "motion": make_graph(gradient),
        "variations": make_graph((*gradient, *curvatures(expression))),
        "slopes": make_graph((expression, *gradient)),
    }


def _graph_values(program: StraightLine, name: str, graph: Graph) -> list[Value]:
    """Return the values of the expressions of a graph at the inputs x and y."""
    values: dict[int, Value] = {}
    for index, node in enumerate(graph.nodes):
        is_axis = node.kind in ("x", "y")
        values[index] = program.input(node.kind) if is_axis else value_of(program, name, node, values)
    return [values[index] for index in graph.results]
