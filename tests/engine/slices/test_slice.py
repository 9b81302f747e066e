"""Starts, limits, mirror images and windows of arbitrary slices follow from their definitions."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy import ndimage

from engine import (
    CASES,
    Coordinate,
    Direction,
    MapSpec,
    Plane,
    Potential,
    Slice,
    Window,
    compute_map,
    parse_formula,
    start_states,
)
from engine.exits.interior import find_outside_channels
from engine.slices.default_window import default_window
from engine.slices.limiting_curves import trace_zero_velocity_curve
from engine.slices.planes import checked_slice
from tests.peers.exit_lines import exit_lines
from tests.peers.random_systems import random_well

PLANES_OF_ONE_ENERGY = [Plane.X_Y, Plane.X_PX]


@pytest.mark.parametrize("plane", PLANES_OF_ONE_ENERGY)
def test_zero_velocity_curve_has_the_required_energy(plane: Plane) -> None:
    name = "II"
    window = default_window(CASES[name], plane, 0.4)
    lines = trace_zero_velocity_curve(CASES[name], plane, 0.4, window)
    x, ordinate = np.concatenate(lines).T
    energy = CASES[name].value(x, ordinate) if plane is Plane.X_Y else 0.5 * ordinate**2 + CASES[name].value(x, 0 * x)
    # The curve is piecewise linear between the grid lines.
    np.testing.assert_allclose(energy, 0.4, atol=1e-4)


def interior_by_path(name: str, plane: Plane, energy: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the points of a large grid that are connected with the origin without crossing a Lyapunov orbit."""
    side = np.linspace(-2.2, 2.2, 551)
    x, ordinate = np.meshgrid(side, side)
    y = ordinate if plane is Plane.X_Y else np.zeros_like(x)
    exists = CASES[name].value(x, y) + (0.5 * ordinate**2 if plane is Plane.X_PX else 0.0) <= energy
    beyond = np.any([line.beyond(x, y) > 0 for line in exit_lines(CASES[name], energy)], axis=0)
    labels = ndimage.label(exists & ~beyond)[0]
    inside = labels == labels[275, 275]
    return x[inside], ordinate[inside]


@pytest.mark.parametrize(("name", "energy"), [("II", 0.2), ("III", 1.0)])
@pytest.mark.parametrize("plane", PLANES_OF_ONE_ENERGY)
def test_default_window_encloses_the_interior_closely(name: str, energy: float, plane: Plane) -> None:
    x, ordinate = interior_by_path(name, plane, energy)
    w = default_window(CASES[name], plane, energy)
    assert w.x_low < x.min() < x.max() < w.x_high
    assert w.ordinate_low < ordinate.min() < ordinate.max() < w.ordinate_high
    assert max(np.ptp(x), np.ptp(ordinate)) > 0.9 * (w.x_high - w.x_low)


@pytest.mark.parametrize("plane", [Plane.X_PX, Slice(Direction("u", x=1.0, py=0.5), Coordinate.Y)])
def test_default_window_shows_an_interior_far_smaller_than_the_distance_of_an_exit(plane: Slice) -> None:
    # One exit saddle is 260 times as far from the origin as the nearest one.
    potential = random_well(150, 10)
    energy = 1.2 * potential.escape_energy
    window = default_window(potential, plane, energy)
    x, ordinate = window.pixel_centres(60, 60)
    states = start_states(potential, plane, energy, *(axis.ravel() for axis in np.meshgrid(x, ordinate)))
    exists = np.flatnonzero(np.isfinite(states).all(axis=1))
    inside = exists[find_outside_channels(potential, energy, *states[exists, :2].T) == 0]
    rows, columns = np.divmod(inside, 60)
    # The interior fills the window along one axis and does not touch the edges of the window.
    assert max(np.ptp(rows), np.ptp(columns)) > 50
    assert min(*rows, *columns) > 0
    assert max(*rows, *columns) < 59


HELD = st.sampled_from((0.0, 0.25, -0.1))
COLUMNS = {Coordinate.X: 0, Coordinate.Y: 1, Coordinate.PX: 2, Coordinate.PY: 3}


@st.composite
def slices_of_coordinates(draw: st.DrawFn) -> Slice:
    """Draw a slice with two coordinates as axes, values of the others, and the momentum that the energy determines."""
    solved, other = draw(st.permutations((Coordinate.PX, Coordinate.PY)))
    axes = draw(st.permutations((Coordinate.X, Coordinate.Y, other, Coordinate.H)))
    held = [c for c in (Coordinate.X, Coordinate.Y, other) if c not in axes[:2]]
    fixed = tuple((coordinate, draw(HELD)) for coordinate in held)
    return Slice(axes[0], axes[1], solved, draw(st.sampled_from((1, -1))), fixed)


@st.composite
def slices_with_an_angle(draw: st.DrawFn) -> Slice:
    """Draw a slice on which an angle is an axis or has a value, and the energy determines the speed."""
    angle = draw(st.sampled_from((Coordinate.THETA, Coordinate.BETA)))
    axes = draw(st.permutations((Coordinate.X, Coordinate.Y, angle, Coordinate.H)))
    fixed = tuple((c, draw(HELD)) for c in (Coordinate.X, Coordinate.Y, angle) if c not in axes[:2])
    return Slice(axes[0], axes[1], Coordinate.SPEED, 1, fixed)


@st.composite
def oblique_slices(draw: st.DrawFn) -> Slice:
    """Draw a slice with one or two oblique axes."""
    solved, other = draw(st.permutations((Coordinate.PX, Coordinate.PY)))
    component = st.sampled_from((-1.0, 0.5, 2.0))
    first = Direction("u", **{c.key: draw(component) for c in (Coordinate.X, other)})
    second = draw(st.sampled_from((Coordinate.Y, Coordinate.X, Direction("w", **{"y": draw(component), other.key: 0.25}))))
    return Slice(first, second, solved, draw(st.sampled_from((1, -1))), ((other, draw(HELD)),))


def slices() -> st.SearchStrategy[Slice]:
    """Return any slice of one system."""
    return st.one_of(slices_of_coordinates(), slices_with_an_angle(), oblique_slices())


def states_and_energies(plane: Slice, potential: Potential) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    x, ordinate = np.random.default_rng(5).uniform(-0.6, 0.6, (2, 200))
    states = plane.states(potential, 0.4, x, ordinate)
    return states, np.broadcast_to(plane.energies(0.4, x, ordinate), x.shape), x, ordinate


@given(slices(), st.sampled_from(["I", "II", "III"]))
def test_starts_of_any_slice_have_its_energy(plane: Slice, name: str) -> None:
    states, energy, _, _ = states_and_energies(plane, CASES[name])
    exists = np.isfinite(states).all(axis=1)
    assert exists.any()
    np.testing.assert_allclose(CASES[name].energy(states[exists]), energy[exists], atol=1e-14)


@given(slices_of_coordinates())
def test_starts_have_the_coordinates_of_the_slice_and_the_sign_of_the_momentum(plane: Slice) -> None:
    states, _, x, ordinate = states_and_energies(plane, CASES["I"])
    exists = np.isfinite(states).all(axis=1)
    for coordinate, values in (dict(plane.fixed) | dict(zip(plane.axes, (x, ordinate), strict=True))).items():
        if coordinate in COLUMNS:
            np.testing.assert_array_equal(states[:, COLUMNS[coordinate]], values)
    assert np.all(plane.sign * states[exists, COLUMNS[plane.decided]] >= 0.0)


@given(slices_with_an_angle())
def test_the_velocity_has_the_angle_of_the_slice(plane: Slice) -> None:
    states, _, x, ordinate = states_and_energies(plane, CASES["I"])
    given = dict(plane.fixed) | dict(zip(plane.axes, (x, ordinate), strict=True))
    start_x, start_y, px, py = states.T
    # At the origin β is the angle from the +y axis.
    outward = np.where((start_x == 0.0) & (start_y == 0.0), 0.5 * np.pi, np.arctan2(start_y, start_x))
    expected = given[Coordinate.THETA] if Coordinate.THETA in given else given[Coordinate.BETA] + outward
    exists = np.hypot(px, py) > 1e-6
    turned = (np.arctan2(py, px) - expected)[exists]
    np.testing.assert_allclose(np.sin(turned), 0.0, atol=1e-9)
    assert np.all(np.cos(turned) > 0.0)


@given(oblique_slices())
def test_starts_of_an_oblique_slice_lie_in_the_plane_of_its_directions(plane: Slice) -> None:
    states, _, x, ordinate = states_and_energies(plane, CASES["III"])
    columns = [c for c in COLUMNS if c is not plane.decided]
    held = dict(plane.fixed)
    rows = [
        [{axis: 1.0}.get(c, 0.0) if isinstance(axis, Coordinate) else getattr(axis, c.key) for c in columns]
        for axis in plane.axes
    ]
    expected = [held.get(c, 0.0) for c in columns] + np.column_stack([x, ordinate]) @ np.array(rows)
    np.testing.assert_allclose(states[:, [COLUMNS[c] for c in columns]], expected, atol=1e-15)


@given(slices())
def test_a_start_of_any_slice_is_forbidden_exactly_where_energy_is_missing(plane: Slice) -> None:
    states, _, x, ordinate = states_and_energies(plane, CASES["II"])
    missing = plane.required_energy(CASES["II"], x, ordinate) - (0.4 if plane.energy_axis is None else 0.0)
    clear = np.abs(missing) > 1e-12
    np.testing.assert_array_equal(np.isnan(states).any(axis=1)[clear], missing[clear] > 0.0)


# Maps with and without pixels at 0.
@pytest.mark.parametrize("shape", [(6, 4), (5, 3)])
@example(Slice(Coordinate.X, Coordinate.BETA))
@example(Slice(Coordinate.X, Coordinate.Y, fixed=((Coordinate.BETA, 0.0),)))
@given(slices())
def test_mirror_images_of_any_slice_are_reflected_states(shape: tuple[int, int], plane: Slice) -> None:
    x, ordinate = Window(-0.6, 0.6, -0.3, 0.3).pixel_centres(*shape)
    images = plane.find_mirror_images(CASES["III"], x, ordinate)
    states = plane.states(CASES["III"], 0.4, *(axis.ravel() for axis in np.meshgrid(x, ordinate)))
    reflected = states * [-1.0, 1.0, -1.0, 1.0]
    if images is not None:
        np.testing.assert_array_equal(states[images], reflected)
    else:
        # The reflection of some start is no start of the slice. Starts that are their own images are left out.
        exists = np.isfinite(states).all(axis=1)
        others = exists & np.any(states != reflected, axis=1)
        has_image = np.any(np.all(states[exists][:, None] == reflected[others], axis=2), axis=0)
        assert not others.any() or not has_image.all()


@given(slices())
def test_the_default_window_of_any_slice_contains_its_interior(plane: Slice) -> None:
    potential, energy = CASES["III"], (0.3, 0.45) if plane.energy_axis is not None else 0.45
    whole = {Coordinate.H: (0.3, 0.45), Coordinate.THETA: (-np.pi, np.pi), Coordinate.BETA: (-np.pi, np.pi)}
    edges = [whole.get(axis, (-1.5, 1.5)) for axis in plane.axes]
    # The time is so short that every orbit stays at its start.
    wide = compute_map(MapSpec(potential, plane, energy, (41, 41), (*edges[0], *edges[1]), t_max=1e-9))
    x, ordinate = wide.coordinates(np.flatnonzero(wide.interior))
    window = default_window(potential, plane, energy)
    assert np.all((window.x_low <= x) & (x <= window.x_high))
    assert np.all((window.ordinate_low <= ordinate) & (ordinate <= window.ordinate_high))


@pytest.mark.parametrize("plane", Plane)
def test_a_named_slice_is_found_by_its_title_and_its_key(plane: Plane) -> None:
    assert checked_slice(plane.title) is checked_slice(plane.key) is plane


@pytest.mark.parametrize(("plane", "row"), [(Plane.X_Y, slice(None)), (Plane.X_PX, 400)])
def test_the_default_window_contains_parts_of_the_interior_behind_a_wall(plane: Plane, row: slice | int) -> None:
    # The well follows the curve y = sin 2x, which crosses y = 0 at x = 0 and x = ±π/2, with V > h between.
    potential, energy = parse_formula("½(y − sin(2x))² + 0.05x²"), 0.2
    side = np.linspace(-3.0, 3.0, 801)
    is_allowed = potential.value(side, side[:, None])[row] <= energy
    window = default_window(potential, plane, energy)
    assert not is_allowed[..., (side < window.x_low) | (side > window.x_high)].any()
