"""The request for a sweep: maps at many energies on one plane and in one window, frozen and validated."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from typing import Any

import numpy as np

from engine.dynamics.planes import Plane, Window
from engine.maps.compute import LARGEST_RUN
from engine.maps.spec import MapSpec
from engine.potentials.potential import Potential
from engine.sweeps.energy_grid import checked_sweep

MOST_SWEPT_ENERGIES = 10_000
"""Most energies of a stored sweep: each is some files in every array's folder."""


@dataclass(frozen=True)
class SweepSpec:
    """A sweep of maps over energies on one plane and in one window, so that all of it is one labelled block.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        (x, y) or (x, px).
    energies
        h, finite, dimensionless, 1 to 10 000 of them; sorted and made unique.
    resolution
        (columns, rows) of the map at each energy, each 1 to 4096.
    window
        As of `MapSpec`, for all energies; None for the default window of the highest one. The interior grows with h on both
        planes of the three cases, so that this window contains those of the other energies.
    t_max
        How long orbits are followed, 0 < t_max ≤ 1e8.
    certify
        As of `MapSpec`.
    piece
        Most starts that are computed, kept and, by a kill, lost together, 1 to 1 048 576; None for the most, with which each map
        is that of `compute_map` to the bit. Larger maps are cut into bands of rows. Smaller pieces leave fates, escape times and
        the crossings of what escapes as they are, unless a certificate errs, which is rare (docs/long-runs.md). Which certificate
        a bounded orbit has may change, as invariant curves enclose orbits of their own band only, and with it the crossings and
        the energy error, which count as far as it was followed.

    Raises
    ------
    ValueError
        Naming the parameter, its value and what is legal.
    """

    potential: Potential
    plane: Plane
    energies: tuple[float, ...]
    resolution: tuple[int, int] = (225, 225)
    window: Window | None = None
    t_max: float = 1e5
    certify: bool = True
    piece: int | None = None

    def __post_init__(self) -> None:
        plane, energies = checked_sweep(self.plane, self.energies, MOST_SWEPT_ENERGIES)
        piece = _checked_piece(self.piece)
        highest = MapSpec(
            self.potential, plane, energies[-1], self.resolution, self.window, self.t_max, self.certify  # type: ignore[arg-type]
        )  # fmt: skip
        object.__setattr__(self, "energies", energies)
        object.__setattr__(self, "piece", piece)
        for name in ("plane", "resolution", "window", "t_max", "certify"):
            object.__setattr__(self, name, getattr(highest, name))

    def map_spec(self, energy: float) -> MapSpec:
        """The request for the map at one energy."""
        assert self.window is not None
        return MapSpec(self.potential, self.plane, energy, self.resolution, self.window, self.t_max, self.certify)

    def provenance(self) -> dict[str, Any]:
        """What all maps have in common, in plain values; see `MapSpec.provenance`."""
        common = self.map_spec(self.energies[-1]).provenance()
        return {**{name: value for name, value in common.items() if name != "energy"}, "piece": self.piece or LARGEST_RUN}

    def coordinates(self) -> dict[str, np.ndarray]:
        """h (energies,), y or px (rows,), x (columns,): the dimensions of the block."""
        x, ordinate = self.map_spec(self.energies[-1]).pixel_centres()
        return {"h": np.array(self.energies), self.plane.ordinate: ordinate, "x": x}

    @property
    def orbits(self) -> int:
        """How many starts there are at all energies together, forbidden and outside ones included."""
        return len(self.energies) * self.resolution[0] * self.resolution[1]


def _checked_piece(piece: Any) -> int | None:
    if piece is None:
        return None
    try:
        checked = operator.index(piece)
    except TypeError:
        checked = 0
    if not 1 <= checked <= LARGEST_RUN:
        raise ValueError(f"piece={piece!r}: must be a number of starts from 1 to {LARGEST_RUN}, or None")
    return checked
