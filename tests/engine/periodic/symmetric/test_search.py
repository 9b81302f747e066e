"""Every point of a curve starts a periodic orbit with the stated period and stability, and all symmetric orbits are on curves."""

from __future__ import annotations

import functools
import threading
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from engine import (
    CASES,
    POTENTIALS,
    Coordinate,
    Execution,
    MapSpec,
    Plane,
    Slice,
    find_periodic_orbits,
    find_symmetric_families,
    parse_formula,
    read_section,
)
from engine.results import SymmetricFamilies

III = CASES["III"]
BOTH = read_section("y = 0 both")
Y_H = Slice(Coordinate.Y, Coordinate.H, Coordinate.PX)
SPECS = {
    # The rows contain h = 0.3, and no column is x = 0.
    "III": MapSpec(III, Plane.X_H, (0.01, 0.6), (200, 59), (-1.05, 1.05, 0.005, 0.595), 400.0),
    "HH": MapSpec(POTENTIALS["HH"], Y_H, (0.01, 0.3), (150, 101), (-0.5, 0.9, 0.0495, 0.1505), 400.0, section="x = 0"),
    # Here the returns jump at a third of all changes of sign.
    "Copenhagen": MapSpec(POTENTIALS["Copenhagen"], Plane.X_H, (-1.7, -1.4), (60, 60), (-3.0, -1.0, -1.7, -1.4), 50.0),
    "Hill": MapSpec(POTENTIALS["Hill"], Plane.X_H, (-2.5, -2.0), (40, 12), (-0.6, 0.6, -2.5, -2.2), 50.0),
    # The unit of this well is not 1, and starts go downward.
    "wide": MapSpec(
        parse_formula("½(x² + 1.7y²) − 0.001x²y² − 0.0003x⁴"), Slice(Coordinate.X, Coordinate.H, Coordinate.PY, -1),
        (10.0, 300.0), (60, 40), (-25.0, 25.0, 10.0, 300.0), 400.0,
    ),
    "momentum": MapSpec(III, Plane.X_H, (0.1, 0.5), (60, 40), (-1.05, 1.05, 0.1, 0.5), 400.0, section="px = 0"),
    "mixed": MapSpec(III, Plane.X_H, (0.1, 0.5), (60, 40), (-1.05, 1.05, 0.1, 0.5), 400.0, section="y + 0.5 px = 0"),
    # Orbits from the origin, by their direction.
    "origin": MapSpec(III, Slice(Coordinate.THETA, Coordinate.H), (0.1, 0.5), (60, 40), (0.1, 3.1, 0.1, 0.5), 400.0),
}  # fmt: skip
RETURNS = {"III": 3, "wide": 3, "origin": 4}


@functools.cache
def families(name: str) -> SymmetricFamilies:
    return find_symmetric_families(SPECS[name], RETURNS.get(name, 2))


def random_points(found: SymmetricFamilies, count: int) -> list[int]:
    """Return random points, a number of each number of returns."""
    generator = np.random.default_rng(7)
    groups = [np.flatnonzero(found.returns == n) for n in np.unique(found.returns)]
    return [int(point) for group in groups for point in generator.choice(group, min(count, group.size), replace=False)]


def rows_at(found: SymmetricFamilies, energy: float) -> np.ndarray:
    return np.flatnonzero(np.abs(found.energy - energy) < 1e-9)


@pytest.mark.parametrize("name", SPECS)
def test_points_are_periodic_orbits_of_another_integrator(name: str) -> None:
    found = families(name)
    assert len(found) > 2
    potential = found.spec.potential
    size = potential.units.state

    def velocity(t: float, state: np.ndarray) -> np.ndarray:
        x, y, px, py = state
        slope_x, slope_y = potential.gradient(x, y)
        coriolis = 2.0 * potential.rotation
        return np.array([px, py, coriolis * py - slope_x, -coriolis * px - slope_y])

    for point in random_points(found, 4):
        start = found.states[point]
        path = solve_ivp(velocity, (0.0, found.period[point]), start, "DOP853", rtol=1e-13, atol=1e-13 * size.max())
        # Errors grow with the instability of the orbit.
        growth = 1.0 + abs(found.stability_index[point])
        assert np.abs((path.y[:, -1] - start) / size).max() < 1e-8 * growth
        assert potential.energy(start) == pytest.approx(found.energy[point], abs=1e-12 * potential.units.energy)


@pytest.mark.parametrize("name", SPECS)
def test_points_agree_with_newtons_method(name: str) -> None:
    found = families(name)
    for point in random_points(found, 4):
        orbit = found.orbit(point)
        assert orbit.returns == found.returns[point]
        assert orbit.period == pytest.approx(found.period[point], rel=1e-8)
        assert orbit.stability_index == pytest.approx(found.stability_index[point], rel=1e-6, abs=1e-6)


@pytest.mark.parametrize(
    ("name", "energy", "place", "period", "index"),
    [
        ("III", 0.3, 0.0, 2.0 * np.pi, -0.340506),
        ("III", 0.3, 0.5961137789, 6.8438337339, 3.159324),
        ("III", 0.3, 0.7255675265, 25.9515109788, 0.853885),
        ("HH", 0.1, 0.27550602600, 6.11049967861, 0.5 * 0.08842485),
        ("HH", 0.1, -0.14619013945, 6.79438482685, 0.5 * 2.95480549),
    ],
)
def test_known_orbits_are_on_curves(name: str, energy: float, place: float, period: float, index: float) -> None:
    found = families(name)
    rows = rows_at(found, energy)
    row = rows[np.argmin(np.abs(found.abscissa[rows] - place))]
    assert found.abscissa[row] == pytest.approx(place, abs=1e-9)
    assert found.period[row] == pytest.approx(period, abs=1e-9)
    assert found.stability_index[row] == pytest.approx(index, abs=1e-6)


def test_the_straight_orbit_of_case_iii_has_the_stability_of_mathieus_equation() -> None:
    found = families("III")
    is_straight = (np.abs(found.abscissa) < 1e-9) & (found.returns == 1)
    assert np.count_nonzero(is_straight) >= 58
    np.testing.assert_allclose(found.period[is_straight], 2.0 * np.pi, rtol=1e-12)
    # The characteristic value crosses 1 − 2h here.
    np.testing.assert_array_equal(np.abs(found.stability_index[is_straight]) <= 1.0, found.energy[is_straight] < 0.5816797436)


def test_all_symmetric_orbits_of_an_energy_are_on_curves() -> None:
    found = families("III")
    rows = rows_at(found, 0.3)
    others = find_periodic_orbits(MapSpec(III, Plane.X_PX, 0.3, (40, 40), t_max=400.0), 3)
    is_symmetric = np.abs(others.px) < 1e-8
    assert np.unique(others.returns[is_symmetric]).tolist() == [1, 3]
    for x, returns in zip(others.x[is_symmetric], others.returns[is_symmetric], strict=True):
        assert np.any((np.abs(found.abscissa[rows] - x) < 1e-7) & (found.returns[rows] == returns))


@pytest.mark.parametrize("name", SPECS)
def test_a_number_of_returns_is_the_smallest(name: str) -> None:
    found = families(name)
    # The same start with a divisor of its number of returns would be on another curve.
    places = np.round(found.points / found.spec.plane.axis_units(found.spec.potential.units), 9)
    for k, n in enumerate(found.returns):
        shorter = (found.returns < n) & (n % found.returns == 0)
        assert not np.any(np.all(places[shorter] == places[k], axis=1))


def test_neighbours_on_a_curve_are_in_one_cell() -> None:
    found = families("III")
    (columns, rows), window = found.spec.resolution, found.spec.find_window()
    cell = np.array([window.width / columns, window.height / rows])
    is_inner = np.diff(found.curve) == 0
    assert np.all(np.abs(np.diff(found.points, axis=0)[is_inner]) <= cell * (1.0 + 1e-9))
    assert np.all(np.diff(found.curve) >= 0)


def test_to_a_section_crossed_in_both_directions_orbits_return_twice_as_often() -> None:
    spec = replace(SPECS["III"], resolution=(40, 21))
    one, both = find_symmetric_families(spec, 2), find_symmetric_families(replace(spec, section=BOTH), 5)
    np.testing.assert_array_equal(both.returns, 2 * one.returns)
    np.testing.assert_array_equal(both.points, one.points)
    assert len(find_symmetric_families(replace(spec, section=BOTH), 1)) == 0


def test_the_direction_of_time_and_of_crossings_does_not_matter() -> None:
    spec = replace(SPECS["III"], resolution=(40, 21))
    wanted = find_symmetric_families(spec, 1)
    for other in (replace(spec, backward=True), replace(spec, section=read_section("y = 0 down"))):
        np.testing.assert_array_equal(find_symmetric_families(other, 1).points, wanted.points)


def test_a_cancelled_search_has_the_families_found_before() -> None:
    frames: list[SymmetricFamilies] = []
    cancel = threading.Event()

    def keep(frame: SymmetricFamilies) -> None:
        frames.append(frame)
        cancel.set()

    found = find_symmetric_families(SPECS["III"], 3, execution=Execution(cancel=cancel), on_frame=keep)
    assert [frame.complete for frame in frames] == [False]
    assert not found.complete
    whole = families("III")
    np.testing.assert_array_equal(found.points, whole.points[whole.returns == 1])


@pytest.mark.parametrize(
    ("spec", "reason"),
    [
        (MapSpec(POTENTIALS["HH"], Plane.X_H, (0.1, 0.2)), "its plane is (x, h) and its section y = 0; must be a slice along h"),
        (MapSpec(III, Plane.X_PX, 0.3), "its plane is (x, px) and its section y = 0"),
        (MapSpec(III, Plane.X_H, (0.1, 0.2), (1, 9)), "its resolution is (1, 9); must be at least 2"),
    ],
)
def test_other_requests_are_refused(spec: MapSpec, reason: str) -> None:
    with pytest.raises(ValueError, match=r"^spec: ") as error:
        find_symmetric_families(spec)
    assert reason in str(error.value)
