"""Base classes of results: pictures on Matplotlib axes and in notebooks, tables for pandas, datasets for xarray, and files.

Another package, which is imported for the first picture, draws the pictures; see `engine.foundations.extras`.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from enum import IntEnum
from importlib import metadata
from typing import TYPE_CHECKING, Any, ClassVar, cast

import numpy as np

from engine.foundations.arrays import ReadOnlyArrays
from engine.foundations.extras import load_pictures
from engine.foundations.netcdf_files import write_netcdf
from engine.foundations.stored_fields import write_field
from engine.foundations.wording import describe_codes, show_numbers, summarize

if TYPE_CHECKING:
    import pandas as pd
    import xarray as xr
    from matplotlib.axes import Axes

    from engine.foundations.drawing import Drawing


class _NamesForUsers(type):
    """Metaclass that hides the `inner_names` of results from `dir` of a class, and thus from completion."""

    def __dir__(cls) -> list[str]:
        return [name for name in super().__dir__() if name not in cls.inner_names]  # type: ignore[attr-defined]


@dataclass(frozen=True)
class Chart:
    """A picture of two columns of a result.

    Attributes
    ----------
    x, y
        Names of the columns.
    x_label, y_label
        Labels of the axes.
    logarithmic
        Letters of the axes with a logarithmic scale, such as "xy".
    title
        Title above the axes, with attributes of the result in braces; empty for no title.
    by_channel
        Whether x contains channel numbers; the chart then has bars in the colours of the channels instead of a line.
    """

    x: str
    y: str
    x_label: str
    y_label: str
    logarithmic: str = ""
    title: str = ""
    by_channel: bool = False


class Result(ReadOnlyArrays, metaclass=_NamesForUsers):
    """Base of dataclasses of results; their arrays are read-only."""

    inner_names: ClassVar[frozenset[str]] = frozenset(
        {
            *("array_dimensions", "chart", "codes", "columns", "fate_labels", "held_as", "in_well_units", "inner_names"),
            *("kinds", "made_by", "numbers", "read_parts", "row_dimension", "shown_numbers"),
        }
    )
    """Attributes that `dir` omits, because they are for internal use."""

    chart: ClassVar[Chart | None] = None
    """The chart of a result that is drawn as a line or as bars; otherwise None."""

    codes: ClassVar[Mapping[str, type[IntEnum]]] = {}
    """Names of the attributes that contain codes, each with the enumeration of its codes."""

    row_dimension: ClassVar[str] = ""
    """Name of the dimension of the columns in files; empty if the first column has distinct values and is the coordinate."""

    array_dimensions: ClassVar[Mapping[str, tuple[str, ...]]] = {}
    """Names of the dimensions in files of each array that is no column."""

    held_as: ClassVar[dict[str, str]] = {}
    """{field: name in files} of fields that the class stores itself; if a field is stored in parts, the name of one part."""

    @property
    def fate_labels(self) -> Sequence[str]:
        """Labels of fates 1, 2 and so on, which explain `codes`; empty if unknown."""
        return ()

    def plot(self, ax: Axes | None = None, **options: Any) -> Drawing:
        """Draw the result in Matplotlib axes.

        Several results can be drawn in the same axes. The first one labels the axes and sets limits and aspect, if these are not
        set yet; what is set before or afterwards stays.

        Parameters
        ----------
        ax
            The axes; None for new ones of `matplotlib.pyplot`, with a title, a legend and a colour bar.
        options
            For all results: ``palette``, ``"safe"``, ``"paper"`` or a mapping from fates to colours of Matplotlib, such as
            ``{1: "tab:red", Fate.BOUNDED: "0.8"}``; ``legend`` and ``colorbar``, whether they are drawn. ``cmap`` and ``norm`` of
            pictures with a colour scale, as for `matplotlib.axes.Axes.imshow`. ``picture`` of a map: ``"basins"``, ``"times"``,
            ``"crossings"``, ``"characters"`` or ``"curves"``. ``show`` of an orbit: ``"path"``, ``"crossings"`` of its section,
            ``"sali"``, ``"exponent"`` or ``"r2"``. ``measure`` of a sweep: a name of `MEASURES`, by default the first one with a
            picture; ``outcome``, of which a sweep with two axes shows the share, 0 for bounded orbits.

        Returns
        -------
        Drawing
            The axes and all artists.

        Raises
        ------
        TypeError
            If the result has no picture, or an option does not apply to it.
        ValueError
            If the value of an option is not legal, or the axes show other coordinates than those of the result.
        """
        return load_pictures().plot_result(self, ax, **options)

    def to_holoviews(self) -> Any:
        """Return an interactive HoloViews element for the loaded plotting extension: an image for a map, otherwise curves."""
        return load_pictures().to_holoviews(self)

    def _repr_html_(self) -> str:
        return load_pictures().to_html(self)

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if name not in self.inner_names]

    @classmethod
    def kinds(cls) -> dict[str, type[Any]]:
        """Return all direct and indirect subclasses, by name; files contain this name."""
        return {
            name: kind
            for subclass in cls.__subclasses__()
            for name, kind in {subclass.__name__: subclass, **subclass.kinds()}.items()
        }

    @classmethod
    def read_parts(cls, dataset: xr.Dataset) -> dict[str, Any]:
        """Return the fields that files store as several variables, by name; most results have none."""
        return {}

    def __repr__(self) -> str:
        describe = getattr(self, "describe", None)
        arrays = {name: value for name, value in self._attributes().items() if isinstance(value, np.ndarray)}
        return summarize(type(self).__name__, describe() if describe is not None else "", self.shown_numbers(), arrays)

    def shown_numbers(self) -> dict[str, str]:
        """Return the scalar attributes as text: codes in words, other numbers to four digits."""
        return show_numbers(self.numbers(), self.codes, self.fate_labels)

    def numbers(self) -> dict[str, Any]:
        """Return the scalar attributes by name."""
        return {name: value for name, value in self._attributes().items() if isinstance(value, bool | int | float | str)}

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return the first one-dimensional array and all others of its length, by name; empty without such arrays."""
        attributes = self._attributes().items()
        arrays = {name: value for name, value in attributes if isinstance(value, np.ndarray) and value.ndim == 1}
        length = next(iter(arrays.values())).size if arrays else 0
        return {name: array for name, array in arrays.items() if array.size == length}

    def _attributes(self) -> dict[str, Any]:
        """Return the fields by name."""
        return {field.name: getattr(self, field.name) for field in fields(self)}  # type: ignore[arg-type]

    def to_pandas(self) -> pd.DataFrame:
        """Return the columns as a table with the scalars in ``attrs``; a result without columns gives one row of scalars."""
        import pandas as pd

        numbers, columns = self.numbers(), self.columns()
        table = pd.DataFrame(dict(columns) if columns else {name: [value] for name, value in numbers.items()})
        table.attrs = numbers
        return table

    @property
    def nbytes(self) -> int:
        """Number of bytes of the arrays."""
        # Only the fields count, because a cached property can hold the object itself.
        values = (getattr(self, field.name) for field in fields(cast("Any", self)))
        return sum(int(getattr(value, "nbytes", 0)) for value in values)

    def provenance(self) -> dict[str, Any]:
        """Return how the result was made, as plain values: here, the version of the package."""
        return {"version": metadata.version("escape-explorer")}

    def to_xarray(self) -> xr.Dataset:
        """Return a dataset of the columns along one dimension, or of the scalars for a result without columns.

        Its attributes contain the provenance, and the scalars if they are not variables. NetCDF and Zarr can store the dataset.
        """
        import xarray as xr

        columns = self.columns()
        scalars = {name: write_field(value) for name, value in self.numbers().items()}
        arrays, other_attributes = self._remaining_fields({*scalars, *columns, *self.held_as})
        attributes = {"result": type(self).__name__, **self.provenance(), **other_attributes}
        if not columns:
            variables = {name: ((), value, self._meaning(name, value)) for name, value in scalars.items()}
            return xr.Dataset(variables, attrs=attributes)
        dimension = self.row_dimension or next(iter(columns))
        column_variables = {name: (dimension, values, self._meaning(name, values)) for name, values in columns.items()}
        array_variables = {
            name: (self.array_dimensions[name], values, self._meaning(name, values)) for name, values in arrays.items()
        }
        return xr.Dataset(column_variables | array_variables, attrs=attributes | scalars)

    def _remaining_fields(self, stored: set[str]) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
        """Return the fields whose names are not in `stored`: arrays, and attributes, but no nested results and mappings."""
        remaining = {name: value for name, value in self._attributes().items() if name not in stored}
        arrays = {name: value for name, value in remaining.items() if isinstance(value, np.ndarray)}
        attributes = {
            name: write_field(value)
            for name, value in remaining.items()
            if not (value is None or name in arrays or isinstance(value, Result | Mapping))
        }
        return arrays, attributes

    def identical(self, other: Result) -> bool:
        """Return whether another result has the same class, the same contents to the last bit, and the same provenance.

        NaN equals NaN. A result that `open_result` reads is identical to the written one, which ``==`` says of few results.
        """
        return type(self) is type(other) and self.to_xarray().identical(other.to_xarray())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the result as a NetCDF file, which `open_result` reads; for a table use ``to_pandas().to_csv(path)``.

        Parameters
        ----------
        path
            The file, whose name ends in ".nc"; an existing file is replaced.

        Raises
        ------
        ValueError
            If the name does not end in ".nc".
        OSError
            If the file cannot be written.
        """
        write_netcdf(self.to_xarray(), path)

    def _meaning(self, name: str, values: Any) -> dict[str, str]:
        """Return the attributes of a variable: the meanings of codes, or the unit 1 for other numbers."""
        if name in self.codes:
            return describe_codes(self.codes[name], self.fate_labels)
        return {"units": "1"} if np.asarray(values).dtype.kind in "iuf" else {}


@dataclass(frozen=True, eq=False, repr=False)
class RecordedResult(Result):
    """Base of results that record how they were made.

    Attributes
    ----------
    made_by
        How the result was made, as plain values for `provenance`; empty if unknown.
    """

    made_by: Mapping[str, Any] = field(default_factory=dict, kw_only=True, repr=False, compare=False)

    def provenance(self) -> dict[str, Any]:
        """Return how the result was made, as plain values: the version and, where known, the potential and the request."""
        return {**super().provenance(), **self.made_by}


class MapResult(Result):
    """Base of results with a value for each pixel of a map; their `to_xarray` has named axes."""

    def to_pandas(self) -> pd.DataFrame:
        """Return a table with one row per pixel and its coordinates as index."""
        table = self.to_xarray().to_dataframe()
        table.attrs = self.numbers()
        return table
