"""Curves against energy: shares of the exits, basin entropies, uncertainty exponent and escape times."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from engine.dynamics.fates import Fate
from engine.execution import DEFAULT_EXECUTION, Execution, shows_progress
from engine.maps.compute import run_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.measures.basin_entropy import compute_basin_entropy
from engine.measures.escape_statistics import compute_statistics
from engine.measures.uncertainty_exponent import WORK, compute_uncertainty_exponent
from engine.potentials.potential import Potential
from engine.results.result import Result
from engine.slices.slice import Slice
from engine.sweeps.complete_map import require_complete
from engine.sweeps.energy_grid import checked_sweep

if TYPE_CHECKING:
    import xarray as xr

MOST_ENERGIES = 1000
"""Most energies of one sweep."""

# A tenth of the work for a single map: about ten times faster, with intervals up to three times as wide.
_WORK = 0.1 * WORK


@dataclass(frozen=True)
class EnergyPointSpec:
    """The measurement at one energy.

    Attributes
    ----------
    map_spec
        The map to evaluate.
    exponent
        Whether to compute the uncertainty exponent, which takes longest.
    """

    map_spec: MapSpec
    exponent: bool


@dataclass(frozen=True)
class EnergyCurvesSpec:
    """A sweep over energies on one plane; the map at each energy has the default window, which contains the whole interior.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        A slice without an axis h, such as (x, y) or (x, px).
    energies
        h, finite, dimensionless, 1 to 1000 of them; sorted and made unique.
    resolution
        (columns, rows) of the map at each energy.
    t_max
        Integration time, dimensionless, 0 < t_max ≤ 1e8.
    exponent
        Whether to compute the uncertainty exponent.

    Raises
    ------
    ValueError
        Naming the parameter, its value and what is legal.
    """

    potential: Potential
    plane: Slice
    energies: tuple[float, ...]
    resolution: tuple[int, int] = (112, 112)
    t_max: float = 1e5
    exponent: bool = True

    def __post_init__(self) -> None:
        plane, energies = checked_sweep(self.plane, self.energies, MOST_ENERGIES)
        object.__setattr__(self, "plane", plane)
        object.__setattr__(self, "energies", energies)
        # Validates the other parameters.
        MapSpec(self.potential, self.plane, energies[0], self.resolution, t_max=self.t_max)

    def point(self, energy: float) -> EnergyPointSpec:
        """The measurement at one energy."""
        return EnergyPointSpec(MapSpec(self.potential, self.plane, energy, self.resolution, t_max=self.t_max), self.exponent)


@dataclass(frozen=True)
class EnergyPoint:
    """Measured values at one energy, dimensionless.

    Attributes
    ----------
    energy
        h.
    shares
        (channels + 1,) shares of the interior starts: bounded, then those that escape through channel 1, 2, ….
    direct_share
        Share of the interior starts that escape without an upward crossing of y = 0.
    mean_escape_time, median_escape_time
        Over the escaping orbits; NaN if there are none.
    s_b, s_bb
        Basin entropy and boundary basin entropy; see `compute_basin_entropy`.
    exponent, exponent_low, exponent_high
        Uncertainty exponent and its 95 % interval; see `compute_uncertainty_exponent`. NaN if undetermined or not requested.
    nbytes
        Approximate size in bytes, including the request.
    """

    energy: float
    shares: tuple[float, ...]
    direct_share: float
    mean_escape_time: float
    median_escape_time: float
    s_b: float
    s_bb: float
    exponent: float = math.nan
    exponent_low: float = math.nan
    exponent_high: float = math.nan
    nbytes: ClassVar[int] = 1024


_CURVES = tuple(field.name for field in fields(EnergyPoint) if field.name not in ("energy", "shares"))


@dataclass(frozen=True, eq=False)
class EnergyCurves(Result):
    """The points of a sweep measured so far, by ascending energy."""

    spec: EnergyCurvesSpec
    points: tuple[EnergyPoint, ...]

    def columns(self) -> Mapping[str, np.ndarray]:
        """All curves by name, the energy h first; the share of bounded orbits is ``share_0``."""
        shares = {f"share_{code}": share for code, share in enumerate(self.shares.T)}
        return {"h": self.energies, **shares, **{name: self.curve(name) for name in _CURVES}}

    @property
    def complete(self) -> bool:
        """Whether all energies have been measured."""
        return len(self.points) == len(self.spec.energies)

    @property
    def nbytes(self) -> int:
        """Approximate size in bytes."""
        return sum(point.nbytes for point in self.points)

    @property
    def energies(self) -> np.ndarray:
        """(n,) energies h of the points."""
        return np.array([point.energy for point in self.points])

    @property
    def shares(self) -> np.ndarray:
        """(n, channels + 1) share of bounded orbits, then of each channel."""
        channels = self.spec.potential.channels
        return np.array([point.shares for point in self.points]).reshape(-1, channels + 1)

    def curve(self, name: str) -> np.ndarray:
        """(n,) any other attribute of `EnergyPoint`, by its name."""
        return np.array([getattr(point, name) for point in self.points], dtype=float)

    def to_xarray(self) -> xr.Dataset:
        """All curves as a dataset with coordinates and provenance."""
        # Slow to import, and seldom used.
        import xarray as xr

        variables: dict[str, Any] = {"share": (("h", "fate"), self.shares)}
        variables |= {name: ("h", self.curve(name)) for name in _CURVES}
        coordinates = {"h": self.energies, "fate": np.arange(self.spec.potential.channels + 1)}
        made_by = self.spec.point(self.spec.energies[0]).map_spec.provenance()
        return xr.Dataset(variables, coordinates, {name: made_by[name] for name in made_by if name not in ("energy", "window")})


@shows_progress("energy curves")
def compute_energy_curves(
    spec: EnergyCurvesSpec,
    *,
    on_frame: Callable[[EnergyCurves], None] | None = None,
    execution: Execution = DEFAULT_EXECUTION,
    measure: Callable[[EnergyPointSpec], EnergyPoint] | None = None,
) -> EnergyCurves:
    """Measure exits and basins at many energies, in an order from coarse to fine.

    Parameters
    ----------
    spec
        The request.
    on_frame
        Called in this thread after each energy with the points so far.
    execution
        How the computation runs.
    measure
        Replaces `compute_energy_point`, for example to use a cache; None to compute all energies.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When no exit is defined at one of the energies.

    Examples
    --------
    >>> from engine import CASES, EnergyCurvesSpec, Plane, compute_energy_curves
    >>> spec = EnergyCurvesSpec(CASES["III"], Plane.X_PX, (0.4, 0.5, 0.6), (40, 40), t_max=1e3, exponent=False)
    >>> compute_energy_curves(spec).to_pandas()[["h", "share_1", "share_2"]].round(3)
         h  share_1  share_2
    0  0.4    0.354    0.354
    1  0.5    0.399    0.399
    2  0.6    0.441    0.441
    """
    points: list[EnergyPoint] = []
    for index in _coarse_to_fine(len(spec.energies)):
        point_spec = spec.point(spec.energies[index])
        part = execution.part(len(points), len(spec.energies))
        points.append(measure(point_spec) if measure is not None else compute_energy_point(point_spec, execution=part))
        curves = EnergyCurves(spec, tuple(sorted(points, key=lambda point: point.energy)))
        if on_frame is not None:
            on_frame(curves)
        execution.report(lambda: len(points) / len(spec.energies))
    return curves


def compute_energy_point(
    spec: EnergyPointSpec,
    *,
    execution: Execution = DEFAULT_EXECUTION,
    frame: EscapeMap | None = None,
) -> EnergyPoint:
    """Measure one energy.

    Parameters
    ----------
    spec
        The request.
    execution
        As in `compute_energy_curves`.
    frame
        The complete map of `spec.map_spec`; None to compute it.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    """
    if frame is None:
        frame = run_map(spec.map_spec, execution.part(0, 2))
    point = _evaluate_map(require_complete(frame))
    open_channels = spec.map_spec.potential.open_channels(point.energy)
    if not (spec.exponent and open_channels):
        return point
    found = compute_uncertainty_exponent(spec.map_spec, work=_WORK, execution=execution.part(1, 2))
    return replace(point, exponent=found.exponent, exponent_low=found.low, exponent_high=found.high)


def _evaluate_map(frame: EscapeMap) -> EnergyPoint:
    assert frame.spec.common_energy is not None
    statistics = compute_statistics(frame)
    shares = statistics.shares
    entropy = compute_basin_entropy(frame)
    return EnergyPoint(
        energy=frame.spec.common_energy,
        shares=tuple(shares[code] for code in (Fate.BOUNDED, *range(1, frame.spec.potential.channels + 1))),
        direct_share=statistics.direct_share,
        mean_escape_time=statistics.mean_escape_time,
        median_escape_time=statistics.median_escape_time,
        s_b=entropy.s_b,
        s_bb=entropy.s_bb,
    )


def _coarse_to_fine(count: int) -> list[int]:
    """0 to count − 1, ends first and then repeatedly the midpoints, so that the curves take shape early."""
    order, step = [0, count - 1] if count > 1 else [0], 1 << (count - 1).bit_length()
    while step > 1:
        step //= 2
        order += range(step, count, 2 * step)
    return list(dict.fromkeys(order))
