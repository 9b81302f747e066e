"""Time reversal, tori as evidence and regularity maps are used only for potentials that permit them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from engine import (
    CASES,
    MapSpec,
    Plane,
    Potential,
    compute_flux,
    compute_map,
    compute_regularity,
    integrate_orbit,
    judge_orbit,
    parse_formula,
    sample_entrances,
)
from engine.evidence.birkhoff_averages import TORUS_DIGITS
from engine.evidence.exit_entry_points import find_entry_points
from engine.maps.run import looks_for_tori
from engine.propagation.fates import Evidence
from engine.systems.outcomes import Centre
from engine.trajectories.birkhoff_digits import compute_birkhoff_digits

ROTATING = parse_formula("½(x² + y²) + ½(x² + y²) - x² y").in_rotating_frame(0.5)
ENERGY = 1.2 * ROTATING.escape_energy
WITH_CENTRE = CASES["I"].with_outcomes([Centre(0.3, 0.0, 0.01)])
WITH_RADIUS = CASES["I"].with_outcomes(escape_radius=3.0)


@pytest.mark.parametrize(
    "call",
    [
        compute_flux,
        find_entry_points,
        lambda potential, energy: sample_entrances(potential, energy, 10, rng=0),
    ],
)
def test_analyses_that_need_time_reversal_refuse_rotating_frames(call: Callable[[Potential, float], Any]) -> None:
    with pytest.raises(ValueError, match="its frame rotates"):
        call(ROTATING, ENERGY)


@pytest.mark.parametrize(
    ("potential", "expected"), [(CASES["I"], True), (ROTATING, False), (WITH_CENTRE, False), (WITH_RADIUS, False)]
)
def test_tori_are_evidence_only_in_wells_at_rest(potential: Potential, expected: bool) -> None:
    spec = MapSpec(potential, Plane.X_PX, 0.12, (4, 4), t_max=1e5)
    assert looks_for_tori(spec) == expected


def test_a_quasi_periodic_orbit_in_a_rotating_frame_is_bounded_by_integration_only() -> None:
    state = (0.0, -0.1, np.sqrt(2.0 * (1.02 * ROTATING.escape_energy - ROTATING.value(0.0, -0.1))), 0.0)
    digits = compute_birkhoff_digits(ROTATING, state, t_max=3000.0)
    assert digits.digits[-1] > TORUS_DIGITS
    assert judge_orbit(integrate_orbit(ROTATING, state, t_max=3000.0), digits).evidence is Evidence.INTEGRATED


def test_orbits_below_all_saddles_are_closed_unless_they_can_collide() -> None:
    assert CASES["I"].well.is_closed_at(0.1)
    assert ROTATING.well.is_closed_at(0.9 * ROTATING.escape_energy)
    assert not CASES["I"].well.is_closed_at(0.13)
    assert not WITH_CENTRE.well.is_closed_at(0.1)
    assert not WITH_RADIUS.well.is_closed_at(0.1)
    assert CASES["I"].well.is_closed_at(np.array([0.1, 0.2])).tolist() == [True, False]


def test_regularity_of_maps_refuses_centres() -> None:
    escapes = compute_map(MapSpec(WITH_CENTRE, Plane.X_PX, 0.12, (4, 4), t_max=100.0))
    with pytest.raises(ValueError, match="has centres; regular and chaotic orbits of a map are not told apart"):
        compute_regularity(escapes)
