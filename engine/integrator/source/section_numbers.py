"""Surfaces of section as numbers, for generated functions and kernels."""

from __future__ import annotations

from enum import Enum
from typing import NamedTuple

ROUNDING = 2.0**-50
"""Share of the sum of the sizes of its terms below which a form counts as 0, so that a start on a section is on it."""

COLUMNS = 3
"""Number of columns of the rows that describe a section, as of the rows of exits in `gates`."""


class SectionForm(Enum):
    """The kinds of forms that vanish on a surface of section, other than y."""

    LINEAR = "linear"
    """A linear form of x, y, px and py."""
    RADIAL = "radial"
    """A linear form plus a multiple of x px + y py."""


class SectionNumbers(NamedTuple):
    """A surface of section as numbers, with the default y = 0, upward.

    Attributes
    ----------
    form
        The kind of its form; None for y.
    rows
        Rows of `COLUMNS` numbers in the order of `NAMES`, which follow the rows of the exits in `gates`; none for y.
    """

    form: SectionForm | None = None
    rows: tuple[tuple[float, ...], ...] = ()


UPWARD = SectionNumbers()
"""The section y = 0, crossed upward."""

NAMES = (
    ("x", "y", "px"),
    ("py", "radial", "value"),
    ("side_x", "side_y", "side_value"),
    ("both", "", ""),
)  # fmt: skip
"""The numbers in the rows of a section: the section is where x · X + y · Y + px · PX + py · PY + radial · (X PX + Y PY) = value
for a state X, Y, PX, PY, and, on the section, side_x · X + side_y · Y ≥ side_value. A crossing goes from negative to other values
of the difference of both sides of the equation or, if both > 0, in any direction."""
