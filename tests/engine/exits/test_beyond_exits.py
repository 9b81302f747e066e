"""Energies at which orbits can leave for infinity beside the exits are refused, and orbits there are followed without exits."""

from __future__ import annotations

import numpy as np
import pytest

from engine import parse_formula
from engine.exits.lyapunov_orbits import UndefinedExitsError, find_lyapunov_orbits
from engine.maps.compute import compute_map
from engine.maps.spec import MapSpec
from engine.propagation.fates import Evidence, Fate
from engine.slices.planes import SECTION
from engine.systems.known_potentials import POTENTIALS
from engine.systems.potential import Potential
from engine.trajectories.orbit_verdicts import judge_orbit
from engine.trajectories.trajectory import integrate_orbit

# Two wells below V(∞) = 0, with a saddle between them at −0.8.
TWO_WELLS = parse_formula("½x² − 2/(1 + (y − 2)²) − 2/(1 + (y + 2)²); well (0, 2)")
# A bond that breaks at 200.
BOND = parse_formula("½x² + 200(1 − exp(−0.05y))²")


@pytest.mark.parametrize(("energy", "exits"), [(-1.0, 0), (-0.79, 1), (-0.5, 1), (-0.05, 1)])
def test_exits_are_found_below_v_at_infinity(energy: float, exits: int) -> None:
    assert len(find_lyapunov_orbits(TWO_WELLS, energy)) == exits


@pytest.mark.parametrize("energy", [0.01, 0.2, 5.0])
def test_energies_above_v_at_infinity_are_refused(energy: float) -> None:
    with pytest.raises(UndefinedExitsError, match="leads to infinity beside the exits"):
        find_lyapunov_orbits(TWO_WELLS, energy)


def test_the_answer_is_the_same_in_mirrored_and_turned_axes() -> None:
    mirrored = parse_formula("½x² − 2/(1 + (y − 2)²) − 2/(1 + (y + 2)²); well (0, −2)")
    turned = parse_formula("½y² − 2/(1 + (x − 2)²) − 2/(1 + (x + 2)²); well (2, 0)")
    for potential in (mirrored, turned):
        assert len(find_lyapunov_orbits(potential, -0.05)) == 1
        with pytest.raises(UndefinedExitsError):
            find_lyapunov_orbits(potential, 0.2)


@pytest.mark.parametrize("factor", [1.01, 2.0, 10.0, 50.0])
def test_walls_without_openings_are_not_refused(factor: float) -> None:
    potential = parse_formula("½r² + x²y² − 0.000001x⁶")
    assert len(find_lyapunov_orbits(potential, factor * potential.escape_energy)) == 2


def test_an_orbit_along_an_open_channel_is_not_called_bounded() -> None:
    orbit = integrate_orbit(TWO_WELLS, (0.1, 0.0, 0.0, 2.2), 1000.0)
    assert orbit.y[-1] > 100.0
    assert judge_orbit(orbit).describe().startswith("Followed until t = 1 000")


def test_an_orbit_of_a_broken_bond_is_not_called_bounded() -> None:
    orbit = integrate_orbit(BOND, (0.1, 0.0, 0.0, 25.0), 400.0)
    assert orbit.y[-1] > 5000.0
    assert orbit.evidence is not Evidence.CLOSED
    assert "is shown to be closed only up to" in judge_orbit(orbit).describe()


def test_a_map_above_the_energy_at_which_a_bond_breaks_is_refused() -> None:
    with pytest.raises(UndefinedExitsError, match="is shown to be closed only up to"):
        compute_map(MapSpec(BOND, SECTION, 250.0, (8, 8), t_max=10.0))


@pytest.mark.parametrize(("potential", "energy"), [(BOND, 150.0), (parse_formula("x² + y²"), 2.0), (TWO_WELLS, -0.9)])
def test_all_orbits_of_a_closed_well_are_bounded_for_ever(potential: Potential, energy: float) -> None:
    escapes = compute_map(MapSpec(potential, SECTION, energy, (12, 12), t_max=1e4))
    is_orbit = escapes.fate != Fate.FORBIDDEN
    assert is_orbit.any()
    assert np.all(escapes.fate[is_orbit] == Fate.BOUNDED)
    assert np.isin(escapes.evidence[is_orbit], (Evidence.CLOSED, Evidence.MIRRORED)).all()


def test_an_orbit_needs_no_list_of_critical_points() -> None:
    # The exponentials overflow in the region in which critical points are searched.
    potential = parse_formula("exp(6x + 7y) + exp(6x − 7y) + exp(−12x) − 3")
    orbit = integrate_orbit(potential, (0.01, 0.0, 0.0, 0.4), 100.0)
    assert (orbit.fate, orbit.evidence) == (Fate.BOUNDED, Evidence.CLOSED)
    assert orbit.energy_error < 1e-10


def test_an_energy_at_which_no_orbit_turns_is_refused_in_the_usual_words() -> None:
    # The energy of the maximum between both exits.
    potential = POTENTIALS["Separable"]
    with pytest.raises(UndefinedExitsError, match="no Lyapunov orbit was found"):
        find_lyapunov_orbits(potential, 2.0 * potential.escape_energy)
