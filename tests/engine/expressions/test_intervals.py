"""Intervals contain the values of expressions at random points of random boxes."""

from __future__ import annotations

import numpy as np
import pytest

from engine import parse_formula
from engine.expressions.evaluation import evaluate
from engine.expressions.graph import make_graph
from engine.expressions.intervals import Interval, enclose

FORMULAS = [
    "x² − 3x y + y³ + 0.1exp(y)",
    "log(x + y + 0.5) + x",
    "√(x² + y + 1) + (y + 2)^(−1.5)",
    "1/(x − y) + (x + 0.3)^−3",
    "sin(3x + y) cos(20y) + cos(x² − y)",
    "x/(1 + x² + y²)^0.5 − r^−3",
]


@pytest.mark.parametrize("text", FORMULAS)
@pytest.mark.parametrize("size", [3.0, 0.1, 1e-9])
def test_all_values_in_a_box_lie_in_its_interval(text: str, size: float) -> None:
    chance = np.random.default_rng(5)
    graph, numbers = make_graph((parse_formula(text).form.definition,))
    low = chance.uniform(-2.0, 2.0, (2, 200))
    high = low + size * chance.uniform(0.0, 1.0, low.shape)
    found = enclose(graph, numbers, *(Interval(*ends) for ends in zip(low, high, strict=True)))
    (interval,) = found.values
    for share in chance.uniform(0.0, 1.0, (60, 2, 1)):
        (values,) = evaluate(graph, numbers, *(low + share * (high - low)))
        known = np.isfinite(values)
        assert np.all((interval.low <= values)[known] & (values <= interval.high)[known])
        assert not np.any(found.defined_everywhere & ~known)
        assert not np.any(found.defined_nowhere & known)


def test_intervals_shrink_with_the_box() -> None:
    graph, numbers = make_graph((parse_formula("exp(x) cos(y)/(2 + x² + y)").form.definition,))
    x, y = np.array([0.3]), np.array([-0.7])
    widths = []
    for size in (1e-1, 1e-3, 1e-5):
        (interval,) = enclose(graph, numbers, Interval(x, x + size), Interval(y, y + size)).values
        widths.append(float((interval.high - interval.low)[0]))
    assert widths[0] > 50 * widths[1] > 2500 * widths[2]
