"""Charts as data: series of points with their colours, axes and limits. The page and figures draw them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum, auto
from types import MappingProxyType

import numpy as np

from plots.pictures.histories import logarithmic_limits
from plots.pictures.palette import THRESHOLD, Entry

# Margin of an axis that is fitted to its points, as a share of their range.
_MARGIN = 0.05

Limits = tuple[float, float]
"""Ends of an axis."""

Ticks = Mapping[float, str]
"""Labels of an axis by their places."""

NO_TICKS: Ticks = MappingProxyType({})
"""The ticks of an axis that is not drawn."""


class Shape(Enum):
    """How a series is drawn. Dashed lines are in front of other lines. Steps keep the y of a point until the next x.

    Dots are small points, rings and crosses are large ones.
    """

    LINE = auto()
    THICK = auto()
    DASHED = auto()
    STEPS = auto()
    POINTS = auto()
    RINGS = auto()
    CROSSES = auto()
    DOTS = auto()
    JOINED_POINTS = auto()
    BARS = auto()


ONLY_POINTS = (Shape.POINTS, Shape.RINGS, Shape.CROSSES, Shape.DOTS)
"""The shapes without lines."""


@dataclass(frozen=True, eq=False)
class Series:
    """Points of one colour.

    Attributes
    ----------
    label
        Label in the legend; empty for a series without an entry.
    colour
        Colour of the points.
    x, y
        Coordinates of the points, of shape (n,).
    shape
        How the points are drawn.
    bars
        Lower and upper ends of the error bars; for `Shape.BARS`, left and right edges of the bars; None without bars.
    notes
        What is said of each point under the mouse; empty if nothing is said of single points.
    """

    label: str
    colour: str
    x: np.ndarray
    y: np.ndarray
    shape: Shape = Shape.LINE
    bars: tuple[np.ndarray, np.ndarray] | None = None
    notes: Sequence[str] = ()

    @property
    def curve(self) -> tuple[np.ndarray, np.ndarray]:
        """x and y of the line through the points."""
        return (np.repeat(self.x, 2)[1:], np.repeat(self.y, 2)[:-1]) if self.shape is Shape.STEPS else (self.x, self.y)

    def extent(self, axis: str) -> tuple[np.ndarray, ...]:
        """Return the coordinates of the points along an axis, "x" or "y", and of the ends of the bars along it."""
        has_bars = self.bars is not None and (axis == "x") == (self.shape is Shape.BARS)
        return (self.x if axis == "x" else self.y), *(self.bars if has_bars and self.bars else ())


@dataclass(frozen=True, eq=False)
class Tile:
    """A small image in a chart, with a text above it.

    Attributes
    ----------
    codes
        (rows, columns) uint8 indices of `Chart.tile_colours`, row 0 lowest.
    left, bottom
        Coordinates of the lower left corner.
    name
        Text under the mouse.
    text
        The text above the image.
    side
        Width and height, in the coordinates of the chart.
    """

    codes: np.ndarray
    left: float
    bottom: float
    name: str
    text: str
    side: float = 1.0


@dataclass(frozen=True)
class Frame:
    """What charts of different results have in common.

    Attributes
    ----------
    name
        Name of the chart on the page.
    title
        Title above the chart.
    labels
        Labels of both axes.
    help
        What the chart shows, and how to read it.
    text
        Text of the line, point or bar under the mouse, see `app.views.components.plots.chart_hover`. The columns are x, y, low,
        high, label and note; those of a bar are left, right and top, and that of a tile is name.
    described
        The shape that the text describes: all lines, points, dots, or bars.
    logarithmic
        Letters of the logarithmic axes, such as "xy".
    level
        Value of a marked horizontal line with its label; None for no line.
    aspect
        Width of the chart over its height; 1 for a picture of a plane.
    has_tiles
        Whether the charts consist of tiles, with the axes of `Chart.ticks`.
    """

    name: str
    title: str
    labels: tuple[str, str]
    help: str
    text: str = ""
    described: Shape = Shape.POINTS
    logarithmic: str = ""
    level: tuple[float, str] | None = None
    aspect: float = 1.7
    has_tiles: bool = False

    @property
    def is_square(self) -> bool:
        """Whether the chart is as high as wide, as a picture of a plane."""
        return self.aspect == 1.0


@dataclass(frozen=True, eq=False)
class Chart:
    """Series, or tiles, in a frame.

    Attributes
    ----------
    frame
        The frame.
    series
        The series.
    limits
        Limits of the x axis and the y axis; None fits an axis to the points, see `axis_limits`.
    tiles
        The tiles.
    tile_colours
        Colours of the codes of the tiles.
    ticks
        Ticks of the x axis and the y axis of tiles; other axes choose their own.
    """

    frame: Frame
    series: Sequence[Series]
    limits: tuple[Limits | None, Limits | None] = (None, None)
    tiles: Sequence[Tile] = ()
    tile_colours: Sequence[str] = ()
    ticks: tuple[Ticks, Ticks] = (NO_TICKS, NO_TICKS)

    @property
    def axis_limits(self) -> tuple[Limits, Limits]:
        """The limits of both axes, which all renderers apply."""
        x, y = self.limits
        return x or self._fitted_limits("x"), y or self._fitted_limits("y")

    def _fitted_limits(self, axis: str) -> Limits:
        """Return limits a little beyond the points and bars of the series."""
        values = np.concatenate([np.zeros(0), *(part for one in self.series for part in one.extent(axis))])
        is_logarithmic = axis in self.frame.logarithmic
        values = values[np.isfinite(values) & ((values > 0.0) | (not is_logarithmic))]
        if not values.size:
            return (1.0, 100.0) if is_logarithmic else (0.0, 1.0)
        low, high = float(values.min()), float(values.max())
        if is_logarithmic:
            return logarithmic_limits(low, high)
        margin = _MARGIN * ((high - low) or abs(low) or 1.0)
        return low - margin, high + margin

    def legend(self) -> list[Entry]:
        """Return the entries of the legend."""
        level = [] if self.frame.level is None else [Entry(self.frame.level[1], THRESHOLD)]
        return [*(Entry(one.label, one.colour) for one in self.series if one.label), *level]
