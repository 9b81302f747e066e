"""Results show themselves: pictures on Matplotlib axes and in notebooks, tables for pandas and xarray.

The pictures are drawn by another package, which is imported at the first of them; see `engine.results.pictures`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from engine.results.pictures import load_pictures

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes


class Result:
    """Base of dataclasses of results."""

    def plot(self, ax: Axes | None = None, **options: Any) -> Axes:
        """Draw the result.

        Parameters
        ----------
        ax
            Matplotlib axes; None for new ones of `matplotlib.pyplot`.
        options
            ``palette``: ``"paper"`` or ``"safe"`` for all results; ``picture`` of a map: ``"basins"``, ``"times"``,
            ``"crossings"``, ``"characters"`` or ``"curves"``; ``show`` of an orbit: ``"path"``, ``"sali"`` or ``"r2"``.

        Returns
        -------
        The axes, in the coordinates of the result: whatever is drawn on them later lies in front.

        Raises
        ------
        TypeError
            If the result has no picture, or an option does not apply to it.
        ValueError
            If an option has no such value.
        """
        return load_pictures().plot_result(self, ax, **options)

    def to_holoviews(self) -> Any:
        """The result as an interactive HoloViews element, for the extension that is loaded: an image of a map, else curves."""
        return load_pictures().to_holoviews(self)

    def _repr_html_(self) -> str:
        return load_pictures().to_html(self)

    def numbers(self) -> dict[str, Any]:
        """The scalar attributes by name."""
        return {name: value for name, value in self._attributes().items() if isinstance(value, bool | int | float | str)}

    def columns(self) -> Mapping[str, np.ndarray]:
        """The one-dimensional arrays by name that are as long as the first of them; empty if there are none."""
        arrays = {name: a for name, a in self._attributes().items() if isinstance(a, np.ndarray) and a.ndim == 1}
        length = next(iter(arrays.values())).size if arrays else 0
        return {name: array for name, array in arrays.items() if array.size == length}

    def _attributes(self) -> dict[str, Any]:
        return {field.name: getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]

    def to_pandas(self) -> pd.DataFrame:
        """The columns as a table with the scalars in ``attrs``; without columns one row of the scalars."""
        import pandas as pd

        numbers, columns = self.numbers(), self.columns()
        table = pd.DataFrame(dict(columns) if columns else {name: [value] for name, value in numbers.items()})
        table.attrs = numbers
        return table

    def to_xarray(self) -> xr.Dataset:
        """The columns along the first of them, with the scalars as attributes; without columns a dataset of the scalars."""
        import xarray as xr

        numbers, columns = self.numbers(), self.columns()
        if not columns:
            return xr.Dataset(numbers)
        index, *others = columns
        attributes = {name: int(value) if isinstance(value, bool) else value for name, value in numbers.items()}
        return xr.Dataset({name: (index, columns[name]) for name in others}, {index: columns[index]}, attributes)


class MapResult(Result):
    """Base of results with a value for each pixel of a map; `to_xarray` has named axes."""

    def to_pandas(self) -> pd.DataFrame:
        """One row per pixel, with its coordinates as index."""
        table = self.to_xarray().to_dataframe()
        table.attrs = self.numbers()
        return table
