"""Polynomial potentials with a well at the origin, and what follows from them: saddles, escape energy, channels.

A potential is a table of terms. Everything else, the compiled integrator included, is derived from that table, so a new
potential is a new entry of `CASES` and nothing else.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np

from engine.critical_points import find_critical_points
from engine.taylor.products import derivative

Terms = Mapping[tuple[int, int], float]

# A coordinate this small is a zero that rounding has touched; on the +x axis its sign would decide the channel's number.
ROUNDING = 1e-13
# Saddles this close in energy count as equally high: an escape energy is a round number computed in floating point.
SAME_ENERGY = 1e-12


@dataclass(frozen=True)
class Potential:
    """V(x, y) = Σ c x^i y^j, dimensionless, for a unit mass: H = (px² + py²)/2 + V.

    Parameters
    ----------
    name
        What people call it; has no influence on any result.
    terms
        ((i, j, c), …): exponents i, j ≥ 0 and finite coefficient c ≠ 0 of each term, each (i, j) once.

    Raises
    ------
    ValueError
        When a term has a negative exponent, a coefficient that is not finite, or stands twice.
    """

    name: str = field(compare=False)
    terms: tuple[tuple[int, int, float], ...]

    def __post_init__(self) -> None:
        if len({term[:2] for term in self.terms}) != len(self.terms):
            raise ValueError(f"terms={self.terms!r}: each pair of exponents may stand once")
        for i, j, c in self.terms:
            if i < 0 or j < 0 or not np.isfinite(c):
                raise ValueError(f"terms: ({i}, {j}, {c}) needs exponents of 0 or more and a finite coefficient")

    def value(self, x: Any, y: Any) -> Any:
        """V at (x, y); arrays broadcast."""
        return _evaluate(self._table, x, y)

    def gradient(self, x: Any, y: Any) -> tuple[Any, Any]:
        """(V_x, V_y) at (x, y); arrays broadcast."""
        return _evaluate(self.derivative(1, 0), x, y), _evaluate(self.derivative(0, 1), x, y)

    def hessian(self, x: Any, y: Any) -> tuple[Any, Any, Any]:
        """(V_xx, V_xy, V_yy) at (x, y); arrays broadcast."""
        return tuple(_evaluate(self.derivative(*order), x, y) for order in ((2, 0), (1, 1), (0, 2)))

    def energy(self, states: Any) -> Any:
        """H of states (…, 4) = x, y, px, py."""
        x, y, px, py = np.moveaxis(np.asarray(states, dtype=float), -1, 0)
        return 0.5 * (px * px + py * py) + self.value(x, y)

    def derivative(self, nx: int, ny: int) -> dict[tuple[int, int], float]:
        """The terms of ∂^(nx+ny) V / ∂x^nx ∂y^ny, as {(i, j): coefficient}; terms that vanish are left out."""
        table = dict(self._table)
        for axis in (0,) * nx + (1,) * ny:
            table = derivative(table, axis)
        return table

    @property
    def mirror_in_x(self) -> bool:
        """Whether V(−x, y) = V(x, y): then (x, px) → (−x, −px) carries orbits into orbits, to the bit."""
        return all(i % 2 == 0 for i, _, _ in self.terms)

    @property
    def _table(self) -> dict[tuple[int, int], float]:
        return {(i, j): c for i, j, c in self.terms}

    @cached_property
    def saddles(self) -> np.ndarray:
        """(n, 2) saddle points (∇V = 0, V_xx V_yy − V_xy² < 0), counterclockwise by angle from the +x axis.

        Channel k leads over ``saddles[k - 1]``. The paper prints the saddle test without the square on V_xy; the square
        belongs there.
        """
        points = find_critical_points(self.derivative(1, 0), self.derivative(0, 1))
        vxx, vxy, vyy = self.hessian(points[:, 0], points[:, 1])
        points = points[vxx * vyy - vxy**2 < 0]
        points = np.where(np.abs(points) < ROUNDING, 0.0, points)
        angle = np.arctan2(points[:, 1], points[:, 0]) % (2 * np.pi)
        points = points[np.argsort(angle, kind="stable")]
        if self.mirror_in_x:
            _make_symmetric(points)
        points.flags.writeable = False
        return points

    @cached_property
    def mirror_channels(self) -> np.ndarray:
        """(channels + 1,) the channel that each one is carried into by x → −x; entry 0 is 0. Only where `mirror_in_x` holds."""
        apart = np.hypot(*(self.saddles[:, None] - self.saddles * [-1.0, 1.0]).T)
        images = np.concatenate([[0], 1 + np.argmin(apart, axis=0)]).astype(np.int8)
        images.flags.writeable = False
        return images

    @cached_property
    def saddle_energies(self) -> np.ndarray:
        """(n,) V at each saddle, in channel order."""
        energies = np.asarray(self.value(self.saddles[:, 0], self.saddles[:, 1]), dtype=float)
        energies.flags.writeable = False
        return energies

    @cached_property
    def escape_energy(self) -> float:
        """The lowest energy at which anything can leave: V at the lowest saddle; infinite when there is no saddle."""
        return float(self.saddle_energies.min(initial=np.inf))

    @property
    def channels(self) -> int:
        """How many exit channels there are; they are numbered 1 … channels, counterclockwise from the +x axis."""
        return len(self.saddles)

    def open_channels(self, energy: float) -> tuple[int, ...]:
        """The channels whose saddle lies below `energy`; none at or below the escape energy."""
        return tuple(int(k) + 1 for k in np.flatnonzero(self.saddle_energies < energy - SAME_ENERGY))


def _make_symmetric(points: np.ndarray) -> None:
    """Make points that come in mirror pairs in x exact images of each other: those at x < 0 of the others."""
    right = points[points[:, 0] > 0.0]
    for left in np.flatnonzero(points[:, 0] < 0.0):
        points[left] = right[np.argmin(np.hypot(*(right - points[left] * [-1.0, 1.0]).T))] * [-1.0, 1.0]


def _evaluate(table: Terms, x: Any, y: Any) -> Any:
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    total = np.zeros(np.broadcast_shapes(x.shape, y.shape))
    for (i, j), c in table.items():
        total = total + c * x**i * y**j
    return total[()]


_HARMONIC = ((2, 0, 0.5), (0, 2, 0.5))

CASES: Mapping[str, Potential] = MappingProxyType(
    {
        "I": Potential("I", (*_HARMONIC, (1, 2, -1.0))),
        "II": Potential("II", (*_HARMONIC, (3, 0, -1.0 / 3.0), (1, 2, 1.0))),
        "III": Potential("III", (*_HARMONIC, (2, 2, -1.0))),
    }
)
"""The three cases of Zotos (2014): V = (x² + y²)/2 + V1 with V1 = −x y², −x (x²/3 − y²) and −x² y²."""
