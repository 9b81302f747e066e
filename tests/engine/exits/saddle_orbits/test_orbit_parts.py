"""Monodromy matrices agree with closed forms, also where the orbit does not show what acts across it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import CASES, Potential, find_lyapunov_orbits, parse_formula
from engine.exits.saddle_orbits.orbit_parts import monodromy_matrix


def matrix_of(potential: Potential, state: tuple[float, ...], period: float) -> np.ndarray:
    units = potential.units
    return monodromy_matrix(potential.in_well_units, np.array(state) / units.state, period / units.time)


# Largest multiplier of the orbit y = 0 of case I at some energies, by Mathieu's equation with a = 4, q = 4 √(2h).
MATHIEU = {0.13: 1.8110179097, 0.15: 1.9759288610, 0.20: 2.4404084116, 0.30: 3.6053023236}


@pytest.mark.parametrize("energy", MATHIEU)
def test_the_orbit_along_the_axis_of_case_i_has_the_multipliers_of_mathieus_equation(energy: float) -> None:
    found = np.linalg.eigvals(matrix_of(CASES["I"], (0.0, 0.0, (2.0 * energy) ** 0.5, 0.0), 2.0 * np.pi))
    assert np.abs(found).max() == pytest.approx(MATHIEU[energy], abs=1e-10)


# The force along x = 0 is that of an oscillator in all of them. Across it, V″ changes with y.
ACROSS: dict[str, Callable[[float], float]] = {
    "½(x² + y²) − x²y²": lambda y: 1.0 - 2.0 * y**2,
    "½(x² + y²) + 3x²y⁴": lambda y: 1.0 + 6.0 * y**4,
    "½(x² + y²) + x²y^8": lambda y: 1.0 + 2.0 * y**8,
}


@pytest.mark.parametrize("text", ACROSS)
@pytest.mark.parametrize("energy", [0.1, 0.3, 0.8])
def test_deviations_across_an_orbit_are_resolved_that_the_orbit_does_not_show(text: str, energy: float) -> None:
    amplitude = (2.0 * energy) ** 0.5

    def derivative(t: float, deviations: np.ndarray) -> list[float]:
        curvature = ACROSS[text](amplitude * np.sin(t))
        return [deviations[1], -curvature * deviations[0], deviations[3], -curvature * deviations[2]]

    path = solve_ivp(derivative, (0.0, 2.0 * np.pi), [1.0, 0.0, 0.0, 1.0], "DOP853", rtol=1e-13, atol=1e-14)
    expected = path.y[0, -1] + path.y[3, -1]
    trace = float(np.trace(matrix_of(parse_formula(text), (0.0, 0.0, 0.0, amplitude), 2.0 * np.pi)))
    assert trace - 2.0 == pytest.approx(expected, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("stiffness", [1.0, 4.0, 9.0, 20.0, 30.0])
def test_multipliers_of_a_separable_saddle_are_those_of_its_exponent(stiffness: float) -> None:
    potential = parse_formula(f"½y² + {stiffness / 2.0}x² − {stiffness / 2.0}x³")
    (orbit,) = find_lyapunov_orbits(potential, potential.escape_energy + 0.3)
    assert orbit.period == pytest.approx(2.0 * np.pi, rel=1e-12)
    assert orbit.multipliers[0].real == pytest.approx(np.exp(stiffness**0.5 * orbit.period), rel=1e-8)
