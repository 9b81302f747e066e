"""Equilibria of rotating systems and their energies agree with solutions of the equations in 40 digits."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest

from engine import System, review_potential

ACCURACY = 1e-12


def critical(name: str) -> dict[tuple[float, float], float]:
    """Return the energies of the critical points of a system, by position."""
    return {(point.x, point.y): point.energy for point in review_potential(System(name).potential).critical_points}


def nearest(name: str, x: mpmath.mpf, y: mpmath.mpf) -> tuple[float, float, float]:
    points = critical(name)
    place = min(points, key=lambda each: np.hypot(each[0] - float(x), each[1] - float(y)))
    return (*place, points[place])


def equilibrium(phi, x: float, y: float) -> tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf]:
    with mpmath.workdps(40):
        gradient = [lambda x, y, order=order: mpmath.diff(phi, (x, y), order) for order in ((1, 0), (0, 1))]
        if y == 0.0:
            place = (mpmath.findroot(lambda x: gradient[0](x, mpmath.mpf(0)), x), mpmath.mpf(0))
        else:
            place = tuple(mpmath.findroot(gradient, (x, y)))
        return (*place, phi(*place))


def check(name: str, x: mpmath.mpf, y: mpmath.mpf, energy: mpmath.mpf) -> None:
    found = nearest(name, x, y)
    size = float(mpmath.hypot(x, y)) or 1.0
    assert abs(found[0] - x) < ACCURACY * size
    assert abs(found[1] - y) < ACCURACY * size
    assert abs(found[2] - energy) < ACCURACY * abs(energy)


def barred_galaxy(x, y):
    """Return Φ of Jung & Zotos (2016) at z = 0, with nucleus, disc (h + k = 3.175), halo, bar and rotation."""
    r2, rate = x**2 + y**2, mpmath.mpf("4.5")
    spheres = ((400, "0.25"), (7000, "3.175"), (20000, "20"))
    central = sum(-mass / mpmath.sqrt(r2 + mpmath.mpf(size) ** 2) for mass, size in spheres)
    near, far = (x + side * 10 + mpmath.sqrt((x + side * 10) ** 2 + y**2 + 1) for side in (-1, 1))
    return central + mpmath.mpf(3500) / 20 * mpmath.log(near / far) - rate**2 * r2 / 2


@pytest.mark.parametrize("guess", [(10.6, 0.0), (0.0, 7.6)])
def test_lagrange_points_of_the_barred_galaxy(guess: tuple[float, float]) -> None:
    with mpmath.workdps(40):
        check("Barred galaxy", *equilibrium(barred_galaxy, *guess))


def test_energy_of_l2_of_the_barred_galaxy_is_the_published_one() -> None:
    assert System("Barred galaxy").potential.escape_energy == pytest.approx(-3242.77217493, abs=1e-8)


def test_lagrange_points_of_the_star_cluster() -> None:
    with mpmath.workdps(40):
        core, k = (mpmath.mpf(System("Star cluster").value_of(letter)) for letter in "ck")
        # x / (x² + c²)^(3/2) = (4 − κ²) x, for Ω = 1.
        tide = 4 - k**2
        x2 = mpmath.power(tide, mpmath.mpf(-2) / 3) - core**2
        check("Star cluster", mpmath.sqrt(x2), mpmath.mpf(0), -1 / mpmath.sqrt(x2 + core**2) - tide * x2 / 2)
