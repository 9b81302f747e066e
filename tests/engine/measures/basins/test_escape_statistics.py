"""Statistics count every interior start once, also of unfinished maps and single windows."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from engine import (
    CASES,
    EscapeMap,
    Fate,
    MapSpec,
    Plane,
    Window,
    classify_orbits,
    compute_basin_entropy,
    compute_islands,
    compute_map,
    compute_statistics,
    compute_wada_test,
    fit_decay_laws,
    sample_starts,
)
from engine.measures.basins.escape_statistics import compute_survival
from engine.results import EscapeStatistics

SIDE = 60


@pytest.fixture(scope="module")
def whole() -> EscapeMap:
    """Return a map with early escapes, late escapes and bounded orbits."""
    return compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.3, (SIDE, SIDE), t_max=1e3))


@pytest.fixture(scope="module")
def statistics(whole: EscapeMap) -> EscapeStatistics:
    return compute_statistics(whole)


@pytest.fixture(scope="module")
def under_way() -> EscapeMap:
    """Return the first frame that has both escapes and undecided orbits."""
    frames: list[EscapeMap] = []
    cancel = threading.Event()

    def stop(frame: EscapeMap) -> None:
        frames.append(frame)
        cancel.set()

    compute_map(MapSpec(CASES["III"], Plane.X_PX, 0.26, (SIDE, SIDE), t_max=1e4), stop, cancel)
    return frames[0]


def with_times(frame: EscapeMap, times: list[float]) -> EscapeStatistics:
    """Return statistics of a map in which one orbit escapes at each of these times, and all others are bounded."""
    fate, escape_time = np.zeros(frame.fate.size, np.int8), np.full(frame.fate.size, np.nan)
    fate[: len(times)], escape_time[: len(times)] = 1, times
    shape = frame.fate.shape
    return compute_statistics(replace(frame, fate=fate.reshape(shape), escape_time=escape_time.reshape(shape)))


# Counts.


def test_every_interior_start_is_counted_once(whole: EscapeMap, statistics: EscapeStatistics) -> None:
    assert statistics.starts == np.count_nonzero(whole.interior)
    assert statistics.starts == sum(statistics.channel_counts) + statistics.bounded
    assert statistics.shares == whole.fractions()


def test_direct_escapes_have_no_crossing(whole: EscapeMap, statistics: EscapeStatistics) -> None:
    assert statistics.direct == np.count_nonzero((whole.fate >= 1) & (whole.crossings == 0))
    assert 0 < statistics.direct < statistics.escaped
    assert statistics.direct_share == statistics.direct / statistics.starts


def test_mean_and_median_are_over_the_escapes(whole: EscapeMap, statistics: EscapeStatistics) -> None:
    assert statistics.mean_escape_time == pytest.approx(np.nanmean(whole.escape_time))
    assert statistics.median_escape_time == np.nanmedian(whole.escape_time)


def test_failed_orbits_are_not_decided(whole: EscapeMap, statistics: EscapeStatistics) -> None:
    fate = np.where(whole.fate == Fate.BOUNDED, Fate.FAILED, whole.fate).astype(np.int8)
    broken = compute_statistics(replace(whole, fate=fate))
    assert (broken.failed, broken.bounded) == (statistics.bounded, 0)
    assert broken.starts == statistics.starts
    assert broken.decided == statistics.escaped


# Probabilities of escape after the n-th crossing.


def test_each_probability_is_relative_to_the_orbits_still_inside(statistics: EscapeStatistics) -> None:
    inside = statistics.starts
    for n, left in enumerate(statistics.crossing_counts):
        assert statistics.escape_probabilities[n] == left / inside
        inside -= left
    assert inside == statistics.bounded


# Windows.


def test_a_window_selects_pixels_by_their_centres(whole: EscapeMap) -> None:
    x, px = whole.x, whole.ordinate
    part = compute_statistics(whole, Window(x[10], x[29], px[20], px[24]))
    fate = whole.fate[20:25, 10:30]
    assert part.starts == np.count_nonzero((fate != Fate.FORBIDDEN) & (fate != Fate.OUTSIDE))
    np.testing.assert_array_equal(part.escape_times, whole.escape_time[20:25, 10:30][fate >= 1])


def test_a_window_without_pixels_has_no_starts(whole: EscapeMap) -> None:
    nothing = compute_statistics(whole, Window(5.0, 6.0, 5.0, 6.0))
    assert (nothing.starts, nothing.escaped, nothing.direct, nothing.direct_share) == (0, 0, 0, 0.0)
    assert not any(nothing.shares.values())
    assert np.isnan([nothing.mean_escape_time, nothing.median_escape_time]).all()
    assert nothing.crossing_counts.shape == nothing.escape_probabilities.shape == (0,)
    assert not nothing.time_histogram(5)[1].any()


# Unfinished maps.


def test_an_unfinished_map_counts_undecided_orbits(under_way: EscapeMap) -> None:
    statistics = compute_statistics(under_way)
    assert statistics.shares == under_way.fractions()
    assert statistics.undecided == np.count_nonzero(under_way.fate == Fate.NOT_COMPUTED) > 0
    assert statistics.decided == statistics.starts - statistics.undecided
    assert statistics.escape_probabilities[0] == statistics.direct / statistics.decided
    assert compute_survival(statistics)[1][-1] == pytest.approx(statistics.bounded / statistics.decided)


@pytest.mark.parametrize("measure", [compute_basin_entropy, compute_wada_test, compute_islands])
def test_measures_of_basins_refuse_an_unfinished_map_and_its_file(under_way: EscapeMap, measure: Callable) -> None:
    for unfinished in (under_way, under_way.to_xarray()):
        with pytest.raises(ValueError, match=r"^(labels|starts): the map is not complete; must be a complete map"):
            measure(unfinished)


# Histograms of escape times.


def test_bins_are_logarithmically_spaced_and_hold_every_escape(statistics: EscapeStatistics) -> None:
    edges, counts = statistics.time_histogram(9)
    np.testing.assert_array_equal(counts, np.histogram(statistics.escape_times, edges)[0])
    assert counts.sum() == statistics.escaped
    np.testing.assert_allclose(edges[1:] / edges[:-1], edges[1] / edges[0])
    assert (edges[0], edges[-1]) == (statistics.escape_times.min(), statistics.escape_times.max())


@pytest.mark.parametrize("times", [[3.0, 3.0], [3.0, np.nextafter(3.0, 4.0)], [0.0, 3.0]])
def test_equal_and_zero_times_have_a_histogram(whole: EscapeMap, times: list[float]) -> None:
    edges, counts = with_times(whole, times).time_histogram(5)
    assert np.all(np.diff(edges) > 0.0)
    assert counts.sum() == len(times)


def test_orbits_that_are_no_map_are_counted() -> None:
    potential, energy = CASES["III"], 0.36
    outcomes = classify_orbits(potential, energy, sample_starts(potential, energy, 500, rng=2), 50.0)
    counted = compute_statistics(outcomes)
    assert counted.channel_counts == tuple(int((outcomes.fate == channel).sum()) for channel in range(1, 5))
    assert (counted.starts, counted.t_max) == (500, 50.0)
    np.testing.assert_array_equal(counted.escape_times, outcomes.escape_time[outcomes.fate > 0])
    assert fit_decay_laws(outcomes).t_high == 50.0
