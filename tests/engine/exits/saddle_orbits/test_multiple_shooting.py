"""Lyapunov orbits of rotating systems, and of systems at rest by the same method, agree with published orbits and heyoka."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from engine import CASES, LyapunovOrbit, Potential, find_lyapunov_orbits
from engine.exits.saddle_orbits.multiple_shooting import SaddleOrbit, find_saddle_orbit
from engine.exits.saddle_orbits.orbit_parts import monodromy_matrix
from tests.engine.exits.rotating_systems import EARTH_MOON, at_jacobi_constant, hill, integrate, three_body
from tests.peers.random_systems import random_well

WELLS = [
    (CASES["I"], 0.1251),
    (CASES["II"], 0.5),
    (CASES["III"], 1.0),
    (random_well(9), 2.0 * random_well(9).escape_energy),
]
each_well = pytest.mark.parametrize(("potential", "energy"), WELLS)
# Channels of the Lagrange points: channel 1 is beyond the smaller body.
L1, L2 = 2, 1
HILL_SADDLE = -0.5 * 3.0 ** (4.0 / 3.0)


def orbit_of(potential: Potential, energy: float, channel: int) -> SaddleOrbit:
    """Return the orbit, in units of the well."""
    orbit = find_saddle_orbit(potential.in_well_units, energy / potential.units.energy, channel)
    assert orbit is not None
    return orbit


def multipliers(potential: Potential, orbit: SaddleOrbit) -> np.ndarray:
    values = np.linalg.eigvals(monodromy_matrix(potential.in_well_units, orbit.path[:, 0], orbit.period)).astype(complex)
    return values[np.argsort(-np.abs(values))]


def path_of(potential: Potential, energy: float, channel: int) -> tuple[float, np.ndarray]:
    """Return the period, and the path of shape (4, 201), in the units of the potential."""
    orbit = orbit_of(potential, energy, channel)
    return orbit.period * potential.units.time, orbit.path * potential.units.state[:, None]


def crossings_of(mu: float | None, period: float, path: np.ndarray) -> np.ndarray:
    """Return the states in which an orbit crosses y = 0, of shape (4, n). heyoka integrates from the point of the path before."""

    def later(point: int, time: float) -> np.ndarray:
        return integrate(mu, path[:, point], np.array([0.0, time]))[-1]

    before = np.flatnonzero(path[1, :-1] * path[1, 1:] < 0.0).tolist()
    times = [brentq(lambda time, k=k: later(k, time)[1], 1e-300, period / 200, xtol=1e-16) for k in before]
    return np.array([later(k, time) for k, time in zip(before, times, strict=True)]).T


@each_well
def test_brake_orbits_are_also_found_by_continuation(potential: Potential, energy: float) -> None:
    scaled = energy / potential.units.energy
    for expected in find_lyapunov_orbits(potential.in_well_units, scaled):
        orbit = find_saddle_orbit(potential.in_well_units, scaled, expected.channel)
        assert orbit is not None
        assert orbit.period == pytest.approx(expected.period, abs=1e-9)
        path, wanted = orbit.path[:2], np.array([expected.x, expected.y])
        # Mirrored orbits start at the other end.
        from_the_other_end = np.roll(wanted[:, :-1], 100, axis=1)
        assert min(np.abs(path - wanted).max(), np.abs(path[:, :-1] - from_the_other_end).max()) < 1e-9


@pytest.mark.parametrize(
    ("channel", "jacobi", "period", "stability"),
    [
        (L1, 3.15273107702723, 2.8325231152377177, 964.064108375553),
        (L1, 2.91113555914615, 6.525492852637634, 53.6707952348081),
        (L2, 2.95787377644491, 5.640853006654308, 61.0217545317533),
    ],
)
def test_orbits_of_earth_and_moon_agree_with_the_catalogue(channel: int, jacobi: float, period: float, stability: float) -> None:
    """Three-Body Periodic Orbits of NASA's Jet Propulsion Laboratory, version 1.0: Earth-Moon, planar Lyapunov orbits.

    Jacobi constant, period and stability index (λ + 1/λ)/2 of some members of both families, from a published copy of the
    catalogue of October 2026.
    """
    potential = three_body(EARTH_MOON)
    orbit = orbit_of(potential, at_jacobi_constant(jacobi), channel)
    assert orbit.period * three_body(EARTH_MOON).units.time == pytest.approx(period, rel=1e-9)
    largest = multipliers(potential, orbit)[0].real
    assert 0.5 * (largest + 1.0 / largest) == pytest.approx(stability, rel=1e-7)


def test_the_orbit_of_oterma_agrees_with_a_computer_assisted_proof() -> None:
    """Wilczak & Zgliczyński 2003, Commun. Math. Phys. 234, 37 (arXiv math/0201278): μ = 0.0009537, C = 3.03.

    Their C includes μ(1 − μ). They enclose the points in which the Lyapunov orbits cross y = 0. An example of their library CAPD
    bounds the period of the orbit around L1: 3.082119126376508 to 3.082119126392904.
    """
    mu = 0.0009537
    potential, energy = three_body(mu), at_jacobi_constant(3.03 - mu * (1.0 - mu), mu)
    period, path = path_of(potential, energy, L1)
    assert 3.082119126376508 < period < 3.082119126392904
    assert np.abs(crossings_of(mu, period, path)[0] + 1.0 - mu - 0.9208034913207400196).min() < 1e-11
    period, path = path_of(potential, energy, L2)
    assert np.abs(crossings_of(mu, period, path)[0] + 1.0 - mu - 1.081929486841799903).min() < 1e-11


ROTATING = [
    *((None, HILL_SADDLE + above, L2) for above in (1e-6, 1.5)),
    *((EARTH_MOON, at_jacobi_constant(jacobi), channel) for jacobi in (3.17, 2.95) for channel in (L1, L2)),
]
each_rotating = pytest.mark.parametrize(("mu", "energy", "channel"), ROTATING)


def system(mu: float | None) -> Potential:
    return hill() if mu is None else three_body(mu)


@each_rotating
def test_orbits_are_periodic_when_integrated_by_heyoka(mu: float | None, energy: float, channel: int) -> None:
    period, path = path_of(system(mu), energy, channel)
    integrated = integrate(mu, path[:, 0], np.linspace(0.0, period, 201))
    np.testing.assert_allclose(integrated[-1], path[:, 0], rtol=0, atol=1e-10)
    found = multipliers(system(mu), orbit_of(system(mu), energy, channel))
    assert abs(np.prod(found) - 1.0) < 1e-8
    # An error of the matrix changes the double eigenvalue by its square root.
    assert np.abs(found[[1, 2]] - 1.0).max() < 1e-4
    np.testing.assert_allclose(integrated, path.T, rtol=0, atol=1e-10)


@pytest.mark.parametrize("channel", [1, 2])
def test_the_period_converges_to_that_of_the_linear_centre(channel: int) -> None:
    above = 1e-6
    # In Hill's problem Φ_xx = −9 and Φ_yy = 3 at the saddles, so that s⁴ − 2s² − 27 = 0 and ν² = 2√7 − 1.
    period, _ = path_of(hill(), HILL_SADDLE + above, channel)
    assert period == pytest.approx(2.0 * np.pi / np.sqrt(2.0 * np.sqrt(7.0) - 1.0), abs=above)


def test_an_orbit_in_a_frame_that_rotates_the_other_way_is_the_mirror_image() -> None:
    forward, backward = (path_of(potential, -2.0, 1)[1] for potential in (hill(), hill().reversed_in_time))
    np.testing.assert_allclose(backward[:, ::-1], forward * np.array([1.0, 1.0, -1.0, -1.0])[:, None], atol=1e-11)


def first_orbit(potential: Potential, energy: float) -> LyapunovOrbit:
    return find_lyapunov_orbits(potential, energy)[0]


@pytest.mark.parametrize("potential", [hill(), CASES["II"], CASES["III"]], ids=lambda potential: potential.name)
def test_multipliers_of_a_lyapunov_orbit_are_those_of_the_same_orbit_by_continuation(potential: Potential) -> None:
    energy = -2.0 if potential.rotation else 1.5 * potential.escape_energy
    found = first_orbit(potential, energy).multipliers
    expected = multipliers(potential, orbit_of(potential, energy, 1))
    assert found[0] == pytest.approx(expected[0], rel=1e-7)
