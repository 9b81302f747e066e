"""Quality of the reproduction: as in the paper, or a quick preview."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quality:
    """Resolution of a reproduction.

    Attributes
    ----------
    name
        Name on the command line.
    resolution
        Columns and rows of every map.
    t_max
        Integration time of orbits, dimensionless.
    curve_points
        Number of energies of curves against h.
    search_resolution, search_t_max
        Columns and rows of the map whose chaotic bounded orbits are continued, and until which time.
    """

    name: str
    resolution: int
    t_max: float
    curve_points: int
    search_resolution: int
    search_t_max: float


FULL = Quality("full", resolution=224, t_max=1e5, curve_points=75, search_resolution=224, search_t_max=4e6)
"""As in the paper: about 50 000 starts per map, integrated to 1e5."""

QUICK = Quality("quick", resolution=74, t_max=1e5, curve_points=19, search_resolution=44, search_t_max=4e6)
"""One ninth of the starts."""
