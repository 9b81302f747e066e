"""The request for an escape map; frozen, validated and hashable, so that it also serves as a cache key."""

from __future__ import annotations

import copy
import operator
from dataclasses import dataclass
from importlib import metadata
from typing import Any

import numpy as np

from engine.dynamics.planes import Plane, Window, default_window, start_states
from engine.potentials.potential import Potential
from engine.potentials.well_units import WellUnits
from engine.taylor.source.recurrence import ORDER, TOLERANCE
from engine.validation import LARGEST_NUMBER, checked_array, checked_number, checked_t_max, short_repr

LARGEST_SIDE = 4096
"""Largest number of columns or rows of a map."""

DEFAULT_RESOLUTION = (224, 224)
"""Columns and rows of a map by default: even, so that no pixel lies on a line of symmetry."""

FINEST_PIXEL = 1e-15
"""Smallest distance of neighbouring pixels in units of the well: a few units in the last place of coordinates of order 1."""


@dataclass(frozen=True)
class MapSpec:
    """An escape map: the orbits, the resolution and the integration time.

    Parameters
    ----------
    potential
        The `Potential`.
    plane
        Plane of initial conditions.
    energy
        h, finite, dimensionless; on (x, h) a pair (low, high). At or below the escape energy no orbit escapes.
    resolution
        (columns, rows), each 1 to 4096. In the default window an odd number of columns puts one on x = 0, where an orbit of a
        potential even in x can stay for ever by symmetry alone; such a line has measure zero, but its pixels count in shares.
    window
        `Window`, or (x_low, x_high, ordinate_low, ordinate_high); None for the whole interior. On (x, h) the ordinate
        is the energy.
    t_max
        Integration time, 0 < t_max ≤ 1e8, dimensionless.
    certify
        Whether an orbit is called bounded before t_max if it has a certificate that it never escapes.
    backward
        Whether orbits are followed into the past. As the potential does not depend on velocity, this equals following
        (x, y, −px, −py) into the future. Fates are then the channels through which orbits entered, escape times tell how long
        ago, and crossings are the upward crossings of the reversed orbit.

    Raises
    ------
    ValueError
        When a parameter is invalid; the message names it, its value and what is legal.

    Examples
    --------
    >>> from engine import CASES, MapSpec, Plane
    >>> spec = MapSpec(CASES["III"], Plane.X_PX, 0.45)
    >>> spec.resolution, spec.t_max, round(spec.window.x_high, 4)
    ((224, 224), 100000.0, 1.0056)
    >>> MapSpec(CASES["III"], Plane.X_PX, 0.45, resolution=(0, 50))
    Traceback (most recent call last):
        ...
    ValueError: resolution=(0, 50): must be (columns, rows), each from 1 to 4096
    """

    potential: Potential
    plane: Plane
    energy: float | tuple[float, float]
    resolution: tuple[int, int] = DEFAULT_RESOLUTION
    window: Window = None  # type: ignore[assignment]  # None is replaced in __post_init__
    t_max: float = 1e5
    certify: bool = True
    backward: bool = False

    def __post_init__(self) -> None:
        plane = Plane(self.plane)
        energy = _checked_energy(plane, self.energy)
        for name, value in (("plane", plane), ("energy", energy), ("resolution", _checked_resolution(self.resolution))):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "t_max", checked_t_max(self.t_max))
        for name in ("certify", "backward"):
            object.__setattr__(self, name, bool(getattr(self, name)))
        window: Any = self.window
        if window is None:
            window = default_window(self.potential, plane, energy)
        object.__setattr__(self, "window", _checked_window(window))
        _check_pixels(self)

    def in_well_units(self) -> MapSpec:
        """The same map in units of the well; the request itself if these are 1.

        The legal range of t_max and of energies does not apply to it.
        """
        units = self.potential.units
        if units == WellUnits():
            return self
        low, high = self.energy if isinstance(self.energy, tuple) else (self.energy, self.energy)
        energies = low / units.energy, high / units.energy
        scaled = copy.copy(self)
        for name, value in (
            ("potential", self.potential.in_well_units),
            ("energy", energies if isinstance(self.energy, tuple) else energies[0]),
            ("window", self.window.scaled(1.0 / units.length, 1.0 / self.plane.ordinate_unit(units))),
            ("t_max", self.t_max / units.time),
        ):
            object.__setattr__(scaled, name, value)
        return scaled

    def pixel_centres(self) -> tuple[np.ndarray, np.ndarray]:
        """x (columns,) and ordinate (rows,) of the pixel centres."""
        return self.window.pixel_centres(*self.resolution)

    def start_states(self, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
        """(n, 4) initial states x, y, px, py of the points (n,), (n,) of the plane; py is NaN where forbidden."""
        energy = 0.0 if isinstance(self.energy, tuple) else self.energy
        states = start_states(self.potential, self.plane, energy, x, ordinate)
        if self.backward:
            states[:, 2:] *= -1.0
        return states

    def has_default_window(self) -> bool:
        """Whether the window shows the whole interior; False at energies that are too high for a default window."""
        try:
            return self.window == default_window(self.potential, self.plane, self.energy)
        except ValueError:
            return False

    def provenance(self) -> dict[str, Any]:
        """The request in plain values, with the integrator and the package version."""
        window = self.window
        return {
            "potential": self.potential.name,
            "terms": "; ".join(f"{c!r} x^{i} y^{j}" for i, j, c in self.potential.terms),
            "energy": self.energy,
            "plane": self.plane.value,
            "window": (window.x_low, window.x_high, window.ordinate_low, window.ordinate_high),
            "resolution": self.resolution,
            "t_max": self.t_max,
            "certify": int(self.certify),
            "backward": int(self.backward),
            "integrator": f"Taylor series of order {ORDER}, tolerance {TOLERANCE:g}",
            "version": metadata.version("escape-explorer"),
        }

    def pixel_at(self, x: float, ordinate: float) -> tuple[int, int] | None:
        """(row, column) of the pixel that contains a point of the plane; None outside the window."""
        window, (columns, rows) = self.window, self.resolution
        column = int(np.floor((x - window.x_low) / (window.x_high - window.x_low) * columns))
        row = int(np.floor((ordinate - window.ordinate_low) / (window.ordinate_high - window.ordinate_low) * rows))
        return (row, column) if 0 <= row < rows and 0 <= column < columns else None


def _checked_energy(plane: Plane, energy: Any) -> float | tuple[float, float]:
    if plane is not Plane.X_H:
        return checked_number("energy", energy, f"one finite number on {plane.value}")
    values = checked_array("energy", energy).ravel()
    if values.size != 2 or not (np.all(np.abs(values) <= LARGEST_NUMBER) and values[0] < values[1]):
        raise ValueError(
            f"energy={short_repr(energy)}: on {plane.value} must be a pair (low, high) of finite numbers with low < high"
        )
    return float(values[0]), float(values[1])


def _checked_window(window: Any) -> Window:
    return window if isinstance(window, Window) else _window_from_edges(window)


def _check_pixels(spec: MapSpec) -> None:
    """Raise ValueError if neighbouring pixels are too close for double precision."""
    units = spec.potential.units
    for centres, unit in zip(spec.pixel_centres(), (units.length, spec.plane.ordinate_unit(units)), strict=True):
        finest = FINEST_PIXEL * max(unit, float(np.max(np.abs(centres))))
        if centres.size > 1 and np.min(np.diff(centres)) < finest:
            raise ValueError(f"window={spec.window}: double precision ends here; pixels must be at least {finest:.2g} apart")


def _window_from_edges(edges: Any) -> Window:
    try:
        x_low, x_high, ordinate_low, ordinate_high = map(float, edges)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"window={short_repr(edges)}: must be (x_low, x_high, ordinate_low, ordinate_high)") from None
    return Window(x_low, x_high, ordinate_low, ordinate_high)


def _checked_resolution(resolution: Any) -> tuple[int, int]:
    try:
        sides = tuple(operator.index(side) for side in resolution)
    except TypeError:
        sides = ()
    if len(sides) != 2 or not all(1 <= side <= LARGEST_SIDE for side in sides):
        raise ValueError(f"resolution={short_repr(resolution)}: must be (columns, rows), each from 1 to {LARGEST_SIDE}")
    return sides
