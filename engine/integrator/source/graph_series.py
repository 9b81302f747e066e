"""Series in time of the nodes of a graph along an orbit, by the recurrence of each kind of node.

The derivatives of V are also expressions. Along an orbit each node is a power series in time. Coefficient k of a sum or a product
follows from coefficients 0 … k of its operands. Coefficient k of w = u^a, exp u, log u, sin u or cos u follows from the
coefficients of u and from the lower coefficients of w, because w' is a product of u' and known series (Jorba & Zou 2005,
Experimental Mathematics 14, 99, section 2; Haro et al. 2016, The Parameterization Method for Invariant Manifolds, chapter 2).
Coefficient 0 is the function itself, see `engine.integrator.source.elementary`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import reduce
from itertools import chain, islice
from operator import add

from engine.expressions.graph import Graph, Node
from engine.integrator.source.elementary import FUNCTIONS, power_of
from engine.integrator.source.series import (
    NO_REMAINDERS,
    Series,
    add_coriolis,
    half_square,
    inner_pairs,
    sum_of_products,
    total,
)
from engine.integrator.source.series_plan import plan_series
from engine.integrator.source.straight_line import StraightLine, Value

# Exponent of a square root.
_ROOT = 0.5


class GraphSeries:
    """Appends the operations for the series of all nodes of a graph along an orbit to a program.

    Attributes
    ----------
    program, graph
        The program and the graph, whose first two results are the slopes of V.
    name
        Name of the graph in keys (name, number) of the table.
    rotates
        Whether the frame rotates.
    remainders
        {kind: value}: the rounding errors of the nodes of kinds "x" and "y".
    x, y
        The coefficients of x and y.
    series
        The coefficients of each node.
    """

    def __init__(
        self,
        program: StraightLine,
        name: str,
        graph: Graph,
        rotates: bool,
        remainders: Mapping[str, Value] = NO_REMAINDERS,
    ) -> None:
        self.program, self.name, self.graph, self.rotates, self.remainders = program, name, graph, rotates, remainders
        self.x, self.y = ([program.input(f"{axis}{k}") for k in (0, 1)] for axis in "xy")
        self.series: list[list[Value]] = [{"x": self.x, "y": self.y}.get(node.kind, []) for node in graph.nodes]
        self._plan = plan_series(graph)
        # The series k u_k of nodes u, for functions.
        self._slopes: dict[int, list[Value]] = {}
        # 1 / u_0 of divisors, roots and arguments of powers and logarithms.
        self._reciprocals: dict[int, Value] = {}
        # Sums of products, see `_inner_sum`.
        self._inner_sums: dict[tuple[int, int, bool, int], Value] = {}
        # Sums of series, see `_common_product`.
        self._common_sums: dict[tuple[int, int], list[Value]] = {}
        # Number of known coefficients of each node.
        self._known_count = 0

    def advance_to(self, k: int) -> None:
        """Append coefficients k of all nodes, unless they are known."""
        if k >= self._known_count:
            self.advance(k)

    def advance(self, k: int) -> None:
        """Append coefficients k of all nodes, and with them coefficient k + 2 of x and y."""
        self._known_count = k + 1
        for index, (node, planned) in enumerate(zip(self.graph.nodes, self._plan.nodes, strict=True)):
            if node.kind in ("x", "y"):
                continue
            if k == 0:
                self.series[index].append(self._first(node))
            elif index in self._plan.needed:
                self.series[index].append(_RULES[planned.kind](self, index, planned, k))
        # The first two results of the graph are the gradient of V.
        for axis, slope in zip((self.x, self.y), self.graph.results, strict=False):
            axis.append(self.series[slope][k] * (-1.0 / ((k + 1) * (k + 2))))
        if self.rotates:
            add_coriolis(self.program, self.x, self.y)

    def _first(self, node: Node) -> Value:
        """Return coefficient 0 of a node: its value at the start of the step."""
        value = value_of(self.program, self.name, node, {index: series[0] for index, series in enumerate(self.series) if series})
        return reduce(add, self._remainders(node), value)

    def _remainders(self, node: Node) -> Iterator[Value]:
        """Yield the terms that remainders add to a sum with x or y, such as the distance from a body.

        In other nodes, remainders do not matter.
        """
        for operand, number in zip(node.operands, node.numbers, strict=False):
            remainder = self.remainders.get(self.graph.nodes[operand].kind)
            if remainder is not None and node.kind in ("sum", "shift"):
                yield remainder if node.kind == "shift" else self.program.entry((self.name, number)) * remainder

    def slopes(self, index: int, k: int) -> list[Value]:
        """Return j u_j of a node for j = 0 … k; the first value is not used."""
        series = self.series[index]
        slopes = self._slopes.setdefault(index, [series[0]])
        slopes += [float(j) * series[j] if j > 1 else series[j] for j in range(len(slopes), k + 1)]
        return slopes

    def reciprocal(self, index: int) -> Value:
        """Return 1 / u_0 of a node."""
        if index not in self._reciprocals:
            self._reciprocals[index] = 1.0 / self.series[index][0]
        return self._reciprocals[index]

    def add(self, index: int, node: Node, k: int) -> Value:
        """Return (Σ c u)_k = Σ c u_k, for k > 0, without the constant."""
        factors = {
            operand: self.program.entry((self.name, number)) for operand, number in zip(node.operands, node.numbers, strict=False)
        }
        groups = self._plan.groups[index]
        grouped = {operand for products in groups.values() for operand in products}
        single_terms = (factors[operand] * self.series[operand][k] for operand in node.operands if operand not in grouped)
        group_terms = (
            self._common_product(index, root, {operand: factors[operand] for operand in groups[root]}, k) for root in groups
        )
        return total(self.program, chain(single_terms, group_terms))

    def _common_product(self, index: int, root: int, entries: Mapping[int, Value], k: int) -> Value:
        """Return (Σ c f (x + d))_k = Σ (x + d)_0 c f_k + Σ x_j (Σ c f)_(k − j) over j = 1 … k.

        The factor x + d is almost 0 near a body.
        """
        # For each product, the nodes f and x + d.
        operands = {product: self.graph.nodes[product].operands for product in entries}
        common_sums = self._common_sums.setdefault((index, root), [])
        for j in range(len(common_sums), k + 1):
            common_sums.append(reduce(add, (entries[product] * self.series[f][j] for product, (f, _) in operands.items())))
        pairs = [(self.series[root][j], common_sums[k - j]) for j in range(1, k + 1)]
        pairs += [(self.series[d][0], entries[product] * self.series[f][k]) for product, (f, d) in operands.items()]
        return sum_of_products(pairs)

    def shift(self, _index: int, node: Node, k: int) -> Value:
        """Return (u + c)_k = u_k for k > 0."""
        return self.series[node.operands[0]][k]

    def product(self, _index: int, node: Node, k: int) -> Value:
        """Return (u v)_k = Σ u_j v_(k − j).

        The products of u + c and v + d for all c and d differ only in the first and the last term.
        """
        left, right = node.operands
        u, v = self.series[left], self.series[right]
        if left == right:
            half = reduce(add, [*self._inner_sum(left, left, k), u[0] * u[k]])
            return half + half
        return reduce(add, [*self._inner_sum(left, right, k), u[0] * v[k], u[k] * v[0]])

    def _inner_sum(self, left: int, right: int, k: int) -> list[Value]:
        """Return Σ u_j v_(k − j) over j = 1 … k − 1, or half this sum for a square; an empty list for an empty sum."""
        if k == 1:
            return []
        key = self._plan.roots[left], self._plan.roots[right], left == right, k
        if key not in self._inner_sums:
            u, v = self.series[left], self.series[right]
            # Without the last pair of `half_square`, that of u_0.
            pairs = islice(half_square(u, k), k // 2) if left == right else inner_pairs(u, v, k)
            self._inner_sums[key] = sum_of_products(pairs)
        return [self._inner_sums[key]]

    def quotient(self, index: int, node: Node, k: int) -> Value:
        """Return w_k of w = v/u from u_0 w_k = v_k − Σ u_(k − j) w_j over j = 0 … k − 1."""
        numerator, argument = node.operands
        return self._quotient(index, [numerator], argument, k)

    def power(self, index: int, node: Node, k: int) -> Value:
        """Return w_k of w = u^a from k u_0 w_k = Σ (a (k − j) − j) u_(k − j) w_j over j = 0 … k − 1, because u w' = a u' w."""
        # A node of a higher power, if there is one, is the numerator of u^a = u^(a + 1)/u.
        (argument, *numerator), a = node.operands, node.exponent
        if a == _ROOT:
            return self._root(index, argument, k)
        if numerator or a == -1.0:
            return self._quotient(index, numerator, argument, k)
        u, w = self.series[argument], self.series[index]
        pairs = [((a * (k - j) - j) * u[k - j], w[j]) for j in range(k) if a * (k - j) != j]
        return total(self.program, iter([sum_of_products(pairs)] if pairs else [])) * (1.0 / k) * self.reciprocal(argument)

    def _root(self, index: int, argument: int, k: int) -> Value:
        """Return w_k of w = √u from 2 w_0 w_k = u_k − Σ w_j w_(k − j) over 0 < j < k, a quarter of the work of other powers."""
        half, lower_pairs = 0.5 * self.series[argument][k], list(islice(half_square(self.series[index], k), k // 2))
        return (half - sum_of_products(lower_pairs) if lower_pairs else half) * self.reciprocal(index)

    def _quotient(self, index: int, numerator: list[int], argument: int, k: int) -> Value:
        """Return w_k of w = v/u, with v = 1 if there is no numerator, in half the work of other powers."""
        u, w = self.series[argument], self.series[index]
        lower_sum = sum_of_products((u[k - j], w[j]) for j in range(k))
        return (self.series[numerator[0]][k] - lower_sum if numerator else -1.0 * lower_sum) * self.reciprocal(argument)

    def exponential(self, index: int, node: Node, k: int) -> Value:
        """Return w_k of w = exp u from k w_k = Σ j u_j w_(k − j) over j = 1 … k."""
        return _weighted_sum(self.slopes(node.operands[0], k), self.series[index], k) * (1.0 / k)

    def logarithm(self, index: int, node: Node, k: int) -> Value:
        """Return w_k of w = log u from u_0 w_k = u_k − (1/k) Σ j w_j u_(k − j) over j = 1 … k − 1."""
        (argument,) = node.operands
        u = self.series[argument]
        if k == 1:
            return u[1] * self.reciprocal(argument)
        lower_sum = sum_of_products((slope, u[k - j]) for j, slope in enumerate(self.slopes(index, k - 1)) if j)
        return (u[k] - lower_sum * (1.0 / k)) * self.reciprocal(argument)

    def sine(self, _index: int, node: Node, k: int) -> Value:
        """Return (sin u)_k from k (sin u)_k = Σ j u_j (cos u)_(k − j) over j = 1 … k."""
        argument, cosine = node.operands
        return _weighted_sum(self.slopes(argument, k), self.series[cosine], k) * (1.0 / k)

    def cosine(self, _index: int, node: Node, k: int) -> Value:
        """Return (cos u)_k from k (cos u)_k = −Σ j u_j (sin u)_(k − j) over j = 1 … k."""
        argument, sine = node.operands
        return _weighted_sum(self.slopes(argument, k), self.series[sine], k) * (-1.0 / k)


_RULES: Mapping[str, Callable[[GraphSeries, int, Node, int], Value]] = {
    "sum": GraphSeries.add,
    "shift": GraphSeries.shift,
    "product": GraphSeries.product,
    "quotient": GraphSeries.quotient,
    "power": GraphSeries.power,
    "exp": GraphSeries.exponential,
    "log": GraphSeries.logarithm,
    "sin": GraphSeries.sine,
    "cos": GraphSeries.cosine,
}


def _weighted_sum(slopes: Series, v: Series, k: int) -> Value:
    """Return Σ j u_j v_(k − j) over j = 1 … k, the newest products last; `slopes` are j u_j."""
    pairs: Iterable[tuple[Value, Value]] = ((slopes[j], v[k - j]) for j in range(1, k + 1))
    return sum_of_products(pairs)


def value_of(program: StraightLine, name: str, node: Node, values: Mapping[int, Value]) -> Value:
    """Return the value of a node from the values of its operands."""
    match node.kind:
        case "sum":
            terms = (
                program.entry((name, number)) * values[operand]
                for operand, number in zip(node.operands, node.numbers, strict=False)
            )
            # A number without an operand is a constant.
            constant = [program.entry((name, number)) for number in node.numbers[len(node.operands) :]]
            return total(program, iter([*constant, *terms]))
        case "shift":
            return values[node.operands[0]] + program.entry((name, node.numbers[0]))
        case "product":
            left, right = node.operands
            return values[left] * values[right]
        case "power":
            return power_of(values[node.operands[0]], node.exponent)
    return FUNCTIONS[node.kind](values[node.operands[0]])
