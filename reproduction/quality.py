"""How finely the paper is remade: as it was made, or quickly."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quality:
    """What decides how long a reproduction takes.

    Attributes
    ----------
    name
        What people call it.
    resolution
        Columns and rows of every map.
    t_max
        How long orbits are followed, dimensionless.
    curve_points
        Energies of every curve against h.
    hunt_resolution, hunt_t_max
        Columns and rows of the map whose chaotic bounded orbits are followed on, and how long.
    """

    name: str
    resolution: int
    t_max: float
    curve_points: int
    hunt_resolution: int
    hunt_t_max: float


FULL = Quality("full", resolution=225, t_max=1e5, curve_points=75, hunt_resolution=225, hunt_t_max=4e6)
"""As the paper: about 50 000 starts a map, followed to 1e5."""

QUICK = Quality("quick", resolution=75, t_max=1e5, curve_points=19, hunt_resolution=45, hunt_t_max=4e6)
"""A ninth of the starts."""
