"""Crossing statistics (Zotos 2014, section 5), compared with direct counts over maps."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from engine import CASES, EscapeMap, Fate, MapSpec, Plane, Window, compute_crossing_statistics, compute_map, compute_statistics
from engine.execution import Execution
from engine.measures.published_fits import PAPER_FITS
from engine.sweeps.crossing_statistics import tabulate_crossing_statistics

SIDE = 50
T_MAX = 1000.0
# A window that extends beyond the exits.
WIDE = Window(-1.5, 1.5, -1.5, 1.5)


@pytest.fixture(scope="module")
def maps() -> list[EscapeMap]:
    """Below the escape energy, just above it, and with many starts outside."""
    specs = [MapSpec(CASES["II"], Plane.X_PX, h, (SIDE, SIDE), t_max=T_MAX) for h in (0.1, 0.18)]
    specs.append(MapSpec(CASES["II"], Plane.X_PX, 0.3, (SIDE, SIDE), WIDE, T_MAX))
    return [compute_map(spec) for spec in specs]


@pytest.fixture(scope="module")
def table(maps: list[EscapeMap]) -> xr.Dataset:
    return tabulate_crossing_statistics(maps)


@pytest.fixture(scope="module")
def with_outside(maps: list[EscapeMap]) -> xr.Dataset:
    return tabulate_crossing_statistics(maps, count_outside=True)


# Counts.


def test_crossing_counts(maps: list[EscapeMap], table: xr.Dataset) -> None:
    for index, frame in enumerate(maps):
        escaped = frame.fate >= 1
        expected = [np.count_nonzero(escaped & (frame.crossings == n)) for n in table.n.values]
        np.testing.assert_array_equal(table.crossing_count[index], expected)


def test_starts_are_the_interior(maps: list[EscapeMap], table: xr.Dataset) -> None:
    np.testing.assert_array_equal(table.starts, [np.count_nonzero(frame.interior) for frame in maps])


def test_shares_equal_the_fractions_of_the_maps(maps: list[EscapeMap], table: xr.Dataset) -> None:
    expected = [[frame.fractions()[int(code)] for code in table.fate.values] for frame in maps]
    np.testing.assert_allclose(table.share, expected, rtol=1e-14)
    np.testing.assert_allclose(table.share.sum("fate"), 1.0, rtol=1e-14)


def test_crossing_shares_and_bounded_share_sum_to_1(table: xr.Dataset) -> None:
    np.testing.assert_allclose(table.crossing_share.sum("n") + table.share.sel(fate=Fate.BOUNDED), 1.0, rtol=1e-13)


def test_direct_escapes_have_no_crossing(table: xr.Dataset) -> None:
    np.testing.assert_array_equal(table.direct, table.crossing_count.sel(n=0))
    np.testing.assert_allclose(table.direct_share, table.direct / table.starts, rtol=1e-15)


def test_no_escapes_below_the_escape_energy(table: xr.Dataset) -> None:
    lowest = table.isel(h=0)
    assert int(lowest.escaped) == 0
    assert float(lowest.share.sel(fate=Fate.BOUNDED)) == 1.0
    assert np.isnan(lowest.median_escape_time)
    np.testing.assert_array_equal(lowest.escape_probability, 0.0)


def test_escape_times(maps: list[EscapeMap], table: xr.Dataset) -> None:
    times = maps[1].escape_time[maps[1].fate >= 1]
    assert float(table.mean_escape_time[1]) == pytest.approx(times.mean(), rel=1e-13)
    assert float(table.median_escape_time[1]) == np.median(times)


# Escape probability.


def test_remaining_decreases_by_the_escapes_to_the_bounded_orbits(table: xr.Dataset) -> None:
    remaining, escapes = table.remaining.values, table.crossing_count.values
    np.testing.assert_array_equal(remaining[:, 0], table.starts)
    np.testing.assert_array_equal(remaining[:, 1:], remaining[:, :-1] - escapes[:, :-1])
    bounded = np.rint(table.share.sel(fate=Fate.BOUNDED) * table.starts)
    np.testing.assert_array_equal(remaining[:, -1] - escapes[:, -1], bounded)


def test_product_of_survival_probabilities_is_the_bounded_share(table: xr.Dataset) -> None:
    survival = np.nanprod(1.0 - table.escape_probability, axis=1)
    np.testing.assert_allclose(survival, table.share.sel(fate=Fate.BOUNDED), rtol=1e-11, atol=1e-13)


def test_probabilities_equal_those_of_compute_statistics(maps: list[EscapeMap], table: xr.Dataset) -> None:
    for index, frame in enumerate(maps):
        expected = compute_statistics(frame).escape_probabilities
        np.testing.assert_allclose(table.escape_probability[index, : expected.size], expected, rtol=1e-14)


def test_probability_is_nan_without_remaining_orbits(table: xr.Dataset) -> None:
    undefined = np.isnan(table.escape_probability)
    np.testing.assert_array_equal(undefined, table.remaining == 0)
    assert undefined.any()


def test_table_can_be_shorter(maps: list[EscapeMap], table: xr.Dataset) -> None:
    short = tabulate_crossing_statistics(maps, most_crossings=3)
    xr.testing.assert_identical(short, table.sel(n=slice(0, 3)))


def test_table_can_be_longer(maps: list[EscapeMap], table: xr.Dataset) -> None:
    beyond = tabulate_crossing_statistics(maps, most_crossings=table.sizes["n"])
    np.testing.assert_array_equal(beyond.crossing_count[:, -1], 0)
    np.testing.assert_array_equal(beyond.remaining[:, -1], table.starts - table.escaped)


def test_failed_orbits_count_as_starts_only(maps: list[EscapeMap], table: xr.Dataset) -> None:
    fate = maps[1].fate.copy()
    rows, columns = np.nonzero(fate == Fate.BOUNDED)
    fate[rows[0], columns[0]] = Fate.FAILED
    with_failure = tabulate_crossing_statistics([replace(maps[1], fate=fate)])
    assert int(with_failure.failed[0]) == 1
    assert int(with_failure.starts[0]) == int(table.starts[1])
    assert int(with_failure.remaining[0, 0]) == int(table.starts[1]) - 1


# Starts outside.


def test_outside_starts_are_counted_as_in_fractions(maps: list[EscapeMap], with_outside: xr.Dataset) -> None:
    expected = [[frame.fractions(count_outside=True)[int(code)] for code in with_outside.fate.values] for frame in maps]
    np.testing.assert_allclose(with_outside.share, expected, rtol=1e-14)


def test_outside_starts_escape_directly(maps: list[EscapeMap], table: xr.Dataset, with_outside: xr.Dataset) -> None:
    outside = [np.count_nonzero(frame.fate == Fate.OUTSIDE) for frame in maps]
    assert outside[-1] > 100
    np.testing.assert_array_equal(with_outside.direct - table.direct, outside)
    np.testing.assert_array_equal(with_outside.crossing_count[:, 1:], table.crossing_count[:, 1:])


def test_escape_time_of_outside_starts_is_0(maps: list[EscapeMap], table: xr.Dataset, with_outside: xr.Dataset) -> None:
    total = (with_outside.mean_escape_time * with_outside.escaped)[1:]
    np.testing.assert_allclose(total, (table.mean_escape_time * table.escaped)[1:], rtol=1e-12)


# Metadata.


def test_variables_and_table_have_metadata(table: xr.Dataset) -> None:
    assert all({"long_name", "units"} <= table[name].attrs.keys() for name in table.data_vars)
    assert table.attrs["plane"] == "(x, px)"
    assert table.attrs["t_max"] == T_MAX
    assert table.attrs["count_outside"] == 0
    assert not {"energy", "window"} & table.attrs.keys()


def test_windows_are_stored_by_energy(table: xr.Dataset) -> None:
    assert table.window.sel(h=0.3).values.tolist() == [-1.5, 1.5, -1.5, 1.5]


def test_table_round_trips_through_netcdf(table: xr.Dataset, tmp_path: Path) -> None:
    table.to_netcdf(tmp_path / "table.nc", engine="h5netcdf")
    with xr.open_dataset(tmp_path / "table.nc", engine="h5netcdf") as read:
        xr.testing.assert_equal(read.load(), table)


# Computing.


def test_compute_equals_tabulate(maps: list[EscapeMap], table: xr.Dataset) -> None:
    computed = compute_crossing_statistics(CASES["II"], Plane.X_PX, (0.18, 0.1, 0.18), (SIDE, SIDE), T_MAX)
    xr.testing.assert_identical(computed, tabulate_crossing_statistics(maps[:2]))


def test_window_applies_to_all_energies() -> None:
    computed = compute_crossing_statistics(CASES["II"], Plane.X_PX, (0.3, 0.4), (9, 9), 10.0, window=WIDE)
    np.testing.assert_array_equal(computed.window, [[-1.5, 1.5, -1.5, 1.5]] * 2)


def test_progress_reaches_1() -> None:
    reported: list[float] = []
    compute_crossing_statistics(
        CASES["II"], Plane.X_PX, (0.3, 0.4), (20, 20), 100.0, execution=Execution(on_progress=reported.append)
    )
    assert reported[-1] == 1.0
    assert 0.5 in reported


def test_cancel_raises() -> None:
    cancel = threading.Event()
    with pytest.raises(CancelledError):
        compute_crossing_statistics(
            CASES["II"], Plane.X_PX, (0.3, 0.4), (20, 20), execution=Execution(cancel=cancel, on_progress=lambda _: cancel.set())
        )


# The fits of the paper give 0.90, 0.85 and 0.92.
@pytest.mark.parametrize(("name", "energy", "expected"), [("I", 0.5, 0.885), ("II", 0.5, 0.851), ("III", 0.6, 0.930)])
def test_direct_share_at_high_energy(name: str, energy: float, expected: float) -> None:
    computed = compute_crossing_statistics(CASES[name], Plane.X_PX, (energy,), (224, 224), 100.0, most_crossings=0)
    direct = float(computed.direct_share[0])
    assert direct == pytest.approx(expected, abs=0.005)
    assert direct == pytest.approx(float(PAPER_FITS[name].direct(energy)), abs=0.02)


# Validation.


def test_no_maps_are_refused() -> None:
    with pytest.raises(ValueError, match="maps: none"):
        tabulate_crossing_statistics([])


def test_energies_must_ascend(maps: list[EscapeMap]) -> None:
    with pytest.raises(ValueError, match="must ascend"):
        tabulate_crossing_statistics(maps[::-1])


def test_maps_with_different_t_max_are_refused(maps: list[EscapeMap]) -> None:
    other = replace(maps[1], spec=replace(maps[1].spec, t_max=10.0))
    with pytest.raises(ValueError, match="differs"):
        tabulate_crossing_statistics([maps[0], other])


def test_incomplete_maps_are_refused(maps: list[EscapeMap]) -> None:
    with pytest.raises(ValueError, match="not complete"):
        tabulate_crossing_statistics([replace(maps[0], complete=False)])


def test_plane_x_h_is_refused() -> None:
    frame = compute_map(MapSpec(CASES["II"], Plane.X_H, (0.2, 0.3), (3, 3), t_max=1.0))
    with pytest.raises(ValueError, match=r"\(x, h\)"):
        tabulate_crossing_statistics([frame])


def test_negative_most_crossings_is_refused_before_computing() -> None:
    with pytest.raises(ValueError, match="most_crossings=-1"):
        compute_crossing_statistics(CASES["III"], Plane.X_PX, (0.26,), most_crossings=-1)
