"""Small maps as the tiles of a chart, in rows, with a text above each."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine import MEASURES
from engine.foundations.wording import format_number
from engine.measures.table import curve_names
from engine.results import Sweep
from plots.pictures.charts import Chart, Frame, Ticks, Tile
from plots.pictures.image_columns import fate_codes
from plots.pictures.palette import Palette
from plots.pictures.setting import Setting, Settings
from plots.studies.study import Click

TILES_ASPECT = 0.76
"""Width of a chart of as many rows as columns with its title over its height, at which the maps are about as high as wide."""

OPEN_MAP = "Click a map to open it."
"""What a click on a tile does."""

# Distance between the left edges of neighbouring maps of side 1, and between their lower edges.
_STEPS = 1.08, 1.36
# Margin beside and below the maps.
_MARGIN = 0.03
# Digits of the measures above the maps, and of the values at which the maps are, which are rounded to few decimals.
_DIGITS, _VALUE_DIGITS = 3, 6

BESIDE = Setting(
    name="beside",
    title="Measure of each map",
    word="Measure:",
    choices={name: name for name in curve_names(slow=False)},
    default="basin_entropy",
    help="Measure that is written above each map.",
)
"""The measure whose number is written above each map; of the shares, that of the bounded starts."""


@dataclass(frozen=True)
class TileGrid:
    """Places of maps, in rows from the top, each from the left.

    Attributes
    ----------
    columns, rows
        Number of places in a row, and of rows.
    """

    columns: int
    rows: int

    def corner(self, place: int) -> tuple[float, float]:
        """Return the lower left corner of a place."""
        row, column = divmod(place, self.columns)
        return column * _STEPS[0], -row * _STEPS[1]

    def map_at(self, click: Click, maps: Mapping[int, tuple[int, ...]]) -> tuple[int, ...] | None:
        """Return the indices of the map under a click, given those of each map by its place; None beside the maps."""
        column, row = math.floor(click.x / _STEPS[0]), -math.floor(click.y / _STEPS[1])
        if not (0 <= column < self.columns and 0 <= row < self.rows):
            return None
        place = row * self.columns + column
        left, bottom = self.corner(place)
        return maps.get(place) if click.x <= left + 1.0 and click.y <= bottom + 1.0 else None

    def chart(
        self,
        frame: Frame,
        found: Sweep,
        maps: Mapping[int, tuple[int, ...]],
        palette: Palette,
        settings: Settings,
        axes: Sequence[Sequence[float]] = (),
    ) -> Chart:
        """Return the chart of the maps of a sweep.

        Parameters
        ----------
        frame
            The frame of the chart.
        found
            The sweep, with its maps and the measures of `BESIDE`.
        maps
            The indices of a map in the arrays of the sweep, by its place.
        palette
            The colours of the fates.
        settings
            The setting `BESIDE`.
        axes
            Values of the columns from the left, and of the rows from below, beside the maps; empty writes them above each map.
        """
        tiles = []
        for place, index in maps.items():
            values = zip(found.symbols, found.axes, index, strict=True)
            name = ", ".join(f"{symbol} = {format_number(found[axis][k], _VALUE_DIGITS)}" for symbol, axis, k in values)
            measure = _measure_text(found, index, BESIDE.value_in(settings))
            codes = fate_codes(found["fate"][index], found.outcomes)
            tiles.append(Tile(codes, *self.corner(place), name, measure if axes else f"{name}\n{measure}"))
        right, top = (self.columns - 1) * _STEPS[0] + 1.0, _STEPS[1]
        limits = ((-_MARGIN, right + _MARGIN), (top - self.rows * top - _MARGIN, top))
        chart = Chart(frame, [], limits, tiles, palette.fate_colours)
        if not axes:
            return chart
        labels = found.symbols[0], found.symbols[1]
        return replace(chart, frame=replace(frame, labels=labels), ticks=self._ticks(*axes))

    def _ticks(self, columns: Sequence[float], rows: Sequence[float]) -> tuple[Ticks, Ticks]:
        """Return the ticks of both axes, at the middles of the maps."""
        x = [self.corner(column)[0] + 0.5 for column in range(self.columns)]
        y = [self.corner(row * self.columns)[1] + 0.5 for row in reversed(range(self.rows))]
        labels = [[format_number(value, _VALUE_DIGITS) for value in values] for values in (columns, rows)]
        return dict(zip(x, labels[0], strict=True)), dict(zip(y, labels[1], strict=True))


def _measure_text(found: Sweep, index: tuple[int, ...], measure: str) -> str:
    """Return what is written of a map below its values on the axes; empty for a measure without a number there."""
    if measure == "shares":
        return f"{format_number(100.0 * found['share'][*index, 0], _DIGITS)} % stay"
    value = float(found[next(iter(MEASURES[measure].labels))][index])
    return format_number(value, _DIGITS) if np.isfinite(value) else ""
