from __future__ import annotations

import numpy as np
import pytest
from scipy import ndimage

from engine import CASES, Fate, MapSpec, Plane, Window, compute_map, default_window, start_states, trace_zero_velocity_curve
from tests.peers.exit_lines import exit_lines

PLANES_OF_ONE_ENERGY = [Plane.X_Y, Plane.X_PX]
each_case = pytest.mark.parametrize("name", CASES)


def box(plane: Plane, energy: float, count: int = 500) -> tuple[np.ndarray, np.ndarray]:
    x, ordinate = np.random.default_rng(3).uniform(-1.2, 1.2, (2, count))
    return x, 0.5 * energy * (1 + ordinate) if plane is Plane.X_H else ordinate


@each_case
@pytest.mark.parametrize("plane", list(Plane))
def test_starts_have_the_right_energy(name: str, plane: Plane) -> None:
    x, ordinate = box(plane, 0.4)
    states = start_states(CASES[name], plane, 0.4, x, ordinate)
    exists = np.isfinite(states).all(axis=1)
    expected = ordinate if plane is Plane.X_H else np.full(x.size, 0.4)
    assert exists.sum() > 50
    np.testing.assert_allclose(CASES[name].energy(states[exists]), expected[exists], atol=1e-14)


@each_case
@pytest.mark.parametrize("plane", list(Plane))
def test_start_is_forbidden_exactly_if_its_kinetic_energy_is_negative(name: str, plane: Plane) -> None:
    x, ordinate = box(plane, 0.4)
    states = start_states(CASES[name], plane, 0.4, x, ordinate)
    energy = ordinate if plane is Plane.X_H else 0.4
    left = energy - CASES[name].value(states[:, 0], states[:, 1]) - 0.5 * states[:, 2] ** 2
    np.testing.assert_array_equal(np.isnan(states[:, 3]), left < 0)


@pytest.mark.parametrize(("plane", "held"), [(Plane.X_Y, [2]), (Plane.X_PX, [1]), (Plane.X_H, [1, 2])])
def test_coordinates_off_the_plane_are_zero(plane: Plane, held: list[int]) -> None:
    states = start_states(CASES["II"], plane, 0.3, *box(plane, 0.3))
    assert not states[:, held].any()


@each_case
@pytest.mark.parametrize("plane", list(Plane))
def test_py_of_starts_is_not_negative(name: str, plane: Plane) -> None:
    py = start_states(CASES[name], plane, 0.3, *box(plane, 0.3))[:, 3]
    assert np.all(py[np.isfinite(py)] >= 0)


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
