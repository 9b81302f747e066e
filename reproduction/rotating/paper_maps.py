"""Choose maps of the systems in rotating frames, and with bodies, that papers study.

Planes, windows and grids may differ from those of the papers, which were not available.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from engine import POTENTIALS, Coordinate, MapSpec, Plane, Potential, Slice, Window, parse_formula

BODY_RADII = (1e-5, 1e-4, 1e-3, 1e-2)
"""Radii of both bodies of the Copenhagen problem, in units of their distance."""

# Number of pixels per side.
_SIDE = 150
# Number of pixels per side around the Moon, where islands are small.
_SIDE_AT_MOON = 300
# Integration time, in units of time of the system.
_T_MAX = 1e3
# Integration time around the Moon, where orbits end soon, in units of time of the system.
_T_MAX_AT_MOON = 1e2

# Starts on (x, y) with the velocity at a right angle to the radius, clockwise.
_RETROGRADE = Slice(Coordinate.X, Coordinate.Y, fixed=((Coordinate.BETA, -0.5 * np.pi),))

# Four overlapping discs, far from the hills where V < 0.001, stand for the four directions between the hills.
_FOUR_HILLS = (
    "x²y² exp(−r²); centre the right (10, 0) 7.08; centre the top (0, 10) 7.08; centre the left (−10, 0) 7.08; "
    "centre the bottom (0, −10) 7.08; escape 20"
)


@dataclass(frozen=True)
class PaperMap:
    """A map with the name of its row in a table.

    Attributes
    ----------
    name
        Name that distinguishes the map from other maps of the paper.
    spec
        Request of the map.
    """

    name: str
    spec: MapSpec


def four_hills() -> Potential:
    """Return four hills at (±1, ±1) of height e⁻². Discs at the right, top, left and bottom stand for exits."""
    return parse_formula(_FOUR_HILLS, "Four hills")


def copenhagen(radius: float) -> Potential:
    """Return the Copenhagen problem with another radius of the bodies, 1e-6 to 1e6 of their distance; ValueError otherwise."""
    potential = POTENTIALS["Copenhagen"]
    return potential.with_outcomes([replace(body, radius=radius) for body in potential.centres], potential.escape_radius)


def _earth_moon() -> tuple[PaperMap, ...]:
    names = {-1.108: "both necks closed", -1.1055: "L1 open", -1.102: "L1 open", -1.0985: "L1 open", -1.085: "both open"}
    potential = POTENTIALS["Earth-Moon"]
    resolution = (_SIDE_AT_MOON, _SIDE_AT_MOON)
    specs = {h: MapSpec(potential, Plane.X_PX, h, resolution, t_max=_T_MAX_AT_MOON) for h in names}
    return tuple(PaperMap(f"{names[h]}, h = −{-h}", spec) for h, spec in specs.items())


def _copenhagen() -> tuple[PaperMap, ...]:
    window = Window(-2.0, 2.0, -2.0, 2.0)
    resolution = (_SIDE, _SIDE)
    specs = {radius: MapSpec(copenhagen(radius), _RETROGRADE, -1.6, resolution, window, t_max=_T_MAX) for radius in BODY_RADII}
    return tuple(PaperMap(f"radius {radius:.5f}".rstrip("0"), spec) for radius, spec in specs.items())


def _star_cluster() -> tuple[PaperMap, ...]:
    potential = POTENTIALS["Star cluster"]
    specs = {h: MapSpec(potential, Plane.X_PX, h, (_SIDE, _SIDE), t_max=_T_MAX) for h in (-1.85, -1.75, -1.5)}
    return tuple(PaperMap(f"h = −{-h}", spec) for h, spec in specs.items())


def _four_hills() -> tuple[PaperMap, ...]:
    potential = four_hills()
    resolution = (_SIDE, _SIDE)
    window = Window(-2.5, 2.5, -0.6, 0.6)
    energies = {share: share * float(np.exp(-2.0)) for share in (0.3, 0.6, 0.9, 1.2)}
    specs = {share: MapSpec(potential, Plane.X_PX, h, resolution, window, t_max=_T_MAX) for share, h in energies.items()}
    return tuple(PaperMap(f"h = {share}/e²", spec) for share, spec in specs.items())


PAPER_MAPS: Mapping[str, tuple[PaperMap, ...]] = MappingProxyType(
    {
        "Earth–Moon system": _earth_moon(),
        "Copenhagen problem": _copenhagen(),
        "Star cluster": _star_cluster(),
        "Four hills": _four_hills(),
    }
)
"""The maps by system."""
