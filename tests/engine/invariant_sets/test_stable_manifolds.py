from __future__ import annotations

import threading
from concurrent.futures import CancelledError, ThreadPoolExecutor
from functools import cache

import numpy as np
import pytest
import shapely
from scipy.integrate import solve_ivp

from engine import CASES, MapSpec, Plane, Potential, Window, classify_orbits, compute_map, find_lyapunov_orbits, start_states
from engine.dynamics.section_points import find_section_points
from engine.invariant_sets.stable_manifolds import MOST_IMAGES, StableManifolds, find_stable_manifolds
from engine.invariant_sets.unstable_manifold import UnstableManifold
from tests.peers.dop853 import equations

# Hénon and Heiles' own orientation of Case II: odd in y, so that orbits can touch y = 0.
TURNED = Potential("turned", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 1.0), (0, 3, -1 / 3)))
NEVER = 1e9
# Turns of an arc that winds round another come nearer to each other than 1e-8.
STEP = 1e-10
EVERY = [("I", 0.15), ("II", 0.2), ("III", 0.45), ("III", 1.0)]
each_case = pytest.mark.parametrize("name", CASES)
each = pytest.mark.parametrize(("name", "energy"), EVERY)


@cache
def manifolds(potential: Potential, energy: float, images: int = 2) -> StableManifolds:
    return find_stable_manifolds(potential, energy, images)


def points_of(found: StableManifolds, channel: int, image: int) -> np.ndarray:
    """(n, 4) points of the arcs and unit normals there, ends of arcs left out."""
    rows = [np.empty((0, 4))]
    for arc in found.arcs:
        if (arc.channel, arc.image) == (channel, image):
            point = np.column_stack([arc.x, arc.px])
            step = np.diff(point, axis=0)
            length = np.hypot(*step.T)[:, None]
            along = step[:-1] / length[:-1] * length[1:] + step[1:] / length[1:] * length[:-1]
            along /= np.maximum(np.hypot(*along.T), np.finfo(float).tiny)[:, None]
            rows.append(np.column_stack([point[1:-1], -along[:, 1], along[:, 0]]))
    return np.concatenate(rows)


def share_that_parts(potential: Potential, energy: float, channel: int, image: int, most: int = 60) -> float:
    """The share of points of an image on one side of which, so far away, orbits leave in time, and on the other turn back."""
    points = points_of(manifolds(potential, energy), channel, image)
    points = points[:: -(-len(points) // most)]
    sides = []
    pairs = [start_states(potential, Plane.X_PX, energy, *(points[:, :2] + s * points[:, 2:]).T) for s in (STEP, -STEP)]
    exist = np.isfinite(pairs).all(axis=(0, 2))
    for starts in pairs:
        outcomes = classify_orbits(potential, energy, starts[exist], 200.0)
        leaves = (outcomes.fate == channel) & (outcomes.crossings == image - 1)
        sides.append(np.where(leaves, outcomes.escape_time, NEVER))
    one, other = sides
    # An orbit that turns back may come again to the same exit without crossing y = 0 upward, some time later.
    return float(np.mean((np.minimum(one, other) < NEVER) & (np.abs(one - other) > 1.0)))


def winds(name: str, channel: int) -> bool:
    """Whether the channel's Lyapunov orbit crosses y = 0."""
    return name == "II" and channel == 1


# What the curves part.


@each
@pytest.mark.parametrize("image", [1, 2])
def test_an_arc_parts_orbits_that_leave_after_so_many_crossings_from_those_that_turn_back(
    name: str, energy: float, image: int
) -> None:
    for channel in range(1, CASES[name].channels + 1):
        if not winds(name, channel):
            assert share_that_parts(CASES[name], energy, channel, image) >= 0.99


@pytest.mark.parametrize("image", [1, 2])
def test_an_arc_of_a_channel_on_the_axis_parts_orbits_that_leave_sooner_from_others(image: int) -> None:
    points = points_of(manifolds(CASES["II"], 0.2), 1, image)
    times = []
    for step in (STEP, -STEP):
        starts = start_states(CASES["II"], Plane.X_PX, 0.2, *(points[:, :2] + step * points[:, 2:]).T)
        outcomes = classify_orbits(CASES["II"], 0.2, starts, 200.0)
        times.append(np.where(outcomes.fate == 1, outcomes.escape_time, NEVER))
    assert np.all(np.minimum(*times) < NEVER)
    assert np.all(np.abs(times[0] - times[1]) > 1.0)


@pytest.mark.slow
@pytest.mark.parametrize("channel", [1, 2, 3])
def test_a_potential_without_symmetry_in_y_has_its_arcs_too(channel: int) -> None:
    assert share_that_parts(TURNED, 0.2, channel, 1) >= 0.99


@pytest.mark.parametrize(("name", "energy"), [("I", 0.15), ("II", 0.2)])
def test_the_first_image_encloses_exactly_the_direct_escapes(name: str, energy: float) -> None:
    x, px = np.random.default_rng(1).uniform(-0.5, 0.5, (2, 2000))
    starts = start_states(CASES[name], Plane.X_PX, energy, x, px)
    exist = np.isfinite(starts).all(axis=1)
    outcomes = classify_orbits(CASES[name], energy, starts[exist], 200.0)
    (arc,) = (a for a in manifolds(CASES[name], energy).arcs if (a.channel, a.image) == (2, 1))
    loop = shapely.Polygon(np.column_stack([arc.x, arc.px]))
    near = shapely.distance(loop.exterior, shapely.points(x[exist], px[exist])) < 1e-3
    direct = (outcomes.fate == 2) & (outcomes.crossings == 0)
    np.testing.assert_array_equal(shapely.contains_xy(loop, x[exist], px[exist])[~near], direct[~near])


@pytest.mark.parametrize(("name", "energy", "channel"), [("I", 0.15, 1), ("II", 0.2, 3), ("III", 0.45, 1), ("III", 0.45, 3)])
def test_no_border_of_a_basin_is_missed(name: str, energy: float, channel: int) -> None:
    spec = MapSpec(CASES[name], Plane.X_PX, energy, resolution=(101, 101), t_max=100.0)
    found = compute_map(spec)
    column = found.x[1] - found.x[0]
    for image in (1, 2):
        basin = (found.fate == channel) & (found.crossings == image - 1)
        row, left = np.nonzero((basin[:, 1:] != basin[:, :-1]) & (found.fate >= 0)[:, 1:] & (found.fate >= 0)[:, :-1])
        arcs = [a for a in manifolds(CASES[name], energy).arcs if (a.channel, a.image) == (channel, image)]
        lines = shapely.MultiLineString([np.column_stack([a.x, a.px]) for a in arcs])
        away = shapely.distance(lines, shapely.points(0.5 * (found.x[left] + found.x[left + 1]), found.ordinate[row]))
        assert np.mean(away < 0.55 * column) > 0.97
        assert away.max() < 1.5 * column


# What the points are.


@pytest.mark.parametrize(("name", "energy", "channel"), [("I", 0.15, 2), ("II", 0.2, 1), ("II", 0.2, 3), ("III", 0.45, 4)])
def test_orbits_from_an_arc_stay_at_the_lyapunov_orbit_by_scipy(name: str, energy: float, channel: int) -> None:
    orbit = find_lyapunov_orbits(CASES[name], energy)[channel - 1]
    path = shapely.LineString(orbit.half_path)
    times = np.arange(0.0, 45.0, 0.05)

    def inside(_t: float, s: np.ndarray) -> float:
        return 2.0 - float(np.hypot(s[0], s[1]))

    inside.terminal = True  # type: ignore[attr-defined]
    for image in (1, 2):
        points = points_of(manifolds(CASES[name], energy), channel, image)
        (start,) = start_states(CASES[name], Plane.X_PX, energy, *points[[len(points) // 2], :2].T)
        solution = solve_ivp(
            equations(CASES[name]), (0.0, times[-1]), start, "DOP853", t_eval=times, events=inside, rtol=1e-12, atol=1e-13
        )
        near = shapely.distance(path, shapely.points(solution.y[:2].T)) < 0.02
        longest = max(run.size for run in np.split(near, np.flatnonzero(np.diff(near)) + 1) if run[0])
        assert 0.05 * longest > orbit.period


@pytest.mark.parametrize(("name", "energy", "channel"), [("I", 0.15, 1), ("II", 0.2, 2), ("III", 0.45, 1), ("III", 0.45, 3)])
def test_a_point_of_an_image_next_crosses_on_the_image_before(name: str, energy: float, channel: int) -> None:
    found = manifolds(CASES[name], energy)
    second = points_of(found, channel, 2)[:, :2]
    second = second[:: -(-len(second) // 200)]
    following = find_section_points(CASES[name], start_states(CASES[name], Plane.X_PX, energy, *second.T), 1, 30.0)[:, 0]
    first = shapely.MultiLineString([np.column_stack([a.x, a.px]) for a in found.arcs if (a.channel, a.image) == (channel, 1)])
    assert np.mean(shapely.distance(first, shapely.points(following)) < 1e-3) > 0.98


@each
def test_every_point_can_be_started_from(name: str, energy: float) -> None:
    for arc in manifolds(CASES[name], energy).arcs:
        assert np.isfinite(start_states(CASES[name], Plane.X_PX, energy, arc.x, arc.px)).all()


def test_mirrored_channels_have_mirrored_arcs() -> None:
    by_channel = {c: [a for a in manifolds(CASES["III"], 0.45).arcs if a.channel == c] for c in (1, 2, 3, 4)}
    for one, other in ((1, 2), (4, 3)):
        assert len(by_channel[one]) == len(by_channel[other])
        for arc, image in zip(by_channel[one], by_channel[other], strict=True):
            np.testing.assert_array_equal([arc.x, arc.px], [-image.x, -image.px])


@pytest.mark.slow
def test_a_channel_that_is_its_own_mirror_image_has_symmetric_arcs() -> None:
    (arc,) = (a for a in manifolds(TURNED, 0.2).arcs if (a.channel, a.image) == (1, 1))
    loop = shapely.LinearRing(np.column_stack([arc.x, arc.px]))
    assert shapely.hausdorff_distance(loop, shapely.transform(loop, np.negative)) < 2e-3


def test_images_of_a_channel_on_the_axis_start_at_its_orbit_and_go_on_end_to_end() -> None:
    found = manifolds(CASES["II"], 0.2)
    first, second = (next(a for a in found.arcs if (a.channel, a.image) == (1, image)) for image in (1, 2))
    assert np.hypot(first.x[0] - find_lyapunov_orbits(CASES["II"], 0.2)[0].x[50], first.px[0]) < 1e-3
    assert np.hypot(second.x[0] - first.x[-1], second.px[0] - first.px[-1]) < 1e-3


def test_closed_curves_end_where_they_begin_and_are_whole() -> None:
    found = find_stable_manifolds(CASES["I"], 0.15, 1)
    assert not found.truncated
    for arc in found.arcs:
        assert (arc.x[0], arc.px[0]) == (arc.x[-1], arc.px[-1])


def test_curves_that_break_off_are_said_to_be_truncated() -> None:
    assert manifolds(CASES["I"], 0.15).truncated


# The tube.


@each_case
def test_near_the_saddle_the_multiplier_is_that_of_the_saddle(name: str) -> None:
    # exp(2π μ/ω) with the eigenvalues −μ² and ω² of the saddle's Hessian.
    potential = CASES[name]
    vxx, vxy, vyy = potential.hessian(*potential.saddles[0])
    unstable, stable = np.linalg.eigvalsh([[vxx, vxy], [vxy, vyy]])
    (orbit, *_) = find_lyapunov_orbits(potential, potential.escape_energy + 1e-7)
    expected = np.exp(2 * np.pi * np.sqrt(-unstable / stable))
    assert UnstableManifold.from_orbit(potential, orbit).multiplier == pytest.approx(expected, rel=1e-5)


@each
def test_launched_orbits_have_the_energy_and_lie_inside_the_exit(name: str, energy: float) -> None:
    for orbit in find_lyapunov_orbits(CASES[name], energy):
        tube = UnstableManifold.from_orbit(CASES[name], orbit)
        states = tube.launch(np.geomspace(1e-8, 1e-3, 20))
        np.testing.assert_allclose(CASES[name].energy(states), energy, rtol=0, atol=1e-15)
        assert not np.any(classify_orbits(CASES[name], energy, states, 1e-3).fate)


def test_cuts_are_the_downward_passages_that_scipy_finds() -> None:
    tube = UnstableManifold.from_orbit(CASES["I"], find_lyapunov_orbits(CASES["I"], 0.15)[0])
    numbers = np.linspace(0.0, 1.0, 21)
    cuts = tube.follow(numbers, 2)
    early = np.flatnonzero(cuts[:, 1, 2] < np.nanmedian(cuts[:, 1, 2]))[::3]
    numbers, cuts = numbers[early], cuts[early]
    launched = tube.launch(tube.sizes(numbers))

    def height(_t: float, s: np.ndarray) -> float:
        return s[1]

    height.direction = -1.0  # type: ignore[attr-defined]
    for mine, start in zip(cuts, launched, strict=True):
        theirs = solve_ivp(equations(CASES["I"]), (0, 26.0), start, "DOP853", events=height, rtol=1e-13, atol=1e-15).y_events[0]
        np.testing.assert_allclose(mine[:, :2], theirs[:2, [0, 2]], rtol=0, atol=1e-5)


def test_orbits_have_no_cut_after_they_have_left() -> None:
    tube = UnstableManifold.from_orbit(CASES["III"], find_lyapunov_orbits(CASES["III"], 0.45)[0])
    numbers = np.linspace(0.0, 1.0, 200)
    passages = np.isfinite(tube.follow(numbers, 5)[:, :, 0]).sum(axis=1)
    launched = tube.launch(tube.sizes(numbers))
    # Where V is even in y, downward passages are the upward ones of the mirrored orbit.
    outcomes = classify_orbits(CASES["III"], 0.45, launched * [1.0, -1.0, 1.0, -1.0], 1e4)
    assert (outcomes.fate >= 1).all()
    np.testing.assert_array_equal(passages, np.minimum(outcomes.crossings, 5))


def test_number_one_is_number_zero_a_period_later() -> None:
    tube = UnstableManifold.from_orbit(CASES["I"], find_lyapunov_orbits(CASES["I"], 0.15)[0])
    np.testing.assert_allclose(*tube.follow(np.array([0.0, 1.0]), 1), rtol=0, atol=1e-6)


# The request.


@each_case
@pytest.mark.parametrize("below", [0.0, 0.05])
def test_closed_channels_have_no_arcs(name: str, below: float) -> None:
    found = find_stable_manifolds(CASES[name], CASES[name].escape_energy - below)
    assert (found.arcs, found.truncated, found.nbytes) == ((), False, 0)


@pytest.mark.parametrize("images", [0, -1, MOST_IMAGES + 1])
def test_a_number_of_images_out_of_range_is_refused(images: int) -> None:
    with pytest.raises(ValueError, match=f"images={images}"):
        find_stable_manifolds(CASES["I"], 0.15, images)


@pytest.mark.parametrize("energy", [np.nan, np.inf])
def test_energy_that_is_not_finite_is_refused(energy: float) -> None:
    with pytest.raises(ValueError, match=f"energy={energy}"):
        find_stable_manifolds(CASES["I"], energy)


def test_an_executor_makes_no_difference() -> None:
    with ThreadPoolExecutor(3) as pool:
        mine = find_stable_manifolds(CASES["I"], 0.15, 2, executor=pool)
    for arc, other in zip(mine.arcs, manifolds(CASES["I"], 0.15).arcs, strict=True):
        np.testing.assert_array_equal([arc.x, arc.px], [other.x, other.px])


def test_when_cancelled_it_says_so() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        find_stable_manifolds(CASES["I"], 0.15, cancel=cancel)


def test_arrays_are_read_only() -> None:
    for arc in manifolds(CASES["III"], 0.45).arcs:
        assert not arc.x.flags.writeable
        assert not arc.px.flags.writeable


def test_bytes_are_those_of_the_arrays() -> None:
    found = manifolds(CASES["I"], 0.15)
    assert found.nbytes == 16 * sum(arc.x.size for arc in found.arcs)


def window_on_an_arc(half: float) -> Window:
    """A square around a point of an arc of I at h = 0.19."""
    arc = next(arc for arc in find_stable_manifolds(CASES["I"], 0.19, 1).arcs if arc.channel == 1)
    x, px = float(arc.x[arc.x.size // 3]), float(arc.px[arc.x.size // 3])
    return Window(x - half, x + half, px - half, px + half)


def points_inside(found: StableManifolds, window: Window) -> np.ndarray:
    points = np.concatenate([np.column_stack([arc.x, arc.px]) for arc in found.arcs])
    low, high = np.array([[window.x_low, window.ordinate_low], [window.x_high, window.ordinate_high]])
    return points[np.all((points >= low) & (points <= high), axis=1)]


def test_a_closer_look_has_finer_curves_in_its_window_and_none_beyond() -> None:
    window = window_on_an_arc(0.02)
    whole, close = (find_stable_manifolds(CASES["I"], 0.19, 3, window=part) for part in (None, window))
    assert len(points_inside(close, window)) > 2 * len(points_inside(whole, window)) > 0
    rim = Window(window.x_low - 0.0041, window.x_high + 0.0041, window.ordinate_low - 0.0041, window.ordinate_high + 0.0041)
    assert len(points_inside(close, rim)) == sum(arc.x.size for arc in close.arcs)


def test_a_closer_look_lies_on_the_curves_of_the_whole() -> None:
    window = window_on_an_arc(0.02)
    whole, close = (find_stable_manifolds(CASES["I"], 0.19, 1, window=part) for part in (None, window))
    lines = shapely.MultiLineString([np.column_stack([arc.x, arc.px]) for arc in whole.arcs])
    distance = shapely.distance(lines, shapely.points(points_inside(close, window)))
    assert distance.size > 0
    assert distance.max() < 1e-3


def test_in_a_deep_zoom_the_curves_still_part_the_basins() -> None:
    half = 1e-6
    window = window_on_an_arc(half)
    close = find_stable_manifolds(CASES["I"], 0.19, 1, window=window)
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (40, 40), window, t_max=500.0))
    direct = (frame.fate == 1) & (frame.crossings == 0)
    assert 0.2 < direct.mean() < 0.8
    line = shapely.MultiLineString([np.column_stack([one.x, one.px]) for one in close.arcs if one.channel == 1])
    rows, columns = np.nonzero(direct[:, 1:] != direct[:, :-1])
    border = shapely.points(0.5 * (frame.x[columns] + frame.x[columns + 1]), frame.ordinate[rows])
    assert shapely.distance(line, border).max() < 2.0 * half / 40
