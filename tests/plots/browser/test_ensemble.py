"""Orbits in the browser agree with heyoka, leave through the server's exits, and start evenly spread."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import heyoka as hy
import numpy as np
import pytest
from scipy import stats

from engine import (
    Plane,
    Potential,
    Section,
    System,
    classify_orbits,
    compute_flux,
    find_lyapunov_orbits,
    read_section,
    sample_entrances,
    sample_orbits,
    sample_starts,
)
from engine.exits.interior import find_outside_channels
from engine.integrator.kernels.random_starts import BEFORE_EXIT
from engine.slices.default_window import default_window
from engine.slices.portable_system import make_portable_system
from engine.systems.review.potential_review import review_system
from tests.node import needs_node, run_node
from tests.peers.taylor_heyoka import equations

COUNT, FRAMES, LONGEST = 200, 50, 40.0
SYSTEMS = [("II", 0.22), ("III", 0.45)]
FALSE_ALARM = 1e-7
"""Probability that a comparison of two random samples fails though both have the same distribution."""
# Tolerance of positions. The browser needs a thousandth of a pixel, but its steps are those of the server.
PLACE_ERROR = 1e-8


@dataclass(frozen=True)
class Followed:
    """An ensemble that the browser has followed, with its request."""

    potential: Potential
    energy: float
    states: np.ndarray
    times: np.ndarray
    frames: list[dict[str, np.ndarray]]
    outcomes: np.ndarray
    again: np.ndarray


def follow(case: str, energy: float, folder: Path, section: Section = Section.Y_UP) -> Followed:
    """Follow random orbits in the browser's engine, with their crossings of a section."""
    potential = System(case).potential
    assert potential.units.length == potential.units.time == 1.0
    portable = make_portable_system(potential, review_system(System(case)).energies.high, section)
    states = sample_starts(potential, energy, COUNT, rng=3)
    times = np.sort(np.random.default_rng(1).uniform(0.0, LONGEST, FRAMES))
    data = {"system": portable.to_dict(), "module": portable.module, "energy": energy}
    data |= {"states": states.ravel().tolist(), "times": times.tolist()}
    found = run_node("run_ensemble.js", data, folder)
    frames = [{name: np.array(values, float) for name, values in frame.items()} for frame in found["frames"]]
    return Followed(potential, energy, states, times, frames, np.array(found["outcomes"]), np.array(found["again"], float))


@pytest.fixture(scope="module", params=SYSTEMS, ids=lambda system: system[0])
def followed(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Followed:
    return follow(*request.param, tmp_path_factory.mktemp("ensemble"))


def positions_of_heyoka(potential: Potential, state: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Return x and y by heyoka at rising times, of shape (n, 2)."""
    integrator = hy.taylor_adaptive(equations(potential), state.tolist(), tol=1e-16)
    _, grid = integrator.propagate_grid(np.concatenate([[0.0], times]))[-2:]
    positions: np.ndarray = grid[1:, :2]
    return positions


@needs_node
def test_orbits_agree_with_heyoka_until_they_leave(followed: Followed) -> None:
    compared = 0
    places = np.array([[frame["x"], frame["y"]] for frame in followed.frames])
    for orbit in range(COUNT):
        inside = np.array([frame["channel"][orbit] == 0 for frame in followed.frames])
        times = followed.times[inside]
        if not times.size:
            continue
        expected = positions_of_heyoka(followed.potential, followed.states[orbit], times)
        found = places[inside, :, orbit]
        # Chaos magnifies the error of a step, here at most by about exp(λ t) with λ < 0.3.
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=PLACE_ERROR)
        compared += times.size
    assert compared > COUNT * FRAMES / 10


@needs_node
def test_exits_are_those_of_the_server_at_each_time(followed: Followed) -> None:
    outcomes = classify_orbits(followed.potential, followed.energy, followed.states, t_max=LONGEST)
    for time, frame in zip(followed.times, followed.frames, strict=True):
        clear = ~(np.abs(outcomes.escape_time - time) < 1e-6)
        gone = np.where(outcomes.escape_time <= time, outcomes.fate, 0)
        np.testing.assert_array_equal(frame["channel"][clear], gone[clear])
    before_end = outcomes.escape_time < followed.times[-1] - 1e-6
    np.testing.assert_array_equal(followed.outcomes[before_end], outcomes.fate[before_end])


@needs_node
def test_an_earlier_time_begins_again_with_the_same_bits(followed: Followed) -> None:
    np.testing.assert_array_equal(followed.again, followed.frames[0]["x"])


@needs_node
def test_growth_compares_the_width_of_the_orbits_inside_with_that_of_their_starts(followed: Followed) -> None:
    for frame in followed.frames:
        inside = frame["channel"] == 0
        now = np.var(frame["x"][inside]) + np.var(frame["y"][inside])
        before = np.var(followed.states[inside, :2], axis=0).sum()
        assert frame["growth"] == pytest.approx(math.sqrt(now / before), rel=1e-9)


@needs_node
def test_passages_lie_on_the_section_at_the_energy(followed: Followed) -> None:
    states = followed.frames[-1]["section"].T
    passed = states[np.isfinite(states).all(axis=1)]
    assert len(passed) > COUNT / 2
    np.testing.assert_allclose(passed[:, 1], 0.0, atol=1e-14)
    assert (passed[:, 3] > 0.0).all()
    np.testing.assert_allclose(followed.potential.energy(passed), followed.energy, atol=1e-9)


@needs_node
@pytest.mark.parametrize("text", ["x = 0.008 down", "apsis"])
def test_passages_lie_on_any_section(text: str, tmp_path: Path) -> None:
    # Lanes without an orbit start at x = 0.01, at rest, and cross x = 0.008.
    section = read_section(text)
    followed = follow(*SYSTEMS[0], tmp_path, section)
    seen = 0
    for frame in followed.frames:
        states = frame["section"].T
        passed = states[np.isfinite(states).all(axis=1)]
        seen += len(passed)
        form = section.form
        linear = passed @ [form.get(name, 0.0) for name in ("x", "y", "px", "py")]
        radial = form.get("radial", 0.0) * np.sum(passed[:, :2] * passed[:, 2:], axis=1)
        np.testing.assert_allclose(linear + radial, form.get("value", 0.0), atol=1e-12)
        assert text == "apsis" or np.all(passed[:, 2] < 0.0)
    assert seen > FRAMES * COUNT / 2


def request_for(where: str, **changes: Any) -> dict[str, Any]:
    place = {"point": [0.1, 0.05], "radius": 0.01, "box": [0.1, 0.3, -0.2, 0.1]}
    return {"where": where, "count": 4000, "seed": 1} | place | changes


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> dict[str, np.ndarray]:
    system, energy = System("III"), 0.45
    portable = make_portable_system(system.potential, review_system(system).energies.high)
    view, well = (default_window(system.potential, plane, energy) for plane in (Plane.X_PX, Plane.X_Y))
    names = ("xLow", "xHigh", "ordinateLow", "ordinateHigh")
    scene = {
        "slice": Plane.X_PX.to_dict(system.potential.units),
        "energy": energy,
        "window": dict(zip(names, vars(view).values(), strict=True)),
    }
    windows = {"x_y": {"energies": [energy, 2 * energy], "windows": 2 * [list(vars(well).values())]}}
    requests = {
        "well": request_for("well"),
        "view": request_for("view"),
        "disc": request_for("disc"),
        "box": request_for("box"),
        "exits": request_for("exits"),
        "tubes": request_for("tubes"),
        "again": request_for("view"),
        "other": request_for("view", seed=2),
        "outside": request_for("disc", point=[5.0, 5.0]),
    }
    data = {"system": {**portable.to_dict(), "windows": windows}, "module": portable.module, "scene": scene}
    found = run_node("run_ensemble.js", data | {"requests": list(requests.values())}, tmp_path_factory.mktemp("starts"))
    return {name: np.array(states, float).reshape(-1, 4) for name, states in zip(requests, found, strict=True)}


@needs_node
def test_starts_are_inside_at_the_energy(drawn: dict[str, np.ndarray]) -> None:
    potential = System("III").potential
    for name in ("well", "view", "disc", "box", "exits", "tubes"):
        states = drawn[name]
        # Some orbits at the tubes have come from another exit.
        assert len(states) > 3000 if name == "tubes" else len(states) == 4000
        np.testing.assert_allclose(potential.energy(states), 0.45, rtol=1e-12)
        assert not find_outside_channels(potential, 0.45, *np.ascontiguousarray(states[:, :2].T)).any()
    assert len(drawn["outside"]) == 0


@needs_node
def test_equal_seeds_give_equal_starts(drawn: dict[str, np.ndarray]) -> None:
    np.testing.assert_array_equal(drawn["view"], drawn["again"])
    assert not np.isin(drawn["view"][:, 0], drawn["other"][:, 0]).any()


@needs_node
def test_starts_in_the_well_are_spread_evenly_over_the_energy_surface(drawn: dict[str, np.ndarray]) -> None:
    states, expected = drawn["well"], sample_starts(System("III").potential, 0.45, 4000, rng=9)
    for column in (lambda each: each[:, 0], lambda each: each[:, 1], lambda each: np.arctan2(each[:, 3], each[:, 2])):
        assert stats.ks_2samp(column(states), column(expected)).pvalue > FALSE_ALARM


@needs_node
def test_starts_on_a_disc_are_spread_evenly_around_its_point(drawn: dict[str, np.ndarray]) -> None:
    window = default_window(System("III").potential, Plane.X_PX, 0.45)
    x, px = drawn["disc"][:, 0] - 0.1, drawn["disc"][:, 2] - 0.05
    share = np.hypot(x / (window.x_high - window.x_low), px / (window.ordinate_high - window.ordinate_low)) / 0.005
    assert share.max() <= 1.0 + 1e-12
    # Half of the area lies within 1/√2 of the radius.
    assert np.mean(share < 1.0 / math.sqrt(2.0)) == pytest.approx(0.5, abs=0.045)


@needs_node
def test_starts_of_a_box_fill_it_evenly(drawn: dict[str, np.ndarray]) -> None:
    x, px = drawn["box"][:, 0], drawn["box"][:, 2]
    assert (x.min(), x.max(), px.min(), px.max()) == pytest.approx((0.1, 0.3, -0.2, 0.1), abs=1e-3)
    counts = np.histogram2d(x, px, bins=4)[0]
    np.testing.assert_allclose(counts, 250.0, atol=6.0 * math.sqrt(250.0))


@needs_node
def test_entering_orbits_stay_as_long_as_entering_orbits_of_the_library(drawn: dict[str, np.ndarray]) -> None:
    potential, t_max = System("III").potential, 100.0
    # For orbits that are still inside at t_max and have no escape time, t_max stands for the time.
    found, wanted = (
        np.fmin(classify_orbits(potential, 0.45, states, t_max).escape_time, t_max)
        for states in (drawn["exits"], sample_entrances(potential, 0.45, 4000, rng=8))
    )
    assert (found == t_max).any()
    assert stats.ks_2samp(found, wanted).pvalue > FALSE_ALARM
    # The mean time until t_max is volume over flux times the share of all starts that leave until then.
    leave = classify_orbits(potential, 0.45, sample_starts(potential, 0.45, 4000, rng=9), t_max).fate > 0
    assert found.mean() == pytest.approx(compute_flux(potential, 0.45).mean_passage_time * leave.mean(), rel=0.1)


@needs_node
def test_half_of_the_orbits_at_the_tubes_leaves_where_the_other_half_turns_back(drawn: dict[str, np.ndarray]) -> None:
    potential, states = System("III").potential, drawn["tubes"]
    outcomes = classify_orbits(potential, 0.45, states, 100.0)
    leave = np.abs(outcomes.escape_time - BEFORE_EXIT) < 1.0
    assert leave.mean() == pytest.approx(0.5, abs=0.055)
    path = sample_orbits(potential, states[~leave], [BEFORE_EXIT])
    exits = np.concatenate([orbit.half_path for orbit in find_lyapunov_orbits(potential, 0.45)])
    gaps = np.hypot(path.x - exits[:, 0], path.y - exits[:, 1]).min(axis=1)
    # The other half is close to an exit at that time, except for orbits that have left through another exit before.
    assert (gaps < 0.05).mean() > 0.9
