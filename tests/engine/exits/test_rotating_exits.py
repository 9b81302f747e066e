"""Exits of rotating systems are lines at the outer edges of their Lyapunov orbits."""

from __future__ import annotations

import numpy as np
import pytest

from engine import POTENTIALS, classify_orbits, find_lyapunov_orbits, parse_formula
from engine.exits.exit_lines import line_points
from engine.exits.exit_rows import exit_curves
from engine.exits.exit_shapes import exit_gates
from engine.exits.exit_tables import LARGEST_ERROR, tabulate_exits
from engine.integrator.kernels.exit_geometry import exit_distance
from engine.systems.outcomes import Centre
from tests.engine.exits.rotating_systems import EARTH_MOON, at_jacobi_constant, hill, integrate, three_body

HILL_ENERGIES = (-2.16, -1.5)
each_energy = pytest.mark.parametrize("energy", HILL_ENERGIES)


@each_energy
def test_the_exit_lies_just_outside_the_orbit_and_ends_on_the_zero_velocity_curve(energy: float) -> None:
    for orbit in find_lyapunov_orbits(hill(), energy):
        distances = [exit_distance(x, y, orbit.curve) for x, y in zip(orbit.x, orbit.y, strict=True)]
        assert -0.03 * np.ptp(distances) < max(distances) < 0.0
        value = hill().value(*orbit.exit_path.T)
        np.testing.assert_allclose(value[[0, -1]], energy, rtol=0, atol=1e-12)
        assert np.all(value[1:-1] < energy)
        low, high = sorted(orbit.exit_path[[0, -1], 1])
        assert low < orbit.y.min() < orbit.y.max() < high


@each_energy
def test_gates_lie_inside_the_lines(energy: float) -> None:
    well = hill().in_well_units
    # The exits come before the disc of the planet.
    rows = exit_curves(well, energy / hill().units.energy)[: well.channels]
    for row, (a, b, c) in zip(rows, exit_gates(rows), strict=True):
        x, y = line_points(row).T
        assert 0.0 < (a * x + b * y - c).min() < 0.01


def test_interpolated_lines_are_the_lines() -> None:
    potential, highest = hill(), -1.5
    length, unit = potential.units.length, potential.units.energy
    tables = tabulate_exits(potential.in_well_units, highest / unit)
    for energy in np.random.default_rng(3).uniform(potential.escape_energy, highest, 4).tolist():
        for orbit in find_lyapunov_orbits(potential, energy):
            points = length * tables[orbit.channel - 1].points_at(energy / unit, np.linspace(-1.0, 1.0, len(orbit.exit_path)))
            np.testing.assert_allclose(points.T, orbit.exit_path, rtol=0, atol=LARGEST_ERROR * length)
    assert all(table.highest == highest / unit for table in tables)


def test_the_line_beyond_a_neck_that_has_opened_is_refused() -> None:
    # At C = 3.02 the line beyond L2 no longer meets the forbidden region.
    with pytest.raises(
        ValueError, match="the line at the outer edge of the Lyapunov orbit across channel 2 does not end on its wa"
    ):
        find_lyapunov_orbits(three_body(EARTH_MOON), at_jacobi_constant(3.02))


def test_orbits_and_lines_have_the_units_of_the_potential() -> None:
    factor = 0.125
    # x → L x and V → L² V leave times unchanged; the attraction is L³ times as strong.
    scaled = parse_formula(f"-{factor**3!r}/r - x² + ½y²; centre (0, 0) 1e-4").in_rotating_frame(1.0)
    for orbit, usual in zip(find_lyapunov_orbits(scaled, -2.0 * factor**2), find_lyapunov_orbits(hill(), -2.0), strict=True):
        np.testing.assert_allclose(orbit.x, factor * usual.x, atol=1e-12)
        np.testing.assert_allclose(orbit.velocity, factor * usual.velocity, atol=1e-12)
        np.testing.assert_allclose(orbit.exit_path, factor * usual.exit_path, atol=1e-12)
        assert orbit.period == pytest.approx(usual.period, rel=1e-12)


HILL_WITH_CENTRE = hill().with_outcomes([Centre(0.0, 0.0, 0.01)])


def random_starts(energy: float, count: int) -> np.ndarray:
    """Return states around the centre of Hill's problem, with velocities in random directions, of shape (count, 4)."""
    random = np.random.default_rng(5)
    x, y = 0.3 * random.uniform(-1.0, 1.0, (2, count))
    angle = random.uniform(0.0, 2.0 * np.pi, count)
    speed = np.sqrt(2.0 * (energy - hill().value(x, y)))
    return np.column_stack([x, y, speed * np.cos(angle), speed * np.sin(angle)])


def test_escape_times_are_those_of_the_crossing_of_the_line() -> None:
    energy = -1.8
    curves = [orbit.curve for orbit in find_lyapunov_orbits(HILL_WITH_CENTRE, energy)]
    starts = random_starts(energy, 200)
    found = classify_orbits(HILL_WITH_CENTRE, energy, starts, t_max=20.0)
    escaped = np.flatnonzero((found.fate == 1) | (found.fate == 2))[:20]
    assert set(found.fate[escaped]) == {1, 2}
    for k in escaped.tolist():
        time, curve = found.escape_time[k], curves[found.fate[k] - 1]
        path = integrate(None, starts[k], np.array([0.0, time - 1e-6, time + 1e-6]))[1:, :2]
        before, after = (exit_distance(x, y, curve) for x, y in path)
        assert before < 0.0 < after


@pytest.mark.parametrize("energy", [-2.0, -1.8, -1.5])
def test_orbits_that_have_crossed_the_line_do_not_return_to_the_well(energy: float) -> None:
    orbit = find_lyapunov_orbits(HILL_WITH_CENTRE, energy)[0]
    starts, line = random_starts(energy, 1000), np.abs(orbit.exit_path[:, 0]).max()
    found = classify_orbits(HILL_WITH_CENTRE, energy, starts, t_max=60.0)
    escaped = np.flatnonzero((found.fate == 1) | (found.fate == 2))
    assert escaped.size > 200
    for k in escaped.tolist():
        times = found.escape_time[k] + np.linspace(0.0, 2.5 * orbit.period, 500)
        distance = np.abs(integrate(None, starts[k], np.concatenate([[0.0], times]))[1:, 0])
        far = int(np.argmax(distance > line + 0.3))
        assert far
        assert distance[:far].min() > 0.8 * np.abs(orbit.x).min()


# Systems and energies as in the table of docs/exits.md.
@pytest.mark.parametrize(
    ("name", "highest"),
    [
        ("Hill", -0.944),
        pytest.param("Earth-Moon", -1.041, marks=pytest.mark.slow),
        pytest.param("Star cluster", -0.837, marks=pytest.mark.slow),
        pytest.param("Barred galaxy", -3009.0, marks=pytest.mark.slow),
        pytest.param("Logarithmic bar", -0.308, marks=pytest.mark.slow),
    ],
)
def test_exits_end_at_the_energies_in_the_document(name: str, highest: float) -> None:
    step = 1e-3 * abs(highest)
    assert find_lyapunov_orbits(POTENTIALS[name], highest - step)
    with pytest.raises(ValueError, match="does not end on its walls"):
        find_lyapunov_orbits(POTENTIALS[name], highest + step)
