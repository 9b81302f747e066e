"""Planes of initial conditions: what a point of a picture starts as, and where nothing can start.

| plane   | start                                | ordinate |
|---------|--------------------------------------|----------|
| (x, y)  | px = 0, py > 0 from the energy       | y        |
| (x, px) | y = 0, py > 0 from the energy        | px       |
| (x, h)  | y = px = 0, py > 0 from the energy   | h        |
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Never

import contourpy
import numpy as np

from engine.dynamics.lyapunov_orbits import find_lyapunov_orbits, find_outside_exits
from engine.potentials.potential import Potential
from engine.validation import read_number, shown

# The default window leaves this share of its side free around what it shows.
_MARGIN = 0.03
_SCAN = 801
# How far from the origin the interior is looked for: in units of the potential's length, and of its furthest exit.
_FURTHEST = 4.0
_BEYOND_EXITS = 2.0
_RAYS = 180
_CONTOUR_SAMPLES = 201


class Plane(Enum):
    """A plane of initial conditions; the value is its name on paper."""

    X_Y = "(x, y)"
    X_PX = "(x, px)"
    X_H = "(x, h)"

    @property
    def ordinate(self) -> str:
        """Name of the vertical coordinate."""
        return {Plane.X_Y: "y", Plane.X_PX: "px", Plane.X_H: "h"}[self]

    @classmethod
    def _missing_(cls, value: object) -> Never:
        raise ValueError(f"plane={shown(value)}: must be one of {', '.join(plane.value for plane in cls)}")


@dataclass(frozen=True)
class Window:
    """A rectangle of a plane, edges included, dimensionless.

    Raises ValueError when an edge is not finite or beyond ±1e9, or a side is empty or reversed.
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
            edges = [read_number(f"window {name} edge", edge) for edge in (low, high)]
            if not edges[0] < edges[1]:
                raise ValueError(f"window {name} range {low} … {high}: needs two finite numbers, the lower one first")

    def pixel_centres(self, columns: int, rows: int) -> tuple[np.ndarray, np.ndarray]:
        """x (columns,) and ordinate (rows,) of the pixel centres; exactly symmetric in a symmetric window."""
        return _centres(self.x_low, self.x_high, columns), _centres(self.ordinate_low, self.ordinate_high, rows)


def _centres(low: float, high: float, count: int) -> np.ndarray:
    offsets = (2 * np.arange(count) + 1 - count) / (2 * count)
    return 0.5 * (low + high) + (high - low) * offsets


def start_states(
    potential: Potential, plane: Plane, energy: float | np.ndarray, x: np.ndarray, ordinate: np.ndarray
) -> np.ndarray:
    """(n, 4) states x, y, px, py of starts (x, ordinate) on a plane; py is NaN where the start is forbidden.

    `energy` is h, or for (x, h) ignored: there the ordinate is the energy.
    """
    zero = np.zeros_like(x)
    y, px = (ordinate, zero) if plane is Plane.X_Y else (zero, ordinate if plane is Plane.X_PX else zero)
    h = ordinate if plane is Plane.X_H else energy
    with np.errstate(over="ignore", invalid="ignore"):
        # Far enough away, and at no energy, nothing starts.
        doubled = 2.0 * (h - potential.value(x, y)) - px * px
    return np.column_stack([x, y, px, np.sqrt(np.where(doubled >= 0, doubled, np.nan))])


def find_mirror_images(potential: Potential, plane: Plane, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray | None:
    """For each pixel the one whose orbit is the exact image of its own under x → −x.

    Parameters
    ----------
    x, ordinate
        (columns,), (rows,) pixel centres.

    Returns
    -------
    (rows · columns,) pixel numbers, row by row; None where the potential, or the grid to the bit, has no such symmetry.
    """
    turned = plane is Plane.X_PX
    exact = np.array_equal(x, -x[::-1]) and (not turned or np.array_equal(ordinate, -ordinate[::-1]))
    if not (potential.mirror_in_x and exact):
        return None
    numbers = np.arange(x.size * ordinate.size).reshape(ordinate.size, x.size)
    return (numbers[::-1, ::-1] if turned else numbers[:, ::-1]).ravel()


def required_energy(potential: Potential, plane: Plane, x: np.ndarray, ordinate: np.ndarray) -> np.ndarray:
    """The lowest energy at which a start exists; for (x, h), V(x, 0) − h, which is positive where it does not."""
    y = ordinate if plane is Plane.X_Y else np.zeros_like(x)
    kinetic = {Plane.X_Y: 0.0, Plane.X_PX: 0.5 * ordinate**2, Plane.X_H: -ordinate}[plane]
    needed: np.ndarray = kinetic + potential.value(x, y)
    return needed


def trace_zero_velocity_curve(potential: Potential, plane: Plane, energy: float, window: Window) -> list[np.ndarray]:
    """The limiting curve of a plane inside a window, as (n, 2) pieces: V(x, y) = h, px²/2 + V(x, 0) = h, or V(x, 0) = h.

    For (x, h) `energy` is ignored.
    """
    level = 0.0 if plane is Plane.X_H else energy
    return trace_equipotentials(potential, plane, (level,), window)[0]


def trace_equipotentials(potential: Potential, plane: Plane, energies: Sequence[float], window: Window) -> list[list[np.ndarray]]:
    """The limiting curves that several energies would have on (x, y) or (x, px): for each its (n, 2) pieces."""
    levels = [read_number("energies", energy) for energy in energies]
    x, ordinate = (
        np.linspace(low, high, _CONTOUR_SAMPLES)
        for low, high in ((window.x_low, window.x_high), (window.ordinate_low, window.ordinate_high))
    )
    contours = contourpy.contour_generator(x, ordinate, required_energy(potential, Plane(plane), *np.meshgrid(x, ordinate)))
    return [[np.asarray(line) for line in contours.lines(level)] for level in levels]


def default_window(potential: Potential, plane: Plane, energy: float | tuple[float, float]) -> Window:
    """The window that shows the whole interior: all starts that exist and are not outside.

    For (x, y) and (x, px) it is a square; for (x, h) `energy` is the pair of lowest and highest h.
    """
    highest = _highest_energy(energy)
    if Plane(plane) is Plane.X_Y:
        return _square(*_interior_extent(potential, highest))
    x_low, x_high = _interior_interval(potential, highest)
    if isinstance(energy, tuple):
        margin = _MARGIN * (x_high - x_low)
        return Window(x_low - margin, x_high + margin, *energy)
    x = np.linspace(x_low, x_high, _SCAN)
    px = np.sqrt(2.0 * max(highest - np.min(potential.value(x, np.zeros_like(x))), 0.0))
    return _square(x_low, x_high, -float(px), float(px))


def _highest_energy(energy: float | tuple[float, float]) -> float:
    if not isinstance(energy, tuple):
        return read_number("energy", energy)
    ends = [read_number("energy", one) for one in energy]
    if len(ends) != 2 or not ends[0] < ends[1]:
        raise ValueError(f"energy={shown(energy)}: must be one finite number, or on (x, h) a pair (low, high)")
    return ends[1]


def _square(x_low: float, x_high: float, low: float, high: float) -> Window:
    half = 0.5 * max(x_high - x_low, high - low) * (1.0 + 2.0 * _MARGIN)
    x, ordinate = 0.5 * (x_low + x_high), 0.5 * (low + high)
    return Window(x - half, x + half, ordinate - half, ordinate + half)


def _connected_run(allowed: np.ndarray) -> slice:
    """The run of True around the middle of a scan."""
    middle = allowed.size // 2
    blocked = np.flatnonzero(~allowed)
    low = blocked[blocked < middle].max(initial=-1) + 1
    high = blocked[blocked > middle].min(initial=allowed.size)
    return slice(low, high)


def _interior_interval(potential: Potential, energy: float) -> tuple[float, float]:
    """The x between which the axis y = 0 lies in the interior, to about a thousandth."""
    furthest = _furthest(potential)
    x = np.linspace(-furthest, furthest, 4 * _SCAN)
    zero = np.zeros_like(x)
    outside = find_outside_exits(potential, energy, x, zero)
    run = _connected_run((potential.value(x, zero) <= energy) & (outside == 0))
    _check_interior(energy, x[run])
    return _rounded(x[run][0], potential), _rounded(x[run][-1], potential)


def _furthest(potential: Potential) -> float:
    """No point of the interior is further from the origin than this, unless the energy is many times the escape energy."""
    return max(_FURTHEST * potential.length, _BEYOND_EXITS * float(np.hypot(*potential.saddles.T).max(initial=0.0)))


def _interior_extent(potential: Potential, energy: float) -> tuple[float, float, float, float]:
    """The box around the interior of the (x, y) plane: rays from the well's bottom to its walls, and the exits."""
    angle = np.linspace(0.0, 2.0 * np.pi, _RAYS + 1)
    radius = np.linspace(0.0, _furthest(potential), _SCAN // 2)
    x, y = radius * np.cos(angle)[:, None], radius * np.sin(angle)[:, None]
    outside = find_outside_exits(potential, energy, x, y)
    inside = np.logical_and.accumulate((potential.value(x, y) <= energy) & (outside == 0), axis=1)
    x, y = x[inside], y[inside]
    _check_interior(energy, x)
    for orbit in find_lyapunov_orbits(potential, energy):
        x, y = np.append(x, orbit.x), np.append(y, orbit.y)
    x_low, x_high, y_low, y_high = (_rounded(edge, potential) for edge in (x.min(), x.max(), y.min(), y.max()))
    return x_low, x_high, y_low, y_high


def _check_interior(energy: float, x: np.ndarray) -> None:
    """ValueError unless the interior reaches over more than one x."""
    if x.size == 0 or not x.min() < x.max():
        raise ValueError(f"energy={energy}: there is no interior to show; must be above that of the well's bottom by 1e-5 or so")


def _rounded(edge: float, potential: Potential) -> float:
    """To twelve decimals of the potential's length, so that the window of a symmetric interior is symmetric to the bit."""
    return round(float(edge) / potential.length, 12) * potential.length
