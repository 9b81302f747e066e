"""A system has a potential, a formula, parameters and an energy range."""

from __future__ import annotations

import pytest

from engine import CASES, POTENTIALS, ParameterAxis, System, parse_formula, review_potential
from engine.systems.catalogue.entry import CatalogueEntry
from engine.systems.catalogue.table import CATALOGUE
from engine.systems.review.potential_review import review_system
from engine.systems.system import TYPED


def test_parameters_change_the_potential_and_its_energies() -> None:
    system = System("I", parameters={"epsilon": 0.5})
    assert system.potential == CASES["I"].with_parameters(epsilon=0.5)
    assert system.parameters == {"epsilon": 0.5}
    # With half the perturbation the saddles are at twice the distance and four times the energy.
    energies = review_system(system).energies
    assert energies.low == pytest.approx(0.8 * 0.5)
    assert energies.marked == ()


def test_a_frame_may_rotate_either_way() -> None:
    for rotation in (-0.1, 0.1):
        assert System("I", parameters={"rotation": rotation}).potential.rotation == rotation
    low, high = System("I").range_of("rotation")
    assert low == -high < 0.0


def test_a_system_with_letters_rests_if_its_entry_states_no_rotation(monkeypatch: pytest.MonkeyPatch) -> None:
    entry = CatalogueEntry("Q", "Q", "½(x² + a y²) − xy²", parameters={"a": 2.0}, adjustable=("a",))
    monkeypatch.setattr("engine.systems.system.CATALOGUE", {**CATALOGUE, "Q": entry})
    assert System("Q").potential.rotation == 0.0


def test_a_typed_system_keeps_its_letters_and_rotation_when_it_is_edited() -> None:
    system = System(TYPED, "½r² − a x y²", {"a": 1.5, "rotation": 0.1})
    assert system.as_typed == system


@pytest.mark.parametrize("name", POTENTIALS)
def test_the_slider_contains_the_escape_energy_below_the_initial_energy(name: str) -> None:
    energies, escape = review_system(System(name)).energies, POTENTIALS[name].escape_energy
    assert max(energies.low, escape) < energies.first < energies.high <= review_potential(POTENTIALS[name]).highest_energy
    assert energies.low < escape or POTENTIALS[name].escape_radius is not None


@pytest.mark.parametrize("name", POTENTIALS)
def test_a_step_of_the_slider_is_at_most_a_hundredth_of_its_range(name: str) -> None:
    energies = review_system(System(name)).energies
    assert 10.0**-energies.decimals <= 0.01 * (energies.high - energies.low)


def test_the_formula_contains_the_parameters() -> None:
    assert System("III").formula_shown == CATALOGUE["III"].formula
    assert (
        parse_formula(System("III", parameters={"omega_2": 1.5}).formula_shown)
        == System("III", parameters={"omega_2": 1.5}).potential
    )


def test_letters_are_parameters_in_addition_to_those_of_the_well() -> None:
    system = System(TYPED, "½r² − a x y² + b₂ x³", {"a": 1.5, "b2": 1.0, "omega_1": 1.1})
    assert system.parameters == {"omega_1": 1.1, "a": 1.5}
    assert system.letters == {"a": 1.5, "b2": 1.0}
    assert system.potential == parse_formula("½r² − 1.5 x y² + x³").with_parameters(omega_1=1.1)
    assert system.title == "Typed potential with ω1 = 1.1, a = 1.5"
    assert hash(system) == hash(System(TYPED, system.formula, {"omega_1": 1.1, "a": 1.5}))


def test_the_system_of_a_formula_has_its_letters_and_its_rotation() -> None:
    system = System.from_formula("½r² − a x y²", a=1.5, rotation=0.1)
    assert system == System(TYPED, "½r² − a x y²", {"a": 1.5, "rotation": 0.1})
    assert system.potential.rotation == 0.1


@pytest.mark.parametrize(
    "system", [System.from_formula("½r² − a x y²", a=1.5), System("Earth-Moon"), System("I", "", {"epsilon": 2.0})]
)
def test_a_potential_knows_its_system(system: System) -> None:
    assert system.potential.system == system
    assert ParameterAxis(system.parameter_names[-1], 0.5, 2.0, system.potential).system == system


def test_a_potential_with_other_outcomes_or_in_another_frame_is_not_of_the_system() -> None:
    potential = CASES["I"]
    changed = potential.in_rotating_frame(0.1), potential.with_outcomes((), 5.0)
    assert [each.system for each in changed] == [None, None]
    assert changed[0].with_parameters(epsilon=2.0).system is None


def test_a_potential_with_other_parameters_is_of_the_system_with_these() -> None:
    changed = CASES["I"].with_parameters(omega_1=0.8)
    assert changed.system == System("I", parameters={"omega_1": 0.8})
    twice = changed.with_parameters(epsilon=2.0, omega_1=0.5)
    assert twice.system == System("I", parameters={"omega_1": 0.4, "epsilon": 2.0})
    axis = ParameterAxis("epsilon", 0.5, 1.5, changed)
    assert axis.potential(1.2) == CASES["I"].with_parameters(omega_1=0.8, epsilon=1.2)


def test_a_potential_with_a_factor_that_the_system_cannot_have_is_not_of_the_system() -> None:
    assert CASES["I"].with_parameters(omega_1=0.2).with_parameters(omega_1=0.2).system is None


def test_the_letters_of_a_parsed_formula_can_be_varied() -> None:
    potential = parse_formula("½r² − a x y²", parameters={"a": 1.5})
    axis = ParameterAxis("a", 1.0, 2.0, potential)
    assert axis.system == System.from_formula("½r² − a x y²", a=1.5)
    assert axis.potential(2.0) == parse_formula("½r² − 2 x y²")


def test_where_axes_are_moved_the_formula_says_from_where_they_count() -> None:
    shown = System(TYPED, "(x + 1.5)² + y² − (x + 1.5)² y²; well (-1.5, 0)").formula_shown
    assert shown.endswith(", where x and y count from (−1.5, 0)")
