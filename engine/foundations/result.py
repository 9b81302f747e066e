"""Results show themselves: pictures on Matplotlib axes and in notebooks, tables for pandas and xarray.

The pictures are drawn by another package, which is imported at the first of them; see `engine.foundations.pictures`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from enum import Enum, IntEnum
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.foundations.arrays import ReadOnlyArrays
from engine.foundations.codes import describe_codes
from engine.foundations.pictures import load_pictures
from engine.foundations.summary import show_numbers, summarize

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes


class Result(ReadOnlyArrays):
    """Base of dataclasses of results; their arrays are read-only."""

    codes: ClassVar[Mapping[str, type[IntEnum]]] = {}
    """The attributes that are codes, with the meaning of these."""

    row_dimension: ClassVar[str] = ""
    """Name of the dimension of the columns in files; empty if the first column, whose values are different, is its coordinate."""

    @property
    def fate_labels(self) -> Sequence[str]:
        """Labels of the fates from 1 on, for `codes`; empty if they are not known."""
        return ()

    def plot(self, ax: Axes | None = None, **options: Any) -> Axes:
        """Draw the result.

        Parameters
        ----------
        ax
            Matplotlib axes; None for new ones of `matplotlib.pyplot`.
        options
            ``palette``: ``"paper"`` or ``"safe"`` for all results; ``picture`` of a map: ``"basins"``, ``"times"``,
            ``"crossings"``, ``"characters"`` or ``"curves"``; ``show`` of an orbit: ``"path"``, ``"sali"``,
            ``"exponent"`` or ``"r2"``.

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

    def __repr__(self) -> str:
        describe = getattr(self, "describe", None)
        arrays = {name: value for name, value in self._attributes().items() if isinstance(value, np.ndarray)}
        return summarize(type(self).__name__, describe() if describe is not None else "", self.shown_numbers(), arrays)

    def shown_numbers(self) -> dict[str, str]:
        """The scalar attributes as text: codes in words, other numbers to four digits."""
        return show_numbers(self.numbers(), self.codes, self.fate_labels)

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
        """The columns along one dimension, with the scalars as attributes; without columns a dataset of the scalars.

        It can be written as NetCDF and Zarr.
        """
        import xarray as xr

        columns = self.columns()
        scalars = {name: _plain(value) for name, value in self.numbers().items()}
        made = {"result": type(self).__name__}
        if not columns:
            return xr.Dataset({name: ((), value, self._meaning(name, value)) for name, value in scalars.items()}, attrs=made)
        dimension = self.row_dimension or next(iter(columns))
        variables = {name: (dimension, values, self._meaning(name, values)) for name, values in columns.items()}
        return xr.Dataset(variables, attrs=made | scalars)

    def _meaning(self, name: str, values: Any) -> dict[str, str]:
        """Attributes of a variable: what its codes are, or that its numbers are dimensionless."""
        if name in self.codes:
            return describe_codes(self.codes[name], self.fate_labels)
        return {"units": "1"} if np.asarray(values).dtype.kind in "iuf" else {}


def _plain(value: Any) -> Any:
    """A scalar as files hold it."""
    if isinstance(value, Enum):
        return value.value
    return int(value) if isinstance(value, bool) else value


class MapResult(Result):
    """Base of results with a value for each pixel of a map; `to_xarray` has named axes."""

    def to_pandas(self) -> pd.DataFrame:
        """One row per pixel, with its coordinates as index."""
        table = self.to_xarray().to_dataframe()
        table.attrs = self.numbers()
        return table
