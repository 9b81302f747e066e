"""In rotating frames, at discs and at the escape circle, orbits in the browser end as in the library."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine import (
    CASES,
    POTENTIALS,
    Fate,
    MapSpec,
    Plane,
    Potential,
    Trust,
    Window,
    classify_orbits,
    compute_map,
    compute_trust,
    parse_formula,
    sample_orbits,
)
from engine.exits.interior import find_outside_channels
from engine.results import Outcomes
from engine.slices.portable_system import make_portable_system
from engine.systems.outcomes import SMALLEST_RADIUS, Centre
from tests.node import needs_node, run_node
from tests.plots.browser.test_agreement import HORIZON as VIEW_HORIZON
from tests.plots.browser.test_agreement import LEAST_SHARE, SIDE, as_view, expected_fate

COUNT = 400
# In units of the well, as the page computes at rest.
HORIZON = 100.0
# Shift of the starts that changes no outcome unless the motion is very sensitive, and the changes of times that it causes.
SMALL, SAME_TIME = 1e-11, 1e-5
# The browser locates end times to 1e-9.
TIME_ERROR = 1e-6
# Smallest distances of orbits from the edge of a disc, outside or inside, as a share of the radius.
DEPTH = 1e-3
# Time from the start to the disc, in units of time.
TO_THE_DISC = 0.3


@dataclass(frozen=True)
class Example:
    """A system, an energy, half the side of a square around the origin from which orbits start, and a horizon."""

    potential: Potential
    energy: float
    half_side: float
    is_backward: bool = False
    horizon: float = HORIZON


COPENHAGEN = POTENTIALS["Copenhagen"]
ROTATING_WELL = parse_formula("½(x² + y²) − x y²").in_rotating_frame(0.3).with_outcomes((), 3.0)
EXAMPLES = {
    "a mass in a rotating frame": Example(
        parse_formula("½(x² + y²) − x y²; masses (8, 8)").in_rotating_frame(0.1), 0.19, 0.8, horizon=2.0 * HORIZON
    ),
    "two bodies in a rotating frame": Example(COPENHAGEN, -1.3, 3.0),
    "case I with a disc": Example(CASES["I"].with_outcomes([Centre(0.3, 0.1, 0.05)]), 0.19, 0.8),
    "well in a rotating frame": Example(ROTATING_WELL, 0.25, 1.2),
    "rotating bar": Example(parse_formula("½log(0.01 + x² + y²/0.81)").in_rotating_frame(0.5).with_outcomes((), 5.0), 0.4, 3.0),
    "centre at the origin and an exit": Example(
        parse_formula("-1/√(x²+y²) - 0.1x").with_outcomes([Centre(0.0, 0.0, 0.05)]), -0.5, 4.0
    ),
    "exits and a disc in a rotating frame": Example(
        CASES["III"].in_rotating_frame(-0.5).with_outcomes([Centre(0.2, 0.1, 0.02)]), 0.2, 0.8
    ),
    "exits in a rotating frame, backward in time": Example(CASES["I"].in_rotating_frame(0.2), 0.15, 0.8, is_backward=True),
    # Most orbits are still inside.
    "well, backward in time": Example(ROTATING_WELL, 0.25, 1.2, is_backward=True, horizon=2.0),
    "arcs of an escape circle": Example(POTENTIALS["Four hills"], 0.05, 4.0),
    "two bodies, backward in time": Example(COPENHAGEN, -1.3, 3.0, is_backward=True),
}
# Systems whose kernels only these tests need.
SLOW = ("rotating bar", "exits and a disc in a rotating frame")
GRAZED = {
    "two bodies in a rotating frame": (COPENHAGEN.with_outcomes([Centre(-0.5, 0.0, 0.02), Centre(0.5, 0.0, 1e-3)], 10.0), -1.3),
    "case I with a small disc": (CASES["I"].with_outcomes([Centre(0.1, 0.05, 1e-3)]), 0.19),
}


def random_states(example: Example) -> np.ndarray:
    """Return states inside the exits, in random directions, of shape (COUNT, 4)."""
    chance, potential, energy = np.random.default_rng(1), example.potential, example.energy
    x, y = chance.uniform(-example.half_side, example.half_side, (2, 20 * COUNT))
    inside = (potential.value(x, y) < energy) & (find_outside_channels(potential, energy, x, y) == 0)
    x, y = x[inside][:COUNT], y[inside][:COUNT]
    momentum, angle = np.sqrt(2.0 * potential.mass * (energy - potential.value(x, y))), chance.uniform(0.0, 2.0 * np.pi, COUNT)
    return np.column_stack([x, y, momentum * np.cos(angle), momentum * np.sin(angle)])


def ends_in_browser(
    potential: Potential, energy: float, states: np.ndarray, t_max: float, folder: Path, *, is_backward: bool = False
) -> dict[str, dict[str, np.ndarray]]:
    """Return what `run_orbits.js` finds of states, with times in units of the potential."""
    portable, units = make_portable_system(potential, energy), potential.units
    data: dict[str, Any] = {"system": portable.to_dict(), "module": portable.module, "energy": energy / units.energy}
    data |= {"states": (states / units.state).tolist(), "horizon": t_max / units.time, "isBackward": is_backward}
    found = run_node("run_orbits.js", data, folder)
    arrays = {way: {name: np.array(values, float) for name, values in ends.items()} for way, ends in found.items()}
    for ends in arrays.values():
        ends["time"] *= units.time
    return arrays


def decided(fate: np.ndarray) -> np.ndarray:
    """Return the fates of the browser, bounded for orbits that are inside at the horizon, as in the library."""
    return np.where(fate == Fate.NOT_COMPUTED, Fate.BOUNDED, fate)


def ends_in_library(potential: Potential, energy: float, states: np.ndarray, t_max: float) -> tuple[Outcomes, np.ndarray]:
    """Return the outcomes of states, and which of them do not depend on small changes of the starts."""
    turned = states + SMALL * np.column_stack([np.zeros((len(states), 2)), -states[:, 3], states[:, 2]])
    outcomes, others = (classify_orbits(potential, energy, each, t_max) for each in (states, turned))
    same_time = ~(np.abs(outcomes.escape_time - others.escape_time) > SAME_TIME)
    clear = (outcomes.fate == others.fate) & (outcomes.crossings == others.crossings) & same_time
    assert clear.mean() > 0.5
    return outcomes, clear


@needs_node
@pytest.mark.parametrize("name", [pytest.param(name, marks=pytest.mark.slow if name in SLOW else ()) for name in EXAMPLES])
def test_orbits_end_as_those_of_the_library(name: str, tmp_path: Path) -> None:
    example = EXAMPLES[name]
    potential, energy, states = example.potential, example.energy, random_states(example)
    t_max = example.horizon * potential.units.time
    outcomes, clear = ends_in_library(potential.reversed_in_time if example.is_backward else potential, energy, states, t_max)
    escaped = clear & (outcomes.fate > 0)
    assert set(outcomes.fate[escaped]) == set(range(1, len(potential.outcomes) + 1))
    for way, ends in ends_in_browser(potential, energy, states, t_max, tmp_path, is_backward=example.is_backward).items():
        np.testing.assert_array_equal(decided(ends["fate"])[clear], outcomes.fate[clear], err_msg=way)
        np.testing.assert_allclose(ends["time"][escaped], outcomes.escape_time[escaped], rtol=TIME_ERROR, err_msg=way)
        if "crossings" in ends:
            np.testing.assert_array_equal(ends["crossings"][clear], outcomes.crossings[clear], err_msg=way)
        assert not np.any(ends.get("lostBytes", 0)), "memory is not given back"


def touching_states(potential: Potential, energy: float, share: float) -> np.ndarray:
    """Return (n, 4) states whose orbits, `TO_THE_DISC` later, are nearest to a disc, beyond its radius by a share."""
    centre, turned = potential.centres[0], np.linspace(0.0, 2.0 * np.pi, COUNT, endpoint=False)
    distance = share * centre.radius
    x, y = centre.x + distance * np.cos(turned), centre.y + distance * np.sin(turned)
    speed = np.sqrt(2.0 * (energy - potential.value(x, y)))
    touching = np.column_stack([x, y, speed * np.sin(turned), -speed * np.cos(turned)])
    # Orbits do not end at bodies as small as these.
    bodies = [replace(centre, radius=SMALLEST_RADIUS) for centre in potential.centres]
    path = sample_orbits(potential.with_outcomes(bodies, potential.escape_radius).reversed_in_time, touching, [TO_THE_DISC])
    return np.column_stack([path.x, path.y, -path.px, -path.py])


@needs_node
@pytest.mark.parametrize("name", GRAZED)
def test_an_orbit_that_grazes_a_disc_within_a_step_collides(name: str, tmp_path: Path) -> None:
    potential, energy = GRAZED[name]
    collision = potential.channels + 1
    # The orbit ends in the step that passes the horizon, or before.
    for share, t_max in itertools.product((1.0 - DEPTH, 1.0 + DEPTH), (1.1 * TO_THE_DISC, 10.0 * TO_THE_DISC)):
        states = touching_states(potential, energy, share)
        outcomes = classify_orbits(potential, energy, states, t_max)
        touched = (outcomes.fate == collision) & (outcomes.escape_time < 1.1 * TO_THE_DISC)
        assert touched.all() if share < 1.0 else not touched.any()
        found = ends_in_browser(potential, energy, states, t_max, tmp_path)
        # Orbits that have collided are not followed beyond the edge.
        assert np.isnan(found["player"]["x"][outcomes.fate == collision]).all()
        for way, ends in found.items():
            np.testing.assert_array_equal(decided(ends["fate"]), outcomes.fate, err_msg=way)
            times = ends["time"][touched], outcomes.escape_time[touched]
            np.testing.assert_allclose(*times, rtol=TIME_ERROR, err_msg=way)


@needs_node
@pytest.mark.parametrize(
    ("name", "plane"),
    [
        ("two bodies in a rotating frame", Plane.X_Y),
        ("case I with a disc", Plane.X_PX),
        ("well in a rotating frame", Plane.X_PX),
        pytest.param("exits and a disc in a rotating frame", Plane.X_Y, marks=pytest.mark.slow),
    ],
)
def test_pixels_are_those_of_the_map(name: str, plane: Plane, tmp_path: Path) -> None:
    example = EXAMPLES[name]
    potential, edge = example.potential, 1.1 * example.half_side
    t_max = VIEW_HORIZON * potential.units.time
    spec = MapSpec(potential, plane, example.energy, (SIDE, SIDE), Window(-edge, edge, -edge, edge), t_max, use_evidence=False)
    portable = make_portable_system(potential, example.energy)
    data = {"system": portable.to_dict(), "module": portable.module, "views": [as_view(spec)]}
    (found,) = run_node("run_view.js", data, tmp_path)
    escape_map = compute_map(spec)
    fate, expected = np.array(found["fate"]), expected_fate(escape_map).ravel()
    robust = np.isin(compute_trust(escape_map).trust, (Trust.LIKE_NEIGHBOURS, Trust.CONFIRMED)).ravel()
    certain = robust | np.isin(expected, (Fate.OUTSIDE, Fate.FORBIDDEN))
    assert len(np.unique(expected)) > 1
    np.testing.assert_array_equal(fate[certain], expected[certain])
    assert np.mean(fate == expected) >= LEAST_SHARE
