"""Plans to compute the series of the nodes of a graph with few sums over all lower orders."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from engine.expressions.graph import Graph, Node

Groups = Mapping[int, Sequence[int]]
"""{coordinate: products}: the operands of a sum that are products with the same coordinate plus a constant."""


@dataclass(frozen=True)
class SeriesPlan:
    """What is computed for each node.

    Attributes
    ----------
    nodes
        The nodes; a product with 1/u is replaced by a ``quotient`` by u.
    roots
        For each node the node from which it differs by a constant, or itself.
    groups
        For each node its `Groups` of two or more products that no other node uses.
    needed
        The nodes whose higher coefficients are needed, not only coefficient 0.
    """

    nodes: tuple[Node, ...]
    roots: tuple[int, ...]
    groups: tuple[Groups, ...]
    needed: frozenset[int]


def plan_series(graph: Graph) -> SeriesPlan:
    """Plan the series of the nodes of a graph."""
    nodes = tuple(_as_quotient(graph, node) for node in graph.nodes)
    roots: list[int] = []
    for index, node in enumerate(nodes):
        roots.append(roots[node.operands[0]] if node.kind == "shift" else index)
    uses = Counter(operand for node in nodes for operand in node.operands) + Counter(graph.results)
    groups = tuple(_find_groups(node, nodes, roots, uses) for node in nodes)
    return SeriesPlan(nodes, tuple(roots), groups, _find_needed(graph.results, nodes, groups))


def _as_quotient(graph: Graph, node: Node) -> Node:
    """Return a product with 1/u as a quotient, and any other node unchanged."""
    if node.kind == "product":
        for one, other in (node.operands, node.operands[::-1]):
            inverse = graph.nodes[other]
            if inverse.kind == "power" and inverse.exponent == -1.0 and one != other:
                return Node("quotient", (one, inverse.operands[0]))
    return node


def _find_groups(node: Node, nodes: Sequence[Node], roots: Sequence[int], uses: Counter[int]) -> Groups:
    found: dict[int, list[int]] = {}
    for each in node.operands if node.kind == "sum" else ():
        kind, operands = nodes[each].kind, nodes[each].operands
        if kind == "product" and operands[0] != operands[1] and uses[each] == 1:
            found.setdefault(roots[operands[1]], []).append(each)
    return {root: products for root, products in found.items() if len(products) > 1}


def _find_needed(results: Sequence[int], nodes: Sequence[Node], groups: Sequence[Groups]) -> frozenset[int]:
    needed, waiting = set[int](), list(results)
    while waiting:
        index = waiting.pop()
        if index not in needed:
            needed.add(index)
            grouped = {each: root for root, products in groups[index].items() for each in products}
            waiting += [each for each in nodes[index].operands if each not in grouped]
            waiting += [used for each, root in grouped.items() for used in (nodes[each].operands[0], root)]
    return frozenset(needed)
