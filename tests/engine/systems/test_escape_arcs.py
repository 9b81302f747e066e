"""An escape circle can be divided into arcs, each an exit."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import (
    Fate,
    MapSpec,
    Plane,
    Potential,
    classify_orbits,
    compute_map,
    integrate_orbit,
    open_result,
    parse_formula,
    review_potential,
    sample_orbits,
    write_formula,
)
from engine.systems.formulas.formula_parser import read_potential
from engine.systems.formulas.formula_tokens import FormulaError
from engine.systems.landscape.mirror_images import MIRROR_BOTH, MIRROR_X, MIRROR_Y

RADIUS = 6.0
HILLS = "x² y² exp(−x² − y²)"
ENERGY = 0.1


def four_hills(arcs: str) -> Potential:
    return parse_formula(f"{HILLS}; escape {RADIUS} {arcs}")


def random_states(potential: Potential, count: int) -> np.ndarray:
    random = np.random.default_rng(3)
    places = random.uniform(-1.5, 1.5, (2, count))
    speed = np.sqrt(2.0 * np.maximum(ENERGY - potential.value(*places), 0.0))
    angle = random.uniform(0.0, 2.0 * math.pi, count)
    states = np.stack([*places, speed * np.cos(angle), speed * np.sin(angle)], axis=-1)
    return states[speed > 0.0]


def equations(_time: float, state: np.ndarray) -> list[float]:
    x, y, px, py = state
    value = math.exp(-x * x - y * y)
    return [px, py, -2.0 * x * y * y * (1.0 - x * x) * value, -2.0 * y * x * x * (1.0 - y * y) * value]


def arc_at(angle: float, exits: int, begin: float) -> int:
    """Return the number of the arc in a direction in degrees."""
    return 1 + int((angle - begin) % 360.0 // (360.0 / exits))


@pytest.mark.parametrize(
    ("arcs", "exits", "begin"), [("exits 4", 4, -45.0), ("exits 3 from 10", 3, 10.0), ("exits 7", 7, -180 / 7)]
)
def test_orbits_end_at_the_arc_where_an_independent_integration_crosses_the_circle(arcs: str, exits: int, begin: float) -> None:
    potential = four_hills(arcs)
    states = random_states(potential, 60)
    found = classify_orbits(potential, ENERGY, states, t_max=1e3)

    def leaves(_time: float, state: np.ndarray) -> float:
        return float(np.hypot(*state[:2])) - RADIUS

    leaves.terminal = True  # type: ignore[attr-defined]
    compared = set()
    for state, fate, time in zip(states, found.fate, found.escape_time, strict=True):
        # Longer orbits are chaotic: their ends depend on the integrator.
        if fate > 0 and time < 60.0:
            path = solve_ivp(equations, (0.0, 100.0), state, "DOP853", rtol=1e-12, atol=1e-12, events=leaves)
            angle = math.degrees(math.atan2(*path.y[1::-1, -1]))
            assert (fate, time) == (arc_at(angle, exits, begin), pytest.approx(path.t[-1], abs=1e-6))
            compared.add(int(fate))
    assert compared == set(range(1, exits + 1))


def test_single_orbits_maps_and_animations_agree() -> None:
    potential = four_hills("exits 4")
    states = random_states(potential, 20)
    found = classify_orbits(potential, ENERGY, states, t_max=200.0)
    orbits = [integrate_orbit(potential, state, 200.0) for state in states]
    assert [orbit.fate for orbit in orbits] == found.fate.tolist()
    sampled = sample_orbits(potential, states, [0.0, 200.0])
    np.testing.assert_array_equal(sampled.fate, found.fate)


def test_arcs_of_one_circle_are_those_of_the_undivided_circle() -> None:
    divided, whole = (
        compute_map(MapSpec(four_hills(arcs), Plane.X_Y, ENERGY, (24, 24), t_max=300.0)) for arcs in ("exits 4", "")
    )
    np.testing.assert_array_equal(np.minimum(divided.fate, 1), whole.fate)
    np.testing.assert_array_equal(divided.escape_time, whole.escape_time)


def test_formulas_and_files_keep_arcs(tmp_path: Path) -> None:
    potential = four_hills("exits 3 from 10")
    assert parse_formula(write_formula(potential)) == potential
    assert read_potential(potential.provenance()) == potential
    result = compute_map(MapSpec(potential, Plane.X_Y, ENERGY, (8, 8), t_max=50.0))
    result.save(tmp_path / "map.nc")
    assert open_result(tmp_path / "map.nc").spec.outcomes == result.spec.outcomes
    assert [outcome.sentence for outcome in potential.outcomes][1] == "Escaped through exit 2."
    assert [end.geometry for end in potential.ends][1] == "escape radius 6 from 130° to 250°"


@pytest.mark.parametrize(
    ("arcs", "mirrors"),
    [
        ("exits 4", {MIRROR_X, MIRROR_Y, MIRROR_BOTH}),
        ("exits 4 from 0", {MIRROR_X, MIRROR_Y, MIRROR_BOTH}),
        ("exits 3", {MIRROR_Y}),
        ("exits 3 from −90", {MIRROR_X}),
        ("exits 2 from 10", {MIRROR_BOTH}),
        ("exits 7", {MIRROR_Y}),
    ],
)
def test_arcs_are_part_of_the_symmetry(arcs: str, mirrors: set[tuple[float, float]]) -> None:
    assert set(four_hills(arcs).well.mirrors) == mirrors


def test_mirror_images_end_at_mirrored_arcs() -> None:
    potential = four_hills("exits 4")
    assert potential.well.mirror_fates.tolist() == [0, 3, 2, 1, 4]
    states = random_states(potential, 40)
    fates, images = (classify_orbits(potential, ENERGY, states * signs, t_max=100.0).fate for signs in (1.0, [-1, 1, -1, 1]))
    escapes = fates > Fate.BOUNDED
    assert escapes.sum() > 20
    np.testing.assert_array_equal(potential.well.mirror_fates[fates[escapes]], images[escapes])


@pytest.mark.parametrize(
    ("clause", "problem"),
    [
        ("escape 6 exits 1", "exits=1.0: must be from 2 to 8"),
        ("escape 6 exits 2.5", "exits=2.5: must be an integer"),
        ("escape 6 exits 4 from 400", "from=400.0: must be from -360 to 360"),
        ("escape 6 exits 4; escape 6", "the formula has 2 clauses of 'escape'; at most 1 can be given"),
        ("escape 6 exits 4 to 3", "is not understood"),
    ],
)
def test_arcs_that_are_not_legal_are_refused_with_the_reason(clause: str, problem: str) -> None:
    with pytest.raises(FormulaError, match=problem):
        parse_formula(f"{HILLS}; {clause}")


def test_hills_with_arcs_are_accepted() -> None:
    assert review_potential(four_hills("exits 4")).refusal is None
