"""Expressions as a list of operations without repeated parts. The list is evaluated, and kernels are generated from it.

The graph of an expression refers to numbers by position. Expressions that differ only in their numbers have the same graph, and
share compiled code. The graph has few products and powers, because the series of a product or power needs a sum over all lower
orders.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any, NamedTuple

from engine.expressions.common_factors import factor_out
from engine.expressions.nodes import Coordinate, Expression, Function, Product, Sum, as_terms

# Number of cached graphs. Each has a few kB.
_CACHED_GRAPHS = 256


class Node(NamedTuple):
    """An operation on the results of earlier operations.

    Attributes
    ----------
    kind
        ``x``, ``y``, ``sum``, ``shift`` (adds a number), ``product`` (of two values), ``power``, ``exp``, ``log``, ``sin`` or
        ``cos``.
    operands
        Indices of nodes. The second operand of a sine is the cosine of the same argument, and that of a cosine is the sine,
        because each is the derivative of the other, up to a sign. The second operand of a power u^a is u^(a + 1), if this is also
        a node.
    numbers
        Positions of numbers: for a sum, of the coefficient of each operand, then of the constant unless it is 0; for a shift, of
        the added number.
    exponent
        The exponent of a power.
    """

    kind: str
    operands: tuple[int, ...] = ()
    numbers: tuple[int, ...] = ()
    exponent: float = 1.0


class Graph(NamedTuple):
    """The operations of expressions, and the index of the node of each expression."""

    nodes: tuple[Node, ...]
    results: tuple[int, ...]

    @property
    def convolutions(self) -> int:
        """Number of nodes whose series need a sum over all lower orders for each coefficient."""
        return sum(node.kind not in ("x", "y", "sum", "shift") for node in self.nodes)


@lru_cache(maxsize=_CACHED_GRAPHS)
def make_graph(expressions: tuple[Expression, ...]) -> tuple[Graph, tuple[float, ...]]:
    """Return the common graph of expressions, and the numbers to which the graph refers."""
    builder = _Builder()
    results = tuple(builder.add(each) for each in expressions)
    return Graph(tuple(builder.nodes), results), tuple(builder.numbers)


def _is_polynomial(base: Expression, exponent: float) -> bool:
    return exponent > 0.0 and exponent == int(exponent) and as_terms(base) is not None


class _Builder:
    """Collects the nodes and the numbers of a graph."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self.numbers: list[float] = []
        # Indices of nodes by expression, and by `Node` for products and inverses that are parts of an expression.
        self._indices: dict[Any, int] = {}
        # Indices of powers by (index of the base, exponent).
        self._powers: dict[tuple[int, float], int] = {}

    def add(self, expression: Expression) -> int:
        """Return the index of the node of an expression."""
        if expression not in self._indices:
            self._indices[expression] = self._add_new(expression)
        return self._indices[expression]

    def _add_new(self, expression: Expression) -> int:
        match expression:
            case Coordinate(axis):
                return self._append(Node("xy"[axis]))
            case Sum(constant, terms) if constant and (len(terms) > 1 or (terms and terms[0][1] == 1.0)):
                # Sums that differ only in their constants share a node.
                without_constant = terms[0][0] if len(terms) == 1 else Sum(0.0, terms)
                return self._append(Node("shift", (self.add(without_constant),), self._add_numbers([constant])))
            case Sum(constant, terms):
                terms = factor_out(terms)
                operands = tuple(self.add(part) for part, _ in terms)
                values = [*(c for _, c in terms), *([constant] if constant or not terms else [])]
                return self._append(Node("sum", operands, self._add_numbers(values)))
            case Product(factors):
                # Polynomials come last, so that the forces of a centre along x and y share the product of the other factors.
                ordered = sorted(factors, key=lambda factor: _is_polynomial(*factor))
                index, *other_indices = (self._add_power(self.add(base), n) for base, n in ordered)
                for other in other_indices:
                    index = self._add_node(Node("product", (index, other)))
                return index
            case Function("sin" | "cos" as name, argument):
                return self._add_sine_and_cosine(name, argument)
            case Function(name, argument):
                return self._append(Node(name, (self.add(argument),)))
        raise TypeError(expression)

    def _add_power(self, base: int, exponent: float) -> int:
        """Add a power of the node `base` and return its index.

        Positive integer powers are products, because series of products are regular where the base is 0.
        """
        if exponent == 1.0:
            return base
        if exponent != int(exponent):
            return self._add_real_power(base, exponent)
        if exponent < 0.0:
            return self._add_power(self._add_node(Node("power", (base,), exponent=-1.0)), -exponent)
        half = self._add_power(base, float(int(exponent) // 2))
        square = self._add_node(Node("product", (half, half)))
        return square if int(exponent) % 2 == 0 else self._add_node(Node("product", (square, base)))

    def _add_real_power(self, base: int, exponent: float) -> int:
        """Add a non-integer power of the node `base` and return its index.

        The next higher power is an operand if it is a node. For an inverse root, the root is added as a node.
        """
        if exponent == -0.5:
            self._add_real_power(base, 0.5)
        key = base, exponent
        if key not in self._powers:
            higher = self._powers.get((base, exponent + 1.0))
            self._powers[key] = self._append(Node("power", (base,) if higher is None else (base, higher), exponent=exponent))
        return self._powers[key]

    def _add_numbers(self, values: list[float]) -> tuple[int, ...]:
        """Add numbers and return their positions."""
        first = len(self.numbers)
        self.numbers += values
        return tuple(range(first, first + len(values)))

    def _add_sine_and_cosine(self, name: str, argument: Expression) -> int:
        """Add the sine and the cosine of an argument, and return the index of the one called `name`."""
        angle = self.add(argument)
        # The next node is the cosine.
        sine = self._append(Node("sin", (angle, len(self.nodes) + 1)))
        cosine = self._append(Node("cos", (angle, sine)))
        self._indices |= {Function("sin", argument): sine, Function("cos", argument): cosine}
        return sine if name == "sin" else cosine

    def _add_node(self, node: Node) -> int:
        """Add a node if it is new, and return its index."""
        if node not in self._indices:
            self._indices[node] = self._append(node)
        return self._indices[node]

    def _append(self, node: Node) -> int:
        """Add a node and return its index."""
        self.nodes.append(node)
        return len(self.nodes) - 1
