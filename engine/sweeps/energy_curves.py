"""Against energy: shares of the exits, basin entropies, uncertainty exponent and escape times over many values of h."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError, Executor
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import xarray as xr

from engine.basins.basin_entropy import compute_basin_entropy
from engine.basins.labels import ENTROPY_COUNTS_BOUNDED, exit_labels
from engine.basins.uncertainty_exponent import WORK, UncertaintyExponent, compute_uncertainty_exponent
from engine.dynamics.fates import Fate
from engine.dynamics.planes import Plane
from engine.maps.compute import compute_map
from engine.maps.result import EscapeMap
from engine.maps.spec import MapSpec
from engine.potentials.potential import Potential
from engine.statistics.escape_statistics import compute_statistics
from engine.sweeps.energy_grid import checked_sweep

MOST_ENERGIES = 1000
"""Most energies of one sweep."""

# A tenth of what a single map is worth: some ten times faster, with intervals up to three times as wide.
_WORK = 0.1 * WORK


@dataclass(frozen=True)
class EnergyPointSpec:
    """What is measured at one energy: `map_spec`, and whether the uncertainty exponent, which takes longest, is among it."""

    map_spec: MapSpec
    exponent: bool


@dataclass(frozen=True)
class EnergyCurvesSpec:
    """A sweep over energies on one plane, each energy with the window that shows its whole interior.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        (x, y) or (x, px).
    energies
        h, finite, dimensionless, 1 to 1000 of them; sorted and made unique.
    resolution
        (columns, rows) of the map at each energy.
    t_max
        How long orbits are followed, 0 < t_max ≤ 1e8.
    exponent
        Whether to measure the uncertainty exponent, too.

    Raises
    ------
    ValueError
        Naming the parameter, its value and what is legal.
    """

    potential: Potential
    plane: Plane
    energies: tuple[float, ...]
    resolution: tuple[int, int] = (113, 113)
    t_max: float = 1e5
    exponent: bool = True

    def __post_init__(self) -> None:
        plane, energies = checked_sweep(self.plane, self.energies, MOST_ENERGIES)
        object.__setattr__(self, "plane", plane)
        object.__setattr__(self, "energies", energies)
        # Says what is wrong with the rest before anything is computed.
        MapSpec(self.potential, self.plane, energies[0], self.resolution, t_max=self.t_max)

    def point(self, energy: float) -> EnergyPointSpec:
        """The part of it at one energy."""
        return EnergyPointSpec(MapSpec(self.potential, self.plane, energy, self.resolution, t_max=self.t_max), self.exponent)


@dataclass(frozen=True)
class EnergyPoint:
    """What was measured at one energy; dimensionless.

    Attributes
    ----------
    energy
        h.
    shares
        (channels + 1,) of the interior starts: bounded, then channel 1, 2, ….
    direct_share
        Of the interior starts, those that leave without crossing y = 0 upward.
    mean_escape_time, median_escape_time
        Of those that leave; NaN when none does.
    s_b, s_bb
        Basin entropy and boundary entropy, `compute_basin_entropy`.
    exponent, exponent_low, exponent_high
        Uncertainty exponent with its 95 % interval, `compute_uncertainty_exponent`; NaN where it is not determined, or was not
        asked for.
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
    nbytes: int = 1024
    """About what it takes together with its request."""


_CURVES = tuple(field.name for field in fields(EnergyPoint) if field.name not in ("energy", "shares", "nbytes"))


@dataclass(frozen=True, eq=False)
class EnergyCurves:
    """A sweep, finished or on its way: what is known so far, by rising energy."""

    spec: EnergyCurvesSpec
    points: tuple[EnergyPoint, ...]

    @property
    def complete(self) -> bool:
        """Whether every energy is measured."""
        return len(self.points) == len(self.spec.energies)

    @property
    def nbytes(self) -> int:
        """Bytes held."""
        return sum(point.nbytes for point in self.points)

    @property
    def energies(self) -> np.ndarray:
        """(n,) h of the points."""
        return np.array([point.energy for point in self.points])

    @property
    def shares(self) -> np.ndarray:
        """(n, channels + 1) shares of bounded starts and of each channel."""
        channels = self.spec.potential.channels
        return np.array([point.shares for point in self.points]).reshape(-1, channels + 1)

    def curve(self, name: str) -> np.ndarray:
        """(n,) any other attribute of `EnergyPoint` against energy."""
        return np.array([getattr(point, name) for point in self.points], dtype=float)

    def to_xarray(self) -> xr.Dataset:
        """All curves with named axes and what made them."""
        variables: dict[str, Any] = {"share": (("h", "fate"), self.shares)}
        variables |= {name: ("h", self.curve(name)) for name in _CURVES}
        coordinates = {"h": self.energies, "fate": np.arange(self.spec.potential.channels + 1)}
        made_by = self.spec.point(self.spec.energies[0]).map_spec.provenance()
        return xr.Dataset(variables, coordinates, {name: made_by[name] for name in made_by if name not in ("energy", "window")})


def compute_energy_curves(
    spec: EnergyCurvesSpec,
    on_frame: Callable[[EnergyCurves], None] | None = None,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
    *,
    measure: Callable[[EnergyPointSpec], EnergyPoint] | None = None,
) -> EnergyCurves:
    """Measure the exits at many energies, coarsely spread ones first.

    Parameters
    ----------
    spec
        The request.
    on_frame
        Called in this thread with what is known so far, after each energy.
    cancel
        When set, the work stops within about 0.2 s.
    executor
        Any `concurrent.futures.Executor`; None for the pool of this process.
    measure
        How a single energy is measured, to look it up where it is kept; None to compute all of them.

    Raises
    ------
    concurrent.futures.CancelledError
        When cancelled.
    ValueError
        When no exit is defined at one of the energies.
    """
    found: list[EnergyPoint] = []
    for place in _coarse_to_fine(len(spec.energies)):
        point_spec = spec.point(spec.energies[place])
        found.append(measure(point_spec) if measure is not None else compute_energy_point(point_spec, cancel, executor))
        curves = EnergyCurves(spec, tuple(sorted(found, key=lambda point: point.energy)))
        if on_frame is not None:
            on_frame(curves)
    return curves


def compute_energy_point(
    spec: EnergyPointSpec,
    cancel: threading.Event | None = None,
    executor: Executor | None = None,
    *,
    whole_map: EscapeMap | None = None,
) -> EnergyPoint:
    """What is to be known of one energy.

    Parameters
    ----------
    spec
        The request.
    cancel, executor
        As of `compute_energy_curves`.
    whole_map
        The complete map of `spec.map_spec`, where there is one already.
    """
    frame = compute_map(spec.map_spec, None, cancel, executor) if whole_map is None else whole_map
    if not frame.complete:
        raise CancelledError
    point = _read_map(frame)
    open_channels = spec.map_spec.potential.open_channels(point.energy)
    if not (spec.exponent and open_channels):
        return point
    found = compute_uncertainty_exponent(spec.map_spec, work=_WORK, executor=executor, cancel=cancel)
    return _with_exponent(point, found)


def _read_map(frame: EscapeMap) -> EnergyPoint:
    assert not isinstance(frame.spec.energy, tuple)
    statistics = compute_statistics(frame)
    shares = statistics.shares
    entropy = compute_basin_entropy(*exit_labels(frame.fate, bounded=ENTROPY_COUNTS_BOUNDED))
    return EnergyPoint(
        energy=frame.spec.energy,
        shares=tuple(shares[code] for code in (Fate.BOUNDED, *range(1, frame.spec.potential.channels + 1))),
        direct_share=statistics.direct_share,
        mean_escape_time=statistics.mean_escape_time,
        median_escape_time=statistics.median_escape_time,
        s_b=entropy.s_b,
        s_bb=entropy.s_bb,
    )


def _with_exponent(point: EnergyPoint, found: UncertaintyExponent) -> EnergyPoint:
    return replace(point, exponent=found.exponent, exponent_low=found.low, exponent_high=found.high)


def _coarse_to_fine(count: int) -> list[int]:
    """All places from 0 to count − 1, each time between those before: the curves are seen early."""
    order, step = [0, count - 1] if count > 1 else [0], 1 << (count - 1).bit_length()
    while step > 1:
        step //= 2
        order += range(step, count, 2 * step)
    return list(dict.fromkeys(order))
