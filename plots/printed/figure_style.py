"""Define size, fonts and formats of figures."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

LEGAL = {"width": (4.0, 100.0, "cm"), "dpi": (50.0, 1200.0, "pixels per inch"), "font_size": (4.0, 30.0, "points")}
"""Smallest value, largest value and unit of each number of a style."""

CM_PER_INCH = 2.54
"""Centimetres in an inch."""

POINTS_PER_INCH = 72.0
"""Points in an inch."""


class FigureFormat(StrEnum):
    """Format of a figure, by file ending."""

    PNG = "png"
    SVG = "svg"
    PDF = "pdf"


class MovieFormat(StrEnum):
    """Format of a movie, by file ending."""

    WEBP = "webp"
    GIF = "gif"
    MP4 = "mp4"


@dataclass(frozen=True)
class FigureStyle:
    """Style of a figure. The default suits the full width of a page of a paper.

    Attributes
    ----------
    width
        Width of the whole figure in cm, 4 to 100.
    dpi
        Pixels per inch of PNG files, 50 to 1200.
    font_size
        Font size of axis labels in points, 4 to 30. All other font sizes are proportional to it.
    titles
        Whether panels have titles, and the figure has a title and provenance.

    Raises
    ------
    ValueError
        If a number is not in its range.

    Examples
    --------
    >>> FigureStyle(width=8.5, titles=False).columns(3)
    1
    """

    width: float = 16.0
    dpi: float = 300.0
    font_size: float = 9.0
    titles: bool = True

    def __post_init__(self) -> None:
        for name, (low, high, unit) in LEGAL.items():
            if not low <= getattr(self, name) <= high:
                raise ValueError(f"{name}={getattr(self, name)!r}: must be from {low:g} to {high:g} {unit}")

    @property
    def inches(self) -> float:
        """Width in inches."""
        return self.width / CM_PER_INCH

    @property
    def title_size(self) -> float:
        """Font size of the title of a figure."""
        return self.font_size * 7.0 / 6.0

    @property
    def small_size(self) -> float:
        """Font size of tick labels."""
        return self.font_size * 7.0 / 8.0

    @property
    def smallest_size(self) -> float:
        """Font size of the provenance."""
        return self.font_size * 3.0 / 4.0

    def columns(self, panels: int) -> int:
        """Return the number of columns of square panels, each wide enough for its legend."""
        most_columns = max(1, int(self.inches * POINTS_PER_INCH // (_LEAST_PANEL_WIDTH * self.font_size)))
        rows = math.ceil(panels / most_columns)
        # Spread the panels evenly over the rows.
        return math.ceil(panels / rows)


# Smallest width of a panel with its labels, in units of the font size.
_LEAST_PANEL_WIDTH = 16.0

SCREEN = FigureStyle(width=29.0, dpi=180.0, font_size=12.0)
"""Style of figures on a screen, such as those of the reproduction and of notebooks."""

POSTER = FigureStyle(width=29.7, dpi=300.0, font_size=14.0)
"""Style of a poster, as wide as a sheet of A3."""
