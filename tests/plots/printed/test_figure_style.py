"""The numbers of a style are checked, and determine the columns of a figure."""

from __future__ import annotations

import re
from typing import Any

import pytest

from plots.printed.figure_style import LEGAL, FigureStyle


@pytest.mark.parametrize("name", LEGAL)
def test_numbers_at_the_limits_are_legal_and_others_are_refused(name: str) -> None:
    low, high, unit = LEGAL[name]
    for legal in (low, high):
        assert getattr(FigureStyle(**{name: legal}), name) == legal
    for illegal in (low - 0.1, high + 0.1, float("nan"), float("inf")):
        refusal = re.escape(f"{name}={illegal!r}: must be from {low:g} to {high:g} {unit}")
        options: Any = {name: illegal}
        with pytest.raises(ValueError, match=refusal):
            FigureStyle(**options)


@pytest.mark.parametrize(("style", "columns"), [(FigureStyle(), 3), (FigureStyle(8.5), 1), (FigureStyle(font_size=14.0), 2)])
def test_panels_stand_beside_each_other_where_they_are_wide_enough(style: FigureStyle, columns: int) -> None:
    assert style.columns(3) == columns
