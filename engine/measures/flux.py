"""Flux through the exits of a well, and phase-space volume inside. If motion inside is mixed, they give the decay rate."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from engine.exits.beyond_exits import LEAVING_ORBITS, returning_share
from engine.exits.interior import find_outside_channels
from engine.exits.lyapunov_orbits import find_lyapunov_orbits, find_orbits_in_well_units
from engine.foundations.result import Chart, RecordedResult
from engine.foundations.root_finding import bisect
from engine.foundations.validation import checked_number, checks_types
from engine.slices.default_window import default_window
from engine.slices.planes import SPACE
from engine.systems.potential import Potential

# Number of rows of points, in each of which the edges of the interior are searched; a multiple of 3, see `_interior_area`.
_ROWS = 513
# Number of points in a row.
_COLUMNS = 256
# Time for which orbits are followed beyond the exits, in units of the well.
_FOLLOWED_TIME = 100.0
# Number of halvings of the distance between a point inside and the next point outside.
_HALVINGS = 40


@dataclass(frozen=True, eq=False)
class EscapeFlux(RecordedResult):
    """Flux through each open exit at one energy, and volume of the energy surface inside; dimensionless, arrays are read-only.

    Attributes
    ----------
    energy
        h.
    channels
        (n,) numbers of the open exits.
    flux
        (n,) phase-space volume that leaves through each exit per unit of time, measured by δ(H − h) dx dy dpx dpy.
    returning
        (n,) share of the flux through each exit that comes back through any exit within the `followed_time`, from a sample of
        orbits; 0 to 1.
    area, area_error
        Area of the interior in (x, y), and its estimated error.
    followed_time
        Time for which orbits are followed beyond the exits: 100 units of the well.
    mass
        m.
    """

    energy: float
    channels: np.ndarray
    flux: np.ndarray
    returning: np.ndarray
    area: float
    area_error: float = field(repr=False)
    followed_time: float = field(repr=False)
    mass: float = field(default=1.0, repr=False)
    held_as: ClassVar = {"channels": "channel"}
    chart: ClassVar = Chart(
        "channel", "flux", "channel", "flux", title="Flux through the exits at h = {energy:.6g}", by_channel=True
    )

    def numbers(self) -> dict[str, Any]:
        """Return the energy, volume, flux and the share that comes back, and decay rate and passage time of mixed motion."""
        return {
            "energy": self.energy,
            "volume": self.volume,
            "total_flux": self.total,
            "returning_share": self.returning_share,
            "decay_rate": self.decay_rate,
            "mean_passage_time": self.mean_passage_time,
        }

    def columns(self) -> Mapping[str, np.ndarray]:
        """Return channel, flux, share of the flux, and share of this flux that comes back, of each open exit."""
        return {"channel": self.channels, "flux": self.flux, "share": self.shares, "returning": self.returning}

    @property
    def volume(self) -> float:
        """Volume ∫ δ(H − h) dx dy dpx dpy of the energy surface inside: 2π m times the area."""
        return 2.0 * math.pi * self.mass * self.area

    @property
    def total(self) -> float:
        """Flux through all exits together."""
        return float(self.flux.sum())

    @property
    def shares(self) -> np.ndarray:
        """(n,) share of each exit in the flux; also in the escapes, if the exits of orbits are independent of their starts."""
        return self.flux / self.total if self.flux.size else self.flux

    @property
    def returning_share(self) -> float:
        """Share of the flux through all exits that comes back, see `returning`."""
        return float(self.shares @ self.returning)

    @property
    def decay_rate(self) -> float:
        """Flux over volume: the initial decay rate of starts uniform on the energy surface."""
        return self.total / self.volume

    @property
    def mean_passage_time(self) -> float:
        """Volume over flux: the mean time from entrance to exit of all entering orbits; infinite if all exits are closed.

        The mean is exact if orbits that never leave occupy no volume; otherwise their volume is included.
        """
        return self.volume / self.total if self.flux.size else math.inf

    def describe(self) -> str:
        """Return the decay rate and the mean passage time in one sentence."""
        if not self.flux.size:
            return f"All exits are closed at h = {self.energy:.6g}."
        rate = (
            f"Flux {self.total:.4g} over volume {self.volume:.4g}: decay rate {self.decay_rate:.4g}, mean passage time "
            f"{self.mean_passage_time:.4g}, if motion inside is mixed."
        )
        share = f"{100.0 * self.returning_share:.3g} %" if self.returning.any() else "None"
        orbits = f"{LEAVING_ORBITS} orbits through each exit"
        return f"{rate} {share} of the flux comes back within t = {self.followed_time:.4g} ({orbits})."


@checks_types(potential=Potential)
def compute_flux(potential: Potential, energy: float) -> EscapeFlux:
    """Compute the flux through all open exits and the volume of the energy surface inside the exits.

    The flux through an exit is the action ∮ p·dq of its Lyapunov orbit, the smallest of all curves that close the exit (Waalkens,
    Burbanks & Wiggins 2005, J. Phys. A 38, L759; for two degrees of freedom MacKay 1990, Phys. Lett. A 145, 425). With two
    degrees of freedom the momenta at each point inside have the volume 2π m.

    Parameters
    ----------
    potential
        The potential.
    energy
        h, finite, dimensionless.

    Returns
    -------
    The `EscapeFlux`, without exits at or below the escape energy.

    Raises
    ------
    ValueError
        If `energy` is not finite or not above the bottom of the well, the exits are not defined at this energy (see
        `find_lyapunov_orbits`), or the frame rotates.

    Examples
    --------
    >>> from escape_explorer import CASES, compute_flux
    >>> flux = compute_flux(CASES["III"], 0.45)
    >>> flux.flux.round(4).tolist(), round(flux.decay_rate, 4)
    ([0.893, 0.893, 0.893, 0.893], 0.167)
    """
    potential.check_at_rest("the flux and the volume inside")
    h = checked_number("energy", energy)
    bottom = float(potential.value(0.0, 0.0))
    if h <= bottom:
        raise ValueError(f"energy={h}: must be above the bottom of the well, {bottom:.6g}")
    orbits = find_lyapunov_orbits(potential, h)
    # ∮ p·dq is the integral of p²/m = 2 (h − V). The mean over evenly spaced times of a period converges exponentially.
    actions = [orbit.period * float(np.mean(2.0 * (h - potential.value(orbit.x[:-1], orbit.y[:-1])))) for orbit in orbits]
    area, error = _interior_area(potential, h)
    channels = np.array([orbit.channel for orbit in orbits], np.int64)
    made_by = potential.describe_run(energy=h)
    followed_time = _FOLLOWED_TIME * potential.units.time
    returning = _returning_shares(potential, h)
    return EscapeFlux(h, channels, np.array(actions), returning, area, error, followed_time, potential.mass, made_by=made_by)


def _returning_shares(potential: Potential, h: float) -> np.ndarray:
    """Return the share of the flux through each exit that comes back, (exits,)."""
    well, energy = potential.in_well_units, h / potential.units.energy
    curves = {orbit.channel: orbit.curve for orbit in find_orbits_in_well_units(well, energy)}
    return np.array([returning_share(well, energy, curves, channel, _FOLLOWED_TIME) for channel in curves])


def _interior_area(potential: Potential, h: float) -> tuple[float, float]:
    """Return the area of the interior and its error, from the lengths of its sections with evenly spaced rows."""
    window = default_window(potential, SPACE, h)
    row_height = window.height / _ROWS
    y = window.ordinate_low + row_height * (np.arange(_ROWS) + 0.5)
    x = np.linspace(window.x_low, window.x_high, _COLUMNS)
    inside = _is_inside(potential, h, *np.meshgrid(x, y))
    lengths = np.zeros(_ROWS)
    row, column = np.nonzero(inside[:, 1:] != inside[:, :-1])
    inner_x = np.where(inside[row, column], x[column], x[column + 1])
    outer_x = np.where(inside[row, column], x[column + 1], x[column])
    edge_x, _ = bisect(lambda middle: ~_is_inside(potential, h, middle, y[row]), inner_x, outer_x, _HALVINGS)
    # The length of a row is the sum of its right edges minus the sum of its left edges.
    np.add.at(lengths, row, np.where(inside[row, column], edge_x, -edge_x))
    area = float(lengths.sum()) * row_height
    # The lengths behave like square roots at the ends of the interior. The sum over every third row, the middle one of three,
    # therefore has 3^1.5 times the error.
    return area, abs(area - 3.0 * row_height * float(lengths[1::3].sum())) / (3.0**1.5 - 1.0)


def _is_inside(potential: Potential, h: float, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return whether points are in the well, below the energy and inside all exits."""
    return (potential.value(x, y) <= h) & (find_outside_channels(potential, h, x, y) == 0)
