"""Families along a parameter of the system have the special points of closed forms, and members in their own potentials."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.special import mathieu_a, mathieu_b

from engine import (
    CASES,
    POTENTIALS,
    OrbitFamily,
    Potential,
    SpecialKind,
    System,
    continue_family,
    find_periodic_orbit,
    open_result,
    parse_formula,
)

III, ENERGY = CASES["III"], 0.3
# Along x = 0 the motion is y = √(2h) cos t, whatever the parameters of x.
STRAIGHT = find_periodic_orbit(III, [0.0, 0.0, 0.0, np.sqrt(2.0 * ENERGY)], 1)
# h ε at which the straight orbit of case III loses its stability: Mathieu's equation with a = 1 − 2 h ε, q = h ε.
LOSS = brentq(lambda product: mathieu_a(0, product) - (1.0 - 2.0 * product), 0.5, 0.7, xtol=1e-15)


def values(family: OrbitFamily, name: str) -> list[float]:
    return [point.value for point in family.special if point.name == name]


@pytest.fixture(scope="module")
def in_epsilon() -> OrbitFamily:
    return continue_family(STRAIGHT, (0.6, 2.2), along="epsilon")


def test_special_points_along_epsilon_are_those_of_mathieus_equation(in_epsilon: OrbitFamily) -> None:
    assert values(in_epsilon, "branching") == pytest.approx([LOSS / ENERGY], abs=1e-10)
    assert values(in_epsilon, "touching") == pytest.approx([0.4355768771451 / ENERGY], abs=1e-10)
    assert values(in_epsilon, "resonance 1:3") == pytest.approx(np.array([0.3222182591, 0.5166989029]) / ENERGY, abs=1e-9)


# The motion across the orbit is Mathieu's equation with a = ω1² − 2h, q = h.
def test_the_orbit_is_unstable_between_the_characteristic_values_of_mathieus_equation() -> None:
    family = continue_family(STRAIGHT, (0.6, 1.6), along="omega_1")
    edges = [mathieu_a(0, ENERGY), mathieu_b(1, ENERGY), mathieu_a(1, ENERGY)]
    assert values(family, "branching") == pytest.approx(np.sqrt(np.array(edges) + 2.0 * ENERGY), abs=1e-10)


def test_a_letter_of_a_formula_in_other_units_has_the_same_special_point() -> None:
    # V = ½ w² r² − c x² y² with w = 10 is case III with ε = c h / w⁴.
    system, energy = System.from_formula("50(x² + y²) − c x²y²", c=5.0), 700.0
    orbit = find_periodic_orbit(system.potential, [0.0, 0.0, 0.0, np.sqrt(2.0 * energy)], 1)
    family = continue_family(orbit, 10.0, along="c")
    assert values(family, "branching") == pytest.approx([LOSS * 1e4 / energy], rel=1e-10)
    assert family.period == pytest.approx(0.2 * np.pi, abs=1e-12)


def test_a_fold_along_a_parameter_is_that_along_the_energy() -> None:
    # Orbits depend on h ε only.
    straight = continue_family(STRAIGHT, 0.6)
    branch = straight.switch([point.kind for point in straight.special].index(SpecialKind.BRANCHING), 0.1)[0]
    # From here the value falls to the fold, and rises again.
    of_energy, of_epsilon = continue_family(branch, 0.57), continue_family(branch, 0.9, along="epsilon")
    (fold,) = values(of_energy, "fold")
    assert values(of_epsilon, "fold") == pytest.approx([fold / branch.energy], abs=1e-10)
    assert of_epsilon.ends[0] == "it turns back to the lowest or highest value of ε"
    between = 0.5 * (fold + branch.energy)
    pairs = of_energy.at(between), of_epsilon.at(between / branch.energy)
    indices = [sorted(orbit.stability_index for orbit in pair) for pair in pairs]
    assert len(indices[0]) == 2
    assert indices[0] == pytest.approx(indices[1], abs=1e-9)


def test_a_resonance_of_a_rotating_oscillator_is_at_the_rate_of_its_normal_modes() -> None:
    # In V = ½ (x² + c y²), the squares of the frequencies are the roots s of (1 − Ω² − s)(c − Ω² − s) = 4 Ω² s.
    def ratio(rate: float) -> float:
        roots = np.roots([1.0, -(1.5 + 2.0 * rate**2), (1.0 - rate**2) * (0.5 - rate**2)])
        return float(np.sqrt(roots.min() / roots.max()))

    system = System.from_formula("½(x² + c y²)", c=0.5, rotation=0.2)
    # The fast mode: x = −cos ωt, y = b sin ωt.
    frequency = float(np.sqrt(np.roots([1.0, -1.58, 0.96 * 0.46]).max()))
    b = (frequency**2 - 0.96) / (2.0 * 0.2 * frequency)
    orbit = find_periodic_orbit(system.potential, [-1.0, 0.0, 0.0, b * frequency], 1)
    family = continue_family(orbit, 0.6, along="rotation")
    wanted = brentq(lambda rate: ratio(rate) - 1.0 / 3.0, 0.2, 0.6, xtol=1e-15)
    assert values(family, "resonance 1:3") == pytest.approx([wanted], abs=1e-10)


def test_a_symmetry_of_one_value_alone_is_none_of_the_family() -> None:
    # x = 0 is an orbit for every k; half a period maps it onto itself for k = 0 only.
    energy = 0.43
    system = System.from_formula("½(x² + y²) − x²y² + k x²y", k=0.0)

    def trace(k: float) -> float:
        def motion(t: float, state: np.ndarray) -> np.ndarray:
            y = np.sqrt(2.0 * energy) * np.cos(t)
            return np.concatenate([state[2:], -(1.0 - 2.0 * y * y + 2.0 * k * y) * state[:2]])

        end = solve_ivp(motion, (0.0, 2.0 * np.pi), [1.0, 0.0, 0.0, 1.0], "DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
        return float(end[0] + end[3])

    orbit = find_periodic_orbit(system.potential, [0.0, 0.0, 0.0, np.sqrt(2.0 * energy)], 1)
    family = continue_family(orbit, 0.3, along="k")
    assert values(family, "touching") == []
    assert values(family, "period doubling")[0] == pytest.approx(brentq(lambda k: trace(k) + 2.0, 1e-3, 0.1), abs=1e-9)


def test_members_are_closed_orbits_of_one_energy_in_their_own_potentials() -> None:
    potential = POTENTIALS["Earth-Moon"]
    energy, x = -1.12, 0.0555
    orbit = find_periodic_orbit(potential, [x, 0.0, 0.0, np.sqrt(2.0 * (energy - potential.value(x, 0.0)))], 1)
    family = continue_family(orbit, 0.02, along="m", most_members=5)
    for number in (2, 4):
        member = family[number]
        other = System("Earth-Moon", parameters={"m": float(family.value[number])}).potential
        assert member.potential == other
        assert other.energy(member.start) == pytest.approx(orbit.energy, abs=1e-11)
        again = find_periodic_orbit(other, member.start, 1)
        assert (again.period, again.stability_index) == pytest.approx((member.period, member.stability_index), abs=1e-9)


def test_at_finds_the_orbit_of_a_value_in_its_potential(in_epsilon: OrbitFamily) -> None:
    (orbit,) = in_epsilon.at(1.3)
    assert orbit.potential == III.with_parameters(epsilon=1.3)
    # The orbit of h ε = 0.39 of case III.
    alike = find_periodic_orbit(III, [0.0, 0.0, 0.0, np.sqrt(0.78)], 1)
    assert orbit.stability_index == pytest.approx(alike.stability_index, abs=1e-10)
    assert in_epsilon.at(2.3) == ()


def test_a_family_says_along_what_it_was_continued(in_epsilon: OrbitFamily, tmp_path: Path) -> None:
    assert (in_epsilon.along, in_epsilon.symbol) == ("epsilon", "ε")
    assert "from ε = 0.6 to 2.2" in in_epsilon.describe()
    assert in_epsilon.ends == ("the value of ε asked for is reached",) * 2
    in_epsilon.save(tmp_path / "family.nc")
    opened = open_result(tmp_path / "family.nc", OrbitFamily)
    assert opened.along == "epsilon"
    assert opened[3].potential == in_epsilon[3].potential != III


def test_what_is_no_parameter_of_the_system_is_refused() -> None:
    with pytest.raises(ValueError, match=r"along='m': must be one of h, omega_1, omega_2, epsilon, rotation$"):
        continue_family(STRAIGHT, 2.0, along="m")
    with pytest.raises(ValueError, match=r"parameter omega_1 from 1 to 20: must be between 0\.1 and 10"):
        continue_family(STRAIGHT, 20.0, along="omega_1")
    unknown = find_periodic_orbit(Potential("by terms", III.terms), STRAIGHT.start, 1)
    with pytest.raises(ValueError, match=r"along='c': must be one of h; the parameters of .* are not known"):
        continue_family(unknown, 2.0, along="c")


def test_a_family_is_continued_along_a_letter_of_a_parsed_formula() -> None:
    orbit = find_periodic_orbit(parse_formula("½(x² + y²) − a x²y²", parameters={"a": 1.0}), STRAIGHT.start, 1)
    family = continue_family(orbit, 2.0, along="a")
    assert family.along == "a"
    assert family.value[-1] == 2.0


def test_branches_of_a_family_along_a_parameter_move_in_their_own_potentials(in_epsilon: OrbitFamily) -> None:
    number = [point.kind for point in in_epsilon.special].index(SpecialKind.BRANCHING)
    point = in_epsilon.special[number]
    branches = in_epsilon.switch(number)
    assert len(branches) == 2
    for orbit in branches:
        assert orbit.potential != in_epsilon[point.member].potential
        assert orbit.potential.energy(orbit.start) == pytest.approx(in_epsilon.energy[0], abs=1e-10)
        assert find_periodic_orbit(orbit.potential, orbit.start, 1).period == pytest.approx(orbit.period, rel=1e-10)
    one, other = branches
    np.testing.assert_allclose(one.states * [-1.0, 1.0, -1.0, 1.0], other.states, atol=1e-9)


# Case III with ε at h is case III with ε = 1 at ε h: lengths and momenta shrink by √ε.
def test_branches_along_a_parameter_are_those_along_the_energy(in_epsilon: OrbitFamily) -> None:
    along_h = continue_family(STRAIGHT, 0.6)
    numbers = [[point.kind for point in family.special].index(SpecialKind.BRANCHING) for family in (in_epsilon, along_h)]
    orbit = in_epsilon.switch(numbers[0])[0]
    epsilon = orbit.potential.system.value_of("epsilon")
    scaled = find_periodic_orbit(III, orbit.start * np.sqrt(epsilon), 1)
    branch = continue_family(along_h.switch(numbers[1])[0], (scaled.energy - 1e-3, scaled.energy + 0.05))
    assert scaled.stability_index == pytest.approx(orbit.stability_index, abs=1e-9)
    assert min(abs(each.period - scaled.period) for each in branch.at(scaled.energy)) < 1e-9


def test_a_family_reaches_the_last_legal_value_of_a_parameter() -> None:
    orbit = find_periodic_orbit(CASES["I"], [0.0, 0.0, 0.0, 0.3], 1)
    family = continue_family(orbit, 0.01, along="epsilon")
    assert family.ends[0] == "the value of ε asked for is reached"
    assert family.value[0] == 0.01


def test_the_point_at_which_two_families_meet_is_found_on_both() -> None:
    # In a rotating frame, the straight orbits of case III become oval, and meet at a round orbit.
    oval = continue_family(find_periodic_orbit(III, [0.0, 0.0, 0.0, 0.5], 1), 0.4, along="rotation", most_members=16)
    rotating = System("III", parameters={"rotation": 0.05}).potential
    speed = np.sqrt(2.0 * (0.125 - rotating.value(0.355, 0.0)))
    round_orbit = continue_family(find_periodic_orbit(rotating, [-0.355, 0.0, 0.0, speed], 1), 0.0, along="rotation")
    (meeting,) = values(round_orbit, "branching")
    assert values(oval, "fold") == pytest.approx([meeting], abs=1e-9)
    assert all(point.converged for point in oval.special)
