"""Random systems agree with heyoka: wells in random units, wells with functions, and systems that rotate or have bodies."""

from __future__ import annotations

import itertools
from collections.abc import Collection
from concurrent.futures import ProcessPoolExecutor
from functools import cache

import numpy as np
import pytest

from engine import Plane, Potential, classify_orbits, parse_formula, review_potential, sample_starts, start_states
from tests.forked import fork_context
from tests.peers.exits_by_heyoka import compare
from tests.peers.random_systems import FACTORS, HIGHEST_DEGREE, random_formula, random_scaling, random_system, random_well
from tests.peers.well_comparison import Comparison, compare_with_heyoka

CHUNK = 5
# Expected refusals: the well is not open, because no orbit escapes or the escape energy is undefined, or exits merge.
EXPECTED = ("No saddle leads out", "The well is open without a saddle", "are one exit above V")
# Largest number of other refusals in a chunk.
MOST_REFUSED = 2
# Number of starts in a rotating system, and duration of their orbits in exact units of time.
STARTS, DURATION = 40, 40.0
# Smallest share of robust orbits in a system. Rounding errors decide the ends or crossings of other orbits. In the system of
# `CHAOTIC_SEEDS`, at its high energy, no orbit is robust.
LEAST_ROBUST = 0.5
CHAOTIC_SEEDS = {39}
# Numbers of slow tests: wells of all forms with most functions, and systems with exits, bodies or an escape radius.
WITH_FUNCTIONS, ROTATING = range(3, 10), range(1, 5)


def slow_for(numbers: Collection[int]) -> pytest.MarkDecorator:
    """Return a mark that repeats a test for the numbers 0 to 39. Tests of `numbers` are slow, the others exhaustive."""
    marks = (pytest.mark.slow if number in numbers else pytest.mark.exhaustive for number in range(40))
    return pytest.mark.parametrize("number", [pytest.param(number, marks=mark) for number, mark in enumerate(marks)])


chunks = pytest.mark.parametrize(
    "chunk", [pytest.param(k, marks=pytest.mark.exhaustive if k else pytest.mark.slow) for k in range(1000 // CHUNK)]
)


def random_energies(potential: Potential, seed: int) -> list[float]:
    """Return three energies: below the escape energy, slightly above, and up to twice the depth of the well."""
    random = np.random.default_rng([21, seed])
    factors = random.uniform(0.2, 1.0), 1.0 + 10.0 ** random.uniform(-6.0, -1.0), random.uniform(1.02, 2.0)
    return [factor * potential.escape_energy for factor in factors]


def check_well(seed: int) -> tuple[list[Comparison], list[str]]:
    """Compare a well with heyoka at random energies in random units. Return the comparisons and the reasons for refusals."""
    potential, scaling = random_well(seed, HIGHEST_DEGREE), random_scaling(seed)
    usual, review = review_potential(potential), review_potential(scaling.potential(potential))
    assert (review.refusal is None, review.channels) == (usual.refusal is None, usual.channels)
    if review.refusal is not None or not review.channels:
        return [], [review.describe()]
    assert review.escape_energy == pytest.approx(scaling.energy * usual.escape_energy, rel=1e-9)
    comparisons, refusals = [], []
    for energy in random_energies(potential, seed):
        try:
            comparisons.append(compare_with_heyoka(potential, energy, seed, scaling))
        except ValueError as error:
            refusals.append(str(error))
    return comparisons, refusals


@chunks
def test_random_wells_agree_with_heyoka_in_random_units(chunk: int) -> None:
    seeds = range(CHUNK * chunk, CHUNK * (chunk + 1))
    # The wells are compared in a separate process, because compiled code stays in memory until the end of its process.
    with ProcessPoolExecutor(1, mp_context=fork_context()) as process:
        found = dict(zip(seeds, process.map(check_well, seeds), strict=True))
    assert not {seed: wrong for seed, (comparisons, _) in found.items() if (wrong := [w for c in comparisons for w in c.wrong])}
    unexpected = {seed: r for seed, (_, refusals) in found.items() for r in refusals if not any(part in r for part in EXPECTED)}
    assert len(unexpected) <= MOST_REFUSED, unexpected


@pytest.mark.parametrize(("seed", "factor"), [(97, 2.0), pytest.param(155, 2.0, marks=pytest.mark.slow)])
def test_exits_found_by_continuation_or_from_both_ends_agree_with_heyoka(seed: int, factor: float) -> None:
    potential = random_well(seed)
    assert not compare_with_heyoka(potential, factor * potential.escape_energy, seed).wrong


@pytest.mark.parametrize("seed", [81, pytest.param(896, marks=pytest.mark.slow)])
def test_exits_of_several_channels_agree_with_heyoka(seed: int) -> None:
    potential = random_well(seed, HIGHEST_DEGREE)
    energy = random_energies(potential, seed)[-1]
    assert potential.well.merged_exits(energy)
    assert not compare_with_heyoka(potential, energy, seed).wrong


@cache
def open_well(number: int) -> tuple[int, Potential]:
    """Return the seed and the potential of the well with this number, among the wells with exits in the order of seeds."""
    first = open_well(number - 1)[0] + 1 if number else 0
    for seed in itertools.count(first):
        text, values = random_formula(seed)
        potential = parse_formula(text, parameters=values)
        if review_potential(potential).refusal is None and potential.channels:
            return seed, potential
    raise AssertionError


def energy_of(seed: int, potential: Potential) -> float:
    highest = review_potential(potential).highest_energy
    energy = potential.well.energy_at(float(np.random.default_rng(seed).uniform(*FACTORS)))
    return min(energy, potential.escape_energy + 0.5 * (highest - potential.escape_energy))


@slow_for(WITH_FUNCTIONS)
def test_wells_with_functions_agree_with_heyoka(number: int) -> None:
    seed, potential = open_well(number)
    assert not compare_with_heyoka(potential, energy_of(seed, potential), seed).wrong, potential.name


@slow_for(WITH_FUNCTIONS)
def test_the_energy_is_constant_in_wells_with_functions(number: int) -> None:
    _, potential = open_well(number)
    energy = potential.well.energy_at(0.9)
    x = 0.1 * potential.units.length * np.linspace(-1.0, 1.0, 8)
    states = start_states(potential, Plane.X_Y, energy, x, np.zeros(8))
    outcomes = classify_orbits(potential, energy, states, 1e4 * potential.units.time)
    assert np.nanmax(outcomes.energy_error) < 1e-11


@cache
def accepted_system(number: int) -> tuple[int, Potential, float, np.ndarray]:
    """Return seed, potential, energy and starts of the system with this number, among accepted systems in the order of seeds."""
    first = accepted_system(number - 1)[0] + 1 if number else 0
    for seed in itertools.count(first):
        try:
            potential, energy = random_system(seed)
            starts = sample_starts(potential, energy, STARTS, rng=seed)
        except ValueError:
            continue
        if review_potential(potential).refusal is None and potential.channels:
            return seed, potential, energy, starts
    raise AssertionError


@slow_for(ROTATING)
def test_rotating_systems_bodies_and_escape_radii_agree_with_heyoka(number: int) -> None:
    seed, potential, energy, starts = accepted_system(number)
    comparison = compare(potential, energy, starts, DURATION * potential.well.exact_time_unit)
    assert seed in CHAOTIC_SEEDS or comparison.robust > LEAST_ROBUST * STARTS
    assert comparison.wrong == 0
