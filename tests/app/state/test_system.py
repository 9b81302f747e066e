"""The selected system: its potential, name and energy range."""

from __future__ import annotations

import pytest

from app.state.energy_ranges import ENERGIES
from app.state.system import TYPED, System, refusal, review_system
from engine import CASES, POTENTIALS, channel_family, parse_formula, review_potential
from plots.palette import MOST_CHANNELS

HENON_HEILES = "½(x² + y²) + x²y − y³/3"


def test_a_case_has_the_potential_and_the_energies_of_the_paper() -> None:
    assert System("II").potential == CASES["II"]
    assert review_system(System("II")).energies == ENERGIES["II"]


def test_parameters_change_the_potential_and_its_energies() -> None:
    system = System("I", epsilon=0.5)
    assert system.potential == CASES["I"].with_parameters(epsilon=0.5)
    assert system.changed == {"epsilon": 0.5}
    energies = review_system(system).energies
    assert energies is not None
    # With half the perturbation the saddles are at twice the distance and four times the energy.
    assert energies.low == pytest.approx(0.8 * 0.5)
    assert energies.marked == ()


def test_a_formula_gives_a_potential() -> None:
    assert System(TYPED, HENON_HEILES).potential == POTENTIALS["HH"].potential


@pytest.mark.parametrize("system", [System(TYPED, "x y z"), System(TYPED), System("I", omega_1=1e3)])
def test_an_invalid_system_has_no_potential(system: System) -> None:
    with pytest.raises(ValueError, match=r"formula|omega_1"):
        _ = system.potential


@pytest.mark.parametrize("name", POTENTIALS)
def test_the_slider_contains_the_escape_energy_below_the_initial_energy(name: str) -> None:
    energies, escape = review_system(System(name)).energies, POTENTIALS[name].potential.escape_energy
    assert energies is not None
    assert energies.low < escape < energies.first < energies.high <= review_potential(POTENTIALS[name].potential).highest_energy


def test_the_formula_contains_the_parameters() -> None:
    assert review_system(System("III")).formula_shown == POTENTIALS["III"].formula
    assert parse_formula(review_system(System("III", omega_2=1.5)).formula_shown) == System("III", omega_2=1.5).potential


def test_the_formula_has_no_rounding_errors_of_products() -> None:
    assert review_system(System("I", omega_1=1.46)).formula_shown == "1.0658x² + y²/2 − xy²"
    assert review_system(System(TYPED, "½r² − xy²", omega_1=1.46)).formula_shown == "1.0658x² + y²/2 − xy²"


def test_the_title_names_the_parameters() -> None:
    assert System("I").title == "Case I"
    assert System("I", omega_1=1.46, epsilon=0.5).title == "Case I with ω1 = 1.46, ε = 0.5"
    assert System(TYPED, "½r² − xy²", omega_2=2.0).title == "Typed potential with ω2 = 2"


def test_more_exits_than_colours_are_rejected() -> None:
    assert "colours" in str(refusal(review_potential(channel_family(MOST_CHANNELS + 1))))


def test_a_negative_escape_energy_is_rejected() -> None:
    assert "constant term" in str(refusal(review_potential(parse_formula(f"{HENON_HEILES} − 1"))))


def test_an_escape_energy_beyond_the_largest_number_is_refused() -> None:
    assert "energies up to 1e+09" in str(refusal(review_potential(parse_formula("(x² + y²)/2 + 1e-7y³"))))


def test_known_potentials_are_accepted() -> None:
    assert [name for name in POTENTIALS if refusal(review_potential(POTENTIALS[name].potential))] == []
