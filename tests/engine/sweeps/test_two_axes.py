"""Sweeps along a parameter at several energies have two axes, and are stored, resumed and drawn like others."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from engine import (
    CASES,
    Execution,
    ParameterAxis,
    Plane,
    SweepSpec,
    compute_basin_entropy,
    compute_map,
    compute_sweep,
    open_result,
    plan_sweep,
)

ENERGIES = (0.15, 0.2, 0.25)
SPEC = SweepSpec(
    CASES["I"], Plane.X_PX, (0.8, 1.0, 1.2), (16, 12), (-0.8, 0.8, -0.8, 0.8), t_max=100.0,
    measures=("shares", "basin_entropy", "maps"), along=ParameterAxis("epsilon", 0.8, 1.2, CASES["I"]), energy=ENERGIES,
)  # fmt: skip


@pytest.fixture(scope="module")
def plate_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("plate") / "plate.nc"
    compute_sweep(SPEC).save(path)
    return path


def test_each_cell_is_the_map_of_its_parameter_and_energy() -> None:
    plate = compute_sweep(SPEC)
    assert plate.axes == ("epsilon", "h")
    assert plate["s_b"].shape == (3, 3)
    assert plate["share"].shape == (3, 3, 3)
    for number, energy in enumerate(ENERGIES):
        line = compute_sweep(replace(SPEC, energy=energy))
        for name in ("s_b", "share", "fate"):
            np.testing.assert_array_equal(plate[name][:, number], line[name])
    escapes = compute_map(SPEC.point(1.2, 0.25).map_spec)
    np.testing.assert_array_equal(plate["fate"][2, 2], escapes.fate)


def test_a_map_of_a_cell_can_be_measured(plate_file: Path) -> None:
    dataset = open_result(plate_file).to_xarray()
    cell = dataset.sel(epsilon=1.0, h=0.2)
    assert compute_basin_entropy(cell).s_b == pytest.approx(float(cell["s_b"]), nan_ok=True)


def test_a_table_has_a_row_for_each_cell() -> None:
    table = compute_sweep(SPEC).to_pandas()
    assert table[["epsilon", "h"]].to_numpy().tolist() == [[epsilon, h] for epsilon in SPEC.values for h in ENERGIES]
    assert {"share_exit_1", "s_b"} <= set(table)


def test_a_file_is_opened_and_continued(plate_file: Path) -> None:
    plate = compute_sweep(SPEC)
    opened = open_result(plate_file, type(plate))
    assert opened.identical(plate)
    fewer = compute_sweep(replace(SPEC, values=(0.8, 1.2)), earlier=opened)
    np.testing.assert_array_equal(fewer["s_b"], plate["s_b"][[0, 2]])
    with pytest.raises(ValueError, match=r"^earlier: holds another request, with energy="):
        compute_sweep(replace(SPEC, energy=(0.15, 0.2)), earlier=opened)


def test_an_interrupted_store_is_resumed(tmp_path: Path) -> None:
    cancel, finished = threading.Event(), []

    def stop(_frame: object) -> None:
        cancel.set()

    with pytest.raises(CancelledError):
        compute_sweep(SPEC, tmp_path / "plate.zarr", on_frame=stop, execution=Execution(cancel=cancel))
    resumed = compute_sweep(SPEC, tmp_path / "plate.zarr", on_frame=lambda frame: finished.append(frame.values.size))
    assert finished == [2, 3]
    np.testing.assert_array_equal(resumed["fate"], compute_sweep(SPEC)["fate"])


def test_values_are_refined_where_shares_change_most_at_any_energy() -> None:
    refined = compute_sweep(replace(SPEC, measures=("shares",), refine=1))
    changes = np.abs(np.diff(compute_sweep(SPEC)["share"], axis=0)).max(axis=(1, 2))
    assert refined.values.size == 4
    assert refined.values[1 + int(np.argmax(changes))] == pytest.approx((0.9, 1.1)[int(np.argmax(changes))])


def test_the_plan_counts_all_cells() -> None:
    assert plan_sweep(SPEC).orbits == 9 * 16 * 12


def test_a_measure_is_drawn_as_an_image_with_numbers() -> None:
    plate = compute_sweep(SPEC)
    drawing = plate.plot(Figure().subplots(), measure="basin_entropy", colorbar=True)
    assert drawing.image is not None
    np.testing.assert_array_equal(np.ma.filled(drawing.image.get_array(), np.nan), plate["s_b"].T)
    assert (drawing.ax.get_xlabel(), drawing.ax.get_ylabel()) == ("ε", "h")
    shares = plate.plot(Figure().subplots(), outcome=2, cmap="magma", norm=LogNorm(0.01, 1.0)).image
    assert shares is not None
    np.testing.assert_array_equal(np.ma.filled(shares.get_array(), np.nan), plate["share"][..., 2].T)
    with pytest.raises(ValueError, match=r"^outcome=3: must be a number from 0 to 2$"):
        plate.plot(Figure().subplots(), outcome=3)
    with pytest.raises(ValueError, match=r"^measure='wada': must be one of shares, basin_entropy$"):
        plate.plot(Figure().subplots(), measure="wada")
    assert len(plate.to_holoviews()) == 9


@pytest.mark.parametrize("energy", [(), (0.2, float("inf")), "ab"])
def test_wrong_energies_are_refused(energy: object) -> None:
    with pytest.raises(ValueError, match=r"^energy="):
        replace(SPEC, energy=energy)
