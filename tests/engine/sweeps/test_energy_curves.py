"""Curves against energy: values at each energy, order of computation, dataset and validation."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError

import numpy as np
import pytest

from engine import (
    CASES,
    EnergyCurves,
    EnergyCurvesSpec,
    Fate,
    MapSpec,
    Plane,
    compute_energy_curves,
    compute_map,
    compute_statistics,
)
from engine.execution import Execution
from engine.service import EnergyPoint, EnergyPointSpec, compute_energy_point

SPEC = EnergyCurvesSpec(CASES["II"], Plane.X_PX, (0.3, 0.1, 0.2, 0.25, 0.2), (40, 40), 500.0, exponent=False)


@pytest.fixture(scope="module")
def curves() -> EnergyCurves:
    return compute_energy_curves(SPEC)


def test_energies_are_sorted_and_unique(curves: EnergyCurves) -> None:
    np.testing.assert_array_equal(curves.energies, [0.1, 0.2, 0.25, 0.3])
    assert curves.complete


def test_point_equals_the_statistics_of_its_map(curves: EnergyCurves) -> None:
    frame = compute_map(MapSpec(CASES["II"], Plane.X_PX, 0.25, (40, 40), t_max=500.0))
    statistics = compute_statistics(frame)
    index = curves.energies.tolist().index(0.25)
    np.testing.assert_allclose(curves.shares[index], [frame.fractions()[code] for code in range(4)], rtol=1e-12)
    assert curves.curve("mean_escape_time")[index] == statistics.mean_escape_time
    assert curves.curve("direct_share")[index] == statistics.direct_share


def test_below_the_escape_energy_all_orbits_are_bounded(curves: EnergyCurves) -> None:
    np.testing.assert_array_equal(curves.shares[0], [1.0, 0.0, 0.0, 0.0])
    assert curves.curve("s_b")[0] == 0.0
    assert np.isnan(curves.curve("mean_escape_time")[0])


def test_orbits_that_stay_on_a_symmetry_line_have_no_share() -> None:
    curves = compute_energy_curves(EnergyCurvesSpec(CASES["III"], Plane.X_Y, (0.6, 1.0), t_max=1e4, exponent=False))
    np.testing.assert_array_equal(curves.shares[:, Fate.BOUNDED], 0.0)


def test_median_escape_time_decreases_with_energy(curves: EnergyCurves) -> None:
    assert np.all(np.diff(curves.curve("median_escape_time")[1:]) < 0)


def test_frames_come_after_each_energy_from_coarse_to_fine() -> None:
    seen: list[list[float]] = []

    def measure(spec: EnergyPointSpec) -> EnergyPoint:
        assert not isinstance(spec.map_spec.energy, tuple)
        return EnergyPoint(spec.map_spec.energy, (1.0, 0.0, 0.0, 0.0), 0.0, 1.0, 1.0, 0.0, 0.0)

    spec = EnergyCurvesSpec(CASES["II"], Plane.X_PX, tuple(np.linspace(0.2, 0.4, 9)), exponent=False)
    compute_energy_curves(spec, on_frame=lambda frame: seen.append(frame.energies.tolist()), measure=measure)
    assert [len(energies) for energies in seen] == list(range(1, 10))
    np.testing.assert_allclose(seen[2], [0.2, 0.3, 0.4])
    np.testing.assert_allclose(seen[4], [0.2, 0.25, 0.3, 0.35, 0.4])


def test_exponent_is_computed_where_exits_are_open(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("engine.sweeps.energy_curves._WORK", 1e6)
    spec = EnergyCurvesSpec(CASES["III"], Plane.X_PX, (0.2, 0.6), (40, 40), 500.0)
    closed, opened = (compute_energy_point(spec.point(energy)) for energy in spec.energies)
    assert np.isnan(closed.exponent)
    assert opened.exponent_low < opened.exponent < opened.exponent_high


def test_dataset_has_all_curves(curves: EnergyCurves) -> None:
    dataset = curves.to_xarray()
    assert dataset["share"].dims == ("h", "fate")
    assert dataset["s_bb"].dims == ("h",)
    np.testing.assert_allclose(dataset["share"].sum("fate"), 1.0)
    assert dataset.attrs["plane"] == "(x, px)"


@pytest.mark.parametrize("energies", [(), (float("nan"),), tuple(range(2000))])
def test_invalid_energies_are_refused(energies: tuple[float, ...]) -> None:
    with pytest.raises(ValueError, match="energies"):
        EnergyCurvesSpec(CASES["I"], Plane.X_PX, energies)


def test_plane_x_h_is_refused() -> None:
    with pytest.raises(ValueError, match="plane"):
        EnergyCurvesSpec(CASES["I"], Plane.X_H, (0.2,))


def test_cancel_raises() -> None:
    cancel = threading.Event()
    cancel.set()
    with pytest.raises(CancelledError):
        compute_energy_curves(EnergyCurvesSpec(CASES["III"], Plane.X_PX, (0.26, 0.27)), execution=Execution(cancel=cancel))
