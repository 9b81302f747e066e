"""Arcs of stable manifolds separate escaping orbits from orbits that turn back."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import shapely

from engine import CASES, MapSpec, Plane, Potential, Section, Window, classify_orbits, compute_map, read_section, start_states
from engine.exits.lyapunov_orbits import find_orbits_in_well_units
from engine.propagation.limited_steps import find_section_points
from engine.slices.sections.section import Crossing
from engine.trajectories.stable_manifolds import StableManifolds, find_stable_manifolds
from engine.trajectories.unstable_manifold import UnstableManifold

# The Hénon-Heiles potential (case II) in its original orientation. It is not even in y, so orbits can touch y = 0.
TURNED = Potential("turned", ((2, 0, 0.5), (0, 2, 0.5), (2, 1, 1.0), (0, 3, -1 / 3)))
NEVER = 1e9
# Distance to either side of an arc. Successive turns of an arc that winds around another are less than 1e-8 apart.
STEP = 1e-10
SYSTEMS = [("I", 0.15), ("II", 0.2), ("III", 0.45)]
each = pytest.mark.parametrize(("name", "energy"), SYSTEMS)


@cache
def manifolds(potential: Potential, energy: float, images: int = 2, section: Section = Section.Y_UP) -> StableManifolds:
    return find_stable_manifolds(potential, energy, images=images, section=section)


def points_with_normals(found: StableManifolds, channel: int, image: int) -> np.ndarray:
    """Return x and px of the points of arcs, without their ends, and the unit normals at these points, of shape (n, 4)."""
    rows = [np.empty((0, 4))]
    for arc in found.arcs:
        if (arc.channel, arc.image) == (channel, image):
            point = np.column_stack([arc.x, arc.ordinate])
            step = np.diff(point, axis=0)
            length = np.hypot(*step.T)[:, None]
            tangent = step[:-1] / length[:-1] * length[1:] + step[1:] / length[1:] * length[:-1]
            tangent /= np.maximum(np.hypot(*tangent.T), np.finfo(float).tiny)[:, None]
            rows.append(np.column_stack([point[1:-1], -tangent[:, 1], tangent[:, 0]]))
    return np.concatenate(rows)


def separating_share(
    potential: Potential, energy: float, channel: int, image: int, section: Section = Section.Y_UP, most: int = 60
) -> float:
    """Return the share of points of an image that separate: orbits `STEP` to one side escape, to the other side turn back."""
    points = points_with_normals(manifolds(potential, energy, section=section), channel, image)
    points = points[:: math.ceil(len(points) / most)]
    sides = []
    pairs = [start_states(potential, section.plane, energy, *(points[:, :2] + s * points[:, 2:]).T) for s in (STEP, -STEP)]
    exist = np.isfinite(pairs).all(axis=(0, 2))
    for starts in pairs:
        outcomes = classify_orbits(potential, energy, starts[exist], 200.0, section=section)
        leaves = (outcomes.fate == channel) & (outcomes.crossings == image - 1)
        sides.append(np.where(leaves, outcomes.escape_time, NEVER))
    one, other = sides
    # An orbit that turns back may return to the same exit later without crossing y = 0 upward.
    return float(np.mean((np.minimum(one, other) < NEVER) & (np.abs(one - other) > 1.0)))


def crosses_axis(name: str, channel: int) -> bool:
    """Return whether the channel's Lyapunov orbit crosses y = 0."""
    return name == "II" and channel == 1


# Separation of basins.


@each
@pytest.mark.parametrize("image", [1, 2])
def test_arcs_separate_escapes_after_n_crossings_from_orbits_that_turn_back(name: str, energy: float, image: int) -> None:
    for channel in range(1, CASES[name].channels + 1):
        if not crosses_axis(name, channel):
            assert separating_share(CASES[name], energy, channel, image) >= 0.99


@pytest.mark.parametrize(
    ("name", "energy", "channel", "text"),
    [
        ("III", 0.45, 1, "y = 0.1"),
        ("II", 0.2, 1, "x = 0, px < 0"),
        ("I", 0.15, 2, "x - 2 y = 0.1"),
        ("III", 0.45, 2, "angle = 160°"),
        ("II", 0.2, 3, "angle = 290° about (0.1, 0) down"),
    ],
)
@pytest.mark.parametrize("image", [1, 2])
def test_arcs_on_other_sections_separate_escapes(name: str, energy: float, channel: int, text: str, image: int) -> None:
    assert separating_share(CASES[name], energy, channel, image, read_section(text)) >= 0.99


def test_arcs_do_not_depend_on_the_way_in_which_a_section_is_written() -> None:
    turned = find_stable_manifolds(TURNED, 0.2, images=1, section="-2 y = 0 down")
    for arc, other in zip(turned.arcs, find_stable_manifolds(TURNED, 0.2, images=1).arcs, strict=True):
        np.testing.assert_allclose([arc.x, arc.ordinate], [other.x, other.ordinate], atol=1e-9)


def lines_of(found: StableManifolds, channel: int, image: int) -> shapely.MultiLineString:
    """Return the arcs of an image as lines."""
    arcs = [arc for arc in found.arcs if (arc.channel, arc.image) == (channel, image)]
    return shapely.MultiLineString([np.column_stack([arc.x, arc.ordinate]) for arc in arcs])


@pytest.mark.parametrize("image", [1, 2])
def test_images_of_an_orbit_that_crosses_the_section_end_alike_in_both_directions(image: int) -> None:
    # The mirror image of case II under y → −y maps upward crossings to downward ones, and keeps channel 1.
    up, down = (lines_of(manifolds(CASES["II"], 0.2, section=read_section(text)), 1, image) for text in ("y = 0", "y = 0 down"))
    assert down.length == pytest.approx(up.length, rel=1e-3)
    assert shapely.hausdorff_distance(up, down) < 1e-2


@pytest.mark.parametrize("text", ["px = 0", "pericentre", "y = 0 both"])
def test_sections_that_every_tube_crosses_at_the_exit_are_refused(text: str) -> None:
    with pytest.raises(ValueError, match="must be a section of positions that is crossed in one direction"):
        find_stable_manifolds(CASES["I"], 0.15, section=text)


def test_arcs_of_a_channel_on_the_axis_separate_earlier_from_later_escapes() -> None:
    image = 2
    points = points_with_normals(manifolds(CASES["II"], 0.2), 1, image)
    times = []
    for step in (STEP, -STEP):
        starts = start_states(CASES["II"], Plane.X_PX, 0.2, *(points[:, :2] + step * points[:, 2:]).T)
        outcomes = classify_orbits(CASES["II"], 0.2, starts, 200.0)
        times.append(np.where(outcomes.fate == 1, outcomes.escape_time, NEVER))
    assert np.all(np.minimum(*times) < NEVER)
    assert np.all(np.abs(times[0] - times[1]) > 1.0)


def test_arcs_separate_basins_without_symmetry_in_y() -> None:
    assert separating_share(TURNED, 0.2, 2, 1) >= 0.99


@pytest.mark.parametrize(("name", "energy", "channel"), [("II", 0.2, 3), ("III", 0.45, 1)])
def test_all_basin_boundaries_lie_on_arcs(name: str, energy: float, channel: int) -> None:
    spec = MapSpec(CASES[name], Plane.X_PX, energy, resolution=(101, 101), t_max=100.0)
    found = compute_map(spec)
    column = found.x[1] - found.x[0]
    for image in (1, 2):
        basin = (found.fate == channel) & (found.crossings == image - 1)
        row, left = np.nonzero((basin[:, 1:] != basin[:, :-1]) & (found.fate >= 0)[:, 1:] & (found.fate >= 0)[:, :-1])
        arcs = [a for a in manifolds(CASES[name], energy).arcs if (a.channel, a.image) == (channel, image)]
        lines = shapely.MultiLineString([np.column_stack([a.x, a.ordinate]) for a in arcs])
        distance = shapely.distance(lines, shapely.points(0.5 * (found.x[left] + found.x[left + 1]), found.ordinate[row]))
        assert np.mean(distance < 0.55 * column) > 0.97
        assert distance.max() < 1.5 * column


# Points of the arcs.


@pytest.mark.parametrize(("name", "energy", "channel"), [("II", 0.2, 2), ("III", 0.45, 3)])
def test_points_of_an_image_are_mapped_to_the_previous_image(name: str, energy: float, channel: int) -> None:
    found = manifolds(CASES[name], energy)
    second = points_with_normals(found, channel, 2)[:, :2]
    second = second[:: math.ceil(len(second) / 200)]
    next_points = find_section_points(CASES[name], start_states(CASES[name], Plane.X_PX, energy, *second.T), 1, 30.0)[:, 0]
    first = shapely.MultiLineString(
        [np.column_stack([a.x, a.ordinate]) for a in found.arcs if (a.channel, a.image) == (channel, 1)]
    )
    assert np.mean(shapely.distance(first, shapely.points(next_points)) < 1e-3) > 0.98


def test_mirrored_channels_have_mirrored_arcs() -> None:
    by_channel = {c: [a for a in manifolds(CASES["III"], 0.45).arcs if a.channel == c] for c in (1, 2, 3, 4)}
    for one, other in ((1, 2), (4, 3)):
        assert len(by_channel[one]) == len(by_channel[other])
        for arc, image in zip(by_channel[one], by_channel[other], strict=True):
            np.testing.assert_array_equal([arc.x, arc.ordinate], [-image.x, -image.ordinate])


def test_first_images_are_closed_curves_and_not_truncated() -> None:
    found = find_stable_manifolds(CASES["I"], 0.15, images=1)
    assert not found.truncated
    for arc in found.arcs:
        assert (arc.x[0], arc.ordinate[0]) == (arc.x[-1], arc.ordinate[-1])


# The unstable manifold.


def test_an_orbit_of_the_unstable_manifold_has_no_passages_after_its_escape() -> None:
    # Channel 1 lies on y = 0, and orbits oscillate about y = 0 as they leave.
    downward = replace(Section.Y_UP, direction=Crossing.DOWN).numbers
    tube = UnstableManifold.from_orbit(find_orbits_in_well_units(CASES["II"], 0.2)[0], downward)
    phases = np.linspace(0.0, 1.0, 200)
    displacements = tube.displacements(phases)
    growth_time = tube.orbit.period / math.log(tube.max_displacement / tube.min_displacement)
    times = tube.find_passages(phases, 12)[:, :, 4] - growth_time * np.log(displacements)[:, None]
    outcomes = classify_orbits(tube.potential, tube.orbit.energy, tube.start_states(displacements), 1e3)
    escapes = outcomes.fate >= 1
    assert np.count_nonzero(escapes & np.isnan(times[:, -1])) > 100
    assert not np.any(times[escapes] > outcomes.escape_time[escapes, None])


def test_there_are_no_arcs_at_the_escape_energy() -> None:
    found = find_stable_manifolds(CASES["II"], CASES["II"].escape_energy)
    assert (found.arcs, found.truncated, found.nbytes) == ((), False, 0)


# Zooms.


def window_on_an_arc(half: float) -> Window:
    """Return a square of side 2 `half` around a point of an arc of I at h = 0.19."""
    arc = next(arc for arc in find_stable_manifolds(CASES["I"], 0.19, images=1).arcs if arc.channel == 1)
    x, px = float(arc.x[arc.x.size // 3]), float(arc.ordinate[arc.x.size // 3])
    return Window(x - half, x + half, px - half, px + half)


def test_curves_separate_the_basins_in_a_deep_zoom() -> None:
    half = 1e-6
    window = window_on_an_arc(half)
    zoomed = find_stable_manifolds(CASES["I"], 0.19, images=1, window=window)
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (40, 40), window, t_max=500.0))
    direct = (frame.fate == 1) & (frame.crossings == 0)
    assert 0.2 < direct.mean() < 0.8
    line = shapely.MultiLineString([np.column_stack([one.x, one.ordinate]) for one in zoomed.arcs if one.channel == 1])
    rows, columns = np.nonzero(direct[:, 1:] != direct[:, :-1])
    boundary = shapely.points(0.5 * (frame.x[columns] + frame.x[columns + 1]), frame.ordinate[rows])
    assert shapely.distance(line, boundary).max() < 2.0 * half / 40
