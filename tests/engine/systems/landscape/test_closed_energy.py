"""Wells are shown to be closed up to their lowest exit saddle, or up to the energy at which they open without a saddle."""

from __future__ import annotations

import numpy as np
import pytest

from engine import parse_formula
from engine.systems.known_potentials import POTENTIALS
from engine.systems.landscape.closed_energy import HIGHEST_TRIED
from engine.systems.potential import Potential

# Intervals do not show that the logarithms of its bar are defined.
UNDECIDED = {"Barred galaxy"}
WELLS = [name for name, potential in POTENTIALS.items() if potential.escape_radius is None and name not in UNDECIDED]


@pytest.mark.parametrize("name", WELLS)
def test_wells_of_the_catalogue_are_closed_up_to_their_saddles(name: str) -> None:
    potential = POTENTIALS[name]
    assert potential.well.closed_energy == potential.escape_energy


@pytest.mark.parametrize(
    ("formula", "opening"),
    [
        *(("½x² + 200(1 − exp(−0.05y))²", 200.0), ("½x² + ½y²/(1 + 0.0001y²)", 5000.0)),
        # Cores much larger and much smaller than the unit of length, which is 1.
        *(("−1/√(r² + 10000)", 0.0), ("−1/√(r² + 1)", 0.0), ("−1/√(r² + 0.01) + x²/8", 0.0), ("−1/√(r² + 0.000001)", 0.0)),
    ],
)
def test_a_well_without_saddles_is_closed_up_to_nearly_the_energy_at_which_it_opens(formula: str, opening: float) -> None:
    well = parse_formula(formula).well
    assert 0.9 * (opening - well.bottom) < well.closed_energy - well.bottom <= opening - well.bottom


@pytest.mark.parametrize("formula", ["x² + y²", "x² + y² + 0.1x²y²", "exp(6x + 7y) + exp(6x − 7y) + exp(−12x)"])
def test_a_well_with_high_walls_is_closed_at_all_energies_tried(formula: str) -> None:
    potential = parse_formula(formula)
    assert potential.well.closed_energy >= potential.well.bottom + HIGHEST_TRIED * potential.units.energy


def test_a_well_that_opens_below_its_lowest_saddle_is_not_closed_there() -> None:
    # V tends to ½ along y > 0; the only saddle, at y < 0, is above 2.
    potential = parse_formula("½x² + ½y²/(1 + y²) + ½y² exp(−(y + 2)²)")
    assert 0.2 < potential.well.closed_energy < 0.5 < potential.escape_energy
    assert potential.well.is_closed_at(np.array([0.2, 0.6, 1.0])).tolist() == [True, False, False]


@pytest.mark.parametrize("seed", range(6))
def test_random_wells_are_closed_up_to_their_saddles_in_any_units(seed: int) -> None:
    chance = np.random.default_rng(seed)
    terms = [(2, 0, 0.5), (0, 2, 0.5), *((i, 3 - i, float(c)) for i, c in enumerate(chance.normal(0.0, 0.5, 4)))]
    length, energy = 10.0 ** chance.uniform(-3.0, 3.0, 2)
    scaled = Potential("", tuple((i, j, c * energy / length ** (i + j)) for i, j, c in terms))
    assert scaled.channels
    assert scaled.well.closed_energy == scaled.escape_energy
