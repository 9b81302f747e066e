"""Lyapunov orbits of wells at rest lie on their exit curves, and are the same from both ends."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import LyapunovOrbit, Potential, find_lyapunov_orbits
from engine.exits.exit_rows import exit_curves
from engine.exits.exit_shapes import exit_gates
from engine.integrator.kernels.exit_geometry import exit_distance
from engine.systems.known_potentials import POTENTIALS
from tests.peers.dop853 import equations

# The zero-velocity curve bends away from the line across the saddle, so the search starts on this line beyond the curve.
BENT_WALL = Potential(
    "",
    (
        *((2, 0, 0.6868), (0, 2, 0.5375), (3, 1, -0.148), (4, 2, -0.5459)),
        *((0, 4, 0.424), (5, 2, -0.2063), (0, 5, -0.8177)),
    ),
)
# The search from the saddle ends at a jump between orbits that move inward and outward.
JUMP = Potential("", ((2, 0, 0.8228), (0, 2, 0.4038), (2, 5, 0.241), (3, 0, -0.1322)))
# Near its end the orbit passes a place where V is almost flat.
SLOW_END = Potential(
    "",
    (
        *((2, 0, 0.8722), (0, 2, 0.5414), (3, 2, 0.9988), (1, 5, -0.105), (0, 6, -0.0993), (3, 1, -0.0012)),
        *((4, 1, 0.6634), (4, 2, -0.0001)),
    ),
)
# The channel is so flat across that errors grow by a factor of 1e10 in half a period.
FLAT = Potential("", ((2, 0, 0.3665), (0, 2, 1.118), (1, 1, -0.1327), (2, 4, -0.1639), (0, 7, -0.1339), (1, 5, 0.0783)))
# At one end the zero-velocity curve bends away from the line across the saddle.
BENT_FIRST_WALL = Potential(
    "", ((2, 0, 0.6224), (0, 2, 0.9494), (1, 1, 0.4554), (4, 1, -0.3154), (2, 1, -0.1768), (0, 5, -0.5513))
)

each_well = pytest.mark.parametrize(
    ("potential", "factor"), [(BENT_WALL, 2.0), (JUMP, 2.0), pytest.param(SLOW_END, 1.25, marks=pytest.mark.slow)]
)


def orbits_of(potential: Potential, factor: float) -> tuple[LyapunovOrbit, ...]:
    return find_lyapunov_orbits(potential, factor * potential.escape_energy)


@each_well
def test_every_point_of_the_orbit_lies_on_its_exit_curve_and_beyond_its_gate(potential: Potential, factor: float) -> None:
    gates = exit_gates(exit_curves(potential, factor * potential.escape_energy)[None])
    for orbit in orbits_of(potential, factor):
        distances = [exit_distance(x, y, orbit.curve) for x, y in zip(orbit.x, orbit.y, strict=True)]
        assert np.abs(distances).max() < 2e-9
        a, b, c = gates[orbit.channel - 1]
        assert np.min(a * orbit.x + b * orbit.y) > c


def test_gates_of_several_energies_lie_inside_all_exits() -> None:
    # At the higher energy the exit has other axes.
    energies = [1.02 * BENT_WALL.escape_energy, 2.0 * BENT_WALL.escape_energy]
    a, b, c = exit_gates(np.array([exit_curves(BENT_WALL, energy) for energy in energies]))[0]
    for energy in energies:
        (orbit,) = find_lyapunov_orbits(BENT_WALL, energy)
        assert np.min(a * orbit.x + b * orbit.y) > c


def half_of(potential: Potential, orbit: LyapunovOrbit, end: int) -> np.ndarray:
    """Return DOP853's path from an end, sample 0 or 100, to the middle of the orbit, of shape (51, 2)."""
    start, times = [orbit.x[end], orbit.y[end], 0.0, 0.0], np.linspace(0.0, 0.25 * orbit.period, 51)
    path = solve_ivp(equations(potential), times[[0, -1]], start, "DOP853", rtol=1e-13, atol=1e-15, t_eval=times).y
    return path[:2].T


@pytest.mark.slow
@pytest.mark.parametrize(("potential", "factor"), [(FLAT, 1.02), (BENT_FIRST_WALL, 1.5)])
def test_orbits_shot_from_both_ends_are_the_same_in_the_middle(potential: Potential, factor: float) -> None:
    for orbit in orbits_of(potential, factor):
        np.testing.assert_allclose(half_of(potential, orbit, 0), orbit.half_path[:51], rtol=0, atol=1e-7)
        np.testing.assert_allclose(half_of(potential, orbit, 100), orbit.half_path[:49:-1], rtol=0, atol=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["I", "II", "III", "C5", "C6", "C7", "C8"])
def test_exits_are_found_up_to_ten_times_the_escape_energy(name: str) -> None:
    potential = POTENTIALS[name]
    for factor in (3.0, 6.0, 10.0):
        orbits = orbits_of(potential, factor)
        assert len(orbits) == potential.channels
        start = [orbits[0].x[0], orbits[0].y[0], 0.0, 0.0]
        end = solve_ivp(equations(potential), (0.0, 0.5 * orbits[0].period), start, "DOP853", rtol=1e-13, atol=1e-15).y[:, -1]
        np.testing.assert_allclose(end, [orbits[0].x[100], orbits[0].y[100], 0.0, 0.0], rtol=0, atol=1e-9)
