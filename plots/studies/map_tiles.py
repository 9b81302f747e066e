"""Small maps as the tiles of a chart, in rows, with a text of two lines above each."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from engine import MEASURES
from engine.foundations.wording import format_number
from engine.measures.table import curve_names
from engine.results import Sweep
from plots.pictures.charts import Chart, Frame, Tile
from plots.pictures.image_columns import fate_codes
from plots.pictures.palette import Palette
from plots.pictures.setting import Setting, Settings
from plots.studies.study import Click

TILES_ASPECT = 0.76
"""Width of a chart of as many rows as columns with its title over its height, at which the maps are as high as wide."""

# Distance between the left edges of neighbouring maps of side 1, and between their lower edges.
_STEPS = 1.08, 1.36
# Margin beside and below the maps.
_MARGIN = 0.03
# Digits of the numbers above the maps.
_DIGITS = 3

BESIDE = Setting(
    name="beside",
    title="Measure of each map",
    word="Number:",
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

    def place_at(self, click: Click) -> int | None:
        """Return the place whose map is under a click; None between the maps."""
        column, row = math.floor(click.x / _STEPS[0]), -math.floor(click.y / _STEPS[1])
        if not (0 <= column < self.columns and 0 <= row < self.rows):
            return None
        place = row * self.columns + column
        left, bottom = self.corner(place)
        return place if click.x <= left + 1.0 and click.y <= bottom + 1.0 else None

    def chart(
        self, frame: Frame, found: Sweep, maps: Mapping[int, tuple[int, ...]], palette: Palette, settings: Settings
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
        """
        measure = BESIDE.value_in(settings)
        tiles = []
        for place, index in maps.items():
            values = zip(found.symbols, found.axes, index, strict=True)
            name = ", ".join(f"{symbol} = {found[axis][k]:g}" for symbol, axis, k in values)
            text = f"{name}\n{_measure_text(found, index, measure)}"
            tiles.append(Tile(fate_codes(found["fate"][index], found.outcomes), *self.corner(place), text))
        right, top = (self.columns - 1) * _STEPS[0] + 1.0, _STEPS[1]
        limits = ((-_MARGIN, right + _MARGIN), (top - self.rows * top - _MARGIN, top))
        return Chart(frame, [], limits, tiles, palette.fate_colours)


def _measure_text(found: Sweep, index: tuple[int, ...], measure: str) -> str:
    """Return what is written of a map below its values on the axes; empty for a measure without a number there."""
    if measure == "shares":
        return f"{format_number(100.0 * found['share'][*index, 0], _DIGITS)} % stay"
    value = float(found[next(iter(MEASURES[measure].labels))][index])
    return format_number(value, _DIGITS) if np.isfinite(value) else ""
