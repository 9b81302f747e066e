"""The structure of basins is measured right on maps with known fates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from engine import CASES, EscapeMap, Fate, MapSpec, Plane, compute_map
from reproduction.numbers.map_structure import orders_of_escape_times, share_in_basins, share_next_to_all_basins

SIDE = 12


@pytest.fixture(scope="module")
def computed() -> EscapeMap:
    return compute_map(MapSpec(CASES["II"], Plane.X_Y, 0.2, (SIDE, SIDE), t_max=50.0))


def with_fates(computed: EscapeMap, columns: list[int]) -> EscapeMap:
    """Return the map with one fate per column."""
    fate = np.tile(np.array(columns, np.int8), (SIDE, 1))
    return replace(computed, fate=fate, outside=np.where(fate == Fate.OUTSIDE, np.int8(2), np.int8(0)))


def test_starts_at_a_boundary_are_in_no_basin(computed: EscapeMap) -> None:
    assert share_in_basins(with_fates(computed, [1] * 6 + [2] * 6)) == pytest.approx(100.0 * 10 / 12)


def test_islands_are_no_basins(computed: EscapeMap) -> None:
    assert share_in_basins(with_fates(computed, [1] * 6 + [Fate.BOUNDED] * 6)) == pytest.approx(100.0 * 5 / 12)


def test_starts_outside_count_on_request_only(computed: EscapeMap) -> None:
    frame = with_fates(computed, [1] * 4 + [2] * 4 + [Fate.OUTSIDE] * 4)
    assert share_in_basins(frame) == pytest.approx(100.0 * 6 / 8)
    assert share_in_basins(frame, count_outside=True) == pytest.approx(100.0 * 10 / 12)


def test_forbidden_neighbours_do_not_count(computed: EscapeMap) -> None:
    assert share_in_basins(with_fates(computed, [1] * 6 + [Fate.FORBIDDEN] * 6)) == 100.0


def test_starts_on_boundaries_of_thin_basins_are_next_to_all_basins(computed: EscapeMap) -> None:
    assert share_next_to_all_basins(with_fates(computed, [1, 2, 3] * 4)) == 100.0


def test_starts_on_the_boundary_of_two_wide_basins_are_not_next_to_the_third(computed: EscapeMap) -> None:
    share = share_next_to_all_basins(with_fates(computed, [1] * 6 + [2] * 5 + [3]))
    assert share < 50.0


def test_two_basins_are_never_wada(computed: EscapeMap) -> None:
    assert np.isnan(share_next_to_all_basins(with_fates(computed, [1] * 6 + [2] * 6)))


def test_escape_times_next_to_islands_and_to_exits_are_compared(computed: EscapeMap) -> None:
    frame = with_fates(computed, [Fate.BOUNDED] * 3 + [1] * 6 + [Fate.OUTSIDE] * 3)
    times = np.tile(np.array([np.nan] * 3 + [500.0, 70.0, 60.0, 50.0, 40.0, 5.0] + [np.nan] * 3), (SIDE, 1))
    assert orders_of_escape_times(replace(frame, escape_time=times)) == pytest.approx(2.0)
