"""Stable manifolds in rotating frames lead to the Lyapunov orbits, and bound the basins of the exits."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import shapely
from scipy.integrate import solve_ivp
from scipy.spatial import cKDTree

from engine import (
    POTENTIALS,
    LyapunovOrbit,
    MapSpec,
    compute_map,
    find_lyapunov_orbits,
    find_stable_manifolds,
    read_section,
    start_states,
)
from engine.results import StableManifolds
from engine.trajectories.stable_manifolds import ManifoldArc

# Sections across the necks at L1 and L2, which the Lyapunov orbits do not cross, and y = 0, which they cross.
NECKS = [
    pytest.param("Earth-Moon", -1.1, 2, "x = -0.1, px < 0", marks=pytest.mark.slow),
    ("Earth-Moon", -1.09, 1, "x = 0.1, px > 0"),
    ("Earth-Moon", -1.07, 2, "x = -0.06, px < 0"),
    ("Hill", -2.1, 1, "x = 0.4, px > 0"),
    ("Hill", -2.0, 2, "x = -0.4, px < 0"),
]
ON_AXIS = [("Earth-Moon", -1.09, 1, "y = 0"), ("Hill", -2.0, 2, "y = 0"), ("Barred galaxy", -3150.0, 1, "y = 0")]


@cache
def manifolds(name: str, energy: float, section: str) -> StableManifolds:
    return find_stable_manifolds(POTENTIALS[name], energy, images=1, section=section)


def arcs_of(name: str, energy: float, channel: int, section: str) -> list[ManifoldArc]:
    return [arc for arc in manifolds(name, energy, section).arcs if arc.channel == channel]


def distances(orbit: LyapunovOrbit, starts: np.ndarray) -> np.ndarray:
    """Return the smallest distance of each orbit from the Lyapunov orbit in phase space, in units of the well, by DOP853."""
    potential, units = orbit.potential, np.array(orbit.potential.units.state)
    # The time to the exit, and that in which a distance of 1 shrinks to 1e-7.
    duration = orbit.period * (2.0 + np.log(1e7) / np.log(orbit.multipliers[0].real))
    path = solve_ivp(
        lambda t, values: potential.derivatives(values.reshape(-1, 4)).ravel(), (0.0, duration), starts.ravel(), "DOP853",
        t_eval=np.linspace(0.0, duration, 3000), rtol=1e-13, atol=1e-14 * units.min(),
    )  # fmt: skip
    tree = cKDTree(orbit.find_path(20_000)[1:].T / units)
    points = np.moveaxis(path.y.T.reshape(-1, *starts.shape), 1, 0) / units
    return np.array([tree.query(each)[0].min() for each in points])


@pytest.mark.parametrize(("name", "energy", "channel", "section"), NECKS + ON_AXIS)
def test_orbits_on_the_arcs_tend_to_the_lyapunov_orbit(name: str, energy: float, channel: int, section: str) -> None:
    potential, plane = POTENTIALS[name], read_section(section).plane
    points = np.concatenate([np.column_stack([arc.x, arc.ordinate]) for arc in arcs_of(name, energy, channel, section)])
    starts = start_states(potential, plane, energy, *points[:: max(1, len(points) // 3)].T)
    orbit = next(orbit for orbit in find_lyapunov_orbits(potential, energy) if orbit.channel == channel)
    assert distances(orbit, starts[np.isfinite(starts).all(axis=1)]).max() < 1e-4


@pytest.mark.parametrize(("name", "energy", "channel", "section"), NECKS)
def test_orbits_inside_the_first_image_leave_before_they_cross_the_section(
    name: str, energy: float, channel: int, section: str
) -> None:
    (arc,) = arcs_of(name, energy, channel, section)
    spec = MapSpec(POTENTIALS[name], read_section(section).plane, energy, (100, 100), t_max=20.0, section=read_section(section))
    found = compute_map(spec)
    leaves = (found.fate == channel) & (found.crossings == 0)
    points = shapely.points(*np.meshgrid(found.x, found.ordinate))
    is_inside = shapely.contains(shapely.Polygon(np.column_stack([arc.x, arc.ordinate])), points)
    is_allowed = found.fate >= 0
    assert np.count_nonzero(is_inside & is_allowed) > 200
    assert np.mean((is_inside == leaves)[is_allowed]) > 0.999


@pytest.mark.parametrize("name", ["Earth-Moon", "Hill", "Logarithmic bar"])
def test_stable_manifolds_are_mirror_images_of_unstable_ones(name: str) -> None:
    # With reversed momenta, the unstable manifolds are the stable ones of the frame that rotates the other way. The reflection
    # y → −y, which turns the rotation around, leaves x and px unchanged.
    potential = POTENTIALS[name]
    energy = potential.escape_energy + 0.02 * abs(potential.escape_energy)
    stable = find_stable_manifolds(potential, energy, images=1, section="y = 0")
    unstable = find_stable_manifolds(potential.reversed_in_time, energy, images=1, section="y = 0 down")
    for channel in (1, 2):
        one, other = (
            np.concatenate([np.column_stack([arc.x, arc.ordinate]) for arc in found.arcs if arc.channel == channel])
            for found in (stable, unstable)
        )
        # Both curves begin at the Lyapunov orbit's own point, but need not end at the same point.
        assert min(farthest(one, other), farthest(other, one)) < 2e-3 * np.ptp(one, axis=0).max()


def farthest(points: np.ndarray, curve: np.ndarray) -> float:
    """Return the largest distance of points from a curve."""
    return float(shapely.distance(shapely.LineString(curve), shapely.points(points)).max())


def test_both_exits_of_a_symmetric_system_have_images_turned_by_180_degrees() -> None:
    # Hill's problem is unchanged by (x, y) → (−x, −y), which maps x = 0.4, px > 0 to x = −0.4, px < 0, and L2 to L1.
    one, turned = (
        shapely.LineString(np.column_stack([sign * arc.x, sign * arc.ordinate]))
        for sign, (arc,) in (
            (1.0, arcs_of("Hill", -2.0, 1, "x = 0.4, px > 0")),
            (-1.0, arcs_of("Hill", -2.0, 2, "x = -0.4, px < 0")),
        )
    )
    assert shapely.hausdorff_distance(one, turned) < 1e-3


def test_arcs_end_where_the_tube_meets_a_body() -> None:
    # Backward in time, the tube of L1 reaches the Moon, whose surface bounds the slice y = 0 on this side.
    found = manifolds("Earth-Moon", -1.09, "y = 0")
    (body,) = (end for end in POTENTIALS["Earth-Moon"].ends if hasattr(end, "radius"))
    (arc,) = arcs_of("Earth-Moon", -1.09, 2, "y = 0")
    assert found.truncated
    assert arc.x.max() == pytest.approx(-body.radius, abs=1e-5)
