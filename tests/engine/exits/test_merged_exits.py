"""Two channels have one exit above the maximum of V between them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import (
    MapSpec,
    Plane,
    Potential,
    classify_orbits,
    compute_map,
    find_lyapunov_orbits,
)
from engine.exits.exit_rows import exit_curves
from engine.exits.interior import find_outside_channels
from engine.integrator.kernels.events import crossed_exit
from engine.integrator.kernels.exit_geometry import exit_distance
from engine.systems.known_potentials import POTENTIALS
from tests.peers.dop853 import equations
from tests.peers.random_systems import HIGHEST_DEGREE, random_well

# Even in x and y. The maxima lie on the y axis, between channels 1 and 2, and between 3 and 4.
SYMMETRIC = Potential("symmetric", ((2, 0, 0.8902), (0, 2, 0.3619), (2, 4, -0.94), (0, 6, -0.0346)))
# A potential whose channels are not mirror images of each other under x → −x.
GENERAL = random_well(896, HIGHEST_DEGREE)
MAXIMUM = SYMMETRIC.well.channel_mergers[0].energy
# Energy in units of the energy of the maximum.
ABOVE = 1.2


def above(potential: Potential) -> float:
    return 1.1 * potential.well.channel_mergers[0].energy


def random_states(potential: Potential, energy: float, count: int) -> np.ndarray:
    """Return starts in the inner part of the well, with velocities in random directions."""
    random, reach = np.random.default_rng(1), 0.3 * np.hypot(*potential.saddles.T).min()
    place, angle = random.uniform(-reach, reach, (count, 2)), random.uniform(0.0, 2.0 * np.pi, count)
    speed = np.sqrt(2.0 * (energy - potential.value(*place.T)))
    return np.column_stack([place, speed * np.cos(angle), speed * np.sin(angle)])


def test_channels_on_both_sides_of_a_maximum_are_one_exit_above_its_energy() -> None:
    assert [orbit.name for orbit in find_lyapunov_orbits(SYMMETRIC, 0.99 * MAXIMUM)] == ["1", "2", "3", "4"]
    assert [orbit.name for orbit in find_lyapunov_orbits(SYMMETRIC, ABOVE * MAXIMUM)] == ["1+2", "3+4"]
    labels = [outcome.label for outcome in SYMMETRIC.outcomes_at(ABOVE * MAXIMUM)]
    assert labels == ["exit 1+2", "exit 2 in 1+2", "exit 3+4", "exit 4 in 3+4"]


def test_the_orbit_leads_from_rest_to_rest_and_its_ends_enclose_the_saddles() -> None:
    potential = GENERAL
    orbit = next(orbit for orbit in find_lyapunov_orbits(potential, above(potential)) if orbit.others)
    start = [orbit.x[0], orbit.y[0], 0.0, 0.0]
    end = solve_ivp(equations(potential), (0.0, 0.5 * orbit.period), start, "DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
    np.testing.assert_allclose(end, [orbit.x[100], orbit.y[100], 0.0, 0.0], rtol=0, atol=1e-9)
    ends, saddles = orbit.half_path[[0, -1]], potential.saddles[np.array([orbit.channel, *orbit.others]) - 1]
    share = (saddles - ends[0]) @ (ends[1] - ends[0]) / np.sum((ends[1] - ends[0]) ** 2)
    assert np.all((share > 0.0) & (share < 1.0))


def test_orbits_that_have_crossed_do_not_come_back() -> None:
    potential = SYMMETRIC
    energy = above(potential)
    orbit = next(orbit for orbit in find_lyapunov_orbits(potential, energy) if orbit.others)
    assert abs(orbit.multipliers[0]) > 10.0
    exits, no_gates = orbit.curve[None], np.array([[0.0, 0.0, -1.0]])
    random = np.random.default_rng(3)
    farthest = 3.0 * np.hypot(*potential.saddles.T).max()

    def is_far(_t: float, state: np.ndarray) -> float:
        return farthest - np.hypot(state[0], state[1])

    is_far.terminal = True  # type: ignore[attr-defined]
    for k in random.integers(10, 90, 40).tolist():
        along = orbit.half_path[k + 1] - orbit.half_path[k - 1]
        normal = np.array([along[1], -along[0]]) / np.hypot(*along)
        normal *= np.sign(normal @ orbit.outward)
        angle = np.arctan2(normal[1], normal[0]) + random.uniform(-1.4, 1.4)
        place = orbit.half_path[k] + 1e-6 * normal
        speed = np.sqrt(2.0 * (energy - potential.value(*place)))
        start = [*place, speed * np.cos(angle), speed * np.sin(angle)]
        path = solve_ivp(equations(potential), (0.0, 100.0), start, "DOP853", rtol=1e-10, max_step=0.1, events=is_far)
        x, y = path.y[:2]
        assert path.status == 1
        assert not any(crossed_exit(x[i + 1], y[i + 1], x[i], y[i], exits, no_gates) for i in range(x.size - 1))


def test_most_orbits_of_the_inner_well_leave_as_just_below_the_maximum() -> None:
    below, higher = 0.999 * MAXIMUM, 1.025 * MAXIMUM
    fates = [classify_orbits(SYMMETRIC, h, random_states(SYMMETRIC, h, 300), 15.0).fate for h in (below, higher)]
    leaves = fates[0] > 0
    assert leaves.sum() > 100
    expected = SYMMETRIC.well.exit_numbers(higher)[fates[0][leaves]]
    assert np.mean(fates[1][leaves] == expected) > 0.9
    assert set(fates[1].tolist()) == {0, 1, 3}


def test_the_exit_of_mirror_channels_is_exactly_its_own_mirror_image() -> None:
    curve = exit_curves(SYMMETRIC, ABOVE * MAXIMUM)[0]
    for x, y in np.random.default_rng(1).uniform(-2.0, 2.0, (100, 2)):
        assert exit_distance(x, y, curve) == exit_distance(-x, y, curve)


def test_a_start_beyond_the_exit_is_outside_with_its_number() -> None:
    beyond = GENERAL.saddles + 0.5 * GENERAL.well.outward_directions
    energy = above(GENERAL)
    (orbit,) = (orbit for orbit in find_lyapunov_orbits(GENERAL, energy) if orbit.others)
    outside = find_outside_channels(GENERAL, energy, *beyond[np.array([orbit.channel, *orbit.others]) - 1].T)
    assert outside.tolist() == [orbit.channel] * 2


def test_maps_and_single_orbits_agree_and_mirror_images_leave_through_the_mirror_exit() -> None:
    energy = ABOVE * MAXIMUM
    spec = MapSpec(SYMMETRIC, Plane.X_Y, energy, (12, 12), t_max=100.0)
    frame = compute_map(spec)
    assert set(frame.fate[frame.fate > 0].tolist()) <= {1, 3}
    np.testing.assert_array_equal(frame.fate, frame.fate[:, ::-1])
    rows, columns = np.nonzero(frame.fate >= 0)
    states = spec.start_states(frame.x[columns], frame.ordinate[rows])
    np.testing.assert_array_equal(classify_orbits(SYMMETRIC, energy, states, 100.0).fate, frame.fate[rows, columns])


def test_a_plane_of_energies_names_merged_exits_above_their_energy() -> None:
    spec = MapSpec(SYMMETRIC, Plane.X_H, (0.9 * MAXIMUM, ABOVE * MAXIMUM), (6, 2), t_max=20.0)
    assert spec.outcomes[0].label == f"exit 1, 1+2 above h = {MAXIMUM:.6g}"
    fates = compute_map(spec).fate
    assert set(fates[1][fates[1] > 0].tolist()) <= {1, 3}


def test_an_exit_without_an_orbit_between_its_outer_walls_is_refused() -> None:
    # The motion along the maximum is above its barrier and comes to rest only once.
    with pytest.raises(ValueError, match=r"channels 1\+2 are one exit above V = 0\.166667, .* no orbit at rest .*Separable"):
        find_lyapunov_orbits(POTENTIALS["Separable"], 1.01 / 6)


def test_an_exit_all_around_the_well_is_refused() -> None:
    # V is a function of x plus a function of y, with four saddles on the axes and a maximum between neighbouring saddles.
    open_well = Potential("", ((2, 0, 0.5), (0, 2, 0.5), (4, 0, -0.25), (0, 4, -0.25)))
    with pytest.raises(ValueError, match=r"channels 1\+2\+3\+4 are one exit .* all around the well"):
        find_lyapunov_orbits(open_well, 0.6)
