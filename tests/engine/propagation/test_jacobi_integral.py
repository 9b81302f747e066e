"""The Jacobi integral of systems with rotating frames and bodies is constant."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import Fate, MapSpec, Plane, System, Window, classify_orbits, compute_map, parse_formula, sample_starts
from engine.propagation.classification import Outcomes
from engine.systems.potential import Potential

# End time in exact units of time of the well, number of starts, and a distance from a centre in units of its radius.
T_MAX, STARTS, NEAR = 1e4, 60, 10.0
AWAY_FROM_CENTRES, PAST_A_CENTRE = 1e-11, 1e-9

# Systems and energies at which most orbits stay.
ENERGIES = [
    ("Copenhagen", -1.6),
    ("Earth-Moon", -1.12),
    ("Hill", -2.1),
    ("Star cluster", -1.6),
    ("Barred galaxy", -3200.0),
    ("Logarithmic bar", -0.6),
    ("Two Yukawa centres", -0.5),
]


def outcomes_of(potential: Potential, energy: float) -> tuple[Outcomes, np.ndarray]:
    """Return outcomes, and whether each orbit passes a centre within ten radii."""
    starts = sample_starts(potential, energy, STARTS, rng=3)
    wide = potential.with_outcomes([replace(c, radius=NEAR * c.radius) for c in potential.centres], potential.escape_radius)
    t_max = T_MAX * potential.well.exact_time_unit
    fate = classify_orbits(wide, energy, starts, t_max).fate
    past = (fate > potential.channels) & (fate <= potential.channels + len(potential.centres))
    return classify_orbits(potential, energy, starts, t_max), past


@pytest.mark.slow
@pytest.mark.parametrize(("name", "energy"), ENERGIES)
def test_energy_is_held_over_ten_thousand_units_of_time(name: str, energy: float) -> None:
    potential = System(name).potential
    outcomes, past = outcomes_of(potential, energy)
    assert np.all(outcomes.fate >= 0)
    assert outcomes.energy_error[~past].max(initial=0.0) < AWAY_FROM_CENTRES
    assert outcomes.energy_error[past].max(initial=0.0) < PAST_A_CENTRE


STAR = parse_formula("−1/√((x − 1)² + y²); centre the star (1, 0) 0.001; escape 10")


@pytest.mark.parametrize("apastron", [0.1, 0.3])
def test_a_body_away_from_the_origin_costs_no_digits(apastron: float) -> None:
    periastron = 0.002
    start = np.array([[1.0 + apastron, 0.0, 0.0, np.sqrt(2.0 * periastron / (apastron * (apastron + periastron)))]])
    outcomes = classify_orbits(STAR, float(STAR.energy(start)[0]), start, 300.0)
    assert outcomes.fate == Fate.BOUNDED
    assert outcomes.energy_error < AWAY_FROM_CENTRES


def test_orbits_around_a_body_are_continued_to_the_bit() -> None:
    spec = MapSpec(STAR, Plane.X_PX, -0.7, (12, 12), t_max=40.0, window=Window(1.2, 1.4, -0.2, 0.2))
    continued, direct = compute_map(spec, resume=compute_map(replace(spec, t_max=15.0))), compute_map(spec)
    assert continued.batch is not None
    assert direct.batch is not None
    np.testing.assert_array_equal(continued.batch.state, direct.batch.state)
    assert np.any(direct.batch.remainder)
