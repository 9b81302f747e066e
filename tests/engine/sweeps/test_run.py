"""Sweeps over energies: contents of the store, resuming, row blocks, disk errors, clusters and plans."""

from __future__ import annotations

import itertools
import os
import resource
import shutil
import signal
import sys
import threading
import tracemalloc
from collections.abc import Callable, Iterator
from concurrent.futures import CancelledError, Executor
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import xarray as xr

import engine.sweeps.run
from engine import CASES, EscapeMap, MapSpec, Plane, SweepSpec, Window, compute_map, run_sweep
from engine.execution import SerialExecutor, count_workers
from engine.service import SweepPlan, plan_sweep
from engine.slices.default_window import default_window
from tests.forked import Finished, run

ARRAYS = ("fate", "escape_time", "crossings", "certificate", "outside", "energy_error")
SPEC = SweepSpec(CASES["III"], Plane.X_PX, (0.4, 0.3, 0.5), (12, 10), t_max=300.0)
# Long enough for all kinds of certificates; in 4 row blocks at each of two energies.
LONG_SPEC = SweepSpec(CASES["III"], Plane.X_PX, (0.36, 0.4), (15, 15), t_max=2e4, piece=80)


def run_in_child(folder: Path, name: str, killed_in: int = 0) -> Finished:
    """Run `LONG_SPEC` in a child process that is killed during its n-th block; its stdout names the blocks that it starts.

    A bitwise comparison needs the same machine code in both runs: kernels that this process has compiled itself may differ in
    rounding from those that a child loads from the cache.
    """
    return run(folder, run_and_die, folder / name, killed_in)


def run_and_die(store: Path, killed_in: int) -> None:
    compute_block, numbers = engine.sweeps.run._compute_block, itertools.count(1)

    def announced(spec: MapSpec, rows: np.ndarray, *arguments: Any) -> EscapeMap:
        sys.stdout.write(f"{spec.energy} {rows[0]}\n")
        sys.stdout.flush()
        block = compute_block(spec, rows, *arguments)
        if next(numbers) == killed_in:
            os.kill(os.getpid(), signal.SIGKILL)
        return block

    engine.sweeps.run._compute_block = announced
    run_sweep(LONG_SPEC, store)


@pytest.fixture
def computed(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Energies of the computed maps, in order."""
    energies: list[float] = []

    def counted(spec: MapSpec, *arguments: Any) -> EscapeMap:
        assert not isinstance(spec.energy, tuple)
        energies.append(spec.energy)
        return compute_map(spec, *arguments)

    monkeypatch.setattr(engine.sweeps.run, "compute_map", counted)
    return energies


@pytest.fixture
def computed_blocks(monkeypatch: pytest.MonkeyPatch) -> list[tuple[float, int]]:
    """Energy and first row of the computed row blocks, in order."""
    blocks: list[tuple[float, int]] = []
    compute_block = engine.sweeps.run._compute_block

    def counted(spec: MapSpec, rows: np.ndarray, *arguments: Any) -> EscapeMap:
        assert not isinstance(spec.energy, tuple)
        blocks.append((spec.energy, int(rows[0])))
        return compute_block(spec, rows, *arguments)

    monkeypatch.setattr(engine.sweeps.run, "_compute_block", counted)
    return blocks


@pytest.fixture(scope="module")
def straight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The store of `LONG_SPEC`, computed by a child process without interruption."""
    folder = tmp_path_factory.mktemp("straight")
    assert run_in_child(folder, "store").code == 0
    return folder / "store"


def stored_blocks(store: Path) -> list[str]:
    return sorted(str(path.relative_to(store / "under_way")) for path in (store / "under_way").rglob("*.npz"))


def bytes_of(dataset: xr.Dataset) -> dict[str, bytes]:
    return {name: dataset[name].to_numpy().tobytes() for name in ARRAYS}


def marks(store: Path) -> list[Path]:
    return sorted((store / "done" / "c").glob("[0-9]*"))


def files_of(store: Path) -> dict[str, bytes]:
    return {str(path.relative_to(store)): path.read_bytes() for path in store.rglob("*") if path.is_file()}


def limit_block_size(monkeypatch: pytest.MonkeyPatch, starts: int) -> None:
    for module in ("maps.compute", "sweeps.run"):
        monkeypatch.setattr(f"engine.{module}.LARGEST_RUN", starts)


def stacked_maps(spec: SweepSpec) -> xr.Dataset:
    maps = [compute_map(spec.map_spec(h)).to_xarray() for h in spec.energies]
    return xr.concat(maps, xr.DataArray(list(spec.energies), dims="h", name="h"), combine_attrs="drop_conflicts", join="exact")


def cancel_at(share: float) -> tuple[threading.Event, Callable[[float], None]]:
    """A cancel event, and a progress callback that sets it at the given fraction."""
    cancel = threading.Event()
    return cancel, lambda progress: cancel.set() if progress >= share else None


class TestRequest:
    def test_energies_are_sorted_and_made_unique(self) -> None:
        assert replace(SPEC, energies=(0.5, 0.3, 0.4, 0.3)).energies == (0.3, 0.4, 0.5)

    @pytest.mark.parametrize(
        ("change", "message"),
        [
            ({"energies": ()}, "energies: 0 different"),
            ({"energies": (0.3, np.nan)}, "energies: 2 different"),
            ({"energies": np.linspace(0.3, 0.4, 10_001)}, "energies: 10001 different"),
            ({"energies": 0.3}, "energies=0.3"),
            ({"plane": Plane.X_H}, r"plane=\(x, h\)"),
            ({"t_max": 0.0}, "t_max=0"),
            ({"resolution": (0, 5)}, "resolution"),
            ({"window": (1.0, 0.0, 0.0, 1.0)}, "window"),
            ({"piece": 0}, "piece=0"),
            ({"piece": 2**20 + 1}, "piece=1048577"),
            ({"piece": 80.5}, "piece=80.5"),
        ],
    )
    def test_invalid_parameters_are_named(self, change: dict[str, Any], message: str) -> None:
        with pytest.raises(ValueError, match=message):
            replace(SPEC, **change)

    @pytest.mark.parametrize("plane", [Plane.X_Y, Plane.X_PX])
    @pytest.mark.parametrize(("case", "highest"), [("I", 0.5), ("II", 0.5), ("III", 1.0)])
    def test_window_of_the_highest_energy_contains_all_others(self, case: str, highest: float, plane: Plane) -> None:
        potential = CASES[case]
        energies = tuple(np.linspace(0.4 * potential.escape_energy, highest, 15))
        window = SweepSpec(potential, plane, energies).map_spec(highest).find_window()
        for h in energies:
            inner = default_window(potential, plane, h)
            assert window.x_low <= inner.x_low < inner.x_high <= window.x_high
            assert window.ordinate_low <= inner.ordinate_low < inner.ordinate_high <= window.ordinate_high

    def test_energy_without_exits_is_refused_before_writing(self, tmp_path: Path) -> None:
        spec = replace(SPEC, window=Window(-1.0, 1.0, -1.0, 1.0), energies=(0.3, 20.0))
        with pytest.raises(ValueError, match="no Lyapunov orbit"):
            run_sweep(spec, tmp_path / "store")
        assert not any(tmp_path.iterdir())


class TestStore:
    @pytest.mark.parametrize("spec", [SPEC, SweepSpec(CASES["I"], Plane.X_Y, (0.1, 0.2), (9, 14), t_max=100.0)])
    def test_netcdf_equals_the_stacked_maps(self, tmp_path: Path, spec: SweepSpec) -> None:
        run_sweep(spec, tmp_path / "store").to_netcdf(tmp_path / "sweep.nc", engine="h5netcdf")
        expected = stacked_maps(spec)
        with xr.open_dataset(tmp_path / "sweep.nc", engine="h5netcdf") as found:
            assert found["fate"].dims == ("h", *spec.plane.axis_names[::-1])
            assert set(found.data_vars) == set(ARRAYS)
            for name in (*ARRAYS, *expected.coords):
                np.testing.assert_array_equal(found[name], expected[name])
                assert found[name].dtype == expected[name].dtype
            for name in ARRAYS:
                assert {**found[name].attrs} == {**expected[name].attrs}

    def test_attributes_hold_the_provenance(self, tmp_path: Path) -> None:
        attributes = run_sweep(SPEC, tmp_path / "store").attrs
        for name, value in SPEC.map_spec(0.5).provenance().items():
            if name != "energy":
                assert attributes[name] == (list(value) if isinstance(value, tuple) else value)
        assert "energy" not in attributes

    def test_arrays_are_read_lazily(self, tmp_path: Path) -> None:
        dataset = run_sweep(SPEC, tmp_path / "store")
        shutil.rmtree(tmp_path / "store" / "fate")
        assert not dataset["fate"]._in_memory

    def test_chunks_have_the_height_of_row_blocks(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        whole = bytes_of(run_sweep(SPEC, tmp_path / "whole"))
        limit_block_size(monkeypatch, 48)
        assert bytes_of(run_sweep(SPEC, tmp_path / "blocks")) == whole
        assert len(list((tmp_path / "blocks" / "fate" / "c" / "0").iterdir())) == 3

    @pytest.mark.parametrize(
        ("change", "name"),
        [
            ({"t_max": 301.0}, "t_max"),
            ({"potential": CASES["I"]}, "potential"),
            ({"plane": Plane.X_Y}, "plane"),
            ({"resolution": (12, 11)}, "resolution"),
            ({"window": Window(-1.0, 1.0, -1.0, 1.0)}, "window"),
            ({"certify": False}, "certify"),
            ({"piece": 60}, "piece"),
            ({"energies": (0.3, 0.41, 0.5)}, "values of h"),
        ],
    )
    def test_store_of_another_request_is_refused(self, tmp_path: Path, change: dict[str, Any], name: str) -> None:
        run_sweep(SPEC, tmp_path / "store")
        before = files_of(tmp_path / "store")
        with pytest.raises(ValueError, match=name):
            run_sweep(replace(SPEC, **change), tmp_path / "store")
        assert files_of(tmp_path / "store") == before

    def test_folder_with_other_files_is_refused(self, tmp_path: Path) -> None:
        (tmp_path / "thesis.tex").touch()
        with pytest.raises(ValueError, match="holds other files"):
            run_sweep(SPEC, tmp_path)

    def test_empty_folder_is_accepted(self, tmp_path: Path) -> None:
        run_sweep(SPEC, tmp_path)
        assert len(marks(tmp_path)) == 3


class TestResuming:
    def test_finished_energies_are_not_recomputed(self, tmp_path: Path, computed: list[float]) -> None:
        cancel, on_progress = cancel_at(1 / 3)
        with pytest.raises(CancelledError):
            run_sweep(SPEC, tmp_path / "store", on_progress=on_progress, cancel=cancel)
        assert len(marks(tmp_path / "store")) == 1
        computed.clear()
        run_sweep(SPEC, tmp_path / "store")
        run_sweep(SPEC, tmp_path / "store")
        assert computed == [0.4, 0.5]

    def test_resumed_run_is_byte_identical(self, tmp_path: Path) -> None:
        cancel, on_progress = cancel_at(0.4)
        with pytest.raises(CancelledError):
            run_sweep(SPEC, tmp_path / "store", on_progress=on_progress, cancel=cancel)
        run_sweep(SPEC, tmp_path / "store")
        run_sweep(SPEC, tmp_path / "straight")
        assert files_of(tmp_path / "store") == files_of(tmp_path / "straight")

    def test_unmarked_arrays_are_overwritten(self, tmp_path: Path, computed: list[float]) -> None:
        store = tmp_path / "store"
        run_sweep(SPEC, store)
        whole = files_of(store)
        marks(store)[1].unlink()
        chunk = store / "fate" / "c" / "1" / "0" / "0"
        chunk.write_bytes(chunk.read_bytes()[:7])
        computed.clear()
        run_sweep(SPEC, store)
        assert files_of(store) == whole
        assert computed == [0.4]

    def test_progress_ascends_from_0_to_1(self, tmp_path: Path) -> None:
        seen: list[float] = []
        run_sweep(SPEC, tmp_path / "store", on_progress=seen.append)
        assert seen == sorted(seen)
        assert seen[0] == 0.0
        assert seen[-1] == 1.0


class TestRowBlocks:
    @pytest.mark.parametrize("plane", [Plane.X_Y, Plane.X_PX])
    def test_result_equals_compute_map_in_blocks(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, plane: Plane) -> None:
        limit_block_size(monkeypatch, 100)
        spec = SweepSpec(CASES["III"], plane, (0.4,), (20, 19), t_max=2e4)
        found, expected = run_sweep(spec, tmp_path / "store"), stacked_maps(spec)
        for name in ARRAYS:
            np.testing.assert_array_equal(found[name], expected[name])
        assert np.unique(found["certificate"]).size >= 3

    def test_smaller_blocks_do_not_change_escaping_orbits(self, tmp_path: Path) -> None:
        found, expected = run_sweep(LONG_SPEC, tmp_path / "store").load(), stacked_maps(replace(LONG_SPEC, piece=None))
        for name in ("fate", "escape_time", "outside"):
            np.testing.assert_array_equal(found[name], expected[name])
        left = expected["fate"].to_numpy() >= 1
        assert 0 < np.count_nonzero(left) < left.size
        for name in ("crossings", "energy_error"):
            np.testing.assert_array_equal(found[name].to_numpy()[left], expected[name].to_numpy()[left])

    def test_block_size_has_no_effect_without_certificates(self, tmp_path: Path) -> None:
        whole = bytes_of(run_sweep(SPEC, tmp_path / "whole"))
        for piece in (1, 25, 119):
            assert bytes_of(run_sweep(replace(SPEC, piece=piece), tmp_path / str(piece))) == whole

    def test_finished_blocks_are_not_recomputed(self, tmp_path: Path, computed_blocks: list[tuple[float, int]]) -> None:
        spec = replace(SPEC, piece=48)
        cancel, on_progress = cancel_at(0.5)
        with pytest.raises(CancelledError):
            run_sweep(spec, tmp_path / "store", on_progress=on_progress, cancel=cancel)
        assert stored_blocks(tmp_path / "store") == ["1/0.npz", "1/1.npz"]
        del computed_blocks[:]
        run_sweep(spec, tmp_path / "store")
        assert computed_blocks == [(0.4, 4), (0.5, 0), (0.5, 2), (0.5, 4)]
        run_sweep(spec, tmp_path / "straight")
        assert files_of(tmp_path / "store") == files_of(tmp_path / "straight")

    @pytest.mark.parametrize(
        ("killed_in", "first", "rest"),
        [
            pytest.param(
                *(3, ["0.36 0", "0.36 2", "0.36 4"], ["0.36 4", "0.36 6", "0.4 0", "0.4 2", "0.4 4", "0.4 6"]),
                marks=pytest.mark.slow,
            ),
            (7, ["0.36 0", "0.36 2", "0.36 4", "0.36 6", "0.4 0", "0.4 2", "0.4 4"], ["0.4 4", "0.4 6"]),
        ],
        ids=["first energy", "second energy"],
    )
    def test_killed_run_resumes_byte_identically(
        self, tmp_path: Path, straight: Path, killed_in: int, first: list[str], rest: list[str]
    ) -> None:
        killed = run_in_child(tmp_path, "store", killed_in)
        assert (killed.code, killed.out.splitlines()) == (-signal.SIGKILL, first)
        store = tmp_path / "store"
        assert len(stored_blocks(store)) == 2
        kept = {path: path.stat().st_mtime_ns for path in marks(store)}
        resumed = run_in_child(tmp_path, "store")
        assert (resumed.code, resumed.out.splitlines()) == (0, rest)
        assert {path: path.stat().st_mtime_ns for path in kept} == kept
        assert files_of(store) == files_of(straight)

    def test_run_killed_while_joining_blocks_recomputes_none(
        self, tmp_path: Path, computed_blocks: list[tuple[float, int]], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        spec, store = replace(SPEC, energies=(0.4,), piece=48), tmp_path / "store"

        def killed(_store: object, name: str, place: int) -> None:
            if name == "crossings":
                (store / name / "c" / str(place) / "0" / "0.0123.partial").write_bytes(b"half")
                raise KeyboardInterrupt

        with monkeypatch.context() as patch:
            patch.setattr("engine.sweeps.zarr_store.SweepStore._sync_to_disk", killed)
            with pytest.raises(KeyboardInterrupt):
                run_sweep(spec, store)
        assert not marks(store)
        del computed_blocks[:]
        run_sweep(spec, store)
        assert not computed_blocks
        run_sweep(spec, tmp_path / "straight")
        assert files_of(store) == files_of(tmp_path / "straight")

    def test_checkpoints_of_finished_energies_are_deleted(self, tmp_path: Path) -> None:
        spec, store = replace(SPEC, piece=48), tmp_path / "store"
        run_sweep(spec, store)
        whole = files_of(store)
        (store / "under_way" / "2").mkdir()
        (store / "under_way" / "2" / "0.npz").write_bytes(b"obsolete")
        run_sweep(spec, store)
        assert files_of(store) == whole

    def test_store_with_checkpoints_is_valid_zarr(self, tmp_path: Path) -> None:
        cancel, on_progress = cancel_at(0.1)
        with pytest.raises(CancelledError):
            run_sweep(replace(SPEC, piece=48), tmp_path / "store", on_progress=on_progress, cancel=cancel)
        assert stored_blocks(tmp_path / "store") == ["0/0.npz"]
        with xr.open_zarr(tmp_path / "store", chunks=None, consolidated=False) as found:
            assert not found["done"].any()

    def test_memory_is_bounded_by_a_block(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        limit_block_size(monkeypatch, 2000)
        spec = SweepSpec(CASES["III"], Plane.X_PX, (0.4,), (300, 300), t_max=0.5)
        run_sweep(replace(spec, resolution=(30, 30)), tmp_path / "first")
        tracemalloc.start()
        whole = run_sweep(spec, tmp_path / "store")
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < 0.5 * sum(whole[name].nbytes for name in ARRAYS)


class TestFailingDisk:
    @pytest.fixture
    def small_files(self) -> Iterator[SimpleNamespace]:
        """After `full` is called, writing more than 8 bytes to a file raises an OSError."""
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        yield SimpleNamespace(full=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (8, limits[1])))
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)

    def test_finished_energies_survive_a_full_disk(
        self, tmp_path: Path, small_files: SimpleNamespace, computed: list[float]
    ) -> None:
        straight = bytes_of(run_sweep(SPEC, tmp_path / "straight"))
        computed.clear()
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        with pytest.raises(OSError, match="too large"):
            run_sweep(SPEC, tmp_path / "store", on_progress=lambda share: small_files.full() if share > 1 / 3 else None)
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        assert len(marks(tmp_path / "store")) == 1
        assert computed == [0.3, 0.4]
        assert bytes_of(run_sweep(SPEC, tmp_path / "store")) == straight
        assert computed == [0.3, 0.4, 0.4, 0.5]

    def test_store_that_cannot_be_created_fails_before_computing(self, tmp_path: Path, computed: list[float]) -> None:
        (tmp_path / "file").touch()
        with pytest.raises(OSError, match="file"):
            run_sweep(SPEC, tmp_path / "file" / "store")
        assert not computed

    def test_read_only_store_fails_before_computing(
        self, tmp_path: Path, computed: list[float], monkeypatch: pytest.MonkeyPatch
    ) -> None:
        run_sweep(SPEC, tmp_path / "store")
        marks(tmp_path / "store")[0].unlink()
        computed.clear()

        def refused(*_arguments: object, **_named: object) -> None:
            raise PermissionError("read-only")

        monkeypatch.setattr("engine.sweeps.zarr_store.tempfile.TemporaryFile", refused)
        with pytest.raises(PermissionError):
            run_sweep(SPEC, tmp_path / "store")
        assert not computed


class TestCluster:
    def test_dask_workers_are_counted(self) -> None:
        client = SimpleNamespace(nthreads=lambda: {"tcp://a": 3, "tcp://b": 4})
        executor = SerialExecutor()
        executor._client = client  # type: ignore[attr-defined]
        assert count_workers(executor) == 7

    # Threads as workers, with messages as between processes; processes are in the long verification.
    @pytest.mark.parametrize("processes", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["threads", "processes"])
    def test_dask_cluster_is_byte_identical(self, tmp_path: Path, straight: Path, processes: bool) -> None:
        distributed = pytest.importorskip("distributed")
        cluster = distributed.LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            processes=processes,
            protocol="tcp",
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
        )
        with cluster, distributed.Client(cluster) as client:
            executor: Executor = client.get_executor()
            assert count_workers(executor) == 2
            spread = run_sweep(LONG_SPEC, tmp_path / "cluster", executor=executor)
        assert np.unique(spread["certificate"]).size >= 3
        if not processes:
            # The machine code of this process may differ from that in the cache.
            straight = tmp_path / "straight"
            run_sweep(LONG_SPEC, straight)
        assert files_of(tmp_path / "cluster") == files_of(straight)


class TestPlan:
    def test_plan_counts_starts_and_bytes(self, tmp_path: Path) -> None:
        plan = plan_sweep(SPEC, cores=3)
        assert plan.orbits == 3 * 12 * 10
        assert plan.cores == 3
        assert plan.bytes == sum(run_sweep(SPEC, tmp_path / "store")[name].nbytes for name in ARRAYS)

    def test_time_scales_with_pixels_and_cores(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setattr("engine.sweeps.run._measure_seconds", lambda spec, _cancel: 0.5 + 1e-4 * np.prod(spec.resolution))
        one = plan_sweep(replace(SPEC, resolution=(1000, 1000)), cores=1)
        many = plan_sweep(replace(SPEC, resolution=(1000, 1000)), cores=10)
        assert one.seconds == pytest.approx(3 * 100.5)
        assert many.seconds == pytest.approx(one.seconds / 10)

    def test_plan_uses_the_midpoints_of_twelve_intervals(self, monkeypatch: pytest.MonkeyPatch) -> None:
        seen: set[float] = set()

        def measured(spec: MapSpec, _cancel: object) -> float:
            seen.add(float(spec.energy))  # type: ignore[arg-type]
            return 1.0

        monkeypatch.setattr("engine.sweeps.run._measure_seconds", measured)
        plan_sweep(replace(SPEC, energies=tuple(np.linspace(0.0, 0.24, 241))))
        assert sorted(seen) == pytest.approx(np.arange(0.01, 0.24, 0.02), abs=0.001)

    def test_planning_can_be_cancelled(self) -> None:
        cancel = threading.Event()
        cancel.set()
        with pytest.raises(CancelledError):
            plan_sweep(SPEC, cancel=cancel)

    def test_cores_must_be_positive(self) -> None:
        with pytest.raises(ValueError, match="cores=0"):
            plan_sweep(SPEC, cores=0)

    def test_description(self) -> None:
        text = SweepPlan(10**9, 7200.0, 23 * 10**9, 16).describe()
        assert text == "1e+09 orbits: about 2 hours on 16 cores (32 core hours), at most 23 GB"
