"""What measures count: starts with the outcomes of their orbits, as arrays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from engine.foundations.former_names import rename_stored
from engine.foundations.stored_fields import plain_attributes
from engine.foundations.validation import short_repr
from engine.slices.window import Window
from engine.systems.outcomes import Outcome, read_outcomes

if TYPE_CHECKING:
    import xarray as xr


# Attributes of datasets that say what was found, not how.
_FOUND = {"result", "outcomes", "worst_energy_error", "complete", "counts", "rounded_share"}


class Classified(Protocol):
    """Orbits with their outcomes: an `EscapeMap`, or the `Outcomes` of any orbits."""

    @property
    def fate(self) -> np.ndarray:
        """`Fate` codes, and the numbers of outcomes from 1 on."""

    @property
    def escape_time(self) -> np.ndarray:
        """Times of the escapes."""

    @property
    def crossings(self) -> np.ndarray:
        """Numbers of crossings."""

    @property
    def t_max(self) -> float:
        """Integration time."""

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """What fates from 1 on are."""


type Measurable = Classified | xr.Dataset
"""What measures take: a map, its dataset, such as one of the maps of a sweep, or the outcomes of orbits."""


@dataclass(frozen=True, eq=False)
class Starts:
    """Starts with the outcomes of their orbits.

    Attributes
    ----------
    fate, escape_time, crossings
        As in `Outcomes`; (rows, columns) of a map, otherwise (n,).
    t_max
        Integration time, dimensionless; infinite if it is not known.
    outcomes
        What fates from 1 on are; empty if it is not known.
    axes
        (columns,) and (rows,) coordinates of the pixels of a map; None for other orbits.
    pixel_area
        Area of a pixel of a map, in units of the axes; 1 for other orbits.
    made_by
        How they were made, in plain values; empty if it is not known.
    """

    fate: np.ndarray
    escape_time: np.ndarray
    crossings: np.ndarray
    t_max: float = float("inf")
    outcomes: tuple[Outcome, ...] = ()
    axes: tuple[np.ndarray, np.ndarray] | None = None
    pixel_area: float = 1.0
    made_by: Mapping[str, Any] = field(default_factory=dict)

    def place(self, window: Window) -> tuple[slice, slice]:
        """Rows and columns of the pixels whose centres lie in a window, edges included; ValueError if they are no map."""
        if self.axes is None:
            raise ValueError(f"window={window}: must be None for orbits that are no map")
        x, ordinate = self.axes
        rows = slice(*_find_range(ordinate, window.ordinate_low, window.ordinate_high))
        return rows, slice(*_find_range(x, window.x_low, window.x_high))

    def inside(self, window: Window) -> Starts:
        """Those in a window, see `place`."""
        rows, columns = place = self.place(window)
        assert self.axes is not None
        x, ordinate = self.axes
        parts = {name: getattr(self, name)[place] for name in ("fate", "escape_time", "crossings")}
        return replace(self, axes=(x[columns], ordinate[rows]), **parts)


def _find_range(centres: np.ndarray, low: float, high: float) -> tuple[int, int]:
    return int(np.searchsorted(centres, low)), int(np.searchsorted(centres, high, "right"))


def read_starts(name: str, value: Any) -> Starts:
    """The starts of a map, of its dataset or of any orbits.

    Raises
    ------
    ValueError
        If it is none of these, or a dataset of several maps; `name` is the parameter.
    """
    if isinstance(value, Starts):
        return value
    if hasattr(value, "data_vars"):
        return _read_dataset(name, rename_stored(value))
    try:
        arrays = value.fate, value.escape_time, value.crossings, value.t_max, value.outcomes
    except AttributeError:
        raise ValueError(f"{name}={short_repr(value)}: must be an EscapeMap, or a dataset of one, or Outcomes") from None
    if not hasattr(value, "ordinate"):
        return Starts(*arrays, made_by=getattr(value, "made_by", {}))
    return Starts(*arrays, axes=(value.x, value.ordinate), pixel_area=value.pixel_area, made_by=value.spec.provenance())


def _read_dataset(name: str, dataset: xr.Dataset) -> Starts:
    """The starts of a dataset; its attributes tell the outcomes, except in files of earlier versions."""
    if not {"fate", "escape_time", "crossings"} <= set(dataset.data_vars):
        raise ValueError(f"{name}={short_repr(dataset)}: must be an EscapeMap, or a dataset of one, or Outcomes")
    fate, escape_time, crossings = (np.asarray(dataset[each].values) for each in ("fate", "escape_time", "crossings"))
    t_max, outcomes = float(dataset.attrs.get("t_max", np.inf)), read_outcomes(dataset.attrs.get("outcomes", "[]"))
    if fate.ndim > len(("rows", "columns")):
        raise ValueError(f"{name}: a dataset of several maps; must be one of them, such as dataset.sel(h=…)")
    made_by = {name: each for name, each in plain_attributes(dataset.attrs).items() if name not in _FOUND}
    starts = Starts(fate, escape_time, crossings, t_max, outcomes, made_by=made_by)
    if fate.ndim == 1:
        return starts
    ordinate, x = (np.asarray(dataset[dimension].values) for dimension in dataset["fate"].dims)
    return replace(starts, axes=(x, ordinate), pixel_area=_spacing(x) * _spacing(ordinate))


def _spacing(centres: np.ndarray) -> float:
    return float(np.ptp(centres)) / max(centres.size - 1, 1)
