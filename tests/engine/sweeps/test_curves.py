"""Curves against energy: values at each energy, order of computation, dataset and validation."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import CancelledError
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine import (
    CASES,
    Coordinate,
    Curves,
    CurvesSpec,
    Fate,
    MapSpec,
    Plane,
    Slice,
    compute_curves,
    compute_map,
    compute_statistics,
    compute_wada_test,
    fit_decay_laws,
)
from engine.execution import Execution
from engine.sweeps.curve_points import CurvePoint, CurvePointSpec, compute_curve_point
from tests.engine.slices.test_parameter_family import THIRD_EXIT

SPEC = CurvesSpec(CASES["II"], Plane.X_PX, (0.3, 0.1, 0.2, 0.25, 0.2), (40, 40), 500.0, exponent=False)


@pytest.fixture(scope="module")
def curves() -> Curves:
    return compute_curves(SPEC)


def test_energies_are_sorted_and_unique(curves: Curves) -> None:
    np.testing.assert_array_equal(curves.values, [0.1, 0.2, 0.25, 0.3])
    assert curves.complete


def test_point_equals_the_statistics_of_its_map(curves: Curves) -> None:
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.25, (40, 40), t_max=500.0))
    statistics = compute_statistics(frame)
    index = curves.values.tolist().index(0.25)
    np.testing.assert_allclose(curves.shares[index], [frame.fractions()[code] for code in range(4)], rtol=1e-12)
    assert curves.curve("mean_escape_time")[index] == statistics.mean_escape_time
    assert curves.curve("direct_share")[index] == statistics.direct_share


def test_below_the_escape_energy_all_orbits_are_bounded(curves: Curves) -> None:
    np.testing.assert_array_equal(curves.shares[0], [1.0, 0.0, 0.0, 0.0])
    assert curves.curve("s_b")[0] == 0.0
    assert np.isnan(curves.curve("mean_escape_time")[0])


def test_orbits_that_stay_on_a_symmetry_line_have_no_share() -> None:
    curves = compute_curves(CurvesSpec(CASES["III"], Plane.X_Y, (0.6, 1.0), t_max=1e4, exponent=False))
    np.testing.assert_array_equal(curves.shares[:, Fate.BOUNDED], 0.0)


def test_median_escape_time_decreases_with_energy(curves: Curves) -> None:
    assert np.all(np.diff(curves.curve("median_escape_time")[1:]) < 0)


def point_at(value: float, bounded: float = 1.0) -> CurvePoint:
    """A point of the curves with a given share of bounded starts."""
    return CurvePoint(
        value=value, shares=(bounded, 1.0 - bounded, 0.0, 0.0), bounded_low=0.0, bounded_high=1.0, bounded_area=1.0, islands=1,
        largest_island=1.0, direct_share=0.0, mean_escape_time=1.0, median_escape_time=1.0, s_b=0.0, s_bb=0.0,
        wada_distance=1.0, decay_rate=0.1, decay_low=0.05, decay_high=0.2,
    )  # fmt: skip


def step_at(edge: float) -> Callable[[CurvePointSpec], CurvePoint]:
    """Measures a share that falls from 1 to 0 at an energy."""
    return lambda spec: point_at(spec.value, float(spec.value < edge))


STEP = CurvesSpec(CASES["II"], Plane.X_PX, tuple(np.linspace(0.2, 0.4, 5).tolist()), exponent=False, refine=6)


def test_further_values_close_in_on_the_steepest_place() -> None:
    curves = compute_curves(STEP, measure=step_at(0.32))
    assert curves.complete
    values = curves.values
    edge = int(np.searchsorted(values, 0.32))
    # Six bisections of the interval of length 0.05 that contains the step.
    assert values[edge] - values[edge - 1] == pytest.approx(0.05 / 2**6)
    assert set(STEP.values) < set(values.tolist())


@given(st.integers(0, 11), st.floats(0.21, 0.39))
def test_interrupted_curves_continue_where_they_stopped(done: int, edge: float) -> None:
    frames: list[Curves] = []
    whole = compute_curves(STEP, on_frame=frames.append, measure=step_at(edge))
    measured: list[float] = []

    def measure(spec: CurvePointSpec) -> CurvePoint:
        measured.append(spec.value)
        return step_at(edge)(spec)

    again = compute_curves(STEP, earlier=frames[done - 1] if done else None, measure=measure)
    assert again.values.tolist() == whole.values.tolist()
    assert again.shares.tolist() == whole.shares.tolist()
    assert len(measured) == len(whole.points) - done


def test_curves_of_another_request_are_not_continued() -> None:
    earlier = compute_curves(replace(STEP, t_max=50.0), measure=step_at(0.3))
    with pytest.raises(ValueError, match="earlier: its t_max must be those of spec"):
        compute_curves(STEP, earlier=earlier)


def test_late_escapes_and_boundaries_are_measured_at_each_energy() -> None:
    spec = CurvesSpec(CASES["III"], Plane.X_PX, (0.45,), (112, 112), 1e4, exponent=False)
    (point,) = compute_curves(spec).points
    escapes = compute_map(spec.point(0.45).map_spec)
    fit = fit_decay_laws(compute_statistics(escapes), 1e4).exponential
    assert fit is not None
    assert (point.decay_rate, point.decay_low, point.decay_high) == (fit.rate, fit.low, fit.high)
    assert point.wada_distance == compute_wada_test(escapes).radius_99
    closed = compute_curve_point(spec.point(0.2))
    assert np.isnan([closed.decay_rate, closed.wada_distance]).all()


def test_frames_come_after_each_energy_from_coarse_to_fine() -> None:
    seen: list[list[float]] = []

    def measure(spec: CurvePointSpec) -> CurvePoint:
        assert not isinstance(spec.map_spec.energy, tuple)
        return point_at(spec.value)

    spec = CurvesSpec(CASES["II"], Plane.X_PX, tuple(np.linspace(0.2, 0.4, 9)), exponent=False)
    compute_curves(spec, on_frame=lambda frame: seen.append(frame.values.tolist()), measure=measure)
    assert [len(energies) for energies in seen] == list(range(1, 10))
    np.testing.assert_allclose(seen[2], [0.2, 0.3, 0.4])
    np.testing.assert_allclose(seen[4], [0.2, 0.25, 0.3, 0.35, 0.4])


def test_exponent_is_computed_where_exits_are_open(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.sweeps.curve_points._WORK", 1e6)
    spec = CurvesSpec(CASES["III"], Plane.X_PX, (0.2, 0.6), (40, 40), 500.0)
    closed, opened = (compute_curve_point(spec.point(energy)) for energy in spec.values)
    assert np.isnan(closed.exponent)
    assert opened.exponent_low < opened.exponent < opened.exponent_high


def test_dataset_has_all_curves(curves: Curves) -> None:
    dataset = curves.to_xarray()
    assert dataset["share"].dims == ("h", "fate")
    assert dataset["s_bb"].dims == ("h",)
    np.testing.assert_allclose(dataset["share"].sum("fate"), 1.0)
    assert dataset.attrs["plane"] == "(x, px)"


@pytest.mark.parametrize("values", [(), (float("nan"),), tuple(range(2000))])
def test_invalid_values_are_refused(values: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="values"):
        CurvesSpec(CASES["I"], Plane.X_PX, values)


ALONG = CurvesSpec(
    THIRD_EXIT.system.potential, Plane.X_PX, (-0.5, -0.2, 0.1), (24, 24), 200.0, exponent=False, along=THIRD_EXIT, energy=0.16
)


@pytest.mark.slow
def test_curves_along_a_parameter_are_measured_on_maps_of_each_value() -> None:
    curves = compute_curves(ALONG)
    assert curves.values.tolist() == [-0.5, -0.2, 0.1]
    for value, shares in zip(curves.values.tolist(), curves.shares, strict=True):
        potential = THIRD_EXIT.system.with_parameter("b", value).potential
        found = compute_map(MapSpec(potential, Plane.X_PX, 0.16, (24, 24), t_max=200.0)).fractions()
        # The exit at the left, open for b = −0.5 only, is the third one on the curves.
        expected = [found[0], found[1], found[3], found[2]] if potential.channels == 3 else [found[0], found[1], found[2], 0.0]
        np.testing.assert_allclose(shares, expected, atol=1e-12)


def test_a_table_of_curves_along_a_parameter_has_its_name() -> None:
    dataset = compute_curves(replace(ALONG, values=(0.1,))).to_xarray()
    assert dataset["share"].dims == ("b", "fate")
    assert dataset.sizes["fate"] == 4


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"energy": None}, "energy=None: must be given along a parameter"),
        ({"along": None}, "None along the energy"),
        ({"potential": CASES["III"]}, "one of another system"),
        ({"plane": Slice(Coordinate.X, THIRD_EXIT)}, "must be on a slice of one potential"),
    ],
)
def test_a_sweep_that_is_not_defined_is_refused(change: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        replace(ALONG, **change)


def test_islands_are_the_connected_parts_of_the_bounded_starts() -> None:
    # Below the escape energy all starts are bounded: one island, the disc of radius √(2h) of case I at small energies.
    spec = CurvesSpec(CASES["I"], Plane.X_PX, (0.02, 0.13), (100, 100), 1000.0, exponent=False)
    disc, several = compute_curves(spec).points
    assert disc.islands == 1
    assert disc.bounded_area == disc.largest_island == pytest.approx(np.pi * 0.04, rel=0.02)
    assert several.islands > 1
    assert several.largest_island < several.bounded_area
    assert several.bounded_low < several.shares[0] < several.bounded_high


def test_plane_x_h_is_refused() -> None:
    with pytest.raises(ValueError, match="plane"):
        CurvesSpec(CASES["I"], Plane.X_H, (0.2,))


def test_cancel_raises() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        compute_curves(CurvesSpec(CASES["III"], Plane.X_PX, (0.26, 0.27)), execution=Execution(cancel=cancel))
