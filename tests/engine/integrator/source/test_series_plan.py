"""Plans of the series of a force contain few sums over all lower orders."""

from __future__ import annotations

from engine import parse_formula
from engine.expressions.calculus import slopes
from engine.expressions.graph import make_graph
from engine.integrator.source.series_plan import plan_series


def kinds_of(text: str) -> list[str]:
    """Return the kinds of nodes whose series need a sum over all lower orders. A group of factors of a coordinate counts once."""
    graph, _ = make_graph(slopes(parse_formula(text).form.definition))
    plan = plan_series(graph)
    kinds = [plan.nodes[index].kind for index in plan.needed]
    grouped = [kind for groups in plan.groups for kind in ["group"] * len(groups)]
    return sorted(kind for kind in [*kinds, *grouped] if kind not in ("x", "y", "sum", "shift"))


def test_a_product_with_an_inverse_is_one_quotient() -> None:
    assert kinds_of("log(x² + 2y² + 1)") == ["product", "product", "quotient", "quotient"]


def test_forces_of_bodies_have_one_product_with_each_coordinate() -> None:
    assert kinds_of("−1/√((x − 1)² + y²) − 0.3/√((x + 1)² + y²)") == ["group", "power", "power", *["product"] * 4]
