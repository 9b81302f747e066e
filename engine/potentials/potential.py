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

from engine.polynomials import HIGHEST_DEGREE
from engine.potentials.critical_points import balanced_length, find_critical_points
from engine.potentials.exit_saddles import leads_out_of_well
from engine.taylor.source.cauchy_products import derivative
from engine.validation import read_count, read_number, shown

Terms = Mapping[tuple[int, int], float]

# A coordinate this small is a zero that rounding has touched; on the +x axis its sign would decide the channel's number.
# In units of the potential's length, as the next is of its square.
ROUNDING = 1e-13
# Saddles this close in energy count as equally high: an escape energy is a round number computed in floating point.
SAME_ENERGY = 1e-12
# A critical point this near to the origin, in the length in which the coefficients are alike, is the origin.
_SAME_POINT = 1e-8

FREQUENCIES = (0.1, 10.0)
"""Legal range of ω1 and ω2."""

STRENGTHS = (0.01, 100.0)
"""Legal range of ε."""


@dataclass(frozen=True)
class Potential:
    """V(x, y) = Σ c x^i y^j, dimensionless, for a unit mass: H = (px² + py²)/2 + V.

    Parameters
    ----------
    name
        What people call it; has no influence on any result.
    terms
        ((i, j, c), …): exponents i, j from 0 to 12 and finite coefficient c of each term, each (i, j) once.

    Raises
    ------
    ValueError
        When a term has an exponent out of its range, a coefficient that is not finite, or stands twice.
    """

    name: str = field(compare=False)
    terms: tuple[tuple[int, int, float], ...]

    def __post_init__(self) -> None:
        try:
            terms = tuple(_read_term(*term) for term in self.terms)
        except TypeError:
            raise ValueError(f"terms={shown(self.terms)}: must be ((i, j, c), …)") from None
        if len({term[:2] for term in terms}) != len(terms):
            raise ValueError(f"terms={shown(terms)}: each pair of exponents may stand once")
        object.__setattr__(self, "terms", terms)

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
    def mirror_in_y(self) -> bool:
        """Whether V(x, −y) = V(x, y): then (y, py) → (−y, −py) carries orbits into orbits."""
        return all(j % 2 == 0 for _, j, _ in self.terms)

    @property
    def _table(self) -> dict[tuple[int, int], float]:
        return {(i, j): c for i, j, c in self.terms}

    @cached_property
    def critical_points(self) -> np.ndarray:
        """(n, 2) all points with ∇V = 0, the origin exactly where it is one; raises ValueError when they form a curve."""
        slopes = self.derivative(1, 0), self.derivative(0, 1)
        points = find_critical_points(*slopes)
        tiny = ROUNDING * balanced_length(*slopes)
        points = np.where(np.abs(points) < tiny, 0.0, points)
        if not any(slope.get((0, 0), 0.0) for slope in slopes):
            points[np.hypot(*points.T) < _SAME_POINT * balanced_length(*slopes)] = 0.0
        points.flags.writeable = False
        return points

    @cached_property
    def saddles(self) -> np.ndarray:
        """(n, 2) saddle points (∇V = 0, V_xx V_yy − V_xy² < 0) that lead out of the well at the origin.

        Counterclockwise by angle from the +x axis: channel k leads over ``saddles[k - 1]``. Saddles elsewhere, from which
        no line of steepest descent ends at the origin or both do, are no exits and not among them. The paper prints the
        saddle test without the square on V_xy; the square belongs there.
        """
        points = self.critical_points
        points = points[leads_out_of_well(self.gradient, self.hessian, points)]
        points = np.where(np.abs(points) < ROUNDING * np.hypot(*points.T)[:, None], 0.0, points)
        angle = np.arctan2(points[:, 1], points[:, 0]) % (2 * np.pi)
        points = points[np.argsort(angle, kind="stable")]
        if self.mirror_in_x:
            _make_symmetric(points)
        points.flags.writeable = False
        return points

    @cached_property
    def length(self) -> float:
        """The size of the well as a power of 2, near the distance of its nearest exit saddle; 1 for the paper's three cases.

        Whatever is small or large by a length is so in units of this. Being a power of 2 it changes no digit of what it divides.
        """
        if not self.channels:
            return balanced_length(self._table)
        return float(2.0 ** np.round(np.log2(np.hypot(*self.saddles.T).min())))

    @cached_property
    def fastest_frequency(self) -> float:
        """The higher frequency of small oscillations in the well at the origin; NaN where there is no well."""
        vxx, vxy, vyy = self.hessian(0.0, 0.0)
        with np.errstate(invalid="ignore"):
            return float(np.sqrt(np.linalg.eigvalsh([[vxx, vxy], [vxy, vyy]])[-1]))

    def in_units(self, length: float) -> Potential:
        """The potential whose orbits are those of this one with x, y, px, py in units of `length`, at the same times.

        It is V(length · x, length · y) / length², and its energies are in units of length².
        """
        scaled = Potential(self.name, tuple((i, j, c * length ** (i + j - 2)) for i, j, c in self.terms))
        scaled.__dict__["saddles"] = self.saddles / length
        return scaled

    def with_parameters(self, omega_1: float = 1.0, omega_2: float = 1.0, epsilon: float = 1.0) -> Potential:
        """This potential with other frequencies of its well and another strength of what perturbs it.

        V = ½ (ω1² x² + ω2² y²) + ε V1 of Zotos (2014), who goes on with ω1 = ω2 = ε = 1: V1 is all terms of degree 3 and more.
        Where the quadratic terms are other than ½ (x² + y²), x² is multiplied by ω1², y² by ω2² and x y by ω1 ω2, so that
        1, 1, 1 is always the potential itself. Constant and linear terms stay.

        Parameters
        ----------
        omega_1, omega_2
            Frequencies along x and y, dimensionless, from 0.1 to 10.
        epsilon
            Strength of V1, dimensionless, from 0.01 to 100.

        Raises
        ------
        ValueError
            When one is out of its range.
        """
        for name, value, (low, high) in (
            ("omega_1", omega_1, FREQUENCIES),
            ("omega_2", omega_2, FREQUENCIES),
            ("epsilon", epsilon, STRENGTHS),
        ):
            if not low <= value <= high:
                raise ValueError(f"{name}={value}: must be between {low:g} and {high:g}")
        given = (("ω1", omega_1), ("ω2", omega_2), ("ε", epsilon))
        changed = ", ".join(f"{symbol}={value:g}" for symbol, value in given if value != 1.0)
        terms = tuple((i, j, c * _factor(i, j, omega_1, omega_2, epsilon)) for i, j, c in self.terms)
        return Potential(f"{self.name} ({changed})" if changed else self.name, terms)

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

    def outward_direction(self, channel: int) -> np.ndarray:
        """Unit vector along the unstable direction of a channel's saddle, pointing away from the well."""
        saddle = self.saddles[channel - 1]
        vxx, vxy, vyy = self.hessian(*saddle)
        outward: np.ndarray = np.linalg.eigh(np.array([[vxx, vxy], [vxy, vyy]]))[1][:, 0]
        outward = np.where(np.abs(outward) < ROUNDING, 0.0, outward)
        outward = outward if outward @ saddle > 0 else -outward
        if self.mirror_in_x and saddle[0] < 0.0:
            outward = self.outward_direction(int(self.mirror_channels[channel])) * [-1.0, 1.0]
        return outward

    def open_channels(self, energy: float) -> tuple[int, ...]:
        """The channels whose saddle lies below `energy`; none at or below the escape energy."""
        return tuple(int(k) + 1 for k in np.flatnonzero(self.saddle_energies < energy - SAME_ENERGY * self.length**2))


def _factor(i: int, j: int, omega_1: float, omega_2: float, epsilon: float) -> float:
    """What the coefficient of x^i y^j is multiplied by."""
    if i + j < 2:
        return 1.0
    return epsilon if i + j > 2 else omega_1**i * omega_2**j


def _read_term(i: Any, j: Any, c: Any) -> tuple[int, int, float]:
    power_x, power_y = (read_count(f"terms: exponent of {axis}", n, 0, HIGHEST_DEGREE) for axis, n in (("x", i), ("y", j)))
    return power_x, power_y, read_number("terms: coefficient", c)


def _make_symmetric(points: np.ndarray) -> None:
    """Make points that come in mirror pairs in x exact images of each other: those at x < 0 of the others."""
    right = points[points[:, 0] > 0.0]
    for left in np.flatnonzero(points[:, 0] < 0.0):
        points[left] = right[np.argmin(np.hypot(*(right - points[left] * [-1.0, 1.0]).T))] * [-1.0, 1.0]


def _evaluate(table: Terms, x: Any, y: Any) -> Any:
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    total = np.zeros(np.broadcast_shapes(x.shape, y.shape))
    for (i, j), c in table.items():
        total = total + c * _power(x, i) * _power(y, j)
    return total[()]


def _power(x: np.ndarray, i: int) -> np.ndarray:
    """x to a whole power, of x and −x alike to the bit, which the library's own is not for the higher ones."""
    if i < 4:
        return x**i
    return np.abs(x) ** i if i % 2 == 0 else x * np.abs(x) ** (i - 1)


_HARMONIC = ((2, 0, 0.5), (0, 2, 0.5))

CASES: Mapping[str, Potential] = MappingProxyType(
    {
        "I": Potential("I", (*_HARMONIC, (1, 2, -1.0))),
        "II": Potential("II", (*_HARMONIC, (3, 0, -1.0 / 3.0), (1, 2, 1.0))),
        "III": Potential("III", (*_HARMONIC, (2, 2, -1.0))),
    }
)
"""The three cases of Zotos (2014): V = (x² + y²)/2 + V1 with V1 = −x y², −x (x²/3 − y²) and −x² y²."""
