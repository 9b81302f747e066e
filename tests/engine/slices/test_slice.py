from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from scipy import ndimage

from engine import (
    CASES,
    Coordinate,
    Direction,
    Fate,
    MapSpec,
    ParameterAxis,
    Plane,
    Potential,
    Slice,
    System,
    Window,
    compute_map,
    default_window,
    start_states,
    trace_zero_velocity_curve,
)
from engine.exits.interior import find_outside_channels
from engine.potentials.well_units import WellUnits
from engine.slices.planes import checked_slice
from tests.fuzz.test_random_wells import random_well
from tests.peers.exit_lines import exit_lines

PLANES_OF_ONE_ENERGY = [Plane.X_Y, Plane.X_PX]
ALONG_EPSILON = Slice(Coordinate.X, ParameterAxis("epsilon", 0.5, 2.0, System("I")))
each_case = pytest.mark.parametrize("name", CASES)


@each_case
@pytest.mark.parametrize("plane", PLANES_OF_ONE_ENERGY)
def test_zero_velocity_curve_has_the_required_energy(name: str, plane: Plane) -> None:
    window = default_window(CASES[name], plane, 0.4)
    lines = trace_zero_velocity_curve(CASES[name], plane, 0.4, window)
    x, ordinate = np.concatenate(lines).T
    energy = CASES[name].value(x, ordinate) if plane is Plane.X_Y else 0.5 * ordinate**2 + CASES[name].value(x, 0 * x)
    # The curve is piecewise linear between the grid lines.
    np.testing.assert_allclose(energy, 0.4, atol=1e-4)


def test_zero_velocity_curve_of_x_h_is_the_potential_on_the_x_axis() -> None:
    (line,) = trace_zero_velocity_curve(CASES["III"], Plane.X_H, 0.0, Window(-1.0, 1.0, 0.05, 0.4))[:1]
    np.testing.assert_allclose(line[:, 1], 0.5 * line[:, 0] ** 2, atol=1e-4)


@pytest.mark.parametrize("count", [4, 5, 100, 225])
def test_pixel_centres_of_a_symmetric_window_are_exactly_symmetric(count: int) -> None:
    x, ordinate = Window(-1.1, 1.1, -0.7, 0.7).pixel_centres(count, count)
    np.testing.assert_array_equal(x, -x[::-1])
    np.testing.assert_array_equal(ordinate, -ordinate[::-1])


def interior_by_path(name: str, plane: Plane, energy: float) -> tuple[np.ndarray, np.ndarray]:
    """Points of the interior on a large grid: those connected to the origin without crossing a Lyapunov orbit."""
    side = np.linspace(-2.2, 2.2, 551)
    x, ordinate = np.meshgrid(side, side)
    y = ordinate if plane is Plane.X_Y else np.zeros_like(x)
    exists = CASES[name].value(x, y) + (0.5 * ordinate**2 if plane is Plane.X_PX else 0.0) <= energy
    beyond = np.any([line.beyond(x, y) > 0 for line in exit_lines(CASES[name], energy)], axis=0)
    labels = ndimage.label(exists & ~beyond)[0]
    inside = labels == labels[275, 275]
    return x[inside], ordinate[inside]


@pytest.mark.parametrize(("name", "energy"), [("I", 0.2), ("I", 0.5), ("II", 0.2), ("II", 0.5), ("III", 0.3), ("III", 1.0)])
@pytest.mark.parametrize("plane", PLANES_OF_ONE_ENERGY)
def test_default_window_encloses_the_interior_closely(name: str, energy: float, plane: Plane) -> None:
    x, ordinate = interior_by_path(name, plane, energy)
    w = default_window(CASES[name], plane, energy)
    assert w.x_low < x.min() < x.max() < w.x_high
    assert w.ordinate_low < ordinate.min() < ordinate.max() < w.ordinate_high
    assert max(np.ptp(x), np.ptp(ordinate)) > 0.9 * (w.x_high - w.x_low)


@each_case
@pytest.mark.parametrize("plane", PLANES_OF_ONE_ENERGY)
@pytest.mark.parametrize("energy", [0.05, 0.4])
def test_default_window_is_a_square(name: str, plane: Plane, energy: float) -> None:
    w = default_window(CASES[name], plane, energy)
    assert w.x_high - w.x_low == pytest.approx(w.ordinate_high - w.ordinate_low, rel=1e-12)


@pytest.mark.parametrize("plane", [*PLANES_OF_ONE_ENERGY, Plane.Y_PY, Slice(Direction("u", x=1.0, py=0.5), Coordinate.Y)])
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
    # It fills the window along one axis and does not touch its edges.
    assert max(np.ptp(rows), np.ptp(columns)) > 50
    assert min(*rows, *columns) > 0
    assert max(*rows, *columns) < 59


def test_default_window_of_x_h_spans_the_energies() -> None:
    w = default_window(CASES["I"], Plane.X_H, (0.13, 0.5))
    assert (w.ordinate_low, w.ordinate_high) == (0.13, 0.5)


SIDE = 601

GEOMETRIES = [
    ("I", 0.126),
    ("I", 0.2),
    ("I", 0.5),
    ("II", 0.17),
    ("II", 0.3),
    ("II", 0.5),
    ("III", 0.26),
    ("III", 0.6),
    ("III", 1.0),
]


@pytest.fixture(scope="module", params=GEOMETRIES, ids=str)
def geometry(request: pytest.FixtureRequest) -> dict[str, np.ndarray]:
    """Outcomes of a map on a wide window, and connectivity to the origin with the Lyapunov orbits as barriers."""
    name, energy = request.param
    side = SIDE
    # The time is so short that every orbit stays at its start.
    spec = MapSpec(CASES[name], Plane.X_Y, energy, (side, side), window=(-2.0, 2.0, -2.0, 2.0), t_max=1e-9)
    result = compute_map(spec)
    x, y = np.meshgrid(result.x, result.ordinate)
    lines = exit_lines(CASES[name], energy)
    beyond = np.array([line.beyond(x, y) for line in lines])
    # Pixels within a pixel diagonal of a curve may be on either side.
    near = np.any([np.abs(b) < 1.5 * 4.0 / side for b in beyond], axis=0)
    allowed = result.fate != Fate.FORBIDDEN
    labels = ndimage.label(allowed & ~np.any([(np.abs(b) < 1.5 * 4.0 / side) & (b != -1.0) for b in beyond], axis=0))[0]
    return {
        "fate": result.fate,
        "outside": result.outside,
        "allowed": allowed,
        "near": near,
        "reached": labels == labels[side // 2, side // 2],
        "beyond": beyond,
    }


def test_interior_is_connected(geometry: dict[str, np.ndarray]) -> None:
    labels, pieces = ndimage.label((geometry["fate"] != Fate.FORBIDDEN) & (geometry["fate"] != Fate.OUTSIDE))
    assert (pieces, labels[labels.shape[0] // 2, labels.shape[1] // 2]) == (1, 1)


def test_points_reached_without_crossing_an_exit_are_not_outside(geometry: dict[str, np.ndarray]) -> None:
    assert not np.any(geometry["reached"] & (geometry["outside"] > 0))


def test_points_beyond_an_exit_are_outside(geometry: dict[str, np.ndarray]) -> None:
    behind = geometry["allowed"] & ~geometry["reached"] & ~geometry["near"]
    assert behind.sum() > 100
    assert np.all(geometry["outside"][behind] > 0)


def test_outside_has_the_channel_number(geometry: dict[str, np.ndarray]) -> None:
    # Each connected region beyond an exit touches only the curve of that exit.
    labels, pieces = ndimage.label(geometry["allowed"] & (geometry["outside"] > 0))
    for piece in range(1, pieces + 1):
        here = labels == piece
        touched = [k + 1 for k, b in enumerate(geometry["beyond"]) if np.any(here & (np.abs(b) < 1.5 * 4.0 / SIDE))]
        assert sorted(np.unique(geometry["outside"][here])) == touched


HELD = st.sampled_from((0.0, 0.25, -0.1))
COLUMNS = {Coordinate.X: 0, Coordinate.Y: 1, Coordinate.PX: 2, Coordinate.PY: 3}


@st.composite
def slices_of_coordinates(draw: st.DrawFn) -> Slice:
    """Two coordinates as axes, values of the others, and the momentum that the energy decides."""
    solved, other = draw(st.permutations((Coordinate.PX, Coordinate.PY)))
    axes = draw(st.permutations((Coordinate.X, Coordinate.Y, other, Coordinate.H)))
    held = [c for c in (Coordinate.X, Coordinate.Y, other) if c not in axes[:2]]
    fixed = tuple((coordinate, draw(HELD)) for coordinate in held)
    return Slice(axes[0], axes[1], solved, draw(st.sampled_from((1, -1))), fixed)


@st.composite
def slices_with_an_angle(draw: st.DrawFn) -> Slice:
    """An angle as axis or held, of which the energy decides the speed."""
    angle = draw(st.sampled_from((Coordinate.THETA, Coordinate.BETA)))
    axes = draw(st.permutations((Coordinate.X, Coordinate.Y, angle, Coordinate.H)))
    fixed = tuple((c, draw(HELD)) for c in (Coordinate.X, Coordinate.Y, angle) if c not in axes[:2])
    return Slice(axes[0], axes[1], Coordinate.SPEED, 1, fixed)


@st.composite
def oblique_slices(draw: st.DrawFn) -> Slice:
    """One or two oblique axes."""
    solved, other = draw(st.permutations((Coordinate.PX, Coordinate.PY)))
    component = st.sampled_from((-1.0, 0.5, 2.0))
    first = Direction("u", **{c.key: draw(component) for c in (Coordinate.X, other)})
    second = draw(st.sampled_from((Coordinate.Y, Coordinate.X, Direction("w", **{"y": draw(component), other.key: 0.25}))))
    return Slice(first, second, solved, draw(st.sampled_from((1, -1))), ((other, draw(HELD)),))


def slices() -> st.SearchStrategy[Slice]:
    """Any slice of one system."""
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


# With pixels at 0, and without.
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
        # No reflection of a start is another start of the slice, but for starts that are their own images.
        exists = np.isfinite(states).all(axis=1)
        others = exists & np.any(states != reflected, axis=1)
        assert not np.any(np.all(states[exists][:, None] == reflected[others], axis=2))


def test_no_slice_is_symmetric_in_a_potential_that_is_not() -> None:
    assert Plane.X_PX.find_mirror_images(CASES["I"], *Window(-1.0, 1.0, -1.0, 1.0).pixel_centres(4, 4)) is None


@pytest.mark.parametrize(
    ("plane", "curve"),
    [
        (Plane.X_Y, "V = h"),
        (Plane.X_PX, "½px² + V(x, 0) = h"),
        (Plane.X_H, "V(x, 0) = h"),
        (Plane.Y_PY, "½py² + V(0, y) = h"),
        (Slice(Coordinate.X, Coordinate.Y, Coordinate.PX, 1, ((Coordinate.PY, 0.5),)), "½(0.5)² + V = h"),
    ],
)
def test_the_limiting_curve_is_named_by_its_equation(plane: Slice, curve: str) -> None:
    assert plane.limiting_curve == curve


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"ordinate": Coordinate.X}, "at most once"),
        ({"ordinate": Coordinate.PY, "solved": Coordinate.PY}, "at most once"),
        ({"fixed": ((Coordinate.X, 0.1),)}, "at most once"),
        ({"fixed": ((Coordinate.H, 0.1),)}, "at most once"),
        ({"ordinate": Coordinate.PX, "fixed": ((Coordinate.PY, 0.1),), "solved": Coordinate.PX}, "at most once"),
        ({"abscissa": Coordinate.PX, "ordinate": Coordinate.PY}, "at most once"),
        ({"ordinate": Coordinate.THETA, "solved": Coordinate.PX}, "must not be set by an axis or an angle"),
        ({"ordinate": Coordinate.THETA, "fixed": ((Coordinate.PX, 0.1),)}, "px, py and another angle must be left out"),
        ({"ordinate": Coordinate.THETA, "fixed": ((Coordinate.BETA, 0.1),)}, "px, py and another angle must be left out"),
        ({"ordinate": Direction("u", py=1.0), "solved": Coordinate.PY}, "must not be set by an axis or an angle"),
        ({"ordinate": Direction("u", x=2.0)}, "must not be parallel"),
        ({"ordinate": Coordinate.THETA, "sign": -1}, "must be 1"),
        ({"solved": Coordinate.Y}, "must be px, py or v"),
        ({"sign": 2}, "must be 1 or -1"),
        ({"fixed": ((Coordinate.PX, np.inf),)}, "must be a finite number"),
    ],
)
def test_a_slice_that_is_none_is_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Slice(**{"abscissa": Coordinate.X, "ordinate": Coordinate.Y} | change)


@given(slices())
def test_the_text_of_a_slice_makes_it_again(plane: Slice) -> None:
    assert eval(repr(plane), {"Slice": Slice, "Coordinate": Coordinate, "Direction": Direction}) == plane


@given(slices())
def test_a_slice_in_units_of_a_well_holds_the_same_starts(plane: Slice) -> None:
    potential, units = CASES["III"], WellUnits(length=4.0, time=0.5)
    scaled = Potential("scaled", tuple((i, j, c * units.energy / units.length ** (i + j)) for i, j, c in potential.terms))
    x_unit, ordinate_unit = (axis.unit(units) for axis in plane.axes)
    x, ordinate = np.random.default_rng(5).uniform(-0.6, 0.6, (2, 50)) * [[x_unit], [ordinate_unit]]
    given = plane.states(scaled, 0.4 * units.energy, x, ordinate)
    expected = plane.in_well_units(units).states(potential, 0.4, x / x_unit, ordinate / ordinate_unit)
    np.testing.assert_allclose(given / units.state, expected, rtol=1e-12, atol=1e-12)


def test_the_usual_momentum_is_decided_unless_another_one_is_named() -> None:
    assert Slice(Coordinate.Y, Coordinate.PY) == Slice(Coordinate.Y, Coordinate.PY, Coordinate.PX)
    assert Slice(Coordinate.X, Coordinate.THETA).decided is Coordinate.SPEED
    assert Slice(Coordinate.X, Direction("u", py=1.0)).decided is Coordinate.PX


@pytest.mark.parametrize(
    ("plane", "title"),
    [
        (Slice(Coordinate.X, Coordinate.THETA, fixed=((Coordinate.Y, 0.25),)), "(x, θ), y = 0.25"),
        (Slice(Coordinate.X, Coordinate.Y, Coordinate.PX), "(x, y), px > 0"),
        (Slice(Coordinate.Y, Coordinate.PY, sign=-1), "(y, py), px < 0"),
        (ALONG_EPSILON, "(x, ε)"),
    ],
)
def test_titles_name_what_is_not_usual(plane: Slice, title: str) -> None:
    assert plane.title == title


def test_starts_along_a_parameter_have_the_energy_in_the_potential_of_their_value() -> None:
    x, epsilon = np.array([0.1, 0.1, 0.3]), np.array([0.6, 1.7, 1.7])
    states = ALONG_EPSILON.states(CASES["I"], 0.2, x, epsilon)
    for state, value in zip(states, epsilon, strict=True):
        assert CASES["I"].with_parameters(epsilon=value).energy(state) == pytest.approx(0.2, abs=1e-15)


def test_a_start_at_a_value_that_the_parameter_cannot_have_is_forbidden() -> None:
    states = ALONG_EPSILON.states(CASES["I"], 0.2, np.zeros(2), np.array([-1.0, 1.0]))
    assert np.isnan(states).any(axis=1).tolist() == [True, False]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ParameterAxis("mass", 0.5, 2.0, System("I")), "must be one of the system, omega_1, omega_2, epsilon"),
        (lambda: ParameterAxis("epsilon", 2.0, 0.5, System("I")), "the lower end must be below the upper end"),
        (lambda: ParameterAxis("a", 1.0, 2e9, System("typed", "a x² + y²")), r"at most 1e\+09 in magnitude"),
        (lambda: ParameterAxis("epsilon", -1.0, 0.5, System("I")), "must be between 0.01 and 100"),
        (lambda: Direction("x", x=1.0), "must be an identifier and none of a coordinate"),
        (lambda: Direction("u"), "must not be 0"),
        (lambda: Slice(ALONG_EPSILON.ordinate, ALONG_EPSILON.ordinate), "must be different ones"),
    ],
)
def test_an_axis_that_is_none_is_refused(make: Callable[[], object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()


def test_a_slice_equal_to_a_named_one_is_that_one() -> None:
    assert checked_slice(Slice(Coordinate.X, Coordinate.PX, fixed=((Coordinate.Y, 0.0),))) is Plane.X_PX


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
