"""How well the energy, in rotating frames the Jacobi integral, is held in the systems with rotating frames and bodies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import System, classify_orbits, sample_starts
from engine.dynamics.classification import Outcomes
from engine.potentials.potential import Potential

# T_MAX in exact units of time of the well.
T_MAX, STARTS, NEAR = 1e4, 60, 10.0
AWAY_FROM_CENTRES, PAST_A_CENTRE = 1e-11, 1e-9
# Of two orbits around the centres of this system, at 11 radii, errors for the reason below are 1.3e-11.
AROUND_OUTER_CENTRES = {"Two Yukawa centres": 2e-11}
# Around a centre that is not at the origin a position is rounded relative to its distance from the origin: near the edge of a
# disc of 0.001 this changes V, about 1000, by 1e-10 in each step. The errors of heyoka are similar.
PAST_AN_OUTER_CENTRE = 1e-6

# Energies at which most orbits stay.
ENERGIES = [
    ("Copenhagen", -2.1),
    ("Copenhagen", -1.6),
    ("Earth-Moon", -1.12),
    ("Hill", -2.2),
    ("Hill", -2.1),
    ("Star cluster", -2.0),
    ("Star cluster", -1.6),
    ("Barred galaxy", -3300.0),
    ("Barred galaxy", -3200.0),
    ("Logarithmic bar", -0.6),
    ("Two Yukawa centres", -0.5),
]


def outcomes_of(potential: Potential, energy: float) -> tuple[Outcomes, np.ndarray]:
    """Outcomes, and which orbits pass a centre within ten radii."""
    starts = sample_starts(potential, energy, STARTS, seed=3)
    wide = potential.with_outcomes([replace(c, radius=NEAR * c.radius) for c in potential.centres], potential.escape_radius)
    t_max = T_MAX * potential.exact_time_unit
    fate = classify_orbits(wide, energy, starts, t_max).fate
    past = (fate > potential.channels) & (fate <= potential.channels + len(potential.centres))
    return classify_orbits(potential, energy, starts, t_max), past


@pytest.mark.slow
@pytest.mark.parametrize(("name", "energy"), ENERGIES)
def test_energy_is_held_over_ten_thousand_units_of_time(name: str, energy: float) -> None:
    potential = System(name).potential
    outcomes, past = outcomes_of(potential, energy)
    assert np.all(outcomes.fate >= 0)
    assert outcomes.energy_error[~past].max(initial=0.0) < AROUND_OUTER_CENTRES.get(name, AWAY_FROM_CENTRES)
    assert outcomes.energy_error[past].max(initial=0.0) < (PAST_AN_OUTER_CENTRE if potential.escape_radius else PAST_A_CENTRE)
