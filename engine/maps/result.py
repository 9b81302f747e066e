"""Escape maps: the result arrays and quantities derived from them."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.foundations.extras import write_live_figure
from engine.foundations.result import MapResult, Result
from engine.foundations.stored_fields import checked_dataset
from engine.foundations.validation import checked_flag
from engine.foundations.wording import describe_codes
from engine.maps.spec import MapSpec, read_spec
from engine.propagation.batch import OrbitBatch
from engine.propagation.fates import Evidence, Fate, name_fate
from engine.slices.window import Window
from engine.systems.outcomes import Outcome, write_outcomes
from engine.systems.well_units import TIME

if TYPE_CHECKING:
    import xarray as xr

PixelArrays = Mapping[str, tuple[type, float]]
"""Arrays with a value for each pixel: by name, the data type and the value of pixels that are not computed."""

PIXEL_ARRAYS: PixelArrays = {
    "fate": (np.int8, Fate.NOT_COMPUTED),
    "escape_time": (np.float64, np.nan),
    "crossings": (np.int32, 0),
    "energy_error": (np.float64, np.nan),
    "evidence": (np.int8, Evidence.NONE),
    "outside": (np.int8, 0),
    "started": (np.bool_, False),
}
"""The (rows, columns) arrays of a map."""

# Names of the arrays that files contain.
_STORED_ARRAYS = tuple(name for name in PIXEL_ARRAYS if name != "started")


def empty_arrays(kinds: PixelArrays, shape: tuple[int, ...]) -> dict[str, np.ndarray]:
    """Return arrays by name in which no pixel is computed."""
    return {name: np.full(shape, value, dtype) for name, (dtype, value) in kinds.items()}


type MapLike = EscapeMap | xr.Dataset
"""A map as measures and analyses accept it: an `EscapeMap`, or its dataset, such as a map of a sweep."""

NOTED_SHARE = 0.01
"""Smallest share of interior pixels, not supported by double precision, at which a map counts as rounded."""


@dataclass(frozen=True, eq=False, repr=False)
class EscapeMap(MapResult):
    """An escape map, complete or in progress. Arrays are read-only and of shape (rows, columns), with row 0 at the bottom.

    Attributes
    ----------
    spec
        The request.
    x, ordinate
        (columns,), (rows,) pixel centres.
    fate, escape_time, crossings, energy_error
        See `Outcomes`. Undecided pixels are `Fate.NOT_COMPUTED`.
    evidence
        int8, the `Evidence` of each bounded orbit: the reason why it is called bounded. Crossings and energy error of an orbit
        that is bounded on evidence refer to the time up to which it was integrated.
    outside
        int8, for a start outside, the number, as in `fate`, of the exit or escape radius beyond which it lies, or of the disc in
        which it lies; 0 for other starts.
    stride
        Side, in pixels, of the squares that each contain a started pixel; 1 if all pixels have been started, and for a map that
        is filled block by block.
    horizon
        Time up to which orbits are integrated in the current stage, dimensionless; t_max in the last stage. Frames along a
        parameter have the time that all lines have reached, 0 at first.
    progress
        Share of the work done, 0 to 1. An undecided orbit counts by the share of t_max up to which it is integrated.
    complete
        Whether every pixel is decided.
    started
        bool, the pixels whose orbits have been started.
    batch
        States of the orbits of `continued_pixels` for ``resume``, in units of the well; None in frames.
    rounded_share
        For a complete map in a deep zoom, the estimated share of the interior pixels whose outcome is not reliable in double
        precision, because it changes with the errors of the integration. Otherwise None.

    Examples
    --------
    >>> from escape_explorer import CASES, Fate, MapSpec, Plane, compute_map
    >>> escapes = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (40, 40), t_max=1e3))
    >>> {code: round(share, 3) for code, share in escapes.fractions().items() if share}
    {1: 0.549, 2: 0.451}
    >>> int((escapes.fate == Fate.OUTSIDE).sum()), list(escapes.to_xarray().sizes)
    (0, ['px', 'x'])
    """

    spec: MapSpec
    x: np.ndarray
    ordinate: np.ndarray
    fate: np.ndarray
    escape_time: np.ndarray = field(metadata=TIME)
    crossings: np.ndarray
    energy_error: np.ndarray
    evidence: np.ndarray
    outside: np.ndarray
    stride: int
    horizon: float = field(metadata=TIME)
    progress: float
    complete: bool
    started: np.ndarray = field(repr=False)
    batch: OrbitBatch | None = field(default=None, repr=False)
    rounded_share: float | None = None
    inner_names: ClassVar = Result.inner_names | {
        "batch", "check_complete", "continued_pixels", "horizon", "restored", "started", "stride", "thinned",
    }  # fmt: skip

    def numbers(self) -> dict[str, Any]:
        """Return the main fields of the request, the share of each outcome among the interior starts, and `complete`."""
        spec = self.spec
        request = {"potential": spec.potential.name, "plane": spec.plane.title, "energy": str(spec.energy), "t_max": spec.t_max}
        shares = {name_fate(code, spec.outcomes): share for code, share in self.fractions().items()}
        rounded = {} if self.rounded_share is None else {"lost to rounding, about": self.rounded_share}
        return request | shares | {"complete": self.complete} | rounded

    @property
    def t_max(self) -> float:
        """Integration time of the request."""
        return self.spec.t_max

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcomes with the fates 1, 2, …"""
        return self.spec.outcomes

    @property
    def pixel_area(self) -> float:
        """Area of a pixel, in units of the axes."""
        window, (columns, rows) = self.spec.find_window(), self.spec.resolution
        return window.width * window.height / (columns * rows)

    @property
    def interior(self) -> np.ndarray:
        """(rows, columns) bool, the pixels that are neither forbidden nor outside."""
        return find_interior(self.fate)

    @property
    def continued_pixels(self) -> np.ndarray:
        """(n,) the pixels, numbered row by row, whose outcome a larger t_max can change."""
        can_change = (self.fate == Fate.NOT_COMPUTED) | (self.evidence == Evidence.INTEGRATED)
        return np.flatnonzero(self.started & can_change)

    @property
    def undecided(self) -> float:
        """Share of the interior pixels that are undecided; 0 if there are none."""
        return float(np.mean(self.fate[self.interior] == Fate.NOT_COMPUTED)) if self.interior.any() else 0.0

    @property
    def worst_energy_error(self) -> float:
        """Largest relative energy error of the decided orbits; NaN if no orbit is decided."""
        errors = self.energy_error[np.isfinite(self.energy_error)]
        return float(errors.max()) if errors.size else float("nan")

    @property
    def is_rounded(self) -> bool:
        """Whether the outcomes of 1 % or more of the interior pixels are not reliable in double precision."""
        return self.rounded_share is not None and self.rounded_share >= NOTED_SHARE

    def check_complete(self, name: str) -> None:
        """Raise ValueError, with `name` as the parameter, unless the map is complete."""
        if not self.complete:
            raise ValueError(f"{name}: the map is not complete, its progress is {self.progress:.1%}; must be a complete map")

    def in_well_units(self) -> EscapeMap:
        """Return the map with coordinates, energies and times in units of the well. Its `batch` is always in these units."""
        units, spec = self.spec.potential.units, self.spec.in_well_units()
        x_unit, ordinate_unit = self.spec.plane.axis_units(units)
        return replace(units.inverse.restore(self), spec=spec, x=self.x / x_unit, ordinate=self.ordinate / ordinate_unit)

    def restored(self, spec: MapSpec) -> EscapeMap:
        """Convert this map from units of the well to the units of the request from which it was made."""
        return replace(spec.plane.restore(self, spec.potential.units), spec=spec)

    def coordinates(self, pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return x and ordinate of the centres of n pixels, which are numbered row by row from 0, of shape (n,) each."""
        rows, columns = np.divmod(pixels, self.x.size)
        return self.x[columns], self.ordinate[rows]

    def fractions(self, *, count_outside: bool = False) -> dict[int, float]:
        """Return the share of the starts for each outcome that can occur, and for `Fate.BOUNDED`, `NOT_COMPUTED` and `FAILED`.

        Parameters
        ----------
        count_outside
            Whether outside starts count as escaped, with the outcome `outside`, as in the percentages of Zotos (2014). The shares
            then depend on the window. By default, the shares are those of the interior starts.
        """
        fate = self.fate
        if checked_flag("count_outside", count_outside):
            fate = np.where(fate == Fate.OUTSIDE, self.outside, fate)
        return outcome_shares(fate, self.spec.outcomes)

    def thinned(self) -> tuple[dict[str, np.ndarray], Window]:
        """Return fate, escape_time, crossings and evidence of one started pixel per square of `stride` pixels a side.

        Returns
        -------
        The arrays, with a row for each row of squares, and the window that the squares cover. This window can extend beyond the
        window of the map by less than one square, because the last squares may be incomplete.
        """
        names, window = ("fate", "escape_time", "crossings", "evidence"), self.spec.find_window()
        if self.stride == 1:
            return {name: getattr(self, name) for name in names}, window
        grid = np.ix_(*(np.unique(representative_indices(size, self.stride)) for size in self.fate.shape))
        arrays = {name: getattr(self, name)[grid] for name in names}
        rows, columns = arrays["fate"].shape
        x_high = window.x_low + window.width * columns * self.stride / self.fate.shape[1]
        ordinate_high = window.ordinate_low + window.height * rows * self.stride / self.fate.shape[0]
        return arrays, Window(window.x_low, x_high, window.ordinate_low, ordinate_high)

    def to_xarray(self) -> xr.Dataset:
        """Return the map as a dataset with named axes, units and provenance, which can be written as NetCDF."""
        fates = describe_codes(Fate, [outcome.label for outcome in self.outcomes])
        variables = {
            "fate": (self.fate, {"long_name": "exit channel (k >= 1) or outcome code", **fates}),
            "escape_time": (self.escape_time, {"long_name": "escape time", "units": "1"}),
            "crossings": (self.crossings, {"long_name": f"{self.spec.section.crossings_name} before escape"}),
            "energy_error": (self.energy_error, {"long_name": "relative energy error", "units": "1"}),
            "outside": (self.outside, {"long_name": "exit beyond which the start lies, 0 inside"}),
            "evidence": (self.evidence, {"long_name": "why the orbit is bounded", **describe_codes(Evidence)}),
        }
        attributes = {"result": "EscapeMap", **self.provenance(), "outcomes": write_outcomes(self.outcomes)}
        return pixel_dataset(self.spec, (self.x, self.ordinate), variables, attributes)

    def to_html(self, path: str | os.PathLike[str], **options: Any) -> None:
        """Write a live figure: one HTML file that needs no server, in which its reader changes the energy and the window.

        Parameters
        ----------
        path
            The file, which is replaced.
        options
            ``energies``: lowest and highest energy of the figure; ``starts``: (x, ordinate) of orbits, at most five; ``picture``
            shown first: ``"basins"``, ``"times"`` or ``"crossings"``; ``caption``; ``link``: address of the view in an explorer;
            ``palette``: ``"safe"`` or ``"paper"``; ``title``: heading, by default system and slice.

        Raises
        ------
        TypeError
            If an option does not exist.
        ValueError
            If the map is not complete, has an axis that is a parameter, or an option is not legal.
        """
        write_live_figure(self, path, options)

    def provenance(self) -> dict[str, Any]:
        """Return the provenance of the map in plain values: request, integrator, version, worst energy error, pixels per fate."""
        codes, counts = np.unique(self.fate, return_counts=True)
        return {
            **self.spec.provenance(),
            "worst_energy_error": self.worst_energy_error,
            "complete": int(self.complete),
            "counts": "; ".join(f"{code}: {count}" for code, count in zip(codes, counts, strict=True)),
            **({} if self.rounded_share is None else {"rounded_share": self.rounded_share}),
        }


def pixel_dataset(
    spec: MapSpec,
    centres: tuple[np.ndarray, np.ndarray],
    variables: Mapping[str, tuple[np.ndarray, dict[str, str]]],
    attributes: Mapping[str, Any],
) -> xr.Dataset:
    """Return arrays (rows, columns), each with its attributes, as a dataset with named axes."""
    # The import is slow and seldom needed.
    import xarray as xr

    names = spec.plane.axis_names[::-1]
    arrays = {name: (names, values, meaning) for name, (values, meaning) in variables.items()}
    coordinates = {name: (name, places, {"units": "1"}) for name, places in zip(names, centres[::-1], strict=True)}
    return xr.Dataset(arrays, coordinates, attributes)


def collect_map(
    spec: MapSpec, centres: tuple[np.ndarray, np.ndarray], arrays: Mapping[str, np.ndarray], **stage: Any
) -> EscapeMap:
    """Return a map with read-only views of `PIXEL_ARRAYS`. `stage` is its `stride`, `horizon` and `progress`."""
    x, ordinate = centres
    complete = bool(arrays["started"].all() and not np.any(arrays["fate"] == Fate.NOT_COMPUTED))
    pixels: dict[str, Any] = {name: array.reshape(ordinate.size, x.size) for name, array in arrays.items()}
    return EscapeMap(spec=spec, x=x, ordinate=ordinate, complete=complete, **pixels, **stage)


def outcome_shares(fate: np.ndarray, outcomes: Sequence[Outcome]) -> dict[int, float]:
    """Return, by code, the share of each outcome that can occur among the interior starts, given fates of any shape.

    Without interior starts, all shares are 0.
    """
    interior = fate[find_interior(fate)]
    outcome_codes = (code for code, outcome in enumerate(outcomes, 1) if outcome.occurs)
    codes = (*outcome_codes, Fate.BOUNDED, Fate.NOT_COMPUTED, Fate.FAILED)
    return {int(code): float(np.mean(interior == code)) if interior.size else 0.0 for code in codes}


def find_interior(fate: np.ndarray) -> np.ndarray:
    """Return whether starts are neither forbidden nor outside, given fates of any shape."""
    return (fate != Fate.FORBIDDEN) & (fate != Fate.OUTSIDE)


def representative_indices(size: int, stride: int) -> np.ndarray:
    """Return, for each of `size` indices, the index that represents its block of `stride` indices, of shape (size,).

    This is the middle of the block or, if the last block is too short to have it, the last index.
    """
    return np.minimum(np.arange(size) // stride * stride + stride // 2, size - 1)


def as_complete_map(name: str, value: Any) -> EscapeMap:
    """Return a complete map, given as an `EscapeMap` or as its dataset: that of a file, or ``dataset.sel(h=0.3)`` of a sweep.

    Raises
    ------
    ValueError
        If the value is neither, is a dataset of several maps, or is not complete. The message contains `name` as the parameter.
    """
    legal = "an EscapeMap, or a dataset of one"
    escape_map = value if isinstance(value, EscapeMap) else read_map(checked_dataset(name, value, _STORED_ARRAYS, legal))
    escape_map.check_complete(name)
    return escape_map


def read_map(dataset: xr.Dataset) -> EscapeMap:
    """Return the map of a dataset. It has no integration state, so it cannot be resumed."""
    spec = read_spec(dataset)
    abscissa, ordinate = spec.plane.axis_names
    arrays: dict[str, Any] = {name: np.array(dataset[name].values) for name in _STORED_ARRAYS}
    started = arrays["fate"] != Fate.NOT_COMPUTED
    return EscapeMap(
        spec=spec, x=np.array(dataset[abscissa].values), ordinate=np.array(dataset[ordinate].values),
        stride=1, horizon=spec.t_max, progress=float(started.mean()), complete=bool(started.all()), started=started,
        rounded_share=float(dataset.attrs["rounded_share"]) if "rounded_share" in dataset.attrs else None, **arrays,
    )  # fmt: skip
