from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from engine.taylor.source.cauchy_products import plan_products


@given(st.sets(st.tuples(st.integers(0, 5), st.integers(0, 5)), min_size=1, max_size=5))
def test_every_product_is_planned_after_its_factors(needed: set[tuple[int, int]]) -> None:
    known = {(1, 0), (0, 1)}
    for product in plan_products(needed):
        assert {product.left, product.right} <= known
        assert tuple(np.add(product.left, product.right)) == product.monomial
        known.add(product.monomial)
    assert {m for m in needed if sum(m) > 1} <= known


def test_a_fourth_power_is_the_square_of_a_square() -> None:
    # Two products instead of three.
    assert len(plan_products({(4, 0)})) == 2
