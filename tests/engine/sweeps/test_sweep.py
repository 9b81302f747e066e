"""Sweeps in memory have the measures of each value, are ordered and refined, and continue earlier sweeps."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from engine import (
    CASES,
    Fate,
    MapSpec,
    Plane,
    SweepSpec,
    compute_basin_entropy,
    compute_map,
    compute_statistics,
    compute_sweep,
    compute_wada_test,
    fit_decay_laws,
)
from engine.measures.compute import compute_point
from engine.measures.measured_map import SweepPoint
from engine.measures.table import curve_names
from engine.results import Sweep
from engine.slices.default_window import default_window
from tests.engine.slices.test_parameter_family import THIRD_EXIT

SPEC = SweepSpec(CASES["II"], Plane.X_PX, (0.3, 0.1, 0.2, 0.25, 0.2), (40, 40), t_max=500.0, measures=curve_names(slow=False))


@pytest.fixture(scope="module")
def sweep() -> Sweep:
    return compute_sweep(SPEC)


# Measures.


def test_values_are_sorted_and_unique(sweep: Sweep) -> None:
    np.testing.assert_array_equal(sweep.values, [0.1, 0.2, 0.25, 0.3])
    assert sweep.complete


def test_measures_of_a_value_are_those_of_its_map_with_their_errors(sweep: Sweep) -> None:
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.25, (40, 40), t_max=500.0))
    statistics, entropy, found = compute_statistics(frame), compute_basin_entropy(frame), sweep.dataset.sel(h=0.25)
    np.testing.assert_allclose(found["share"], [frame.fractions()[code] for code in range(4)], rtol=1e-12)
    intervals = np.array([statistics.share_intervals[code] for code in range(4)]).T
    np.testing.assert_array_equal([found["share_low"], found["share_high"]], intervals)
    assert found["mean_escape_time"] == statistics.mean_escape_time
    assert found["direct_share"] == statistics.direct_share
    assert (found["s_b"], found["s_b_error"]) == (entropy.s_b, entropy.s_b_error)
    assert (found["s_bb"], found["s_bb_error"]) == (entropy.s_bb, entropy.s_bb_error)
    assert found["wada_distance"] == compute_wada_test(frame).radius_99


def test_below_the_escape_energy_all_orbits_are_bounded(sweep: Sweep) -> None:
    np.testing.assert_array_equal(sweep["share"][0], [1.0, 0.0, 0.0, 0.0])
    assert sweep["s_b"][0] == 0.0
    assert np.isnan([sweep[name][0] for name in ("mean_escape_time", "decay_rate", "wada_distance")]).all()


def test_orbits_that_stay_on_a_symmetry_line_have_no_share() -> None:
    found = compute_sweep(SweepSpec(CASES["III"], Plane.X_Y, (0.6, 1.0), (112, 112), t_max=1e4, measures="shares"))
    np.testing.assert_array_equal(found["share"][:, Fate.BOUNDED], 0.0)


def test_the_law_of_late_escapes_is_that_of_the_map() -> None:
    spec = SweepSpec(CASES["III"], Plane.X_PX, (0.45,), (112, 112), t_max=1e4, measures=("decay_rate",))
    fit = fit_decay_laws(compute_statistics(compute_map(spec.point(0.45).map_spec)), 1e4).exponential
    assert fit is not None
    found = compute_sweep(spec)
    assert (found["decay_rate"], *found.interval("decay_rate")) == (fit.rate, fit.low, fit.high)


def test_exponent_is_computed_where_exits_are_open(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.measures.table.WORK", 1e7)
    found = compute_sweep(
        SweepSpec(CASES["III"], Plane.X_PX, (0.2, 0.6), (40, 40), t_max=500.0, measures=["uncertainty_exponent"])
    )
    low, high = found.interval("exponent")
    assert np.isnan(found["exponent"][0])
    assert low[1] < found["exponent"][1] < high[1]


def test_islands_are_the_connected_parts_of_the_bounded_starts() -> None:
    # Below the escape energy all starts are bounded: one island, the disc of radius √(2h) of case I at small energies.
    spec = SweepSpec(CASES["I"], Plane.X_PX, (0.02, 0.13), (100, 100), t_max=1000.0, measures=("islands",))
    disc, several = (compute_sweep(spec).dataset.isel(h=place) for place in (0, 1))
    assert disc["islands"] == 1
    assert disc["bounded_area"] == disc["largest_island"]
    assert float(disc["bounded_area"]) == pytest.approx(np.pi * 0.04, rel=0.02)
    assert several["islands"] > 1
    assert several["largest_island"] < several["bounded_area"]


def test_maps_are_stacked_on_the_window_of_the_highest_energy() -> None:
    spec = SweepSpec(CASES["I"], Plane.X_Y, (0.2, 0.1), (9, 14), t_max=100.0)
    found = compute_sweep(spec).dataset
    window = default_window(CASES["I"], Plane.X_Y, 0.2)
    for h in (0.1, 0.2):
        expected = compute_map(MapSpec(CASES["I"], Plane.X_Y, h, (9, 14), window, 100.0)).to_xarray()
        for name, array in expected.data_vars.items():
            np.testing.assert_array_equal(found[name].sel(h=h), array)
            assert found[name].dtype == array.dtype
        np.testing.assert_array_equal(found["y"], expected["y"])


@pytest.mark.parametrize("plane", [Plane.X_Y, Plane.X_PX])
@pytest.mark.parametrize(("case", "highest"), [("I", 0.5), ("II", 0.5), ("III", 1.0)])
def test_window_of_the_highest_energy_contains_all_others(case: str, highest: float, plane: Plane) -> None:
    energies = np.linspace(0.4 * CASES[case].escape_energy, highest, 15)
    window = SweepSpec(CASES[case], plane, energies).point(energies[0]).map_spec.find_window()
    for h in energies.tolist():
        inner = default_window(CASES[case], plane, h)
        assert window.x_low <= inner.x_low < inner.x_high <= window.x_high
        assert window.ordinate_low <= inner.ordinate_low < inner.ordinate_high <= window.ordinate_high


def test_dataset_is_labelled(sweep: Sweep) -> None:
    dataset = sweep.to_xarray()
    assert dataset["share"].dims == ("h", "outcome")
    assert all({"long_name", "units"} <= dataset[name].attrs.keys() for name in dataset.data_vars)
    assert dataset.attrs["plane"] == "(x, px)"
    assert sweep.to_pandas()["share_exit_1"].tolist() == sweep["share"][:, 1].tolist()


# Along a parameter.

ALONG = SweepSpec(
    THIRD_EXIT.system.potential, Plane.X_PX, (-0.5, -0.2, 0.1), (24, 24), (-1.0, 1.0, -1.0, 1.0), 200.0,
    measures=("shares", "maps"), along=THIRD_EXIT, energy=0.16,
)  # fmt: skip


@pytest.mark.slow
def test_outcomes_along_a_parameter_keep_their_numbers() -> None:
    found = compute_sweep(ALONG).dataset
    assert found["share"].dims == ("b", "outcome")
    for value in (-0.5, -0.2, 0.1):
        potential, one = THIRD_EXIT.system.with_parameter("b", value).potential, found.sel(b=value)
        frame = compute_map(MapSpec(potential, Plane.X_PX, 0.16, (24, 24), (-1.0, 1.0, -1.0, 1.0), 200.0))
        shares = frame.fractions()
        # The exit at the left, open for b = −0.5 only, is the third one of the sweep.
        numbers = [0, 1, 3, 2] if potential.channels == 3 else [0, 1, 2]
        expected = np.zeros(4)
        expected[numbers] = [shares[code] for code in range(len(numbers))]
        np.testing.assert_allclose(one["share"], expected, atol=1e-12)
        np.testing.assert_array_equal(one["fate"] == 3, frame.fate == numbers.index(3) if 3 in numbers else False)


# Order, refinement, earlier sweeps.


def step_at(edge: float) -> Callable[[SweepPoint], xr.Dataset]:
    """Return a measure whose share falls from 1 to 0 at an energy."""

    def measure(point: SweepPoint) -> xr.Dataset:
        ((name, value),) = point.place
        share = float(value < edge)
        return xr.Dataset({"share": ((name, "outcome"), [[share, 1.0 - share, 0.0, 0.0]])}, {name: [value]})

    return measure


STEP = SweepSpec(CASES["II"], Plane.X_PX, np.linspace(0.2, 0.4, 5), measures=("shares",), refine=6)


def test_further_values_close_in_on_the_steepest_place() -> None:
    found = compute_sweep(STEP, measure=step_at(0.32))
    assert found.complete
    edge = int(np.searchsorted(found.values, 0.32))
    # Six bisections of the interval of length 0.05 that contains the step.
    assert found.values[edge] - found.values[edge - 1] == pytest.approx(0.05 / 2**6)
    assert set(STEP.values) < set(found.values.tolist())


@given(st.integers(0, 10), st.floats(0.21, 0.39))
def test_interrupted_sweeps_continue_where_they_stopped(done: int, edge: float) -> None:
    frames: list[Sweep] = []
    whole = compute_sweep(STEP, on_frame=frames.append, measure=step_at(edge))
    measured: list[SweepPoint] = []

    def measure(point: SweepPoint) -> xr.Dataset:
        measured.append(point)
        return step_at(edge)(point)

    again = compute_sweep(STEP, earlier=frames[done - 1] if done else None, measure=measure)
    xr.testing.assert_identical(again.dataset, whole.dataset)
    assert len(measured) == whole.values.size - done


def test_frames_come_after_each_value_from_coarse_to_fine() -> None:
    seen: list[list[float]] = []
    spec = replace(STEP, values=np.linspace(0.2, 0.4, 9), refine=0)
    compute_sweep(spec, on_frame=lambda frame: seen.append(frame.values.tolist()), measure=step_at(0.3))
    assert [len(energies) for energies in seen] == list(range(1, 10))
    np.testing.assert_allclose(seen[2], [0.2, 0.3, 0.4])
    np.testing.assert_allclose(seen[4], [0.2, 0.25, 0.3, 0.35, 0.4])


def test_a_cached_map_is_measured_as_it_is() -> None:
    frame = compute_map(SPEC.point(0.2).map_spec)
    xr.testing.assert_identical(compute_point(SPEC.point(0.2), escape_map=frame), compute_point(SPEC.point(0.2)))
