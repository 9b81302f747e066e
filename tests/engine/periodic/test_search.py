"""The search on a slice finds all periodic orbits that random starts find, each once, with its images."""

from __future__ import annotations

import threading
from dataclasses import replace

import numpy as np
import pytest

from engine import (
    CASES,
    POTENTIALS,
    Execution,
    MapSpec,
    NoPeriodicOrbitError,
    Plane,
    Stability,
    find_periodic_orbit,
    find_periodic_orbits,
    read_section,
)
from engine.results import PeriodicOrbits

SPEC = MapSpec(CASES["III"], Plane.X_PX, 0.3, (40, 40), t_max=400.0)
X_IS_0 = read_section("x = 0, px > 0")


@pytest.fixture(scope="module")
def found() -> PeriodicOrbits:
    return find_periodic_orbits(SPEC, 2)


def test_the_orbits_of_case_iii_are_found(found: PeriodicOrbits) -> None:
    periods = {round(orbit.period, 7) for orbit in found}
    assert periods >= {6.2831853, 6.8438337, 10.3753286, 10.7971403, 16.9148966, 17.0448411}


def test_each_orbit_is_listed_once(found: PeriodicOrbits) -> None:
    points, orbit = found.points, found.orbit
    distances = np.abs(points[:, None] - points).max(axis=-1)
    # Different points of one orbit are apart as well.
    assert distances[~np.eye(len(points), dtype=bool)].min() > 1e-6
    assert sorted(set(orbit.tolist())) == list(range(1, len(found) + 1))


def test_every_image_under_the_symmetries_is_listed(found: PeriodicOrbits) -> None:
    points = np.round(found.points, 7)
    listed = {tuple(point) for point in points + 0.0}
    for signs in ((-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)):
        assert {tuple(point) for point in points * signs + 0.0} == listed


def test_images_name_the_orbit_of_which_they_are_images(found: PeriodicOrbits) -> None:
    orbits = list(found)
    for orbit, number in zip(found.orbit, found.image_of, strict=True):
        if number:
            assert orbits[orbit - 1].period == pytest.approx(orbits[number - 1].period, rel=1e-9)
            assert orbits[number - 1].returns == orbits[orbit - 1].returns
    assert (found.image_of == 0).any()
    assert (found.image_of > 0).any()
    assert np.all(found.image_of < found.orbit)


def test_orbits_of_all_kinds_of_stability_are_found(found: PeriodicOrbits) -> None:
    assert set(found.stability) == set(Stability)


def test_random_starts_find_no_other_orbit(found: PeriodicOrbits) -> None:
    rng = np.random.default_rng(7)
    known = {round(orbit.period, 6) for orbit in found}
    tried = 0
    for x, px in rng.uniform(-0.75, 0.75, (60, 2)):
        (start,) = SPEC.start_states(np.array([x]), np.array([px]))
        if np.isnan(start).any():
            continue
        try:
            orbit = find_periodic_orbit(CASES["III"], start, 1 + tried % 2)
        except NoPeriodicOrbitError:
            continue
        if orbit.returns <= 2:
            assert round(orbit.period, 6) in known
            tried += 1
    assert tried > 15


def test_henon_and_heiles_have_the_eight_simple_orbits_of_churchill_pecelli_and_rod() -> None:
    spec = MapSpec(POTENTIALS["HH"], X_IS_0.slice_of_starts, 0.05, (40, 40), t_max=100.0, section=X_IS_0)
    periods = sorted(round(orbit.period, 6) for orbit in find_periodic_orbits(spec, 1))
    up = MapSpec(POTENTIALS["HH"], Plane.X_PX, 0.05, (40, 40), t_max=100.0)
    others = sorted(round(orbit.period, 6) for orbit in find_periodic_orbits(up, 1))
    # Three straight orbits A of equal period, three orbits B, and C in both directions. Each section misses those along itself.
    assert len(set(periods) | set(others)) == 3
    numbers = {period: max(periods.count(period), others.count(period)) for period in {*periods, *others}}
    assert sorted(numbers.values()) == [2, 3, 3]


def test_an_orbit_at_a_corner_of_parts_of_cells_is_found() -> None:
    # The orbit x = 0 is where four cells of this window meet, and unstable.
    periods = [round(orbit.period, 6) for orbit in find_periodic_orbits(replace(SPEC, energy=0.6), 1)]
    assert round(2.0 * np.pi, 6) in periods


# Orbits of one return with a = 63.97 and −275.4, which Newton's method found from thousands of random starts.
@pytest.mark.parametrize(("energy", "period"), [(0.2, 10.508880), (0.4, 9.307161)])
def test_orbits_near_which_most_starts_escape_are_found(energy: float, period: float) -> None:
    spec = MapSpec(POTENTIALS["HH"], Plane.X_PX, energy, (60, 60), t_max=60.0)
    assert period in {round(orbit.period, 6) for orbit in find_periodic_orbits(spec, 1)}


def test_parts_of_cells_can_have_corners_in_a_body() -> None:
    found = find_periodic_orbits(MapSpec(POTENTIALS["Hill"], Plane.X_PX, -2.1, (30, 30), t_max=60.0), 2)
    # Near the last two, most starts escape.
    assert {round(orbit.period, 4) for orbit in found} >= {1.498, 0.5096, 2.908, 4.6875}


def test_a_point_is_found_by_its_place(found: PeriodicOrbits) -> None:
    orbit = found.nearest(0.59, 0.01)
    assert orbit is not None
    assert orbit.period == pytest.approx(6.8438337339, abs=1e-9)


def test_returns_on_a_line_are_told_apart_by_their_place() -> None:
    on_axis = find_periodic_orbits(replace(SPEC, window=(-0.7, 0.7, -0.05, 0.05), resolution=(20, 2)), 1)
    for x in (-0.6, 0.0, 0.6):
        orbit = on_axis.nearest(x, 0.01)
        assert orbit is not None
        assert orbit.x[0] == pytest.approx(x, abs=0.01)


def test_a_cancelled_search_is_not_complete() -> None:
    frames: list[PeriodicOrbits] = []
    cancel = threading.Event()

    def keep(frame: PeriodicOrbits) -> None:
        frames.append(frame)
        cancel.set()

    stopped = find_periodic_orbits(SPEC, 2, execution=Execution(cancel=cancel), on_frame=keep)
    assert not stopped.complete
    assert len(frames) == 1
    assert stopped.returns.max(initial=0) <= 1


def test_a_window_limits_the_search() -> None:
    inside = find_periodic_orbits(replace(SPEC, window=(0.5, 0.7, -0.1, 0.1), resolution=(30, 30)), 1)
    assert [round(orbit.period, 6) for orbit in inside][:1] == [6.843834]
    assert len(inside) <= 2


def test_energies_without_orbits_are_legal() -> None:
    nothing = find_periodic_orbits(replace(SPEC, energy=-1.0, window=(-1, 1, -1, 1), resolution=(10, 10)), 1)
    assert len(nothing) == 0
    assert nothing.nearest(0.0, 0.0) is None
    assert nothing.describe().startswith("0 periodic orbits")


def test_another_slice_than_that_of_the_section_is_refused() -> None:
    with pytest.raises(ValueError, match=r"spec: its plane is \(x, y\); must be the slice of its section y = 0"):
        find_periodic_orbits(replace(SPEC, plane=Plane.X_Y), 1)
    with pytest.raises(ValueError, match=r"its resolution is \(1, 20\)"):
        find_periodic_orbits(replace(SPEC, resolution=(1, 20)), 1)
    with pytest.raises(ValueError, match="returns=0"):
        find_periodic_orbits(SPEC, 0)
