"""Results show themselves: pictures on Matplotlib axes and in notebooks, tables for pandas and xarray.

The pictures are drawn by another package, which is imported at the first of them; see `engine.foundations.extras`.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from enum import IntEnum
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.foundations.arrays import ReadOnlyArrays
from engine.foundations.extras import load_pictures
from engine.foundations.former_names import FORMER_FIELDS
from engine.foundations.stored_fields import write_field
from engine.foundations.wording import describe_codes, show_numbers, summarize

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes


class _NamesForUsers(type):
    """Metaclass of results: the completion of names, which reads classes too, shows what is for users."""

    def __dir__(cls) -> list[str]:
        return [name for name in super().__dir__() if name not in cls.inner_names]  # type: ignore[attr-defined]


@dataclass(frozen=True)
class Chart:
    """A picture of two columns of a result.

    Attributes
    ----------
    x, y
        Names of the columns.
    across, up
        Labels of the axes.
    logarithmic
        The letters of the axes with a logarithmic scale.
    title
        Above the axes, with the numbers of the result in braces; empty for none.
    by_channel
        Whether x are channels: bars in their colours instead of a line.
    """

    x: str
    y: str
    across: str
    up: str
    logarithmic: str = ""
    title: str = ""
    by_channel: bool = False


class Result(ReadOnlyArrays, metaclass=_NamesForUsers):
    """Base of dataclasses of results; their arrays are read-only."""

    inner_names: ClassVar[frozenset[str]] = frozenset(
        {
            *("chart", "codes", "columns", "fate_labels", "held_as", "in_well_units", "inner_names", "made_by", "numbers"),
            *("row_dimension", "shown_numbers"),
            *FORMER_FIELDS,
        }
    )
    """The attributes that `dir` leaves out: they are for the modules of this package."""

    chart: ClassVar[Chart | None] = None
    """The picture of a result that is a line or bars."""

    codes: ClassVar[Mapping[str, type[IntEnum]]] = {}
    """The attributes that are codes, with the meaning of these."""

    row_dimension: ClassVar[str] = ""
    """Name of the dimension of the columns in files; empty if the first column, whose values are different, is its coordinate."""

    held_as: ClassVar[dict[str, str]] = {}
    """The fields that files hold under another name, or as parts, with the name of a part."""

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

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if name not in self.inner_names]

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

    def provenance(self) -> dict[str, Any]:
        """How the result was made, in plain values, as far as it is known: the version, the potential, the request."""
        return {"version": metadata.version("escape-explorer")}

    def to_xarray(self) -> xr.Dataset:
        """The columns along one dimension, with the scalars and the provenance as attributes; without columns the scalars.

        It can be written as NetCDF and Zarr.
        """
        import xarray as xr

        columns = self.columns()
        scalars = {name: write_field(value) for name, value in self.numbers().items()}
        arrays, others = self._remaining_fields({*scalars, *columns, *self.held_as})
        attributes = {"result": type(self).__name__, **self.provenance(), **others}
        if not columns:
            variables = {name: ((), value, self._meaning(name, value)) for name, value in scalars.items()}
            return xr.Dataset(variables, attrs=attributes)
        dimension = self.row_dimension or next(iter(columns))
        rows = {name: (dimension, values, self._meaning(name, values)) for name, values in columns.items()}
        entries = {
            name: ([f"{name}_entry_{axis}" for axis in range(values.ndim)], values, self._meaning(name, values))
            for name, values in arrays.items()
        }
        return xr.Dataset(rows | entries, attrs=attributes | scalars)

    def _remaining_fields(self, stored: set[str]) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """The fields that are neither columns nor shown numbers: arrays, and attributes; a potential is in the provenance."""
        fields_left = {name: value for name, value in self._attributes().items() if name not in stored}
        arrays = {name: value for name, value in fields_left.items() if isinstance(value, np.ndarray)}
        others = {
            name: write_field(value)
            for name, value in fields_left.items()
            if not (value is None or name in arrays or isinstance(value, Result | Mapping))
        }
        return arrays, others

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the result as a NetCDF file, which `open_result` reads; tables are written by ``to_pandas().to_csv(path)``.

        Parameters
        ----------
        path
            The file, which ends in ".nc"; one that exists is replaced.

        Raises
        ------
        ValueError
            If the name has another ending.
        OSError
            If the file cannot be written.
        """
        wanted = Path(path)
        if wanted.suffix != ".nc":
            raise ValueError(f"path={path}: must end in .nc")
        # An interrupted call leaves the file that it would replace as it is.
        part = wanted.with_name(f".{wanted.name}.{os.getpid()}.part")
        try:
            self.to_xarray().to_netcdf(part)
            part.replace(wanted)
        finally:
            part.unlink(missing_ok=True)

    def _meaning(self, name: str, values: Any) -> dict[str, str]:
        """Attributes of a variable: what its codes are, or that its numbers are dimensionless."""
        if name in self.codes:
            return describe_codes(self.codes[name], self.fate_labels)
        return {"units": "1"} if np.asarray(values).dtype.kind in "iuf" else {}


@dataclass(frozen=True, eq=False, repr=False)
class RecordedResult(Result):
    """Base of results that keep how they were made.

    Attributes
    ----------
    made_by
        How the result was made, in plain values, for `provenance`; empty if it is not known.
    """

    made_by: Mapping[str, Any] = field(default_factory=dict, kw_only=True, repr=False, compare=False)

    def provenance(self) -> dict[str, Any]:
        """How the result was made, in plain values, as far as it is known: the version, the potential, the request."""
        return {**super().provenance(), **self.made_by}


class MapResult(Result):
    """Base of results with a value for each pixel of a map; `to_xarray` has named axes."""

    def to_pandas(self) -> pd.DataFrame:
        """One row per pixel, with its coordinates as index."""
        table = self.to_xarray().to_dataframe()
        table.attrs = self.numbers()
        return table
