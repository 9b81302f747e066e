"""Evaluation of a graph for any kind of numbers: one walk through the nodes, with a table of operations for each kind."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.expressions.graph import Graph, Node
from engine.expressions.nodes import FUNCTIONS


@dataclass(frozen=True)
class Operations[Value]:
    """The operations of one kind of numbers.

    Attributes
    ----------
    linear
        A constant plus the sum of the products of coefficients and values.
    product
        Product of two values. If both are the same object, the product may be computed as a square.
    power
        Power of a value with a constant exponent.
    functions
        The functions exp, log, sin and cos by name.
    """

    linear: Callable[[float, Sequence[float], Sequence[Value]], Value]
    product: Callable[[Value, Value], Value]
    power: Callable[[Value, float], Value]
    functions: Mapping[str, Callable[[Value], Value]]


def node_values[Value](graph: Graph, numbers: Sequence[float], x: Value, y: Value, operations: Operations[Value]) -> list[Value]:
    """Return the values of all nodes of a graph at x and y."""
    coordinates = {"x": x, "y": y}
    values: list[Value] = []
    for node in graph.nodes:
        values.append(coordinates[node.kind] if node.kind in coordinates else _value(node, values, numbers, operations))
    return values


def _value[Value](node: Node, values: list[Value], numbers: Sequence[float], operations: Operations[Value]) -> Value:
    match node.kind:
        case "product":
            left, right = node.operands
            return operations.product(values[left], values[right])
        case "sum":
            coefficients = [numbers[position] for position in node.numbers]
            # The constant, if any, follows the coefficients.
            constant = coefficients.pop() if len(coefficients) > len(node.operands) else 0.0
            return operations.linear(constant, coefficients, [values[operand] for operand in node.operands])
        case "shift":
            return operations.linear(numbers[node.numbers[0]], (1.0,), (values[node.operands[0]],))
        case "power":
            return operations.power(values[node.operands[0]], node.exponent)
    return operations.functions[node.kind](values[node.operands[0]])


def _linear(constant: float, coefficients: Sequence[float], values: Sequence[Any]) -> Any:
    total = constant
    for coefficient, value in zip(coefficients, values, strict=True):
        total = total + coefficient * value
    return total


_FLOATS = Operations[float](_linear, operator.mul, math.pow, FUNCTIONS)
_ARRAYS = Operations[np.ndarray](_linear, operator.mul, np.power, {"exp": np.exp, "log": np.log, "sin": np.sin, "cos": np.cos})


def evaluate(graph: Graph, numbers: Sequence[float], x: Any, y: Any) -> list[np.ndarray]:
    """Evaluate the expressions at x and y, which broadcast. Values are NaN or infinite where an expression is not defined."""
    x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    with np.errstate(all="ignore"):
        values = node_values(graph, numbers, x, y, _ARRAYS)
    return [_broadcast(values[index], x.shape) for index in graph.results]


def _broadcast(value: Any, shape: tuple[int, ...]) -> np.ndarray:
    """Return a value as an array of the given shape. The value of a constant expression is a single number."""
    return np.asarray(value) if np.shape(value) == shape else np.full(shape, value)


def evaluate_at(graph: Graph, numbers: Sequence[float], x: float, y: float) -> list[float]:
    """Return the values of `evaluate` at one point, up to rounding, in a tenth of the time."""
    try:
        values = node_values(graph, numbers, x, y, _FLOATS)
    except (ArithmeticError, ValueError):
        # For infinite or undefined values, functions of `math` raise errors, but functions of NumPy do not.
        return [float(value) for value in evaluate(graph, numbers, x, y)]
    return [values[index] for index in graph.results]
