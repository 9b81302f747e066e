"""The part of a lattice on which V is below the energy, and which paths join to the origin without crossing an exit."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import ndimage

from tests.peers.sampled_paths import Exits
from tests.referee.own_system import OwnSystem

_SIDE = 401
# Number of points between two points of an exit.
_BETWEEN = 40
_BLOCK = np.ones((3, 3))


@dataclass(frozen=True)
class Lattice:
    """A square lattice of points around the origin; `reach` is half its side."""

    system: OwnSystem
    energy: float
    exits: Exits
    reach: float

    @property
    def side(self) -> np.ndarray:
        return np.linspace(-self.reach, self.reach, _SIDE)

    @property
    def step(self) -> float:
        return 2.0 * self.reach / (_SIDE - 1)

    @cached_property
    def is_allowed(self) -> np.ndarray:
        return self.system.value(self.side[:, None], self.side) < self.energy

    @cached_property
    def surely_inside(self) -> np.ndarray:
        """Whether points are inside also if walls and exits are a step thicker."""
        return _joined(ndimage.binary_erosion(self.is_allowed, _BLOCK) & ~self._near_exits)

    @cached_property
    def perhaps_inside(self) -> np.ndarray:
        """Whether points are inside if walls are a step thinner, or near an exit."""
        return _joined(ndimage.binary_dilation(self.is_allowed, _BLOCK) & ~self._on_exits) | self._near_exits

    def points(self, mask: np.ndarray) -> np.ndarray:
        """Return the points of a mask, (n, 2)."""
        return self.side[np.argwhere(mask)]

    @cached_property
    def _near_exits(self) -> np.ndarray:
        return ndimage.binary_dilation(self._on_exits, _BLOCK)

    @cached_property
    def _on_exits(self) -> np.ndarray:
        found = np.zeros((_SIDE, _SIDE), bool)
        for path in self.exits.paths:
            steps = np.arange(0.0, len(path) - 1.0, 1.0 / _BETWEEN)
            points = np.column_stack([np.interp(steps, np.arange(len(path)), coordinate) for coordinate in path.T])
            places = np.rint((points + self.reach) / self.step).astype(int)
            within = ((places >= 0) & (places < _SIDE)).all(axis=1)
            found[tuple(places[within].T)] = True
        return found


def _joined(mask: np.ndarray) -> np.ndarray:
    """Return the part of a mask that contains the origin."""
    parts, _ = ndimage.label(mask)
    middle = _SIDE // 2
    return mask & (parts == parts[middle, middle])
