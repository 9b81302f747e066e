"""The qualities of a reproduction: as in the paper, or a quick preview."""

from __future__ import annotations

from dataclasses import dataclass

from engine.maps.spec import DEFAULT_RESOLUTION


@dataclass(frozen=True)
class Quality:
    """Resolution and limits of the work of a reproduction.

    Attributes
    ----------
    name
        Name on the command line.
    resolution
        Columns and rows of every map. An odd number of columns would put starts of III on the symmetry line x = 0, where orbits
        never escape.
    t_max
        Integration time of orbits, dimensionless.
    curve_points
        Number of energies of curves against h.
    search_resolution, search_t_max
        Columns and rows of the map of III whose chaotic bounded orbits are continued, and the end time of the continuation.
    classified_resolution
        Columns and rows of the maps of I and II whose chaotic bounded orbits are continued. Classifying these orbits takes ten
        times as long as the map.
    exponent_work
        Limit of the work for each uncertainty exponent: the parameter `work` of `engine.compute_uncertainty_exponent`.
    """

    name: str
    resolution: int
    t_max: float
    curve_points: int
    search_resolution: int
    search_t_max: float
    classified_resolution: int
    exponent_work: float


FULL = Quality(
    "full", resolution=DEFAULT_RESOLUTION[0], t_max=1e5, curve_points=75, search_resolution=DEFAULT_RESOLUTION[0],
    search_t_max=4e6, classified_resolution=74, exponent_work=1.5e8,
)  # fmt: skip
"""The quality of the paper: about 50 000 starts per map, integrated to 1e5."""

QUICK = Quality(
    "quick", resolution=74, t_max=1e5, curve_points=19, search_resolution=44, search_t_max=4e6, classified_resolution=24,
    exponent_work=1.5e7,
)  # fmt: skip
"""A quality with one ninth of the starts."""
