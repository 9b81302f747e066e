"""Systems of the catalogue with rotating frames and bodies agree with heyoka, for random starts and grazing orbits."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import chebyshev

from engine import Potential, System, classify_orbits, find_lyapunov_orbits, sample_starts
from engine.exits.interior import find_outside_channels
from engine.integrator.kernels import exit_geometry as geometry
from engine.systems.catalogue.rotating_systems import ROTATING_ENTRIES
from engine.systems.review.potential_review import review_system
from tests.peers import taylor_heyoka
from tests.peers.exits_by_heyoka import compare

NAMES = [entry.name for entry in ROTATING_ENTRIES]
STARTS, ENERGIES, DURATION = 60, 3, 40.0
# Distances beyond an exit of the nearest points of orbits, as shares of a radius or of the distance of a saddle.
DEPTHS = (1e-9, -1e-9)
# Times from the start of a grazing orbit to its nearest point, and from there to the end, in exact units of time.
TIME_TO_TURN, AFTER = 1.0, 0.1


def energies_of(name: str) -> list[float]:
    """Return random energies from the range of the system at which exits are known."""
    system, random = review_system(System(name)), np.random.default_rng(len(name))
    found: list[float] = []
    while len(found) < ENERGIES:
        energy = float(random.uniform(system.energies.low, system.energies.high))
        try:
            find_lyapunov_orbits(system.potential, energy)
        except ValueError:
            continue
        found.append(energy)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_outcomes_agree_with_heyoka(name: str) -> None:
    potential = System(name).potential
    for energy in energies_of(name):
        starts = sample_starts(potential, energy, STARTS, rng=1)
        comparison = compare(potential, energy, starts, DURATION * potential.well.exact_time_unit)
        assert comparison.robust > 0.9 * STARTS
        assert comparison.wrong == 0


def acceleration(potential: Potential, states: np.ndarray) -> np.ndarray:
    """Return ẍ and ÿ, of shape (n, 2)."""
    x, y, px, py = states.T
    twice, (vx, vy) = 2.0 * potential.rotation, potential.gradient(x, y)
    return np.column_stack([twice * py - vx, -twice * px - vy])


def with_speeds(potential: Potential, energy: float, places: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Return the allowed states at some places with an energy and with velocities in given directions, of shape (n, 4)."""
    square = 2.0 * (energy - potential.value(*places.T))
    allowed = square > 0.0
    return np.column_stack([places, np.sqrt(square.clip(0.0))[:, None] * directions])[allowed]


def at_circle(
    potential: Potential, energy: float, centre: tuple[float, float], radius: float, sign: float, depth: float
) -> np.ndarray:
    """Return states at extrema of the distance from a centre, a share beyond the radius. `sign` is 1 for the escape circle."""
    angle = np.repeat(np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False) + 0.1, 2)
    radial = np.column_stack([np.cos(angle), np.sin(angle)])
    tangent = np.column_stack([-radial[:, 1], radial[:, 0]]) * np.tile([1.0, -1.0], 24)[:, None]
    distance = radius * (1.0 + sign * depth)
    states = with_speeds(potential, energy, np.array(centre) + distance * radial, tangent)
    from_centre = states[:, :2] - centre
    bend = (states[:, 2:] ** 2).sum(axis=1) + (from_centre * acceleration(potential, states)).sum(axis=1)
    return states[sign * bend < 0.0]


def at_line(potential: Potential, curve: np.ndarray, energy: float, depth: float) -> np.ndarray:
    """Return states of orbits that turn back inward on a line parallel to that of an exit."""
    place, outward = (
        curve[[geometry.ORIGIN_X, geometry.ORIGIN_Y]],
        curve[[geometry.OUTWARD_X, geometry.OUTWARD_Y]],
    )
    across = np.array([-outward[1], outward[0]])
    series, half = chebyshev.Chebyshev(curve[geometry.COEFFICIENTS :]), curve[geometry.HALF_WIDTH]
    s = np.repeat(np.linspace(-0.95, 0.95, 40), 2)
    u, slope, bend = series(s) + depth * np.hypot(*place), series.deriv(1)(s) / half, series.deriv(2)(s) / half**2
    points = place + u[:, None] * outward + (curve[geometry.MIDDLE] + half * s)[:, None] * across
    along = (across + slope[:, None] * outward) / np.hypot(1.0, slope)[:, None] * np.tile([1.0, -1.0], 40)[:, None]
    states = with_speeds(potential, energy, points, along)
    kept = np.isin(np.arange(len(points)), np.flatnonzero(potential.value(*points.T) < energy))
    slope, bend, forces = slope[kept], bend[kept], acceleration(potential, states)
    rise = forces @ outward - slope * (forces @ across) - bend * (states[:, 2:] @ across) ** 2
    return states[rise < 0.0]


def grazing_states(potential: Potential, energy: float, depth: float) -> list[tuple[int, np.ndarray]]:
    """Return each fate with states at the nearest points of orbits to the exit of the fate."""
    discs = enumerate(potential.centres, potential.channels + 1)
    states = [(fate, at_circle(potential, energy, (each.x, each.y), each.radius, -1.0, depth)) for fate, each in discs]
    states += [
        (orbit.channel, at_line(potential, orbit.curve, energy, depth)) for orbit in find_lyapunov_orbits(potential, energy)
    ]
    if potential.escape_radius is not None:
        circle = at_circle(potential, energy, (0.0, 0.0), potential.escape_radius, 1.0, depth)
        states.append((len(potential.outcomes), circle))
    return states


GRAZED = [
    ("Earth-Moon", -1.095),
    pytest.param("Logarithmic bar", -0.485, marks=pytest.mark.slow),
    ("Copenhagen", -1.3),
]


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize(("name", "energy"), GRAZED)
def test_an_orbit_that_grazes_an_exit_ends_there_only_beyond_it(name: str, energy: float, depth: float) -> None:
    potential = System(name).potential
    before, after = TIME_TO_TURN * potential.well.exact_time_unit, (TIME_TO_TURN + AFTER) * potential.well.exact_time_unit

    def are_inside(states: np.ndarray) -> np.ndarray:
        return find_outside_channels(potential, energy, *np.ascontiguousarray(states[:, :2].T)) == 0

    tested = 0
    for fate, turning in grazing_states(potential, energy, depth):
        # Some orbits that turn back slowly turn outward again, and cross the exit.
        turning = turning[are_inside(taylor_heyoka.propagated(potential, turning, after - before))]
        starts = taylor_heyoka.propagated(potential, turning, -before)
        # Backward in time some orbits pass close to the other body, where heyoka's steps do not conserve the energy.
        starts = starts[np.abs(potential.energy(starts) - energy) < 1e-10 * potential.units.energy]
        starts = starts[are_inside(starts)]
        # Orbits that pass an exit before their nearest point do not count.
        fresh = classify_orbits(potential, energy, starts, 0.9 * before).fate == 0
        ended = classify_orbits(potential, energy, starts[fresh], after).fate
        assert set(ended.tolist()) <= {fate if depth > 0.0 else 0}
        tested += ended.size
    assert tested > 0
