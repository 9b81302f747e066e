"""The typeset formula of a typed system has at most the digits of the numbers in its text."""

from __future__ import annotations

import pytest

from app.state.system_review import review_for_page
from engine import System


@pytest.mark.parametrize(
    ("text", "coefficient"),
    [
        # At another origin, the coefficient of x² is 0.426467140545….
        ("0.4(x^2 + y^2) + 0.3y - 0.03(x^4 + y^4 - 6x^2 y^2); well (0, -0.383458)", "0.426467"),
        ("0.3123 * 1.123 (x^2 + y^2) - x^2 y", "0.350713"),
        ("0.31234567 (x^2 + y^2) - x^2 y", "0.31234567"),
    ],
)
def test_coefficients_have_the_digits_of_the_text(text: str, coefficient: str) -> None:
    typeset = review_for_page(System.from_formula(text)).typeset
    assert f"<mn>{coefficient}</mn>" in typeset


def test_coefficients_of_the_catalogue_are_complete() -> None:
    assert "<mn>1.5625</mn>" in review_for_page(System("Logarithmic bar")).typeset
