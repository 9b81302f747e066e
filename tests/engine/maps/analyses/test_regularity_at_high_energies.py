"""Orbits far above the bottom of the well, and orbits that leave it, are judged rightly or not at all."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import (
    CASES,
    POTENTIALS,
    Fate,
    MapSpec,
    Plane,
    Potential,
    Regularity,
    compute_map,
    compute_regularity,
    integrate_orbit,
    judge_orbit,
    parse_formula,
    start_states,
)
from engine.evidence.birkhoff_averages import count_agreeing_digits
from engine.results import RegularityMap
from engine.trajectories.chaos_indicators import Verdict

# Frequencies at its escape energy, 136, are 15 times those at the bottom. All orbits at the energies below are chaotic.
STEEP = parse_formula("½r²+x²y²−0.000001x⁶")
# A closed well, and wells that open, with energies from just above the bottom to the highest with bounded orbits.
FAMILY = [
    *(("½x²+0.8y²+x²y²", energy) for energy in (0.02, 0.9, 50.0)),
    *(("½r² − 0.02x⁴ + 0.3x²y²", energy) for energy in (0.06, 1.0, 2.8)),
    *(("½r²+0.1x⁴y²−0.001r⁸", energy) for energy in (0.04, 1.0, 1.7)),
]


def regularity_of(potential: Potential, plane: Plane, energy: float, side: int, t_max: float) -> RegularityMap:
    return compute_regularity(compute_map(MapSpec(potential, plane, energy, (side, side), t_max=t_max)))


@pytest.mark.parametrize("energy", [5.0, 30.0, 60.0, 100.0])
def test_all_orbits_of_a_steep_well_are_chaotic_at_any_energy(energy: float) -> None:
    regularity = regularity_of(STEEP, Plane.X_PX, energy, 24, 1000.0)
    assert regularity.chaotic_share == 1.0
    assert Regularity.UNDECIDED not in regularity.character
    assert np.isfinite(regularity.sali[regularity.character == Regularity.CHAOTIC]).all()


@pytest.mark.parametrize(("plane", "side"), [(Plane.X_PX, 112), (Plane.X_Y, 56)])
def test_no_torus_is_chaotic_at_three_escape_energies(plane: Plane, side: int) -> None:
    """The SALI of all bounded orbits stays above 3e-4 until t = 1e4."""
    regularity = regularity_of(POTENTIALS["C8"], plane, 1.2, side, 1e4)
    assert np.any(regularity.character == Regularity.REGULAR)
    assert not np.isin(regularity.character, (Regularity.CHAOTIC, Regularity.UNDECIDED)).any()


@pytest.mark.parametrize("name", ["C6", "C7", "C8"])
@pytest.mark.parametrize("multiple", [1.8, 2.2])
def test_bounded_orbits_have_digits_above_the_escape_energy(name: str, multiple: float) -> None:
    potential = POTENTIALS[name]
    energy = multiple * potential.escape_energy
    whole = compute_map(MapSpec(potential, Plane.X_Y, energy, (48, 48), t_max=3e3))
    rows, columns = np.nonzero(whole.fate == Fate.BOUNDED)
    states = start_states(potential, Plane.X_Y, energy, whole.x[columns], whole.ordinate[rows])
    digits = count_agreeing_digits(potential.in_well_units, states / potential.units.state, 1000.0)
    assert digits.size > 0
    assert np.mean(digits > 0.0) > 0.95


@pytest.mark.parametrize(("text", "energy"), FAMILY)
def test_pixels_agree_with_single_orbits_where_both_decide(text: str, energy: float) -> None:
    potential = parse_formula(text)
    whole = compute_map(MapSpec(potential, Plane.X_PX, energy, (10, 10), t_max=1000.0))
    character = compute_regularity(whole).character
    pixels = np.random.default_rng(8).permutation(np.argwhere(whole.fate == Fate.BOUNDED))[:8]
    contradictions = 0
    for row, column in pixels:
        state = start_states(potential, Plane.X_PX, energy, whole.x[[column]], whole.ordinate[[row]])[0]
        verdict = judge_orbit(integrate_orbit(potential, state, 1000.0)).character
        if verdict in (Verdict.REGULAR, Verdict.NO_SIGN, Verdict.CHAOTIC):
            contradictions += (verdict is Verdict.CHAOTIC) != (character[row, column] == Regularity.CHAOTIC)
    # The SALI of one orbit may reach the threshold just before or just after the end.
    assert contradictions <= 1


@pytest.mark.parametrize(
    ("potential", "energy"), [(CASES["III"], 0.5), (parse_formula("½y² + 8x²(1−x)² + 0.2x²y"), 0.7)], ids=["open", "two wells"]
)
def test_orbits_that_leave_the_well_before_their_sali_falls_are_undecided(potential: Potential, energy: float) -> None:
    """The orbits escape just before the end. In the second well, they would not run to infinity."""
    whole = compute_map(MapSpec(potential, Plane.X_PX, energy, (24, 24), t_max=3.0))
    escapes = (whole.fate >= 1) & (whole.escape_time > 2.4)
    assert escapes.any()
    regularity = compute_regularity(replace(whole, fate=np.where(escapes, Fate.BOUNDED, whole.fate).astype(np.int8)))
    assert set(regularity.character[escapes].tolist()) == {Regularity.UNDECIDED}
    assert np.isnan(regularity.sali[escapes]).all()
    assert regularity.complete


def test_undecided_orbits_do_not_count_in_shares() -> None:
    whole = compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.26, (2, 3), t_max=20.0))
    codes = np.array([[Regularity.CHAOTIC, Regularity.REGULAR], [Regularity.UNDECIDED] * 2, [Regularity.NOT_APPLICABLE] * 2])
    regularity = RegularityMap(whole.spec, codes.astype(np.int8), np.full((3, 2), np.nan))
    assert regularity.chaotic_share == 0.5
    assert regularity.describe() == (
        "50.00 % of the judged bounded orbits are chaotic, 0.00 % show no sign of chaos until t_max. "
        "50.00 % of the bounded orbits are undecided."
    )
