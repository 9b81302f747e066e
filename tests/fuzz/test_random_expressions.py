"""Random open wells with roots, exponentials, logarithms, sines and real powers, compared with heyoka as in `test_random_wells`.

A well is a harmonic, Plummer, logarithmic or cosine one, with two terms of degree 3 or 4 times a random function.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from engine import Potential, classify_orbits, parse_formula, review_potential, start_states
from engine.slices.planes import Plane
from tests.fuzz.test_random_wells import compare_with_heyoka

WELLS = 40
# As many are tried often.
OFTEN = 10
FACTORS = (1.02, 1.5)

_WELLS = (
    "½(a x² + b y²)",
    "−1/√(a x² + b y² + c²)",
    "½ log(a x² + b y² + c²)",
    "−cos(a x) − b cos(y)",
    "(a x² + b y² + c²)^0.7",
)
_POWERS = ("x³", "x²y", "x y²", "y³", "x²y²", "x⁴", "y⁴", "x³y")
_FUNCTIONS = (
    "",
    "exp(−c (x² + y²))",
    "exp(−y²)",
    "cos(a x + b y)",
    "/(1 + b y² + c x²)",
    "(1 + r²)^(−a)",
    "log(2 + r²)",
    "sin(1 + x)",
    "√(1 + b (x + y)²)",
)


def random_formula(seed: int) -> tuple[str, dict[str, float]]:
    """A formula and the values of its letters."""
    random = np.random.default_rng([33, seed])
    terms = [
        f"{'−+'[int(random.integers(2))]} {letter} {_POWERS[random.integers(len(_POWERS))]} "
        f"{_FUNCTIONS[random.integers(len(_FUNCTIONS))]}"
        for letter in "kq"
    ]
    text = " ".join([_WELLS[seed % len(_WELLS)], *terms])
    values = dict(zip("abckq", random.uniform(0.4, 1.4, 5).round(3).tolist(), strict=True))
    return text, {name: value for name, value in values.items() if name in text.replace("cos", "").replace("exp", "")}


@cache
def open_wells() -> tuple[tuple[int, Potential], ...]:
    """The first wells with exits, with their seeds."""
    wells: list[tuple[int, Potential]] = []
    seed = 0
    while len(wells) < WELLS:
        text, values = random_formula(seed)
        potential = parse_formula(text, parameters=values)
        if review_potential(potential).refusal is None:
            wells.append((seed, potential))
        seed += 1
    return tuple(wells)


def energy_of(seed: int, potential: Potential) -> float:
    highest = review_potential(potential).highest_energy
    energy = potential.well.energy_at(float(np.random.default_rng(seed).uniform(*FACTORS)))
    return min(energy, potential.escape_energy + 0.5 * (highest - potential.escape_energy))


@pytest.mark.parametrize(
    "number", [pytest.param(k, marks=pytest.mark.slow if k < OFTEN else pytest.mark.exhaustive) for k in range(WELLS)]
)
def test_outcomes_are_those_of_heyoka(number: int) -> None:
    seed, potential = open_wells()[number]
    assert not compare_with_heyoka(potential, energy_of(seed, potential), seed).wrong, potential.name


@pytest.mark.slow
@pytest.mark.parametrize("number", range(0, WELLS, 5))
def test_energy_is_held(number: int) -> None:
    _, potential = open_wells()[number]
    energy = potential.well.energy_at(0.9)
    x = 0.1 * potential.units.length * np.linspace(-1.0, 1.0, 8)
    states = start_states(potential, Plane.X_Y, energy, x, np.zeros(8))
    outcomes = classify_orbits(potential, energy, states, 1e4 * potential.units.time)
    assert np.nanmax(outcomes.energy_error) < 1e-11
