"""Planes of initial conditions: the start for each point of a plane, forbidden regions, and default windows.

| plane   | start                                | ordinate |
|---------|--------------------------------------|----------|
| (x, y)  | px = 0, py > 0 from the energy       | y        |
| (x, px) | y = 0, py > 0 from the energy        | px       |
| (x, h)  | y = px = 0, py > 0 from the energy   | h        |
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Never

import numpy as np

from engine.exits.interior import find_outside_channels
from engine.exits.lyapunov_orbits import find_lyapunov_orbits
from engine.potentials.potential import Potential
from engine.potentials.well_units import WellUnits
from engine.validation import checked_number, short_repr

# Margin of the default window on each side, as a share of the size of the interior.
_MARGIN = 0.03
_SCAN_POINTS = 801
# The interior is searched up to this distance from the origin: in units of the well, and of the distance of the
# outermost exit saddle.
_SEARCH_LENGTHS = 4.0
_SEARCH_SADDLE_DISTANCES = 2.0
_RAYS = 180
_CONTOUR_SAMPLES = 201


class Plane(Enum):
    """A plane of initial conditions; the value is its name in texts."""

    X_Y = "(x, y)"
    X_PX = "(x, px)"
    X_H = "(x, h)"

    @property
    def ordinate(self) -> str:
        """Name of the vertical coordinate."""
        return {Plane.X_Y: "y", Plane.X_PX: "px", Plane.X_H: "h"}[self]

    def ordinate_unit(self, units: WellUnits) -> float:
        """The unit of the vertical coordinate in which it is a number of the size of the well."""
        return {Plane.X_Y: units.length, Plane.X_PX: units.momentum, Plane.X_H: units.energy}[self]

    @classmethod
    def _missing_(cls, value: object) -> Never:
        raise ValueError(f"plane={short_repr(value)}: must be one of {', '.join(plane.value for plane in cls)}")


@dataclass(frozen=True)
class Window:
    """A rectangle of a plane, including its edges, dimensionless.

    Raises ValueError if an edge is not finite or beyond ±1e9, or a lower edge is not below the upper edge.
    """

    x_low: float
    x_high: float
    ordinate_low: float
    ordinate_high: float

    def __post_init__(self) -> None:
        for name, low, high in (
            ("x", self.x_low, self.x_high),
            ("ordinate", self.ordinate_low, self.ordinate_high),
        ):
            edges = [checked_number(f"window {name} edge", edge) for edge in (low, high)]
            if not edges[0] < edges[1]:
                raise ValueError(f"window {name} range {low} … {high}: the lower edge must be below the upper edge")

    def scaled(self, x_factor: float, ordinate_factor: float) -> Window:
        """The window with its edges multiplied by two factors."""
        x, ordinate = (self.x_low, self.x_high), (self.ordinate_low, self.ordinate_high)
        return Window(*(x_factor * edge for edge in x), *(ordinate_factor * edge for edge in ordinate))

    def pixel_centres(self, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
        """x (columns,) and ordinate (rows,) of the pixel centres; they are exactly symmetric if the window is."""
        return _interval_centres(self.x_low, self.x_high, columns), _interval_centres(self.ordinate_low, self.ordinate_high, rows)


def _interval_centres(low: float, high: float, count: int) -> np.ndarray:
    offsets = (2 * np.arange(count) + 1 - count) / (2 * count)
    return 0.5 * (low + high) + (high - low) * offsets


def start_states(
    potential: Potential, plane: Plane, energy: float | np.ndarray, x: np.ndarray, ordinate: np.ndarray
) -> np.ndarray:
    """The initial conditions of points of a plane.

    Parameters
    ----------
    potential
        The potential.
    plane
        The plane of initial conditions.
    energy
        h, a number or (n,); ignored for (x, h), where the ordinate is the energy.
    x, ordinate
        (n,) coordinates on the plane.

    Returns
    -------
    (n, 4) x, y, px, py; py is NaN where the start is forbidden.

    Examples
    --------
    >>> import numpy as np
    >>> from engine import CASES, Plane, start_states
    >>> start_states(CASES["III"], Plane.X_PX, 0.45, np.array([0.0, 0.9]), np.array([0.3, 0.5])).round(4)
    array([[0. , 0. , 0.3, 0.9],
           [0.9, 0. , 0.5, nan]])
    """
    zero = np.zeros_like(x)
    y, px = (ordinate, zero) if plane is Plane.X_Y else (zero, ordinate if plane is Plane.X_PX else zero)
    h = ordinate if plane is Plane.X_H else energy
    with np.errstate(over="ignore", invalid="ignore"):
        # An overflow far from the origin gives a forbidden start.
        doubled = 2.0 * (h - potential.value(x, y)) - px * px
    return np.column_stack([x, y, px, np.sqrt(np.where(doubled >= 0, doubled, np.nan))])


def find_mirror_images(potential: Potential, plane: Plane, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray | None:
    """For each pixel, the pixel whose orbit is its exact mirror image under x → −x.

    Parameters
    ----------
    potential
        The potential.
    plane
        The plane of initial conditions.
    x, ordinate
        (columns,), (rows,) pixel centres.

    Returns
    -------
    (rows · columns,) pixel indices in row-major order; None if the potential or the grid is not exactly symmetric.
    """
    # On (x, px) the sign of px changes as well.
    flips_ordinate = plane is Plane.X_PX
    symmetric = np.array_equal(x, -x[::-1]) and (not flips_ordinate or np.array_equal(ordinate, -ordinate[::-1]))
    if not (potential.mirror_in_x and symmetric):
        return None
    pixels = np.arange(x.size * ordinate.size).reshape(ordinate.size, x.size)
    return (pixels[::-1, ::-1] if flips_ordinate else pixels[:, ::-1]).ravel()


def required_energy(potential: Potential, plane: Plane, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
    """The lowest energy at which a start exists; for (x, h), V(x, 0) − h, which is positive where the start is forbidden."""
    y = ordinate if plane is Plane.X_Y else np.zeros_like(x)
    kinetic = {Plane.X_Y: 0.0, Plane.X_PX: 0.5 * ordinate**2, Plane.X_H: -ordinate}[plane]
    required: np.ndarray = kinetic + potential.value(x, y)
    return required


def trace_zero_velocity_curve(potential: Potential, plane: Plane, energy: float, window: Window) -> list[np.ndarray]:
    """The boundary of the forbidden region of a plane: V(x, y) = h, px²/2 + V(x, 0) = h, or V(x, 0) = h.

    Parameters
    ----------
    potential
        The potential.
    plane
        The plane of initial conditions.
    energy
        h, dimensionless; ignored for (x, h).
    window
        The part of the plane to trace.

    Returns
    -------
    The pieces of the curve, each (n, 2).

    Examples
    --------
    >>> from engine import CASES, Plane, default_window, trace_zero_velocity_curve
    >>> window = default_window(CASES["I"], Plane.X_PX, 0.19)
    >>> len(trace_zero_velocity_curve(CASES["I"], Plane.X_PX, 0.19, window))
    1
    """
    level = 0.0 if plane is Plane.X_H else energy
    return trace_equipotentials(potential, plane, (level,), window)[0]


def trace_equipotentials(potential: Potential, plane: Plane, energies: Sequence[float], window: Window) -> list[list[np.ndarray]]:
    """The zero-velocity curves of several energies on (x, y) or (x, px): a list of (n, 2) pieces for each energy."""
    import contourpy

    levels = [checked_number("energies", energy) for energy in energies]
    x, ordinate = (
        np.linspace(low, high, _CONTOUR_SAMPLES)
        for low, high in ((window.x_low, window.x_high), (window.ordinate_low, window.ordinate_high))
    )
    contours = contourpy.contour_generator(x, ordinate, required_energy(potential, Plane(plane), *np.meshgrid(x, ordinate)))
    return [[np.asarray(line) for line in contours.lines(level)] for level in levels]


def default_window(potential: Potential, plane: Plane, energy: float | tuple[float, float]) -> Window:
    """A window that shows the whole interior: all starts that are neither forbidden nor outside.

    Parameters
    ----------
    potential
        The potential.
    plane
        The plane of initial conditions.
    energy
        h, dimensionless; for (x, h) the pair (lowest, highest).

    Returns
    -------
    The window; for (x, y) and (x, px) it is a square in units of the well.

    Raises
    ------
    ValueError
        If an energy is out of range, or there is no interior at this energy.

    Examples
    --------
    >>> from engine import CASES, Plane, default_window
    >>> window = default_window(CASES["III"], Plane.X_PX, 0.45)
    >>> round(window.x_low, 4), round(window.x_high, 4)
    (-1.0056, 1.0056)
    """
    highest = _checked_highest_energy(energy)
    return _default_window(potential, Plane(plane), (float(energy[0]), highest) if isinstance(energy, tuple) else highest)


@functools.lru_cache(maxsize=1024)
def _default_window(potential: Potential, plane: Plane, energy: float | tuple[float, float]) -> Window:
    highest, units = energy[1] if isinstance(energy, tuple) else energy, potential.units
    # An error about the exits is to name the energy as it is given.
    find_lyapunov_orbits(potential, highest)
    well, well_energy = potential.in_well_units, highest / units.energy
    x, y = _interior_points(well, well_energy) if plane is Plane.X_Y else (_interior_interval(well, well_energy), np.empty(0))
    if x.size == 0 or not x.min() < x.max():
        raise ValueError(f"energy={highest}: the interior is empty; must be at least about 1e-5 above the minimum of the well")
    x_low, x_high = _rounded_range(x)
    if isinstance(energy, tuple):
        margin = _MARGIN * (x_high - x_low)
        return Window(units.length * (x_low - margin), units.length * (x_high + margin), *energy)
    ordinates = _rounded_range(y) if plane is Plane.X_Y else _momentum_range(well, well_energy, x_low, x_high)
    return _square_window(x_low, x_high, *ordinates).scaled(units.length, plane.ordinate_unit(units))


def _momentum_range(potential: Potential, energy: float, x_low: float, x_high: float) -> tuple[float, float]:
    """The range of px of the starts on the axis y = 0 between two x."""
    x = np.linspace(x_low, x_high, _SCAN_POINTS)
    px = float(np.sqrt(2.0 * max(energy - np.min(potential.value(x, np.zeros_like(x))), 0.0)))
    return -px, px


def _checked_highest_energy(energy: float | tuple[float, float]) -> float:
    if not isinstance(energy, tuple):
        return checked_number("energy", energy)
    energies = [checked_number("energy", one) for one in energy]
    if len(energies) != 2 or not energies[0] < energies[1]:
        raise ValueError(f"energy={short_repr(energy)}: must be one finite number, or on (x, h) a pair (low, high)")
    return energies[1]


def _square_window(x_low: float, x_high: float, low: float, high: float) -> Window:
    half = 0.5 * max(x_high - x_low, high - low) * (1.0 + 2.0 * _MARGIN)
    x, ordinate = 0.5 * (x_low + x_high), 0.5 * (low + high)
    return Window(x - half, x + half, ordinate - half, ordinate + half)


def _run_around_middle(allowed: np.ndarray) -> slice:
    """The run of True values around the middle of an array."""
    middle = allowed.size // 2
    blocked = np.flatnonzero(~allowed)
    low = blocked[blocked < middle].max(initial=-1) + 1
    high = blocked[blocked > middle].min(initial=allowed.size)
    return slice(low, high)


def _interior_interval(potential: Potential, energy: float) -> np.ndarray:
    """(n,) x of the interior on the axis y = 0, with a resolution of about a thousandth."""
    radius = _search_radius(potential)
    x = np.linspace(-radius, radius, 4 * _SCAN_POINTS)
    zero = np.zeros_like(x)
    outside = find_outside_channels(potential, energy, x, zero)
    return x[_run_around_middle((potential.value(x, zero) <= energy) & (outside == 0))]


def _search_radius(potential: Potential) -> float:
    """A radius that contains the interior, unless the energy is many times the escape energy."""
    outermost = float(np.hypot(*potential.saddles.T).max(initial=0.0))
    return max(_SEARCH_LENGTHS, _SEARCH_SADDLE_DISTANCES * outermost)


def _interior_points(potential: Potential, energy: float) -> tuple[np.ndarray, np.ndarray]:
    """(n,) x and y of points of the interior of the (x, y) plane, on rays that start at the origin, and of the exits."""
    angle = np.linspace(0.0, 2.0 * np.pi, _RAYS + 1)
    radius = np.linspace(0.0, _search_radius(potential), _SCAN_POINTS // 2)
    x, y = radius * np.cos(angle)[:, None], radius * np.sin(angle)[:, None]
    outside = find_outside_channels(potential, energy, x, y)
    inside = np.logical_and.accumulate((potential.value(x, y) <= energy) & (outside == 0), axis=1)
    x, y = x[inside], y[inside]
    if x.size == 0 or not x.min() < x.max():
        return np.empty(0), np.empty(0)
    orbits = find_lyapunov_orbits(potential, energy)
    return np.concatenate([x, *(orbit.x for orbit in orbits)]), np.concatenate([y, *(orbit.y for orbit in orbits)])


def _rounded_range(coordinate: np.ndarray) -> tuple[float, float]:
    """The smallest and the largest value, to 12 decimals, so that the window of a symmetric interior is symmetric."""
    return round(float(coordinate.min()), 12), round(float(coordinate.max()), 12)
