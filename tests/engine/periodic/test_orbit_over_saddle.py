"""Lyapunov orbits are continued to their families, whose members are the Lyapunov orbits of other energies."""

from __future__ import annotations

import numpy as np
import pytest

from engine import CASES, POTENTIALS, LyapunovOrbit, Potential, continue_family, find_lyapunov_orbits, parse_formula
from tests.engine.exits.test_merged_exits import MAXIMUM, SYMMETRIC

HILL = POTENTIALS["Hill"]

# Potential, two energies, and the channel.
ORBITS = {
    "I": (CASES["I"], 0.19, 0.3, 1),
    "II, an oblique channel": (CASES["II"], 0.3, 0.2, 2),
    "III": (CASES["III"], 0.4, 0.6, 4),
    "Hill": (HILL, -2.1, -2.0, 1),
    "in other units": (parse_formula("40(x² + 2y²) + 3x³"), 4000.0, 4500.0, 1),
    "over two saddles": (SYMMETRIC, 1.2 * MAXIMUM, 1.25 * MAXIMUM, 1),
}


def orbit_at(potential: Potential, energy: float, channel: int) -> LyapunovOrbit:
    return next(orbit for orbit in find_lyapunov_orbits(potential, energy) if orbit.channel == channel)


@pytest.mark.parametrize("name", ORBITS)
def test_members_of_the_family_are_the_lyapunov_orbits_of_their_energies(name: str) -> None:
    potential, first, last, channel = ORBITS[name]
    family = continue_family(orbit_at(potential, first, channel), last)
    expected = orbit_at(potential, last, channel)
    (member,) = family.at(last)
    assert member.period == pytest.approx(expected.period, rel=1e-10)
    assert member.action == pytest.approx(expected.action, rel=1e-9)
    assert member.stability_index == pytest.approx(expected.stability_index, rel=1e-7)
    # The returns are points of the path of the Lyapunov orbit.
    distances = np.hypot(*(expected.find_path(20_000)[1:3] - np.array([[member.x[0]], [member.y[0]]])))
    assert distances.min() < 1e-3 * potential.units.length


@pytest.mark.parametrize("potential", [CASES["I"], HILL], ids=["at rest", "rotating"])
def test_the_family_begins_at_the_saddle(potential: Potential) -> None:
    orbit = orbit_at(potential, potential.escape_energy + 0.05, 1)
    family = continue_family(orbit, potential.escape_energy - 1.0)
    assert family.ends == ("the orbits shrink to an equilibrium", "it was continued from this orbit")
    assert family.energy[0] == pytest.approx(potential.escape_energy, abs=1e-5)
    np.testing.assert_allclose(family.states[0, 0, :2], potential.saddles[0], atol=1e-2)
