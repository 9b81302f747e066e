"""The request for a stored sweep: maps at many energies on one plane and in one window."""

from __future__ import annotations

import operator
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.maps.compute import LARGEST_RUN
from engine.maps.spec import DEFAULT_RESOLUTION, MapSpec
from engine.potentials.potential import Potential
from engine.slices.default_window import map_window
from engine.slices.slice import Slice
from engine.slices.window import GivenWindow
from engine.sweeps.energy_grid import checked_sweep

MOST_SWEPT_ENERGIES = 10_000
"""Most energies of a stored sweep; each takes several files per array."""


@dataclass(frozen=True)
class SweepSpec:
    """A sweep of maps over energies on one plane and in one window, so that its result is one array per variable.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        A slice without an axis h, such as (x, y) or (x, px).
    energies
        h, finite, dimensionless, 1 to 10 000 of them; sorted and made unique.
    resolution
        (columns, rows) of the map at each energy, each 1 to 4096.
    window
        As in `MapSpec`, for all energies; None for the default window of the highest energy. In the three cases the interior
        grows with h on both planes, so that this window contains the default windows of all other energies.
    t_max
        Integration time, dimensionless, 0 < t_max ≤ 1e8.
    certify
        As in `MapSpec`.
    piece
        Largest number of starts per row block, 1 to 1 048 576. A block is computed and stored as a whole, and is what a killed
        run loses. None for the largest, with which each map is bit-identical to `compute_map`. Smaller blocks leave fates, escape
        times and the crossings of escaping orbits unchanged, unless a certificate errs, which is rare (docs/long-runs.md). The
        certificate of a bounded orbit may change, because invariant curves are only compared with orbits of their own block, and
        with it its crossings and energy error, which are those up to the time it was integrated.

    Raises
    ------
    ValueError
        Naming the parameter, its value and what is legal.
    """

    potential: Potential
    plane: Slice
    energies: Sequence[float] | np.ndarray
    resolution: tuple[int, int] = DEFAULT_RESOLUTION
    window: GivenWindow | None = None
    t_max: float = 1e5
    certify: bool = True
    piece: int | None = None

    def __post_init__(self) -> None:
        plane, energies = checked_sweep(self.plane, self.energies, MOST_SWEPT_ENERGIES)
        piece = _checked_piece(self.piece)
        highest = MapSpec(self.potential, plane, energies[-1], self.resolution, self.window, self.t_max, self.certify)
        object.__setattr__(self, "energies", energies)
        object.__setattr__(self, "piece", piece)
        for name in ("plane", "resolution", "window", "t_max", "certify"):
            object.__setattr__(self, name, getattr(highest, name))

    def map_spec(self, energy: float) -> MapSpec:
        """The spec of the map at one energy."""
        window = self.window or map_window(self.potential, self.plane, self.energies[-1], self.resolution)
        return MapSpec(self.potential, self.plane, energy, self.resolution, window, self.t_max, self.certify)

    def provenance(self) -> dict[str, Any]:
        """The request as plain values, without the energies; see `MapSpec.provenance`."""
        common = self.map_spec(self.energies[-1]).provenance()
        return {**{name: value for name, value in common.items() if name != "energy"}, "piece": self.piece or LARGEST_RUN}

    def coordinates(self) -> dict[str, np.ndarray]:
        """h (energies,), ordinate (rows,), abscissa (columns,): the coordinates of the arrays, in order."""
        x, ordinate = self.map_spec(self.energies[-1]).pixel_centres()
        abscissa_name, ordinate_name = self.plane.axis_names
        return {"h": np.array(self.energies), ordinate_name: ordinate, abscissa_name: x}

    @property
    def orbits(self) -> int:
        """Number of starts at all energies, including forbidden ones and those outside."""
        return len(self.energies) * self.resolution[0] * self.resolution[1]


def _checked_piece(piece: Any) -> int | None:
    if piece is None:
        return None
    try:
        checked = operator.index(piece)
    except TypeError:
        checked = 0
    if not 1 <= checked <= LARGEST_RUN:
        raise ValueError(f"piece={piece!r}: must be an integer from 1 to {LARGEST_RUN}, or None")
    return checked
