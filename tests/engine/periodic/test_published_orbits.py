"""Periodic orbits have the periods, the stability and the bifurcations of closed forms and of publications."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from scipy.special import ellipk, gamma, mathieu_a

from engine import (
    CASES,
    POTENTIALS,
    PeriodicOrbit,
    Potential,
    SpecialKind,
    System,
    continue_family,
    find_periodic_orbit,
    parse_formula,
)
from engine.foundations.root_finding import find_root

III, HH, HILL, SEPARABLE = CASES["III"], POTENTIALS["HH"], POTENTIALS["Hill"], POTENTIALS["Separable"]
LATTICE = parse_formula("2 − cos(x) − cos(y)")
# Morse's motion along y = 0 over the saddle (De Leon and Berne 1981, J. Chem. Phys. 75, 3495).
DE_LEON_BERNE = parse_formula("10(1 − exp(−1.5x))² + 1 + 4y²(y² − 1) exp(−1.5x); masses (8, 8)")
PLUMMER, ISOCHRONE = parse_formula("−1/√(r² + 1)"), parse_formula("−1/(1 + √(1 + r²))")
LOGARITHMIC, KEPLER = parse_formula("½ log(r² + 0.1)"), parse_formula("−1/r; centre sun (0, 0) 0.001")
OSCILLATOR = parse_formula("½(x² + 2y²)")
SUN_EARTH = System("Copenhagen", "", {"m": 3.0542e-6}).potential
SUN_EARTH_START = [0.9919572253872686, 0.0, 0.0, -0.011810020232594805]


class Orbit(NamedTuple):
    """A periodic orbit: a start near it, the section, its period and its stability index, None if it is not known."""

    potential: Potential
    start: list[float]
    section: str
    period: float
    index: float | None


def along(direction: tuple[float, float], potential: Potential, energy: float, x: float = 0.0, y: float = 0.0) -> list[float]:
    """The state at a place with momentum in a direction at an energy."""
    momentum = np.sqrt(2.0 * potential.mass * (energy - potential.value(x, y))) * np.array(direction) / np.hypot(*direction)
    return [x, y, *momentum]


ALONG_X, DIAGONAL = (1.0, 0.0), (1.0, 1.0)


def pendulum(kinetic: float) -> float:
    """Period of a pendulum with a kinetic energy at its lowest point, 0 to 2."""
    return 4.0 * float(ellipk(0.5 * kinetic))


def cubic(energy: float) -> float:
    """Period of u″ = −u − u²."""
    low, middle, high = np.sort(np.roots([1.0 / 3.0, 0.5, 0.0, -energy]).real)
    return float(2.0 * np.sqrt(6.0 / (high - low)) * ellipk((high - middle) / (high - low)))


def softening(energy: float) -> float:
    """Period of u″ = −u + u³."""
    amplitude = 1.0 - np.sqrt(1.0 - 4.0 * energy)
    return float(4.0 / np.sqrt(1.0 - 0.5 * amplitude) * ellipk(amplitude / (2.0 - amplitude)))


def power(degree: int, energy: float, coefficient: float) -> float:
    """Period of the motion in c uᵏ."""
    amplitude = (energy / coefficient) ** (1.0 / degree)
    integral = np.sqrt(np.pi) / degree * gamma(1.0 / degree) / gamma(1.0 / degree + 0.5)
    return float(4.0 * amplitude / np.sqrt(2.0 * energy) * integral)


def homogeneous_index(degree: int, curvature: float) -> float:
    """a of a straight orbit in a homogeneous potential of a degree, by Yoshida 1984, Celest. Mech. 32, 73.

    The curvature is that across the orbit, where the slope along it equals the distance from the origin. The matrix of half a
    period, with the reflected orbit, has b = cos(π √((k − 2)² + 8kλ) / 2k) / sin(π/k).
    """
    root = np.emath.sqrt((degree - 2.0) ** 2 + 8.0 * degree * curvature)
    half = np.cos(np.pi * root / (2.0 * degree)).real / np.sin(np.pi / degree)
    return float(2.0 * half**2 - 1.0)


def mathieu_index(a: float, q: float) -> float:
    """½ tr over a period π of Mathieu's equation, by Hill's determinant (Whittaker and Watson, section 19.42)."""
    orders = 2.0 * np.arange(-200, 201)
    across = q / (orders**2 - a)
    determinant = np.linalg.det(np.eye(orders.size) + np.diag(across[1:], -1) + np.diag(across[:-1], 1))
    return float(1.0 - 2.0 * determinant * (np.sin(0.5 * np.pi * np.emath.sqrt(a)) ** 2).real)


def quartic(coupling: float, energy: float, direction: tuple[float, float]) -> Orbit:
    """A straight orbit of V = x⁴ + y⁴ + e x² y²."""
    potential = parse_formula(f"x⁴ + y⁴ + {coupling}x²y²")
    is_diagonal = direction == DIAGONAL
    coefficient = 0.25 * (2.0 + coupling) if is_diagonal else 1.0
    curvature = (6.0 - coupling) / (2.0 + coupling) if is_diagonal else 0.5 * coupling
    start = along(direction, potential, energy)
    return Orbit(potential, start, "x = 0 up", power(4, energy, coefficient), homogeneous_index(4, curvature))


def sextic(coupling: float, energy: float) -> Orbit:
    """A straight orbit of V = x⁶ + y⁶ + e x² y² r²."""
    potential = parse_formula(f"x⁶ + y⁶ + {coupling}x²y²(x² + y²)")
    index = homogeneous_index(6, coupling / 3.0)
    return Orbit(potential, along(ALONG_X, potential, energy), "x = 0 up", power(6, energy, 1.0), index)


def circular(potential: Potential, radius: float, rotation: float = 0.0, sense: float = 1.0) -> Orbit:
    """A circular orbit in a frame at rest or in a rotating frame, with Ω² = V′/r and κ² = V″ + 3Ω²."""
    slope, curvature = potential.gradient(radius, 0.0)[0], potential.hessian_matrix(radius, 0.0)[0, 0]
    frequency, epicyclic = sense * np.sqrt(slope / radius), np.sqrt(curvature + 3.0 * slope / radius)
    relative = frequency - rotation
    period = 2.0 * np.pi / abs(relative)
    frame = potential.in_rotating_frame(rotation) if rotation else potential
    section = "y = 0 up" if relative > 0.0 else "y = 0 down"
    return Orbit(frame, [radius, 0.0, 0.0, relative * radius], section, period, np.cos(epicyclic * period))


def morse(excess: float) -> Orbit:
    """The orbit over the saddle of De Leon and Berne's potential at an energy above it, with the period of Morse's motion."""
    period = 2.0 * np.pi * np.sqrt(8.0 / (20.0 * 1.5**2 * (1.0 - 0.1 * excess)))
    return Orbit(DE_LEON_BERNE, along(ALONG_X, DE_LEON_BERNE, 1.0 + excess), "x = 0 up", period, None)


def barbanis(energy: float) -> Orbit:
    """The orbit y = 0: across it, Mathieu's equation with a = 4 · 1.21, q = 0.44 √(2h)."""
    potential = POTENTIALS["Barbanis"]
    index = mathieu_index(4.84, 0.44 * np.sqrt(2.0 * energy))
    return Orbit(potential, along(ALONG_X, potential, energy), "x = 0 up", 2.0 * np.pi, index)


def straight_in_iii(energy: float) -> Orbit:
    """The orbit y = 0: across it, Mathieu's equation with a = 1 − 2h, q = h, twice in a period."""
    index = 2.0 * mathieu_index(1.0 - 2.0 * energy, energy) ** 2 - 1.0
    return Orbit(III, along(ALONG_X, III, energy), "x = 0 up", 2.0 * np.pi, index)


def rotating_oscillator() -> Orbit:
    """A normal mode of ½(x² + 2y²) at Ω = 0.3: (1 − Ω² − ω²)(2 − Ω² − ω²) = 4Ω² ω²."""
    slow, fast = np.sqrt(np.sort(np.roots([1.0, -(3.0 + 2.0 * 0.09), (1.0 - 0.09) * (2.0 - 0.09)])))
    ratio = (1.0 - 0.09 - slow**2) / (0.6 * slow)
    start = [1.0, 0.0, 0.0, ratio * slow]
    section = "y = 0 up" if ratio > 0.0 else "y = 0 down"
    frame = OSCILLATOR.in_rotating_frame(0.3)
    return Orbit(frame, start, section, 2.0 * np.pi / slow, np.cos(2.0 * np.pi * fast / slow))


def oterma(x: float, sense: float, period: float) -> Orbit:
    """A Lyapunov orbit of Sun and Jupiter at the Jacobi constant of comet Oterma."""
    mass = 0.0009537
    potential = System("Copenhagen", "", {"m": mass}).potential
    start = along((0.0, sense), potential, -0.5 * (3.03 - mass * (1.0 - mass)), x)
    return Orbit(potential, start, "y = 0 up" if sense > 0.0 else "y = 0 down", period, None)


ORBITS = {
    # Separable: ½v² + 1 − cos along the orbit, and an oscillator or a saddle of unit curvature across it.
    "lattice, well": Orbit(LATTICE, along(ALONG_X, LATTICE, 1.0), "x = 0 up", pendulum(1.0), np.cos(pendulum(1.0))),
    "lattice, saddle": Orbit(LATTICE, along(ALONG_X, LATTICE, 2.7, y=np.pi), "x = 0 up", pendulum(0.7), np.cosh(pendulum(0.7))),
    # Separable in u = x ± y, each with u″ = −u − u².
    "separable, well": Orbit(SEPARABLE, along(DIAGONAL, SEPARABLE, 0.03), "x = 0 up", cubic(0.06), np.cos(cubic(0.06))),
    "separable, saddle": Orbit(
        SEPARABLE, along(DIAGONAL, SEPARABLE, 1.0 / 12.0 + 0.03, -0.5, 0.5), "x + y = 0 up", cubic(0.06), np.cosh(cubic(0.06))
    ),
    "Hénon–Heiles, straight": Orbit(HH, along((0.0, 1.0), HH, 0.12), "y = 0 up", cubic(0.12), None),
    "III, diagonal": Orbit(III, along(DIAGONAL, III, 0.2), "x + y = 0 up", softening(0.2), None),
    "III, straight, stable": straight_in_iii(0.2),
    "III, straight, unstable": straight_in_iii(0.6),
    "Barbanis, stable": barbanis(2.0),
    "Barbanis, unstable": barbanis(8.0),
    # UPOsHam's data have 2.66256983609 and 2.7925268032 (Lyu, Naik and Wiggins 2020, J. Open Source Softw. 5, 1684).
    "De Leon and Berne, 0.1": morse(0.1),
    "De Leon and Berne, 1": morse(1.0),
    "quartic 0.5, axis": quartic(0.5, 0.7, ALONG_X),
    "quartic 0.5, diagonal": quartic(0.5, 0.7, DIAGONAL),
    "quartic 3, axis": quartic(3.0, 0.2, ALONG_X),
    "quartic 7, axis": quartic(7.0, 2.0, ALONG_X),
    "quartic 7, diagonal": quartic(7.0, 2.0, DIAGONAL),
    "quartic 10, diagonal": quartic(10.0, 2.0, DIAGONAL),
    "sextic 1": sextic(1.0, 0.7),
    "sextic 4": sextic(4.0, 0.7),
    # Binney and Tremaine 2008, Galactic Dynamics, section 3.2.3.
    "Plummer": circular(PLUMMER, 0.7),
    "Plummer, rotating frame": circular(PLUMMER, 0.7, 0.4),
    "isochrone": circular(ISOCHRONE, 1.3),
    "logarithmic, rotating frame": circular(LOGARITHMIC, 0.7, 0.3),
    "Kepler, rotating frame": circular(KEPLER, 0.4, 1.0),
    "Kepler, retrograde": circular(KEPLER, 0.4, 1.0, -1.0),
    "oscillator, rotating frame": rotating_oscillator(),
    # Wilczak and Zgliczyński 2003, Commun. Math. Phys. 234, 37: proved between 3.082119126376508 and 3.082119126392904.
    "Oterma, L1": oterma(0.92080349132074, 1.0, 3.0821191263847),
    # The catalogue of JPL, see `MOON`.
    "Sun and Earth, L1": Orbit(SUN_EARTH, SUN_EARTH_START, "y = 0 down", 3.0848099797153212, None),
}


@pytest.mark.parametrize("name", ORBITS)
def test_period_and_stability_are_those_of_the_closed_form_or_of_the_publication(name: str) -> None:
    expected = ORBITS[name]
    orbit = find_periodic_orbit(expected.potential, expected.start, 1, section=expected.section)
    assert orbit.period == pytest.approx(expected.period, rel=3e-12)
    if expected.index is not None:
        assert orbit.stability_index == pytest.approx(expected.index, rel=3e-9, abs=3e-9)


def test_simple_orbits_of_henon_and_heiles_have_the_periods_of_the_normal_form() -> None:
    # h = J − (5/12) J² + (7/12) L² to second order (Gustavson 1966, Astron. J. 71, 670): orbits A and B with L = 0 have
    # T = 2π (1 + 5h/6), orbits C with L = ±J have T = 2π (1 − h/3) and the rotation angle 14πh/3.
    energy = 1e-5
    for direction, section in [((1.0, 0.0), "x = 0 up"), ((0.0, 1.0), "y = 0 up")]:
        straight = find_periodic_orbit(HH, along(direction, HH, energy), 1, section=section)
        assert (straight.period / (2.0 * np.pi) - 1.0) / energy == pytest.approx(5.0 / 6.0, rel=1e-4)
    circular_orbit = find_periodic_orbit(HH, along((0.0, 1.0), HH, energy, np.sqrt(energy)), 1)
    assert (circular_orbit.period / (2.0 * np.pi) - 1.0) / energy == pytest.approx(-1.0 / 3.0, rel=1e-4)
    assert 2.0 * np.pi * circular_orbit.rotation_number / energy == pytest.approx(14.0 * np.pi / 3.0, rel=1e-4)


def test_the_straight_orbit_of_henon_and_heiles_branches_again_and_again_below_the_saddle() -> None:
    # Brack 2001, Found. Phys. 31, 209: e = 6h of the first four bifurcations; 1 − e of every second one falls by e^(2π/√3).
    family = continue_family(find_periodic_orbit(HH, along((0.0, 1.0), HH, 0.161), 1), 0.16666)
    scaled = 6.0 * np.array([point.energy for point in family.special if point.kind is SpecialKind.BRANCHING])
    assert scaled == pytest.approx([0.969309, 0.986709, 0.999188, 0.999650], abs=1e-6)
    ratios = (1.0 - scaled[:2]) / (1.0 - scaled[2:])
    assert ratios == pytest.approx(np.exp(2.0 * np.pi / np.sqrt(3.0)), rel=0.01)


def test_special_points_of_the_straight_orbit_of_the_lattice() -> None:
    # a = cos T, and T grows from 2π: a resonance m : n is at T = 2π (1 + m/n) and T = 2π (2 − m/n), a touches −1 at T = 3π.
    family = continue_family(find_periodic_orbit(LATTICE, along(ALONG_X, LATTICE, 0.9), 1, section="x = 0 up"), 1.87)
    expected = [(1, 6), (1, 5), (1, 4), (1, 3), (2, 5), (1, 2), (3, 5), (2, 3), (3, 4)]
    energies = [
        find_root(lambda h, m=m, n=n: pendulum(h) - 2.0 * np.pi * (1.0 + m / n), 0.5, 1.9, xtol=1e-14) for m, n in expected
    ]
    assert [point.energy for point in family.special] == pytest.approx(energies, abs=1e-10)
    names = [f"resonance {min(m, n - m)}:{n}" for m, n in expected]
    names[expected.index((1, 2))] = "touching"
    assert [point.name for point in family.special] == names


def test_the_straight_orbit_of_barbanis_branches_where_a_mathieu_function_is_periodic() -> None:
    energy = find_root(lambda h: mathieu_a(2, 0.44 * np.sqrt(2.0 * h)) - 4.84, 2.0, 8.0, xtol=1e-13)
    potential = POTENTIALS["Barbanis"]
    family = continue_family(find_periodic_orbit(potential, along(ALONG_X, potential, 4.0), 1, section="x = 0 up"), 8.0)
    (branching,) = [point for point in family.special if point.kind is SpecialKind.BRANCHING]
    assert branching.energy == pytest.approx(energy, abs=1e-9)


def test_hills_orbit_of_the_moon_has_his_motion_of_the_perigee() -> None:
    # Hill 1886, Acta Math. 8, 1: T = 2πm with m = 0.08084893380831, and c0 = 1.07158327741601, so a = cos(2π c0).
    period = 2.0 * np.pi * 0.08084893380831
    family = continue_family(find_periodic_orbit(HILL, [0.17, 0.0, 0.0, 2.2], 1), (-3.6, -3.0))
    energy = find_root(lambda h: family.at(h)[0].period - period, -3.5, -3.1, xtol=1e-14)
    (orbit,) = family.at(energy)
    assert 1.0 + orbit.rotation_number == pytest.approx(1.07158327741601, abs=1e-11)


def small_orbit(mass: float, point: float) -> PeriodicOrbit:
    """A small orbit around a point L1 or L2 of the restricted three-body problem."""
    potential = System("Copenhagen", "", {"m": mass}).potential
    x = find_root(lambda place: potential.gradient(place, 0.0)[0], point - 0.1, point + 0.1, xtol=1e-15)
    return find_periodic_orbit(potential, [x - 1e-4, 0.0, 0.0, 1e-4 * steepness(mass, x)], 1)


def steepness(mass: float, x: float) -> float:
    """Speed of a small orbit at its return, relative to its size (Szebehely 1967, Theory of Orbits, section 5.3).

    With K = (1 − μ)/r1³ + μ/r2³, it is ½ (ω² + 1 + 2K), and ω² = ½ (2 − K + √(9K² − 8K)).
    """
    strength = (1.0 - mass) / abs(x + mass) ** 3 + mass / abs(x - 1.0 + mass) ** 3
    square = 0.5 * (2.0 - strength + np.sqrt(9.0 * strength**2 - 8.0 * strength))
    return float(0.5 * (square + 1.0 + 2.0 * strength))


# Mass ratio and orbits of the catalogue of JPL, https://ssd.jpl.nasa.gov/tools/periodic_orbits.html: Jacobi constants, periods.
MOON = 0.01215058560962404
LYAPUNOV = {
    "L1": (0.84, {3.15273107702723: 2.8325231152377177, 2.91113555914615: 6.525492852637634}),
    "L2": (1.15, {2.95787377644491: 5.640853006654308}),
}


@pytest.mark.parametrize("name", LYAPUNOV)
def test_lyapunov_orbits_of_the_moon_have_the_periods_of_the_catalogue(name: str) -> None:
    place, periods = LYAPUNOV[name]
    family = continue_family(small_orbit(MOON, place), -0.5 * min(periods))
    for constant, period in periods.items():
        # The constants of the catalogue have 15 digits.
        (orbit,) = family.at(-0.5 * constant)
        assert orbit.period == pytest.approx(period, rel=1e-11)


def test_small_orbits_around_equilibria_have_the_linear_frequencies() -> None:
    # Copenhagen problem, L1: K = 8, ω² = 8√2 − 3. Hill's problem: ω² = 2√7 − 1.
    assert small_orbit(0.5, 0.0).period == pytest.approx(2.0 * np.pi / np.sqrt(8.0 * np.sqrt(2.0) - 3.0), rel=1e-6)
    place, omega = 3.0 ** (-1.0 / 3.0), np.sqrt(2.0 * np.sqrt(7.0) - 1.0)
    around_l2 = find_periodic_orbit(HILL, [place - 1e-5, 0.0, 0.0, 1e-5 * 0.5 * (omega**2 + 9.0)], 1)
    assert around_l2.period == pytest.approx(2.0 * np.pi / omega, rel=1e-6)
    assert -2.0 * around_l2.energy == pytest.approx(3.0 ** (4.0 / 3.0), abs=1e-6)


@pytest.mark.parametrize("is_long", [True, False], ids=["long period", "short period"])
def test_small_orbits_around_l4_have_both_frequencies(is_long: bool) -> None:
    # Szebehely 1967, section 5.4: ω² = ½ (1 ∓ √(1 − 27μ(1 − μ))).
    mass = 0.0009537
    potential = System("Copenhagen", "", {"m": mass}).potential
    place = np.array([0.5 - mass, 0.5 * np.sqrt(3.0)])
    own, other = np.sqrt(0.5 * (1.0 + np.array([-1.0, 1.0]) * np.sqrt(1.0 - 27.0 * mass * (1.0 - mass))))[:: 1 if is_long else -1]
    # The real part of a solution exp(iωt) of the linear equations.
    curvatures = potential.hessian_matrix(*place)
    ratio = -(curvatures[0, 0] - own**2) / (curvatures[0, 1] - 2j * own)
    offset = 1e-4 * np.array([1.0, ratio])
    start = np.concatenate([place + offset.real, (1j * own * offset).real])
    orbit = find_periodic_orbit(potential, start, 1, section=f"x = {place[0]:.17g} up", t_max=200.0)
    assert orbit.period == pytest.approx(2.0 * np.pi / own, rel=1e-6)
    assert orbit.stability_index == pytest.approx(np.cos(2.0 * np.pi * other / own), abs=1e-5)
