"""Symbols, numbers and powers are set as in books."""

from __future__ import annotations

import pytest

from plots.texts.typeset import typeset


@pytest.mark.parametrize(
    ("text", "whole"),
    [
        ("Escaped at t = 3.6", "Escaped at t~=~3.6"),
        ("error ≤ 1.9 × 10⁻¹²", "error ≤~1.9~×~10⁻¹²"),
        ("97.5 % of 1 034 275 starts", "97.5_% of 1_034_275 starts"),
        ("x = y, exit 1 at 20 times", "x = y, exit 1 at 20 times"),
        ("e^6.51, like t^1.01, x^2", "e<sup>6.51</sup>, like t<sup>1.01</sup>, x^2"),
        ("<path d='M1 200'>1 200</path>", "<path d='M1 200'>1_200</path>"),
    ],
)
def test_lines_do_not_break_inside_a_number(text: str, whole: str) -> None:
    assert typeset(text) == whole.replace("~", "\N{NO-BREAK SPACE}").replace("_", "\N{NARROW NO-BREAK SPACE}")
