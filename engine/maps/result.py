"""A map of escapes: the result, and what can be read off it."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

import numpy as np
import xarray as xr

from engine.dynamics.batch import OrbitBatch
from engine.dynamics.certificates import Certificate
from engine.dynamics.fates import Fate, Trust
from engine.dynamics.planes import Window
from engine.maps.spec import MapSpec

IMAGES: dict[str, tuple[type, float]] = {
    "fate": (np.int8, Fate.NOT_COMPUTED),
    "escape_time": (np.float64, np.nan),
    "crossings": (np.int32, 0),
    "energy_error": (np.float64, np.nan),
    "certificate": (np.int8, Certificate.NONE),
    "outside": (np.int8, 0),
    "started": (np.bool_, False),
}
"""The arrays of a map that have a number for each pixel: their type, and the number where nothing is known."""


@dataclass(frozen=True, eq=False)
class EscapeMap:
    """A map, finished or on its way; arrays are (rows, columns) with row 0 lowest, and read-only.

    Attributes
    ----------
    spec
        What was asked for.
    x, ordinate
        (columns,), (rows,) pixel centres.
    fate, escape_time, crossings, energy_error
        As in `Outcomes`; pixels not decided yet are `Fate.NOT_COMPUTED`.
    certificate
        int8, the `Certificate` of each bounded orbit: what that word rests on. Crossings and energy error of an orbit
        that was not followed to t_max count as far as it was.
    outside
        int8, the channel beyond whose Lyapunov orbit the start lies, 0 inside.
    stride
        Of each square of this many pixels a side at least one has been started; 1 when all have.
    horizon
        Time to which this stage follows orbits; t_max in the last one.
    progress
        Share of the work that is certainly done, 0 to 1: undecided orbits count by the time they have covered.
    complete
        Whether every pixel is decided.
    started
        bool, the pixels whose orbits have been started.
    batch
        State to go on from with ``resume``; None in frames.
    trust
        (rows, columns) int8, the `Trust` of each pixel where it was asked for; else None.
    """

    spec: MapSpec
    x: np.ndarray
    ordinate: np.ndarray
    fate: np.ndarray
    escape_time: np.ndarray
    crossings: np.ndarray
    energy_error: np.ndarray
    certificate: np.ndarray
    outside: np.ndarray
    stride: int
    horizon: float
    progress: float
    complete: bool
    started: np.ndarray = field(repr=False)
    batch: OrbitBatch | None = field(default=None, repr=False)
    trust: np.ndarray | None = field(default=None, repr=False)

    @property
    def interior(self) -> np.ndarray:
        """(rows, columns) bool, the starts that exist and are not outside."""
        return find_interior(self.fate)

    @property
    def undecided(self) -> float:
        """Share of the interior starts whose fate is still open."""
        return float(np.mean(self.fate[self.interior] == Fate.NOT_COMPUTED)) if self.interior.any() else 0.0

    @property
    def worst_energy_error(self) -> float:
        """Largest relative energy error of any decided orbit; NaN when there is none."""
        errors = self.energy_error[np.isfinite(self.energy_error)]
        return float(errors.max()) if errors.size else float("nan")

    @property
    def nbytes(self) -> int:
        """Bytes held by the arrays, the state to go on from included."""
        images: list[np.ndarray] = [getattr(self, name) for name in IMAGES]
        images += [self.trust] if self.trust is not None else []
        return sum(image.nbytes for image in images) + (self.batch.nbytes if self.batch else 0)

    def fractions(self, *, count_outside: bool = False) -> dict[int, float]:
        """Share of the starts for each channel, and for `Fate.BOUNDED`, `NOT_COMPUTED` and `FAILED`.

        Out of the interior starts; with `count_outside` starts outside count as escaped at once through the channel they
        lie in, as the paper's percentages do (they then depend on the window).
        """
        fate = self.fate
        if count_outside:
            fate = np.where(fate == Fate.OUTSIDE, self.outside, fate)
        fate = fate[find_interior(fate)]
        codes = (*range(1, self.spec.potential.channels + 1), Fate.BOUNDED, Fate.NOT_COMPUTED, Fate.FAILED)
        return {int(code): float(np.mean(fate == code)) if fate.size else 0.0 for code in codes}

    def thinned(self) -> tuple[dict[str, np.ndarray], Window]:
        """fate, escape_time, crossings and certificate of the one pixel that stands for each square of `stride`.

        Returns
        -------
        The images, (rows, columns) over `stride` rounded up, and the window that they fill: up to a square larger than the
        map's, as the last squares may reach beyond it.
        """
        names = ("fate", "escape_time", "crossings", "certificate")
        if self.stride == 1:
            return {name: getattr(self, name) for name in names}, self.spec.window
        places = np.ix_(*(np.unique(anchors(size, self.stride)) for size in self.fate.shape))
        images = {name: getattr(self, name)[places] for name in names}
        (rows, columns), window = images["fate"].shape, self.spec.window
        x_high = window.x_low + (window.x_high - window.x_low) * columns * self.stride / self.fate.shape[1]
        high = window.ordinate_low + (window.ordinate_high - window.ordinate_low) * rows * self.stride / self.fate.shape[0]
        return images, Window(window.x_low, x_high, window.ordinate_low, high)

    def to_xarray(self) -> xr.Dataset:
        """The map with named axes, units and provenance, fit for NetCDF."""
        spec = self.spec
        dims = (spec.plane.ordinate, "x")
        variables = {
            "fate": (dims, self.fate, {"long_name": "exit channel (k >= 1) or outcome code", **describe_codes(Fate)}),
            "escape_time": (dims, self.escape_time, {"long_name": "escape time", "units": "1"}),
            "crossings": (dims, self.crossings, {"long_name": "upward crossings of y = 0 before escape"}),
            "outside": (dims, self.outside, {"long_name": "channel beyond whose Lyapunov orbit the start lies, 0 inside"}),
            "certificate": (dims, self.certificate, {"long_name": "what bounded rests on", **describe_codes(Certificate)}),
            "energy_error": (dims, self.energy_error, {"long_name": "relative energy error", "units": "1"}),
        }
        if self.trust is not None:
            variables["trust"] = (dims, self.trust, {"long_name": "whether the answer survives", **describe_codes(Trust)})
        coordinates = {
            spec.plane.ordinate: (spec.plane.ordinate, self.ordinate, {"units": "1"}),
            "x": ("x", self.x, {"units": "1"}),
        }
        return xr.Dataset(variables, coordinates, self.provenance())

    def provenance(self) -> dict[str, Any]:
        """What made this map, in plain values: the request, the integrator, its version, the worst energy error, the counts."""
        codes, counts = np.unique(self.fate, return_counts=True)
        return {
            **self.spec.provenance(),
            "worst_energy_error": self.worst_energy_error,
            "complete": int(self.complete),
            "counts": "; ".join(f"{code}: {count}" for code, count in zip(codes, counts, strict=True)),
        }


def describe_codes(codes: type[IntEnum]) -> dict[str, str]:
    """The attribute of a labelled array that tells what its codes mean."""
    return {"codes": "; ".join(f"{code.value}: {code.name.lower()}" for code in codes)}


def find_interior(fate: np.ndarray) -> np.ndarray:
    """bool, shaped like the codes: the starts that exist and are not outside."""
    interior: np.ndarray = (fate != Fate.FORBIDDEN) & (fate != Fate.OUTSIDE)
    return interior


def anchors(size: int, stride: int) -> np.ndarray:
    """For each index the one that stands for its square."""
    return np.minimum(np.arange(size) // stride * stride + stride // 2, size - 1)
