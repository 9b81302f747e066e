"""Plans for the series of all nodes of a graph, with few sums over all lower orders."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from engine.expressions.graph import Graph, Node

Groups = Mapping[int, Sequence[int]]
"""{coordinate: products}: the operands of a sum that are products with the same coordinate plus a constant."""


@dataclass(frozen=True)
class SeriesPlan:
    """How the series of each node of a graph is computed.

    Attributes
    ----------
    nodes
        The nodes; a product with 1/u is replaced by a ``quotient`` by u.
    roots
        For each node, the node from which it differs by a constant, or the node itself.
    groups
        For each node, its `Groups` of two or more products that no other node uses.
    needed
        The nodes of which more than coefficient 0 is needed.
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
        for numerator, factor in (node.operands, node.operands[::-1]):
            inverse = graph.nodes[factor]
            if inverse.kind == "power" and inverse.exponent == -1.0 and numerator != factor:
                return Node("quotient", (numerator, inverse.operands[0]))
    return node


def _find_groups(node: Node, nodes: Sequence[Node], roots: Sequence[int], uses: Counter[int]) -> Groups:
    """Return `SeriesPlan.groups` of a node."""
    products_by_root: dict[int, list[int]] = {}
    for operand in node.operands if node.kind == "sum" else ():
        kind, factors = nodes[operand].kind, nodes[operand].operands
        if kind == "product" and factors[0] != factors[1] and uses[operand] == 1:
            products_by_root.setdefault(roots[factors[1]], []).append(operand)
    return {root: products for root, products in products_by_root.items() if len(products) > 1}


def _find_needed(results: Sequence[int], nodes: Sequence[Node], groups: Sequence[Groups]) -> frozenset[int]:
    """Return `SeriesPlan.needed`: the results, and the nodes from which needed nodes are computed."""
    needed, pending = set[int](), list(results)
    while pending:
        index = pending.pop()
        if index not in needed:
            needed.add(index)
            # The sum over a group is computed from the first factors of its products, and from the root of the group.
            root_by_product = {product: root for root, products in groups[index].items() for product in products}
            pending += [operand for operand in nodes[index].operands if operand not in root_by_product]
            pending += [node for product, root in root_by_product.items() for node in (nodes[product].operands[0], root)]
    return frozenset(needed)
