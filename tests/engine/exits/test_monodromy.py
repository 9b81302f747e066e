"""Monodromy matrices are symplectic, and agree with closed forms and with Hamilton's equations as SciPy integrates them."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import (
    CASES,
    POTENTIALS,
    LyapunovOrbit,
    PeriodicOrbit,
    Potential,
    find_lyapunov_orbits,
    find_periodic_orbit,
    parse_formula,
)
from engine.results import Monodromy

J = np.array([[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 0.0]])
HEAVY = parse_formula("½(x² + 1.2y²) − x²y; masses (2, 2)").in_rotating_frame(0.2)


def lyapunov_orbit(name: str, energy: float, channel: int) -> LyapunovOrbit:
    potential = CASES[name] if name in CASES else POTENTIALS[name]
    return next(orbit for orbit in find_lyapunov_orbits(potential, energy) if orbit.channel == channel)


ORBITS: dict[str, Callable[[], LyapunovOrbit | PeriodicOrbit]] = {
    "I": lambda: lyapunov_orbit("I", 0.19, 1),
    "III": lambda: lyapunov_orbit("III", 0.45, 2),
    "HH": lambda: lyapunov_orbit("HH", 0.2, 3),
    "L1 of Earth-Moon": lambda: lyapunov_orbit("Earth-Moon", -1.1, 2),
    "L2 of Earth-Moon": lambda: lyapunov_orbit("Earth-Moon", -1.07, 1),
    "small in Hill's problem": lambda: lyapunov_orbit("Hill", -2.1, 1),
    "large in Hill's problem": lambda: lyapunov_orbit("Hill", -1.9, 2),
    "bar": lambda: lyapunov_orbit("Logarithmic bar", -0.45, 1),
    "galaxy": lambda: lyapunov_orbit("Barred galaxy", -3150.0, 2),
    "mass 2": lambda: find_lyapunov_orbits(HEAVY, HEAVY.escape_energy + 0.1)[0],
    "stable": lambda: find_periodic_orbit(CASES["III"], [0.0, 0.0, 0.0, 0.6], 1),
    "unstable": lambda: find_periodic_orbit(CASES["III"], [0.6, 0.0, 0.0, 0.3], 1),
}


@pytest.fixture(scope="module", params=ORBITS)
def orbit(request: pytest.FixtureRequest) -> LyapunovOrbit | PeriodicOrbit:
    return ORBITS[request.param]()


def hamiltonian_matrix(potential: Potential, x: float, y: float) -> np.ndarray:
    """The second derivatives of H = ((Px + mΩy)² + (Py − mΩx)²)/2m + Φ by x, y, Px, Py."""
    turning = potential.mass * potential.rotation
    momenta = np.array([[0.0, turning, 1.0, 0.0], [-turning, 0.0, 0.0, 1.0]])
    hessian = momenta.T @ momenta / potential.mass
    hessian[:2, :2] += potential.hessian_matrix(x, y)
    return hessian


def integrated_matrix(orbit: LyapunovOrbit | PeriodicOrbit) -> np.ndarray:
    """The monodromy matrix by DOP853, along the orbit in the variables of the library."""
    potential = orbit.potential

    def derivative(t: float, values: np.ndarray) -> np.ndarray:
        matrix = J @ hamiltonian_matrix(potential, *values[:2]) @ values[4:].reshape(4, 4)
        return np.concatenate([potential.derivatives(values[:4]), matrix.ravel()])

    start = np.concatenate([orbit.start, np.eye(4).ravel()])
    return solve_ivp(derivative, (0.0, orbit.period), start, "DOP853", rtol=1e-13, atol=1e-13).y[4:, -1].reshape(4, 4)


def size(monodromy: Monodromy) -> float:
    return float(np.abs(monodromy.matrix).max())


def test_the_matrix_is_that_of_hamiltons_equations(orbit: LyapunovOrbit | PeriodicOrbit) -> None:
    monodromy = orbit.find_monodromy()
    np.testing.assert_allclose(monodromy.matrix, integrated_matrix(orbit), rtol=0, atol=1e-8 * size(monodromy))


def test_the_matrix_is_symplectic_and_its_multipliers_have_the_product_1(orbit: LyapunovOrbit | PeriodicOrbit) -> None:
    monodromy = orbit.find_monodromy()
    # An error of the matrix is multiplied by its largest element.
    np.testing.assert_allclose(monodromy.matrix.T @ J @ monodromy.matrix, J, rtol=0, atol=1e-9 * max(size(monodromy) / 1e3, 1.0))
    assert np.prod(monodromy.multipliers) == pytest.approx(1.0, abs=1e-9)


def test_eigenvectors_are_those_of_the_multipliers(orbit: LyapunovOrbit | PeriodicOrbit) -> None:
    monodromy = orbit.find_monodromy()
    products = monodromy.matrix @ monodromy.vectors
    np.testing.assert_allclose(products, monodromy.vectors * monodromy.multipliers, rtol=0, atol=1e-11 * size(monodromy))
    np.testing.assert_allclose(np.linalg.norm(monodromy.vectors, axis=0), 1.0, rtol=1e-12)
    assert monodromy.vectors.imag.any() == (abs(orbit.stability_index) < 1.0)


def test_the_flow_has_the_multiplier_1(orbit: LyapunovOrbit | PeriodicOrbit) -> None:
    monodromy = orbit.find_monodromy()
    scale = size(monodromy) * np.abs(monodromy.flow).max()
    np.testing.assert_allclose(monodromy.matrix @ monodromy.flow, monodromy.flow, rtol=0, atol=1e-11 * scale)


def test_the_stable_vector_decays_over_a_period_although_rounding_errors_grow() -> None:
    # 1/λ = 4e-4, and M has elements of 3000: the product shrinks to 1/λ within rounding errors of these elements.
    monodromy = lyapunov_orbit("Hill", -2.1, 1).find_monodromy()
    decayed = monodromy.matrix @ monodromy.vectors[:, 1]
    assert np.linalg.norm(decayed) == pytest.approx(abs(monodromy.multipliers[1]), rel=1e-6)


@pytest.mark.parametrize("stiffness", [1.0, 4.0])
def test_the_matrix_over_a_separable_saddle_has_a_closed_form(stiffness: float) -> None:
    potential = parse_formula(f"½y² + {stiffness / 2.0}x² − {stiffness / 2.0}x³")
    (orbit,) = find_lyapunov_orbits(potential, potential.escape_energy + 0.3)
    monodromy, rate = orbit.find_monodromy(), math.sqrt(stiffness)
    growth = 2.0 * math.pi * rate
    across = [[math.cosh(growth), math.sinh(growth) / rate], [rate * math.sinh(growth), math.cosh(growth)]]
    expected = np.eye(4)
    expected[np.ix_([0, 2], [0, 2])] = across
    np.testing.assert_allclose(monodromy.matrix, expected, rtol=0, atol=1e-9 * size(monodromy))
    for vector, slope in zip(monodromy.vectors.T, (rate, -rate), strict=True):
        np.testing.assert_allclose(vector[[1, 2, 3]] / vector[0], [0.0, slope, 0.0], rtol=0, atol=1e-9)


# Largest multiplier of the orbit y = 0 of case I, by Mathieu's equation with a = 4, q = 4 √(2h).
@pytest.mark.parametrize(("energy", "multiplier"), [(0.13, 1.8110179097), (0.3, 3.6053023236)])
def test_the_orbit_along_the_axis_of_case_i_has_the_multiplier_of_mathieus_equation(energy: float, multiplier: float) -> None:
    orbit = find_periodic_orbit(CASES["I"], [0.0, 0.0, math.sqrt(2.0 * energy), 0.0], 1, section="x = 0 up")
    matrix = orbit.find_monodromy().matrix
    # Deviations along and across the orbit do not mix.
    assert np.linalg.eigvals(matrix[np.ix_([1, 3], [1, 3])]).max() == pytest.approx(multiplier, abs=1e-9)
