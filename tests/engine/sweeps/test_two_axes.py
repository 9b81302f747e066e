"""Sweeps along a pair of axes have a map for each pair of values, and are stored, resumed and drawn like others."""

from __future__ import annotations

import threading
from concurrent.futures import CancelledError
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from engine import (
    CASES,
    POTENTIALS,
    Execution,
    MapSpec,
    ParameterAxis,
    Plane,
    SweepSpec,
    compute_basin_entropy,
    compute_map,
    compute_sweep,
    open_result,
    plan_sweep,
)
from engine.results import Sweep
from tests.engine.slices.test_parameter_family import THIRD_EXIT

WINDOW = (-0.8, 0.8, -0.8, 0.8)
MEASURES = ("shares", "escape_times", "basin_entropy", "maps")
EPSILON = ParameterAxis("epsilon", 0.8, 1.2, CASES["I"])
ENERGIES = (0.15, 0.2, 0.25)
BY_ENERGY = SweepSpec(
    CASES["I"], Plane.X_PX, ((0.8, 1.0, 1.2), ENERGIES), (16, 12), WINDOW, 100.0, measures=MEASURES, along=(EPSILON, "h")
)
BY_PARAMETERS = SweepSpec(
    CASES["I"], Plane.X_PX, ((0.9, 1.0, 1.1), (0.8, 1.0, 1.2)), (16, 12), WINDOW, 100.0, measures=MEASURES,
    along=(ParameterAxis("omega_1", 0.9, 1.1, CASES["I"]), EPSILON), energy=0.25,
)  # fmt: skip
MASS_RATIO = ParameterAxis("m", 0.01, 0.02, POTENTIALS["Earth-Moon"])
BY_JACOBI = SweepSpec(
    POTENTIALS["Earth-Moon"], Plane.X_PX, ((0.01, 0.0125), (3.12, 3.17)), (16, 12), measures=MEASURES[:3],
    along=(MASS_RATIO, "jacobi"),
)  # fmt: skip
PLATES = pytest.mark.parametrize("plate", [BY_ENERGY, BY_PARAMETERS, BY_JACOBI], ids=["energy", "parameters", "jacobi"])


def column(plate: SweepSpec, value: float) -> SweepSpec:
    """Return the sweep along the first axis, a parameter, at a value on the second axis, which is h or a parameter."""
    first, second = plate.axes
    assert isinstance(first, ParameterAxis)
    values, _ = plate.axis_values
    if not isinstance(second, ParameterAxis):
        return replace(plate, values=values, along=first, energy=value)
    system = second.system.with_parameter(second.key, value)
    return replace(plate, potential=system.potential, values=values, along=replace(first, system=system))


@pytest.fixture(scope="module")
def whole() -> Sweep:
    return compute_sweep(BY_PARAMETERS)


@pytest.mark.parametrize("plate", [BY_ENERGY, BY_PARAMETERS], ids=["energy", "parameters"])
def test_a_column_is_the_sweep_along_one_axis(plate: SweepSpec) -> None:
    found = compute_sweep(plate)
    assert found.axes == tuple(axis.key for axis in plate.axes)
    for number, value in enumerate(plate.axis_values[1]):
        line = compute_sweep(column(plate, value)).dataset
        for name, variable in line.data_vars.items():
            assert found.dataset[name].dims == (*found.axes, *variable.dims[1:])
            np.testing.assert_array_equal(found.dataset[name][:, number], variable, err_msg=str(name))


def test_the_order_of_the_axes_transposes_the_plate(whole: Sweep) -> None:
    first, second = BY_PARAMETERS.axis_values
    turned = compute_sweep(replace(BY_PARAMETERS, values=(second, first), along=BY_PARAMETERS.axes[::-1]))
    assert turned.axes == whole.axes[::-1]
    np.testing.assert_array_equal(turned["fate"], whole["fate"].swapaxes(0, 1))
    np.testing.assert_allclose(turned["mean_escape_time"], whole["mean_escape_time"].T, rtol=1e-12)


def test_a_jacobi_constant_is_converted_in_the_potential_of_each_mass_ratio() -> None:
    found = compute_sweep(BY_JACOBI)
    for i, mass in enumerate(BY_JACOBI.axis_values[0]):
        potential = MASS_RATIO.potential(mass)
        for j, constant in enumerate(BY_JACOBI.axis_values[1]):
            energy = float(potential.jacobi_energy(constant))
            escapes = compute_map(MapSpec(potential, Plane.X_PX, energy, (16, 12)))
            shares = [escapes.fractions()[fate] for fate in range(len(escapes.outcomes) + 1)]
            np.testing.assert_allclose(found["share"][i, j], shares, rtol=1e-12)


def test_energies_from_jacobi_constants_make_one_axis() -> None:
    potential = POTENTIALS["Hill"]
    constants = (4.2, 4.3)
    by_constant = SweepSpec(potential, Plane.X_PX, constants, (16, 12), t_max=20.0, along="jacobi")
    energies = [float(potential.jacobi_energy(constant)) for constant in constants]
    found, wanted = compute_sweep(by_constant), compute_sweep(replace(by_constant, values=energies, along=None))
    # The energy decreases as the constant increases.
    np.testing.assert_array_equal(found["fate"], wanted["fate"][::-1])
    np.testing.assert_array_equal(found["x"], wanted["x"])


def test_a_sweep_in_a_rotating_frame_is_continued_at_other_energies() -> None:
    spec = SweepSpec(POTENTIALS["Hill"], Plane.X_PX, (-2.1, -2.0), (16, 12), t_max=20.0, measures=("shares",))
    more = replace(spec, values=(-2.1, -2.0, -1.9))
    xr.testing.assert_identical(compute_sweep(more, earlier=compute_sweep(spec)).dataset, compute_sweep(more).dataset)


@pytest.mark.parametrize("first", ["b", "omega_1"])
def test_exits_keep_their_numbers_along_both_parameters(first: str) -> None:
    values = {"b": (-0.5, 0.1), "omega_1": (1.05,)}
    axes = {"b": THIRD_EXIT, "omega_1": ParameterAxis("omega_1", 0.9, 1.1, THIRD_EXIT.system)}
    second = ({*values} - {first}).pop()
    spec = SweepSpec(
        THIRD_EXIT.system.potential, Plane.X_Y, (values[first], values[second]), (12, 12), WINDOW, 50.0, measures=("shares",),
        along=(axes[first], axes[second]), energy=0.2,
    )  # fmt: skip
    numbers = [spec.point(*((b, 1.05) if first == "b" else (1.05, b))).numbers for b in values["b"]]
    # Counterclockwise: above, at the left for b < 0 only, below.
    assert numbers == [(0, 1, 3, 2), (0, 1, 2)]
    assert [outcome.label for outcome in spec.outcomes] == ["exit 1", "exit 2", "exit 3"]


def test_a_map_of_a_cell_can_be_measured(whole: Sweep, tmp_path: Path) -> None:
    whole.save(tmp_path / "plate.nc")
    cell = open_result(tmp_path / "plate.nc").to_xarray().sel(omega_1=1.0, epsilon=0.8)
    assert compute_basin_entropy(cell).s_b == pytest.approx(float(cell["s_b"]), nan_ok=True)


def test_a_table_has_a_row_for_each_cell(whole: Sweep) -> None:
    table = whole.to_pandas()
    first, second = BY_PARAMETERS.axis_values
    assert table[["omega_1", "epsilon"]].to_numpy().tolist() == [[one, other] for one in first for other in second]
    assert {"share_exit_1", "s_b"} <= set(table)


@PLATES
def test_a_file_is_opened_and_continued(plate: SweepSpec, tmp_path: Path) -> None:
    found = compute_sweep(plate)
    found.save(tmp_path / "plate.nc")
    opened = open_result(tmp_path / "plate.nc", Sweep)
    assert opened.identical(found)
    first, second = plate.axis_values
    fewer = compute_sweep(replace(plate, values=(first[::2], second)), earlier=opened)
    np.testing.assert_array_equal(fewer["s_b"], found["s_b"][::2])
    with pytest.raises(ValueError, match=rf"^earlier: holds another request, with {plate.axes[1].key}_values="):
        compute_sweep(replace(plate, values=(first, second[:1])), earlier=opened)


@PLATES
def test_an_interrupted_store_is_resumed(plate: SweepSpec, tmp_path: Path) -> None:
    cancel, finished = threading.Event(), []
    with pytest.raises(CancelledError):
        compute_sweep(plate, tmp_path / "parts.zarr", on_frame=lambda _: cancel.set(), execution=Execution(cancel=cancel))
    resumed = compute_sweep(plate, tmp_path / "parts.zarr", on_frame=lambda frame: finished.append(frame.values.size))
    assert finished == list(range(2, len(plate.axis_values[0]) + 1))
    xr.testing.assert_identical(resumed.dataset.load(), compute_sweep(plate, tmp_path / "whole.zarr").dataset.load())
    xr.testing.assert_equal(resumed.dataset, compute_sweep(plate).dataset)


def test_a_dask_cluster_computes_the_same_store(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    options = {"protocol": "tcp", "host": "127.0.0.1", "dashboard_address": "127.0.0.1:0", "processes": False}
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, **options) as cluster, distributed.Client(cluster) as client:
        spread = compute_sweep(BY_PARAMETERS, tmp_path / "cluster.zarr", execution=Execution(client.get_executor()))
    alone = compute_sweep(BY_PARAMETERS, tmp_path / "alone.zarr")
    xr.testing.assert_identical(spread.dataset.load(), alone.dataset.load())


def test_values_are_refined_where_shares_change_most_on_the_second_axis(whole: Sweep) -> None:
    refined = compute_sweep(replace(BY_PARAMETERS, measures=("shares",), refine=1))
    changes = np.abs(np.diff(whole["share"], axis=0)).max(axis=(1, 2))
    assert refined.values.size == 4
    assert refined.values[1 + int(np.argmax(changes))] == pytest.approx((0.95, 1.05)[int(np.argmax(changes))])


def test_the_plan_counts_all_cells() -> None:
    assert plan_sweep(BY_PARAMETERS).orbits == 9 * 16 * 12


def test_a_sentence_counts_the_values_on_both_axes(whole: Sweep) -> None:
    assert whole.describe() == "3 of 3 values of ω1, each at 3 values of ε, on (x, px)."


def test_a_measure_is_drawn_as_an_image_with_numbers(whole: Sweep) -> None:
    drawing = whole.plot(Figure().subplots(), measure="basin_entropy", colorbar=True)
    assert drawing.image is not None
    np.testing.assert_array_equal(np.ma.filled(drawing.image.get_array(), np.nan), whole["s_b"].T)
    assert (drawing.ax.get_xlabel(), drawing.ax.get_ylabel()) == ("ω1", "ε")
    assert drawing.ax.get_xlim() == pytest.approx((0.85, 1.15))
    assert drawing.ax.get_ylim() == pytest.approx((0.7, 1.3))
    shares = whole.plot(Figure().subplots(), outcome=2, cmap="magma", norm=LogNorm(0.01, 1.0)).image
    assert shares is not None
    np.testing.assert_array_equal(np.ma.filled(shares.get_array(), np.nan), whole["share"][..., 2].T)
    with pytest.raises(ValueError, match=r"^outcome=3: must be an integer from 0 to 2$"):
        whole.plot(Figure().subplots(), outcome=3)
    with pytest.raises(ValueError, match=r"^measure='wada': must be one of shares, escape_times, basin_entropy$"):
        whole.plot(Figure().subplots(), measure="wada")
    assert len(whole.to_holoviews()) == 9


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"values": (0.8, 1.2)}, r"values\[0\]=0.8: must be a sequence of finite numbers"),
        ({"values": ((0.8, 1.2),)}, r"values=\(\(0.8, 1.2\),\): must be a pair of sequences along a pair of axes"),
        ({"values": ((0.8, 1.2), ())}, r"values\[1\]=\(\): must be 1 to 10000 different numbers"),
        ({"along": (EPSILON, EPSILON)}, "along=.*: must be one axis, or a pair of different axes"),
        (
            {"along": ("h", "jacobi")},
            "along=.*: must be one axis, or a pair of different axes of which at most one is h or jacobi",
        ),
        ({"along": ()}, r"along=\(\): must be one axis"),
        ({"along": (EPSILON, MASS_RATIO)}, "along=.*: both parameters must be of the same system"),
        ({"along": (EPSILON, "h")}, "energy=0.25: must be given along parameters alone"),
        ({"along": (EPSILON, "jacobi"), "energy": None}, ".*rotat"),
    ],
)
def test_wrong_axes_and_values_are_refused(changes: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=f"^{message}"):
        replace(BY_PARAMETERS, **changes)  # type: ignore[arg-type]
