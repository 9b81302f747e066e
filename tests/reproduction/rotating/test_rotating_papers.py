"""Maps of rotating systems have the measures that are compared with papers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import POTENTIALS, EscapeMap, Fate, MapSpec, Plane, compute_map, fit_decay_laws
from reproduction.rotating.map_measures import (
    bounded_share_beside,
    end_times,
    outcome_share,
    share_next_to_islands,
)
from reproduction.rotating.paper_maps import BODY_RADII, PAPER_MAPS, PaperMap, copenhagen, four_hills
from reproduction.rotating.tables import COLUMNS, make_table

SIDE = 12

BOUNDED = int(Fate.BOUNDED)


def small(paper_map: PaperMap) -> EscapeMap:
    return compute_map(replace(paper_map.spec, resolution=(40, 40)))


@pytest.fixture(scope="module")
def computed() -> EscapeMap:
    return compute_map(MapSpec(POTENTIALS["Star cluster"], Plane.X_PX, -1.5, (SIDE, SIDE), t_max=50.0))


def with_fates(computed: EscapeMap, columns: list[int]) -> EscapeMap:
    """Return the map with one fate per column, and the number of the column as the escape time."""
    times = np.tile(np.arange(SIDE, dtype=float), (SIDE, 1))
    return replace(computed, fate=np.tile(np.array(columns, np.int8), (SIDE, 1)), escape_time=times)


def test_shares_of_several_outcomes_add_up(computed: EscapeMap) -> None:
    frame = with_fates(computed, [1] * 6 + [2] * 3 + [BOUNDED] * 3)
    assert outcome_share(frame, 1) == 50.0
    assert outcome_share(frame, 2, BOUNDED) == 50.0


def test_shares_of_bounded_starts_are_those_of_each_side(computed: EscapeMap) -> None:
    frame = with_fates(computed, [BOUNDED] * 3 + [1] * 9)
    assert bounded_share_beside(frame, -1) == 50.0
    assert bounded_share_beside(frame, 1) == 0.0


def test_times_at_boundaries_are_those_of_neighbours_of_another_outcome(computed: EscapeMap) -> None:
    times = end_times(with_fates(computed, [1] * 6 + [2] * 6))
    assert times.at_boundary == 5.5
    assert times.inside == 5.5


def test_starts_next_to_islands_are_at_no_boundary_of_basins(computed: EscapeMap) -> None:
    times = end_times(with_fates(computed, [1] * 6 + [BOUNDED] * 6))
    assert np.isnan(times.at_boundary)
    assert times.inside == 2.0


def test_late_orbits_have_the_longest_times(computed: EscapeMap) -> None:
    frame = with_fates(computed, [1] * 10 + [BOUNDED] * 2)
    assert share_next_to_islands(frame, late=False) == pytest.approx(20.0)
    assert share_next_to_islands(frame, late=True) == 100.0


def test_bodies_have_the_given_radius() -> None:
    assert [body.radius for body in copenhagen(0.02).centres] == [0.02, 0.02]


def test_the_discs_of_the_four_hills_enclose_the_hills_and_leave_no_gap() -> None:
    hills = four_hills()
    x, y = 5.0 * np.cos(angles := np.linspace(0.0, 2.0 * np.pi, 721)), 5.0 * np.sin(angles)
    far = np.sqrt(2.0) * np.array([x, y])
    assert np.any([disc.contains(*far) for disc in hills.centres], axis=0).all()
    span = np.linspace(-3.0, 3.0, 301)
    places = np.meshgrid(span, span)
    covered = np.any([disc.contains(*places) for disc in hills.centres], axis=0)
    assert hills.value(*places)[covered].max() < 1e-3


@pytest.mark.parametrize("paper_map", PAPER_MAPS["Four hills"], ids=lambda paper_map: paper_map.name)
def test_every_orbit_leaves_the_four_hills(paper_map: PaperMap) -> None:
    assert outcome_share(small(paper_map), BOUNDED) == 0.0


def test_tables_have_columns_for_each_system() -> None:
    assert set(COLUMNS) == set(PAPER_MAPS)


@pytest.mark.slow
def test_a_table_has_a_row_for_each_map() -> None:
    heads, _, *rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in make_table("Star cluster").splitlines()]
    assert heads == ["Star cluster", *COLUMNS["Star cluster"]]
    assert [row[0] for row in rows] == [paper_map.name for paper_map in PAPER_MAPS["Star cluster"]]
    assert all(float(cell) >= 0.0 for row in rows for cell in row[1:])


@pytest.mark.parametrize("paper_map", PAPER_MAPS["Star cluster"], ids=lambda paper_map: paper_map.name)
def test_retrograde_stars_stay_more_often_and_leave_last_at_boundaries(paper_map: PaperMap) -> None:
    frame = small(paper_map)
    assert bounded_share_beside(frame, -1) > 7.0 * bounded_share_beside(frame, 1)
    times = end_times(frame)
    # Rounding errors change the fates of chaotic orbits, and thereby the median time at boundaries by some 10 %.
    assert times.at_boundary > 3.0 * times.inside


def test_the_exponent_of_collisions_falls_with_the_radius() -> None:
    shares = [outcome_share(small(paper_map), 1, 2) for paper_map in PAPER_MAPS["Copenhagen problem"]]
    first, *others = np.diff(np.log(shares)) / np.diff(np.log(BODY_RADII))
    assert first > max(others) > 0.0


@pytest.mark.exhaustive
def test_survivors_of_the_copenhagen_problem_do_not_fall_exponentially() -> None:
    smallest_bodies = PAPER_MAPS["Copenhagen problem"][0].spec
    computed = compute_map(replace(smallest_bodies, resolution=(220, 220), t_max=1e4))
    times = computed.escape_time[computed.fate > Fate.BOUNDED]
    found = [100.0 * float(np.mean(times > t)) for t in (100.0, 200.0, 500.0, 1000.0)]
    assert found == pytest.approx([16.1, 2.5, 0.30, 0.13], rel=0.05, abs=0.04)
    exponential = fit_decay_laws(computed).exponential
    assert exponential is not None
    assert not exponential.plausible
