"""The starts that measures count, with the outcomes of their orbits; labels of basins; confidence intervals of shares."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from engine.foundations.arrays import read_only
from engine.foundations.stored_fields import checked_dataset, plain_attributes
from engine.foundations.validation import checked_array, short_repr
from engine.propagation.fates import Fate
from engine.slices.window import Window
from engine.systems.outcomes import Outcome, read_outcomes

if TYPE_CHECKING:
    import xarray as xr


Z_95 = 1.959963984540054
"""Half-width of the central 95 % of the normal distribution, in standard deviations."""

# Description of legal starts, for messages.
_LEGAL_STARTS = "an EscapeMap, or a dataset of one, or Outcomes"
# Names of the attributes of datasets that are results, unlike the provenance.
_RESULT_ATTRIBUTES = {"result", "outcomes", "worst_energy_error", "complete", "counts", "rounded_share"}


class Classified(Protocol):
    """Orbits with their outcomes: an `EscapeMap`, or the `Outcomes` of any orbits."""

    @property
    def fate(self) -> np.ndarray:
        """`Fate` codes, or the numbers 1, 2, … of outcomes."""

    @property
    def escape_time(self) -> np.ndarray:
        """Times of the escapes, dimensionless; NaN for other orbits."""

    @property
    def crossings(self) -> np.ndarray:
        """Numbers of crossings of the section, of y = 0 upward by default, the start not counted."""

    @property
    def t_max(self) -> float:
        """Integration time, dimensionless."""

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcomes with the fates 1, 2, …"""


type Measurable = Classified | xr.Dataset
"""The input of measures: a map, its dataset, such as a map of a sweep, or the outcomes of orbits."""


@dataclass(frozen=True, eq=False)
class Starts:
    """Starts with the outcomes of their orbits.

    Attributes
    ----------
    fate, escape_time, crossings
        As in `Outcomes`; (rows, columns) for a map, otherwise (n,).
    t_max
        Integration time, dimensionless; infinite if it is not known.
    outcomes
        The outcomes with the fates 1, 2, …; empty if they are not known.
    axes
        (columns,) and (rows,) coordinates of the pixels of a map; None for other orbits.
    pixel_area
        Area of a pixel of a map, in units of the axes; 1 for other orbits.
    made_by
        How the outcomes were made, in plain values; empty if it is not known.
    complete
        Whether all outcomes are computed.
    """

    fate: np.ndarray
    escape_time: np.ndarray
    crossings: np.ndarray
    t_max: float = float("inf")
    outcomes: tuple[Outcome, ...] = ()
    axes: tuple[np.ndarray, np.ndarray] | None = None
    pixel_area: float = 1.0
    made_by: Mapping[str, Any] = field(default_factory=dict)
    complete: bool = True

    def pixel_slices(self, window: Window) -> tuple[slice, slice]:
        """Return the rows and columns of the pixels whose centres lie in a window, edges included; ValueError without a map."""
        if self.axes is None:
            raise ValueError(f"window={window}: must be None for orbits that are no map")
        x, ordinate = self.axes
        return _find_slice(ordinate, window.ordinate_low, window.ordinate_high), _find_slice(x, window.x_low, window.x_high)

    def inside(self, window: Window) -> Starts:
        """Return the starts in a window, see `pixel_slices`."""
        rows, columns = self.pixel_slices(window)
        assert self.axes is not None
        x, ordinate = self.axes
        arrays = {name: getattr(self, name)[rows, columns] for name in ("fate", "escape_time", "crossings")}
        return replace(self, axes=(x[columns], ordinate[rows]), **arrays)


def _find_slice(centres: np.ndarray, low: float, high: float) -> slice:
    """Return the slice of increasing pixel centres from `low` to `high`, ends included."""
    return slice(int(np.searchsorted(centres, low)), int(np.searchsorted(centres, high, "right")))


def read_starts(name: str, value: Any) -> Starts:
    """Return the starts of a map, of its dataset or of any orbits.

    Raises
    ------
    ValueError
        If `value` is none of these, or a dataset of several maps; the message contains `name` as the parameter.
    """
    if isinstance(value, Starts):
        return value
    if hasattr(value, "data_vars"):
        return _read_dataset(checked_dataset(name, value, ("fate", "escape_time", "crossings"), _LEGAL_STARTS))
    try:
        arrays = value.fate, value.escape_time, value.crossings, value.t_max, value.outcomes
    except AttributeError:
        raise ValueError(f"{name}={short_repr(value)}: must be {_LEGAL_STARTS}") from None
    if not hasattr(value, "ordinate"):
        return Starts(*arrays, made_by=getattr(value, "made_by", {}))
    axes, made_by = (value.x, value.ordinate), value.spec.provenance()
    return Starts(*arrays, axes=axes, pixel_area=value.pixel_area, made_by=made_by, complete=value.complete)


def read_complete_starts(name: str, value: Any) -> Starts:
    """Return starts as `read_starts` does; ValueError if the outcomes of some are not computed yet."""
    starts = read_starts(name, value)
    if not starts.complete:
        raise ValueError(f"{name}: the map is not complete; must be a complete map, only `compute_statistics` counts the others")
    return starts


def _read_dataset(dataset: xr.Dataset) -> Starts:
    """Return the starts of a dataset; its attributes contain the outcomes, except in files of earlier versions."""
    fate, escape_time, crossings = (np.asarray(dataset[name].values) for name in ("fate", "escape_time", "crossings"))
    t_max = float(dataset.attrs.get("t_max", np.inf))
    outcomes = read_outcomes(dataset.attrs.get("outcomes", "[]"))
    made_by = {name: value for name, value in plain_attributes(dataset.attrs).items() if name not in _RESULT_ATTRIBUTES}
    complete = bool(dataset.attrs.get("complete", True))
    starts = Starts(fate, escape_time, crossings, t_max, outcomes, made_by=made_by, complete=complete)
    if fate.ndim == 1:
        return starts
    ordinate, x = (np.asarray(dataset[dimension].values) for dimension in dataset["fate"].dims)
    x_low, x_high, ordinate_low, ordinate_high = made_by.get("window", (math.nan,) * 4)
    pixel_area = _pixel_size(x, x_low, x_high) * _pixel_size(ordinate, ordinate_low, ordinate_high)
    return replace(starts, axes=(x, ordinate), pixel_area=pixel_area)


def _pixel_size(centres: np.ndarray, low: float, high: float) -> float:
    """Return the distance of pixel centres; for a single pixel, the distance of the edges of the window."""
    return float(np.ptp(centres)) / (centres.size - 1) if centres.size > 1 else high - low


def exit_labels(fate: np.ndarray, *, bounded: bool) -> tuple[np.ndarray, np.ndarray]:
    """Label the basins of escape of a map and select the pixels that count.

    Forbidden, outside, undecided and failed starts never count.

    Parameters
    ----------
    fate
        (rows, columns) integer `Fate` codes and outcomes of a map.
    bounded
        Whether bounded orbits have a label, 0; otherwise they do not count. Each measure has a constant `COUNTS_BOUNDED`.

    Returns
    -------
    labels
        (rows, columns) int, a read-only view of `fate`: the outcome of escaping orbits, `Fate.BOUNDED` = 0 for bounded orbits,
        and arbitrary codes where `valid` is False.
    valid
        (rows, columns) bool, the pixels that count; read-only.
    """
    valid = (fate >= 1) | (bounded & (fate == Fate.BOUNDED))
    return read_only(fate.view()), read_only(valid)


def describe_labels(labels: Any) -> dict[str, Any]:
    """Return how the labelled map was made; empty for an array."""
    return dict(read_starts("labels", labels).made_by) if hasattr(labels, "fate") else {}


def checked_labels(labels: Any, valid: Any, *, bounded: bool) -> tuple[np.ndarray, np.ndarray]:
    """Return `labels` as integers and `valid` as bool, (rows, columns) each; for a map, the results of `exit_labels`.

    Raises
    ------
    ValueError
        For any other shape or type, for a map that is not complete, and for negative labels without `valid`, because they are
        codes of starts without an outcome.
    """
    if hasattr(labels, "fate"):
        if valid is not None:
            raise ValueError(f"valid={short_repr(valid)}: must be None for a map, of which the interior pixels count")
        labels, valid = exit_labels(read_complete_starts("labels", labels).fate, bounded=bounded)
    labels = checked_array("labels", labels, keep_type=True)
    if labels.ndim != 2 or not np.issubdtype(labels.dtype, np.integer):
        raise ValueError(f"labels of shape {labels.shape} and type {labels.dtype}: must be a map, or integers, (rows, columns)")
    if valid is None:
        if labels.size and labels.min() < 0:
            raise ValueError(
                f"labels: {np.count_nonzero(labels < 0)} are negative, the codes of starts without an outcome; "
                "give the map itself, or valid=(labels >= 0)"
            )
        return labels, np.ones(labels.shape, np.bool_)
    valid = checked_array("valid", valid, keep_type=True)
    if valid.shape != labels.shape or valid.dtype != np.bool_:
        raise ValueError(
            f"valid of shape {valid.shape} and type {valid.dtype}: must be bool, shaped like the labels {labels.shape}"
        )
    return labels, valid


def wilson_interval(counts: Any, totals: Any) -> tuple[np.ndarray, np.ndarray]:
    """Compute the 95 % score interval of a share (Wilson 1927, Journal of the American Statistical Association 22, 209).

    The interval holds for independent random draws. The shares of starts on a grid scatter less.

    Parameters
    ----------
    counts
        Numbers of successes, 0 to `totals`, of any shape.
    totals
        Numbers of draws, of a shape that broadcasts with `counts`.

    Returns
    -------
    low, high
        Limits between 0 and 1, of the common shape; 0 and 1 without draws.
    """
    counts, totals = np.broadcast_arrays(np.asarray(counts, float), np.asarray(totals, float))
    divisor = np.maximum(totals, 1.0)
    share, spread = counts / divisor, Z_95**2 / divisor
    middle = (share + spread / 2) / (1 + spread)
    half_width = np.sqrt(spread * share * (1 - share) + spread**2 / 4) / (1 + spread)
    has_draws = totals > 0.0
    low = np.where(has_draws, np.maximum(middle - half_width, 0.0), 0.0)
    high = np.where(has_draws, np.minimum(middle + half_width, 1.0), 1.0)
    return low, high
