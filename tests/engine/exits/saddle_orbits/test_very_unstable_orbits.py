"""Lyapunov orbits whose errors grow beyond all digits in half a period are found, and agree with closed forms and DOP853."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import LyapunovOrbit, Potential, find_lyapunov_orbits, find_stable_manifolds, parse_formula
from engine.systems.known_potentials import POTENTIALS
from tests.peers.dop853 import equations

# Wells along a parabola; errors grow by 1e12 to 1e25 in half a period over the saddles in their sides.
BENT = {
    0.1: "½(x − 0.3271y²)² − 0.3106(x − 0.3271y²)⁴ + 0.0075y²",
    0.5: "½(x − 0.0440y²)² − 0.2020(x − 0.0440y²)⁴ + 0.0061y²",
    2.0: "½(x − 0.0564y²)² − 0.5325(x − 0.0564y²)⁴ + 0.0133y²",
}
each_bent_well = pytest.mark.parametrize(("factor", "text"), BENT.items())


def bent_orbits(factor: float, text: str) -> tuple[LyapunovOrbit, ...]:
    """Return the orbits at a number of escape energies above the escape energy."""
    potential = parse_formula(text)
    return find_lyapunov_orbits(potential, (1.0 + factor) * potential.escape_energy)


def integrated(potential: Potential, start: np.ndarray, duration: float) -> np.ndarray:
    end: np.ndarray = solve_ivp(equations(potential), (0.0, duration), start, "DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
    return end


@pytest.mark.parametrize("omega", [0.1, 0.05, 0.03])
@pytest.mark.parametrize("degrees", [0.0, 10.0, 100.0])
def test_orbits_over_a_wide_saddle_that_is_separable_are_known(omega: float, degrees: float) -> None:
    # Along u = 1, v oscillates; across, deviations grow as exp(t), by exp(π/ω) in half a period.
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    u, v = f"({c}x + {s}y)", f"({c}y − {s}x)"
    potential = parse_formula(f"½{u}² − ⅓{u}³ + {0.5 * omega**2}{v}²")
    (orbit,) = find_lyapunov_orbits(potential, 0.2)
    period = 2.0 * np.pi / omega
    assert orbit.period == pytest.approx(period, rel=1e-10)
    np.testing.assert_allclose(c * orbit.x + s * orbit.y, 1.0, rtol=0, atol=1e-9)
    assert np.log(2.0 * orbit.stability_index) == pytest.approx(period, rel=1e-9)
    assert orbit.action == pytest.approx((0.2 - 1.0 / 6.0) * period, rel=1e-9)


@each_bent_well
def test_each_part_of_an_orbit_ends_where_the_next_one_begins(factor: float, text: str) -> None:
    orbits = bent_orbits(factor, text)
    assert len(orbits) == 2
    for orbit in orbits:
        well, nodes = orbit.potential.in_well_units, orbit.nodes
        ends = [integrated(well, state, time) for state, time in zip(nodes.states, nodes.durations.tolist(), strict=True)]
        np.testing.assert_allclose(ends, np.roll(nodes.states, -1, axis=0), rtol=0, atol=1e-7)


@each_bent_well
def test_an_orbit_is_at_rest_on_both_walls(factor: float, text: str) -> None:
    for orbit in bent_orbits(factor, text):
        assert orbit.potential.value(orbit.x[[0, 100]], orbit.y[[0, 100]]) == pytest.approx([orbit.energy] * 2, rel=1e-12)


@each_bent_well
def test_the_slope_of_the_action_is_the_period(factor: float, text: str) -> None:
    below, at, above = (bent_orbits(factor * scale, text) for scale in (0.999, 1.0, 1.001))
    for one, orbit, other in zip(below, at, above, strict=True):
        assert (other.action - one.action) / (other.energy - one.energy) == pytest.approx(orbit.period, rel=1e-5)


@pytest.mark.parametrize("name", ["III", "C8"])
def test_orbits_of_the_catalogue_are_found_at_fifty_times_the_escape_energy(name: str) -> None:
    potential = POTENTIALS[name]
    orbits = find_lyapunov_orbits(potential, 50.0 * potential.escape_energy)
    assert len(orbits) == potential.channels
    # The symmetries of the well exchange all its exits.
    np.testing.assert_allclose([orbit.period for orbit in orbits], orbits[0].period, rtol=1e-9)
    np.testing.assert_allclose([orbit.stability_index for orbit in orbits], orbits[0].stability_index, rtol=1e-4)


def test_the_tube_of_a_very_unstable_orbit_is_refused() -> None:
    potential = parse_formula(BENT[0.1])
    with pytest.raises(ValueError, match="is too unstable for its tube"):
        find_stable_manifolds(potential, 1.1 * potential.escape_energy)
