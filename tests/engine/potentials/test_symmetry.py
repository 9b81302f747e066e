from __future__ import annotations

import pytest

from engine.potentials.formulas.formula_parser import parse_formula


@pytest.mark.parametrize(
    ("formula", "n"),
    [
        ("x²/2 + y²/2 − xy²", 1),
        ("r²/2 − x³/3 + xy²", 3),
        ("r²/2 + x²y − y³/3", 3),
        ("r²/2 − x²y²", 4),
        ("x² + 2y² − x²y²", 2),
        ("r²/2 + 0.1r⁴", 0),
        ("r²/2 + r²xy", 2),
    ],
)
def test_number_of_rotations(formula: str, n: int) -> None:
    assert parse_formula(formula).form.count_rotations() == n
