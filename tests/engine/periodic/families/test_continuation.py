"""Families have the bifurcations that closed forms and publications give, and end where they are said to end."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from scipy.special import mathieu_a

from engine import (
    CASES,
    POTENTIALS,
    Execution,
    OrbitFamily,
    SpecialKind,
    continue_family,
    find_lyapunov_orbits,
    find_periodic_orbit,
)
from engine.foundations.root_finding import find_root

III, HH, HILL = CASES["III"], POTENTIALS["HH"], POTENTIALS["Hill"]


@pytest.fixture(scope="module")
def straight_in_iii() -> OrbitFamily:
    return continue_family(find_periodic_orbit(III, [0.0, 0.0, 0.0, np.sqrt(0.4)], 1), (0.1, 0.7))


@pytest.fixture(scope="module")
def straight_in_hh() -> OrbitFamily:
    return continue_family(find_periodic_orbit(HH, [0.0, 0.0, 0.0, np.sqrt(0.2)], 1), (0.08, 0.1664))


def energies(family: OrbitFamily, name: str) -> list[float]:
    return [point.energy for point in family.special if point.name == name]


# Case III: the motion across the orbit x = 0 is Mathieu's equation with a = 1 − 2h, q = h.
def test_special_points_of_the_straight_orbit_of_case_iii_are_those_of_mathieus_equation(straight_in_iii: OrbitFamily) -> None:
    end = find_root(lambda h: mathieu_a(0, h) - (1.0 - 2.0 * h), 0.5, 0.7, xtol=1e-14)
    assert energies(straight_in_iii, "branching") == pytest.approx([end], abs=1e-10)
    assert energies(straight_in_iii, "touching") == pytest.approx([0.4355768771451], abs=1e-10)
    assert energies(straight_in_iii, "resonance 1:3") == pytest.approx([0.3222182591, 0.5166989029], abs=1e-10)
    assert energies(straight_in_iii, "resonance 1:4") == pytest.approx([0.2535261072, 0.5451192444], abs=1e-10)
    assert energies(straight_in_iii, "resonance 2:5") == pytest.approx([0.3714162994, 0.4881303559], abs=1e-10)
    assert all(point.converged for point in straight_in_iii.special)


# Brack 2001, nlin/0006034, has the first six digits.
def test_bifurcations_of_the_straight_orbit_of_henon_and_heiles(straight_in_hh: OrbitFamily) -> None:
    branchings, doublings = energies(straight_in_hh, "branching"), energies(straight_in_hh, "period doubling")
    assert 6.0 * np.array(branchings) == pytest.approx([0.9693090907, 0.9867092353], abs=1e-9)
    assert 6.0 * np.array(doublings) == pytest.approx([0.8117155158, 0.9152144129, 0.9950130051, 0.9978490551], abs=1e-9)
    periods = [point.period for point in straight_in_hh.special if point.kind is SpecialKind.BRANCHING]
    assert periods == pytest.approx([9.57104822, 10.39875359], abs=1e-7)


def test_family_g_of_hills_problem_loses_its_stability_where_henon_found_it() -> None:
    # Hénon 1969, Astron. Astrophys. 1, 223: Γ = 4.49999, ξ = 0.28350. Γ = −2h.
    orbit = find_periodic_orbit(HILL, [0.28, 0.0, 0.0, 1.5], 1)
    family = continue_family(orbit, -2.1)
    point = next(point for point in family.special if point.kind is SpecialKind.BRANCHING)
    assert -2.0 * point.energy == pytest.approx(4.4999858448, abs=1e-8)
    assert family.states[point.member, 0, 0] == pytest.approx(0.2834967478, abs=1e-8)
    assert point.period == pytest.approx(1.2258745653, abs=1e-8)
    # The other family, g', is not symmetric about the y axis.
    branch, _ = family.switch(family.special.index(point))
    (of_family,) = family.at(branch.energy)
    assert abs(branch.x[0] - of_family.x[0]) > 1e-4


def test_members_are_closed_orbits_of_their_energy(straight_in_hh: OrbitFamily) -> None:
    for member in list(straight_in_hh)[::7]:
        assert HH.energy(member.start) == pytest.approx(member.energy, abs=1e-11)
        again = find_periodic_orbit(HH, member.start, 1)
        assert again.period == pytest.approx(member.period, abs=1e-9)


def test_the_slope_of_the_action_is_the_period(straight_in_hh: OrbitFamily) -> None:
    smooth = slice(0, 30)
    energy, action = straight_in_hh.energy[smooth], straight_in_hh.action[smooth]
    differences = np.diff(action) / np.diff(energy)
    middles = [straight_in_hh.at(float(h))[0].period for h in 0.5 * (energy[1:] + energy[:-1])]
    assert differences == pytest.approx(middles, rel=1e-3)


def test_a_family_is_followed_through_its_fold() -> None:
    straight = continue_family(find_periodic_orbit(III, [0.0, 0.0, 0.0, np.sqrt(0.4)], 1), 0.65)
    number = [point.kind for point in straight.special].index(SpecialKind.BRANCHING)
    family = continue_family(straight.switch(number)[0], (0.5, 0.7))
    folds = [point for point in family.special if point.kind is SpecialKind.FOLD]
    # The branch begins below the point at which it is born, turns, and crosses the energy of this point again.
    assert min(point.energy for point in folds) < straight.special[number].energy < family.energy.max()
    assert len(family.at(0.58)) >= 2
    for member in family.at(0.58):
        assert member.energy == pytest.approx(0.58, abs=1e-12)
        assert III.energy(member.start) == pytest.approx(0.58, abs=1e-11)


def test_a_doubled_orbit_has_twice_the_returns_and_period(straight_in_hh: OrbitFamily) -> None:
    number = [point.kind for point in straight_in_hh.special].index(SpecialKind.DOUBLING)
    (branch,) = straight_in_hh.switch(number, 1e-3)
    assert branch.returns == 2
    assert branch.period == pytest.approx(2.0 * straight_in_hh.special[number].period, rel=1e-4)
    assert abs(branch.x[0]) > 1e-5


def test_both_sides_of_a_branch_are_mirror_images(straight_in_iii: OrbitFamily) -> None:
    number = [point.kind for point in straight_in_iii.special].index(SpecialKind.BRANCHING)
    one, other = straight_in_iii.switch(number)
    np.testing.assert_allclose(other.states * [-1.0, 1.0, -1.0, 1.0], one.states, atol=1e-9)


def test_at_finds_the_orbit_of_an_energy_and_nothing_beyond_the_ends(straight_in_iii: OrbitFamily) -> None:
    (orbit,) = straight_in_iii.at(0.3)
    assert orbit.stability_index == pytest.approx(-0.340506, abs=1e-6)
    assert straight_in_iii.at(0.05) == ()
    assert len(straight_in_iii.at(0.1)) == len(straight_in_iii.at(0.7)) == 1


# Contopoulos, Harsoula & Lukes-Gerakopoulos 2012, arXiv:1203.1010, describe this family. Near the saddle, errors grow at the rate
# 1 and turn at the rate √2 about the orbit y = √2 x, whose period is −ln(1/8 − h) + …: a turn more takes e^(2π/√2) times less.
def test_bifurcations_of_case_i_accumulate_at_its_escape_energy_and_their_families_go_on_above_it() -> None:
    speed = np.sqrt(0.2)
    orbit = find_periodic_orbit(CASES["I"], [0.0, 0.0, speed / np.sqrt(3.0), speed * np.sqrt(2.0 / 3.0)], 1)
    family = continue_family(orbit, 0.125)
    assert family.ends[1] == "the period grows without limit, because the orbits tend to an equilibrium"
    branchings = np.array(energies(family, "branching"))
    ratios = (0.125 - branchings[:-2]) / (0.125 - branchings[2:])
    assert ratios[-2:] == pytest.approx(np.exp(np.sqrt(2.0) * np.pi), rel=2e-4)
    child = family.switch([point.kind for point in family.special].index(SpecialKind.BRANCHING))[0]
    assert continue_family(child, 0.14, most_members=300).energy.max() == 0.14


def test_at_finds_the_orbits_between_members_of_an_unstable_family() -> None:
    moon = POTENTIALS["Earth-Moon"]
    (exit_orbit,) = (orbit for orbit in find_lyapunov_orbits(moon, moon.jacobi_energy(3.16)) if orbit.name == "L1")
    family = continue_family(exit_orbit, moon.jacobi_energy(2.91))
    middles = 0.5 * (family.energy[1:] + family.energy[:-1])[::12]
    periods = [[orbit.period for orbit in family.at(float(h))] for h in middles]
    assert [len(found) for found in periods] == [1] * len(middles)
    assert np.ravel(periods) == pytest.approx(0.5 * (family.period[1:] + family.period[:-1])[::12], rel=1e-2)


def test_the_family_says_why_it_ends() -> None:
    orbit = find_periodic_orbit(III, [0.0, 0.0, 0.0, np.sqrt(0.1)], 1)
    assert continue_family(orbit, 0.1).ends == ("it was continued from this orbit", "the energy asked for is reached")
    assert continue_family(orbit, -1.0).ends[0] == "the orbits shrink to an equilibrium"
    assert continue_family(orbit, 0.4, most_members=3).ends[1] == "the largest number of members is reached"


def test_a_family_that_turns_back_to_its_first_energy_says_so() -> None:
    straight = continue_family(find_periodic_orbit(III, [0.0, 0.0, 0.0, np.sqrt(0.4)], 1), 0.65)
    number = [point.kind for point in straight.special].index(SpecialKind.BRANCHING)
    branch = straight.switch(number)[0]
    # The energy falls from here to a fold, and rises again.
    family = continue_family(branch, 0.5)
    assert family.ends[0] == "it turns back to the lowest or highest energy"


def test_a_family_that_tends_to_a_saddle_says_so() -> None:
    # The straight orbit of Hénon and Heiles tends to the orbit that is homoclinic to the saddle at h = 1/6.
    family = continue_family(find_periodic_orbit(HH, [0.0, 0.0, 0.0, np.sqrt(2.0 * 0.1666)], 1), 0.2)
    assert family.ends[1] == "the period grows without limit, because the orbits tend to an equilibrium"
    assert family.energy.max() == pytest.approx(1.0 / 6.0, abs=1e-7)
    assert family.period.max() > 16.0


def test_frames_grow_and_a_cancelled_family_ends_early() -> None:
    orbit = find_periodic_orbit(III, [0.0, 0.0, 0.0, np.sqrt(0.4)], 1)
    sizes: list[int] = []
    cancel = threading.Event()

    def keep(frame: OrbitFamily) -> None:
        sizes.append(len(frame))
        if len(sizes) == 4:
            cancel.set()

    family = continue_family(orbit, 0.6, execution=Execution(cancel=cancel), on_frame=keep)
    assert len(sizes) == 4
    assert sizes == sorted(sizes)
    assert not family.complete
    assert family.ends[1] == "the search was cancelled"


@pytest.mark.parametrize("until", [0.2, (0.3, 0.4), (0.3, 0.1), np.nan, (0.1, 0.2, 0.3)])
def test_illegal_ranges_are_refused(until: object) -> None:
    orbit = find_periodic_orbit(III, [0.0, 0.0, 0.0, np.sqrt(0.4)], 1)
    with pytest.raises(ValueError, match="until"):
        continue_family(orbit, orbit.energy if until == 0.2 else until)


def test_what_is_no_branch_is_refused(straight_in_iii: OrbitFamily) -> None:
    with pytest.raises(ValueError, match="number=99"):
        straight_in_iii.switch(99)
    with pytest.raises(ValueError, match=r"step=0\.6"):
        straight_in_iii.switch(0, 0.6)


def test_no_family_is_followed_from_a_fold() -> None:
    branch = continue_family(find_periodic_orbit(III, [0.0, 0.0, 0.0, np.sqrt(0.4)], 1), 0.65)
    branch = continue_family(branch.switch([point.kind for point in branch.special].index(SpecialKind.BRANCHING))[0], 0.55)
    number = [point.kind for point in branch.special].index(SpecialKind.FOLD)
    with pytest.raises(ValueError, match="no other family is followed from this fold"):
        branch.switch(number)


# Birkhoff 1913, Trans. Amer. Math. Soc. 14, 14: orbits of a chain of islands alternate with unstable ones.
@pytest.mark.parametrize(("turns", "returns"), [(1, 5), (1, 3), (2, 5), (1, 6)])
def test_a_stable_and_an_unstable_orbit_are_born_at_a_resonance(straight_in_hh: OrbitFamily, turns: int, returns: int) -> None:
    number = [point.name for point in straight_in_hh.special].index(f"resonance {turns}:{returns}")
    point = straight_in_hh.special[number]
    branches = straight_in_hh.switch(number, 0.08)
    assert {orbit.returns for orbit in branches} == {returns}
    excess = [orbit.stability_index - 1.0 for orbit in branches]
    assert min(excess) < 0.0 < max(excess)
    assert max(excess) == pytest.approx(-min(excess), rel=0.2)
    for orbit in branches:
        assert orbit.period == pytest.approx(returns * point.period, rel=0.01)
        assert find_periodic_orbit(HH, orbit.start, returns).period == pytest.approx(orbit.period, rel=1e-9)


def test_the_orbits_of_a_branch_approach_the_special_point(straight_in_hh: OrbitFamily) -> None:
    number = [point.name for point in straight_in_hh.special].index("resonance 1:3")
    point = straight_in_hh.special[number]
    distances = [min(abs(orbit.energy - point.energy) for orbit in straight_in_hh.switch(number, step)) for step in (0.02, 0.04)]
    # The energy changes with the square of the distance.
    assert distances[1] == pytest.approx(4.0 * distances[0], rel=0.05)


def test_several_families_meet_a_touching_orbit(straight_in_iii: OrbitFamily) -> None:
    number = [point.kind for point in straight_in_iii.special].index(SpecialKind.TOUCHING)
    branches = straight_in_iii.switch(number, 0.02)
    assert {orbit.returns for orbit in branches} == {2}
    assert min(orbit.stability_index for orbit in branches) < 1.0 < max(orbit.stability_index for orbit in branches)
