"""Test the referee itself, on systems whose answers are known in closed form, and against DOP853."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tests.peers.sampled_paths import Exits
from tests.referee.descents import Way, descend_steadily
from tests.referee.formulas import Formula
from tests.referee.images import IMAGES
from tests.referee.own_orbits import OwnOrbits, UndecidedError
from tests.referee.own_system import OwnSystem

HENON_HEILES = OwnSystem(Formula("0.5*(x^2+y^2)+x^2*y-y^3/3").expression)
MORSE = OwnSystem(Formula("0.5*x^2+200*(1-exp(-0.05*y))^2").expression)


def test_orbits_agree_with_dop853() -> None:
    start = np.array([0.1, 0.2, 0.3, 0.1])
    _, state = OwnOrbits(HENON_HEILES, 10.0).state_at(start, 20.0)
    peer = solve_ivp(
        lambda _t, s: [*s[2:], *-HENON_HEILES.gradient(*s[:2])], (0.0, 20.0), start, "DOP853", rtol=1e-12, atol=1e-14
    )
    assert state == pytest.approx(peer.y[:, -1], abs=1e-9)


def test_an_orbit_ends_where_it_crosses_an_exit() -> None:
    orbits = OwnOrbits(OwnSystem(Formula("0*x+0*y").expression), 10.0)
    end = orbits.end_of(np.array([0.0, 0.0, 2.0, 0.5]), Exits([3], [np.array([[1.0, -1.0], [1.0, 1.0]])]), 5.0)
    assert (end.channel, end.time) == (3, pytest.approx(0.5, abs=1e-6))


def test_an_orbit_that_steps_over_a_narrow_wall_is_undecided() -> None:
    # The orbit comes back to the wall on y = 0 from y = 113, where the series of heyoka does not show the wall.
    orbits = OwnOrbits(OwnSystem(Formula("0.5*log(0.5164*x^2+0.8292*y^2+1)+0.4472*x^2*y^2*exp(-0.6937*y^2)").expression), 1000.0)
    with pytest.raises(UndecidedError, match="energy"):
        orbits.state_at(np.array([-1.696, 0.0, -1.5443847147650747, 2.443067222934997]), 3000.0)


@pytest.mark.parametrize(("energy_of_y", "leaves"), [(198.0, False), (202.0, True)])
def test_an_orbit_leaves_a_morse_bond_above_its_dissociation_energy(energy_of_y: float, leaves: bool) -> None:
    start = np.array([0.1, 0.0, 0.0, np.sqrt(2.0 * energy_of_y)])
    assert np.isfinite(OwnOrbits(MORSE, 1000.0).time_of_leaving(start, 1e4)) == leaves


@pytest.mark.parametrize(("start", "chaotic"), [([0.0, 0.1, 0.5, 0.0], False), ([0.0, -0.016, 0.49974, 0.0], True)])
def test_deviations_grow_exponentially_along_chaotic_orbits_alone(start: list[float], chaotic: bool) -> None:
    growth = OwnOrbits(HENON_HEILES, 10.0).growth(np.array(start), np.array([500.0, 2000.0]))
    assert (growth[1] > 40.0, growth[1] - growth[0] > 20.0) == (chaotic, chaotic)


def test_symmetries_are_found_from_values() -> None:
    found = {name for name, matrix in IMAGES.items() if HENON_HEILES.is_symmetric(matrix, 1.0)}
    assert found == {"mirrored in x", "turned by 1/3"}


def test_a_line_from_an_exit_saddle_leads_to_the_well_on_one_side_alone() -> None:
    ways = {descend_steadily(HENON_HEILES, (0.0, 1.0), side, 1.0, 1.0, 20.0)[0] for side in (1.0, -1.0)}
    assert ways == {Way.WELL, Way.ELSEWHERE}
