"""The interior is the region connected with the origin without crossing an exit."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import ndimage

from engine import CASES, POTENTIALS, Fate, Potential, Window, classify_orbits, find_lyapunov_orbits
from engine.exits.interior import find_outside_channels
from engine.exits.lyapunov_orbits import find_known_exits

# Beyond the exit the outer region turns back and passes behind the line on which the exit lies.
CURLED = Potential("", ((2, 0, 0.6389), (0, 2, 0.2833), (3, 0, 0.72), (2, 1, -0.077), (1, 2, 0.3877), (0, 3, -0.1425)))
CURLED_QUINTIC = Potential(
    "",
    (
        *((2, 0, 1.0711), (0, 2, 0.249), (1, 1, -0.2849), (3, 0, 0.1143), (0, 3, 0.3622), (0, 5, -0.2048)),
        *((5, 1, 0.3346), (4, 2, 0.0506), (3, 3, 0.303), (2, 4, -0.2891)),
    ),
)


def flood_filled(potential: Potential, energy: float, window: Window, side: int) -> tuple[np.ndarray, ...]:
    """Return x, y, where V ≤ h, and what is connected with the origin, of shape (side, side). The exits are walls of the grid."""
    x, y = np.meshgrid(*window.pixel_centres(side, side))
    allowed = potential.value(x, y) <= energy
    barrier = np.zeros_like(allowed)
    for orbit in find_lyapunov_orbits(potential, energy):
        along, dense = np.arange(101), np.linspace(0.0, 100.0, 20 * side)
        path = [np.interp(dense, along, axis) for axis in orbit.half_path.T]
        columns, rows = (np.clip(((axis - x[0, 0]) / (x[0, 1] - x[0, 0])).round().astype(int), 0, side - 1) for axis in path)
        barrier[rows, columns] = True
    barrier = ndimage.binary_dilation(barrier, np.ones((3, 3)))
    labels = ndimage.label(allowed & ~barrier)[0]
    return x, y, allowed & ~barrier, labels == labels[np.unravel_index(np.argmin(np.hypot(x, y)), x.shape)]


def test_a_start_in_an_outer_region_behind_an_exit_line_is_outside() -> None:
    x, y, energy = -1.1685, -1.1724, 0.0649
    py = np.sqrt(2.0 * (energy - CURLED.value(x, y)))
    assert classify_orbits(CURLED, energy, [[x, y, 0.0, py]], t_max=10.0).fate[0] == Fate.OUTSIDE


@pytest.mark.parametrize(
    ("potential", "energy"),
    [
        (CURLED, 0.0649),
        pytest.param(CURLED_QUINTIC, 0.435296, marks=pytest.mark.slow),
        (CASES["II"], 0.17),
        (CASES["III"], 1.0),
        # V on the exits is below V at the origin.
        (POTENTIALS["C8"], 3.93),
    ],
)
def test_the_interior_is_connected_with_the_origin(potential: Potential, energy: float) -> None:
    x, y, allowed, connected = flood_filled(potential, energy, Window(-2.0, 2.0, -2.0, 2.0), 600)
    outside = find_outside_channels(potential, energy, x[::3, ::3], y[::3, ::3])
    known = allowed[::3, ::3]
    np.testing.assert_array_equal(outside[known] == 0, connected[::3, ::3][known])


@pytest.mark.parametrize("factor", [1.01, 3.0, 10.0, 25.0, 50.0])
@pytest.mark.parametrize("name", ["I", "II", "III", "C5", "C8", "HH"])
def test_an_exit_has_the_interior_on_one_side_at_all_energies(name: str, factor: float) -> None:
    potential = POTENTIALS[name]
    energy = factor * potential.escape_energy
    for orbit in find_known_exits(potential, energy):
        points, tangents = orbit.half_path.T, np.gradient(orbit.half_path.T, axis=1)
        across = np.array([-tangents[1], tangents[0]]) / np.hypot(*tangents)
        outward = across * np.sign(orbit.outward @ across)
        # Near its ends, an exit is as narrow as the shifts.
        between = slice(10, -10)
        inside, outside = (points + side * 1e-3 * outward for side in (-1.0, 1.0))
        assert not find_outside_channels(potential, energy, *inside[:, between]).any()
        assert find_outside_channels(potential, energy, *outside[:, between]).all()


@pytest.mark.parametrize("name", ["I", "II", "III"])
def test_a_point_beyond_a_saddle_is_outside_if_the_channel_is_open_and_if_it_is_closed(name: str) -> None:
    potential = CASES[name]
    x, y = (potential.saddles * 1.2).T
    for factor in (0.99, 1.0, 1.2):
        outside = find_outside_channels(potential, factor * potential.escape_energy, x, y)
        np.testing.assert_array_equal(outside, 1 + np.arange(potential.channels))
