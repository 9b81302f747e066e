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
from engine.execution import Execution
from engine.invariant_sets.stable_manifolds import MOST_IMAGES, StableManifolds, find_stable_manifolds
from engine.invariant_sets.unstable_manifold import UnstableManifold
from tests.peers.dop853 import equations

# The original orientation of the Hénon-Heiles potential (Case II): not even in y, so that orbits can touch y = 0.
TURNED = Potential("turned", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 1.0), (0, 3, -1 / 3)))
NEVER = 1e9
# Distance to either side of an arc. Successive turns of an arc that winds around another are less than 1e-8 apart.
STEP = 1e-10
SYSTEMS = [("I", 0.15), ("II", 0.2), ("III", 0.45), ("III", 1.0)]
each_case = pytest.mark.parametrize("name", CASES)
each = pytest.mark.parametrize(("name", "energy"), SYSTEMS)


@cache
def manifolds(potential: Potential, energy: float, images: int = 2) -> StableManifolds:
    return find_stable_manifolds(potential, energy, images=images)


def points_with_normals(found: StableManifolds, channel: int, image: int) -> np.ndarray:
    """(n, 4) points x, px of the arcs, without their ends, and unit normals."""
    rows = [np.empty((0, 4))]
    for arc in found.arcs:
        if (arc.channel, arc.image) == (channel, image):
            point = np.column_stack([arc.x, arc.px])
            step = np.diff(point, axis=0)
            length = np.hypot(*step.T)[:, None]
            tangent = step[:-1] / length[:-1] * length[1:] + step[1:] / length[1:] * length[:-1]
            tangent /= np.maximum(np.hypot(*tangent.T), np.finfo(float).tiny)[:, None]
            rows.append(np.column_stack([point[1:-1], -tangent[:, 1], tangent[:, 0]]))
    return np.concatenate(rows)


def separating_share(potential: Potential, energy: float, channel: int, image: int, most: int = 60) -> float:
    """Share of the points of an image where orbits `STEP` to one side escape and those `STEP` to the other turn back."""
    points = points_with_normals(manifolds(potential, energy), channel, image)
    points = points[:: -(-len(points) // most)]
    sides = []
    pairs = [start_states(potential, Plane.X_PX, energy, *(points[:, :2] + s * points[:, 2:]).T) for s in (STEP, -STEP)]
    exist = np.isfinite(pairs).all(axis=(0, 2))
    for starts in pairs:
        outcomes = classify_orbits(potential, energy, starts[exist], 200.0)
        leaves = (outcomes.fate == channel) & (outcomes.crossings == image - 1)
        sides.append(np.where(leaves, outcomes.escape_time, NEVER))
    one, other = sides
    # An orbit that turns back may return to the same exit later without crossing y = 0 upward.
    return float(np.mean((np.minimum(one, other) < NEVER) & (np.abs(one - other) > 1.0)))


def crosses_axis(name: str, channel: int) -> bool:
    """Whether the channel's Lyapunov orbit crosses y = 0."""
    return name == "II" and channel == 1


# Separation of basins.


@each
@pytest.mark.parametrize("image", [1, 2])
def test_arcs_separate_escapes_after_n_crossings_from_orbits_that_turn_back(name: str, energy: float, image: int) -> None:
    for channel in range(1, CASES[name].channels + 1):
        if not crosses_axis(name, channel):
            assert separating_share(CASES[name], energy, channel, image) >= 0.99


@pytest.mark.parametrize("image", [1, 2])
def test_arcs_of_a_channel_on_the_axis_separate_earlier_escapes_from_later_ones(image: int) -> None:
    points = points_with_normals(manifolds(CASES["II"], 0.2), 1, image)
    times = []
    for step in (STEP, -STEP):
        starts = start_states(CASES["II"], Plane.X_PX, 0.2, *(points[:, :2] + step * points[:, 2:]).T)
        outcomes = classify_orbits(CASES["II"], 0.2, starts, 200.0)
        times.append(np.where(outcomes.fate == 1, outcomes.escape_time, NEVER))
    assert np.all(np.minimum(*times) < NEVER)
    assert np.all(np.abs(times[0] - times[1]) > 1.0)


@pytest.mark.parametrize("channel", [1, 2, 3])
def test_arcs_separate_basins_without_symmetry_in_y(channel: int) -> None:
    assert separating_share(TURNED, 0.2, channel, 1) >= 0.99


@pytest.mark.parametrize(("name", "energy"), [("I", 0.15), ("II", 0.2)])
def test_first_image_encloses_exactly_the_direct_escapes(name: str, energy: float) -> None:
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
def test_all_basin_boundaries_lie_on_arcs(name: str, energy: float, channel: int) -> None:
    spec = MapSpec(CASES[name], Plane.X_PX, energy, resolution=(101, 101), t_max=100.0)
    found = compute_map(spec)
    column = found.x[1] - found.x[0]
    for image in (1, 2):
        basin = (found.fate == channel) & (found.crossings == image - 1)
        row, left = np.nonzero((basin[:, 1:] != basin[:, :-1]) & (found.fate >= 0)[:, 1:] & (found.fate >= 0)[:, :-1])
        arcs = [a for a in manifolds(CASES[name], energy).arcs if (a.channel, a.image) == (channel, image)]
        lines = shapely.MultiLineString([np.column_stack([a.x, a.px]) for a in arcs])
        distance = shapely.distance(lines, shapely.points(0.5 * (found.x[left] + found.x[left + 1]), found.ordinate[row]))
        assert np.mean(distance < 0.55 * column) > 0.97
        assert distance.max() < 1.5 * column


# Points of the arcs.


@pytest.mark.parametrize(("name", "energy", "channel"), [("I", 0.15, 2), ("II", 0.2, 1), ("II", 0.2, 3), ("III", 0.45, 4)])
def test_scipy_orbits_from_an_arc_stay_near_the_lyapunov_orbit(name: str, energy: float, channel: int) -> None:
    orbit = find_lyapunov_orbits(CASES[name], energy)[channel - 1]
    path = shapely.LineString(orbit.half_path)
    times = np.arange(0.0, 45.0, 0.05)

    def inside(_t: float, s: np.ndarray) -> float:
        return 2.0 - float(np.hypot(s[0], s[1]))

    inside.terminal = True  # type: ignore[attr-defined]
    for image in (1, 2):
        points = points_with_normals(manifolds(CASES[name], energy), channel, image)
        (start,) = start_states(CASES[name], Plane.X_PX, energy, *points[[len(points) // 2], :2].T)
        solution = solve_ivp(
            equations(CASES[name]), (0.0, times[-1]), start, "DOP853", t_eval=times, events=inside, rtol=1e-12, atol=1e-13
        )
        near = shapely.distance(path, shapely.points(solution.y[:2].T)) < 0.02
        longest = max(run.size for run in np.split(near, np.flatnonzero(np.diff(near)) + 1) if run[0])
        assert 0.05 * longest > orbit.period


@pytest.mark.parametrize(("name", "energy", "channel"), [("I", 0.15, 1), ("II", 0.2, 2), ("III", 0.45, 1), ("III", 0.45, 3)])
def test_points_of_an_image_are_mapped_to_the_previous_image(name: str, energy: float, channel: int) -> None:
    found = manifolds(CASES[name], energy)
    second = points_with_normals(found, channel, 2)[:, :2]
    second = second[:: -(-len(second) // 200)]
    next_points = find_section_points(CASES[name], start_states(CASES[name], Plane.X_PX, energy, *second.T), 1, 30.0)[:, 0]
    first = shapely.MultiLineString([np.column_stack([a.x, a.px]) for a in found.arcs if (a.channel, a.image) == (channel, 1)])
    assert np.mean(shapely.distance(first, shapely.points(next_points)) < 1e-3) > 0.98


@each
def test_all_points_are_allowed_starts(name: str, energy: float) -> None:
    for arc in manifolds(CASES[name], energy).arcs:
        assert np.isfinite(start_states(CASES[name], Plane.X_PX, energy, arc.x, arc.px)).all()


def test_mirrored_channels_have_mirrored_arcs() -> None:
    by_channel = {c: [a for a in manifolds(CASES["III"], 0.45).arcs if a.channel == c] for c in (1, 2, 3, 4)}
    for one, other in ((1, 2), (4, 3)):
        assert len(by_channel[one]) == len(by_channel[other])
        for arc, image in zip(by_channel[one], by_channel[other], strict=True):
            np.testing.assert_array_equal([arc.x, arc.px], [-image.x, -image.px])


def test_self_mirrored_channel_has_symmetric_arcs() -> None:
    (arc,) = (a for a in manifolds(TURNED, 0.2).arcs if (a.channel, a.image) == (1, 1))
    loop = shapely.LinearRing(np.column_stack([arc.x, arc.px]))
    assert shapely.hausdorff_distance(loop, shapely.transform(loop, np.negative)) < 2e-3


def test_images_of_a_channel_on_the_axis_start_at_its_orbit_and_join_end_to_end() -> None:
    found = manifolds(CASES["II"], 0.2)
    first, second = (next(a for a in found.arcs if (a.channel, a.image) == (1, image)) for image in (1, 2))
    assert np.hypot(first.x[0] - find_lyapunov_orbits(CASES["II"], 0.2)[0].x[50], first.px[0]) < 1e-3
    assert np.hypot(second.x[0] - first.x[-1], second.px[0] - first.px[-1]) < 1e-3


def test_first_images_are_closed_curves_and_not_truncated() -> None:
    found = find_stable_manifolds(CASES["I"], 0.15, images=1)
    assert not found.truncated
    for arc in found.arcs:
        assert (arc.x[0], arc.px[0]) == (arc.x[-1], arc.px[-1])


def test_incomplete_curves_are_reported_as_truncated() -> None:
    assert manifolds(CASES["I"], 0.15).truncated


# The unstable manifold.


@each_case
def test_multiplier_near_the_saddle_follows_from_its_hessian(name: str) -> None:
    # exp(2π μ/ω) with the eigenvalues −μ² and ω² of the saddle's Hessian.
    potential = CASES[name]
    vxx, vxy, vyy = potential.hessian(*potential.saddles[0])
    unstable, stable = np.linalg.eigvalsh([[vxx, vxy], [vxy, vyy]])
    (orbit, *_) = find_lyapunov_orbits(potential, potential.escape_energy + 1e-7)
    expected = np.exp(2 * np.pi * np.sqrt(-unstable / stable))
    assert UnstableManifold.from_orbit(orbit).multiplier == pytest.approx(expected, rel=1e-5)


@each
def test_start_states_have_the_energy_and_lie_inside_the_exit(name: str, energy: float) -> None:
    for orbit in find_lyapunov_orbits(CASES[name], energy):
        tube = UnstableManifold.from_orbit(orbit)
        states = tube.start_states(np.geomspace(1e-8, 1e-3, 20))
        np.testing.assert_allclose(CASES[name].energy(states), energy, rtol=0, atol=1e-15)
        assert not np.any(classify_orbits(CASES[name], energy, states, 1e-3).fate)


def test_passages_agree_with_scipy() -> None:
    tube = UnstableManifold.from_orbit(find_lyapunov_orbits(CASES["I"], 0.15)[0])
    phases = np.linspace(0.0, 1.0, 21)
    passages = tube.find_passages(phases, 2)
    early = np.flatnonzero(passages[:, 1, 2] < np.nanmedian(passages[:, 1, 2]))[::3]
    phases, passages = phases[early], passages[early]
    starts = tube.start_states(tube.displacements(phases))

    def height(_t: float, s: np.ndarray) -> float:
        return s[1]

    height.direction = -1.0  # type: ignore[attr-defined]
    for found, start in zip(passages, starts, strict=True):
        expected = solve_ivp(equations(CASES["I"]), (0, 26.0), start, "DOP853", events=height, rtol=1e-13, atol=1e-15).y_events[0]
        np.testing.assert_allclose(found[:, :2], expected[:2, [0, 2]], rtol=0, atol=1e-5)


def test_orbits_have_no_passages_after_the_escape() -> None:
    tube = UnstableManifold.from_orbit(find_lyapunov_orbits(CASES["III"], 0.45)[0])
    phases = np.linspace(0.0, 1.0, 200)
    passages = np.isfinite(tube.find_passages(phases, 5)[:, :, 0]).sum(axis=1)
    starts = tube.start_states(tube.displacements(phases))
    # As V is even in y, downward passages are the upward crossings of the mirrored orbit.
    outcomes = classify_orbits(CASES["III"], 0.45, starts * [1.0, -1.0, 1.0, -1.0], 1e4)
    assert (outcomes.fate >= 1).all()
    np.testing.assert_array_equal(passages, np.minimum(outcomes.crossings, 5))


def test_phases_zero_and_one_are_the_same_orbit() -> None:
    tube = UnstableManifold.from_orbit(find_lyapunov_orbits(CASES["I"], 0.15)[0])
    np.testing.assert_allclose(*tube.find_passages(np.array([0.0, 1.0]), 1), rtol=0, atol=1e-6)


# Arguments.


@each_case
@pytest.mark.parametrize("below", [0.0, 0.05])
def test_there_are_no_arcs_at_or_below_the_escape_energy(name: str, below: float) -> None:
    found = find_stable_manifolds(CASES[name], CASES[name].escape_energy - below)
    assert (found.arcs, found.truncated, found.nbytes) == ((), False, 0)


@pytest.mark.parametrize("images", [0, -1, MOST_IMAGES + 1])
def test_number_of_images_out_of_range_raises(images: int) -> None:
    with pytest.raises(ValueError, match=f"images={images}"):
        find_stable_manifolds(CASES["I"], 0.15, images=images)


@pytest.mark.parametrize("energy", [np.nan, np.inf])
def test_non_finite_energy_raises(energy: float) -> None:
    with pytest.raises(ValueError, match=f"energy={energy}"):
        find_stable_manifolds(CASES["I"], energy)


def test_result_does_not_depend_on_the_executor() -> None:
    with ThreadPoolExecutor(3) as pool:
        found = find_stable_manifolds(CASES["I"], 0.15, images=2, execution=Execution(pool))
    for arc, other in zip(found.arcs, manifolds(CASES["I"], 0.15).arcs, strict=True):
        np.testing.assert_array_equal([arc.x, arc.px], [other.x, other.px])


def test_cancelling_raises() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        find_stable_manifolds(CASES["I"], 0.15, execution=Execution(cancel=cancel))


def test_arrays_are_read_only() -> None:
    for arc in manifolds(CASES["III"], 0.45).arcs:
        assert not arc.x.flags.writeable
        assert not arc.px.flags.writeable


def test_nbytes_is_the_size_of_the_arrays() -> None:
    found = manifolds(CASES["I"], 0.15)
    assert found.nbytes == 16 * sum(arc.x.size for arc in found.arcs)


# Zooms.


def window_on_an_arc(half: float) -> Window:
    """A square of side 2 `half` around a point of an arc of I at h = 0.19."""
    arc = next(arc for arc in find_stable_manifolds(CASES["I"], 0.19, images=1).arcs if arc.channel == 1)
    x, px = float(arc.x[arc.x.size // 3]), float(arc.px[arc.x.size // 3])
    return Window(x - half, x + half, px - half, px + half)


def points_inside(found: StableManifolds, window: Window) -> np.ndarray:
    points = np.concatenate([np.column_stack([arc.x, arc.px]) for arc in found.arcs])
    low, high = np.array([[window.x_low, window.ordinate_low], [window.x_high, window.ordinate_high]])
    return points[np.all((points >= low) & (points <= high), axis=1)]


def test_window_has_finer_curves_and_none_beyond_its_margin() -> None:
    window = window_on_an_arc(0.02)
    whole, zoomed = (find_stable_manifolds(CASES["I"], 0.19, images=2, window=part) for part in (None, window))
    assert len(points_inside(zoomed, window)) > 2 * len(points_inside(whole, window)) > 0
    enlarged = Window(window.x_low - 0.0041, window.x_high + 0.0041, window.ordinate_low - 0.0041, window.ordinate_high + 0.0041)
    assert len(points_inside(zoomed, enlarged)) == sum(arc.x.size for arc in zoomed.arcs)


def test_curves_in_a_window_lie_on_the_curves_of_the_whole_plane() -> None:
    window = window_on_an_arc(0.02)
    whole, zoomed = (find_stable_manifolds(CASES["I"], 0.19, images=1, window=part) for part in (None, window))
    lines = shapely.MultiLineString([np.column_stack([arc.x, arc.px]) for arc in whole.arcs])
    distance = shapely.distance(lines, shapely.points(points_inside(zoomed, window)))
    assert distance.size > 0
    assert distance.max() < 1e-3


def test_curves_separate_the_basins_in_a_deep_zoom() -> None:
    half = 1e-6
    window = window_on_an_arc(half)
    zoomed = find_stable_manifolds(CASES["I"], 0.19, images=1, window=window)
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (40, 40), window, t_max=500.0))
    direct = (frame.fate == 1) & (frame.crossings == 0)
    assert 0.2 < direct.mean() < 0.8
    line = shapely.MultiLineString([np.column_stack([one.x, one.px]) for one in zoomed.arcs if one.channel == 1])
    rows, columns = np.nonzero(direct[:, 1:] != direct[:, :-1])
    boundary = shapely.points(0.5 * (frame.x[columns] + frame.x[columns + 1]), frame.ordinate[rows])
    assert shapely.distance(line, boundary).max() < 2.0 * half / 40
