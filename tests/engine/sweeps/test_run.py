"""Sweeps over energies: contents of the store, resuming, row blocks, disk errors, clusters and plans."""

from __future__ import annotations

import itertools
import os
import shutil
import signal
import sys
import threading
import tracemalloc
from collections.abc import Callable
from concurrent.futures import CancelledError
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from engine import CASES, Fate, MapSpec, Plane, SweepPlan, SweepSpec, Window, compute_map, plan_sweep, run_sweep
from engine.execution import Execution, count_workers
from engine.slices.default_window import default_window
from tests.forked import Finished, run

ARRAYS = ("fate", "escape_time", "crossings", "certificate", "outside", "energy_error")
SPEC = SweepSpec(CASES["III"], Plane.X_PX, (0.4, 0.3, 0.5), (12, 10), t_max=300.0)
# Three row blocks at each energy: rows 0, 1, 8, 9, then 2, 3, 6, 7, then 4, 5.
IN_BLOCKS = replace(SPEC, piece=48)
# Long enough for all kinds of certificates; in 4 row blocks at each of two energies.
LONG_SPEC = SweepSpec(CASES["III"], Plane.X_PX, (0.36, 0.4), (15, 15), t_max=2e4, piece=80)


def run_in_child(folder: Path, name: str, killed_after: float = 1.0) -> Finished:
    """Run `LONG_SPEC` in a child process that is killed while it writes the next row block after some progress, if any.

    A bitwise comparison needs the same machine code in both runs: kernels that this process has compiled itself may differ in
    rounding from those that a child loads from the cache.
    """
    return run(folder, run_and_die, folder / name, killed_after)


def run_and_die(store: Path, killed_after: float) -> None:
    def on_progress(share: float) -> None:
        sys.stdout.write(f"{share}\n")
        sys.stdout.flush()
        if killed_after <= share < 1.0:
            interrupt_writing(4, lambda: os.kill(os.getpid(), signal.SIGKILL))

    run_sweep(LONG_SPEC, store, execution=Execution(on_progress=on_progress))


def interrupt_writing(number: int, interrupt: Callable[[], None]) -> None:
    """Call `interrupt` when the n-th file from now on is written to the disk."""
    fsync, written = os.fsync, itertools.count(1)

    def counted(fd: Any) -> None:
        if next(written) == number:
            interrupt()
        fsync(fd)

    os.fsync = counted


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The store of `SPEC`, not to be changed."""
    store = tmp_path_factory.mktemp("finished") / "store"
    run_sweep(SPEC, store)
    return store


@pytest.fixture(scope="module")
def straight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The store of `LONG_SPEC`, computed by a child process without interruption."""
    folder = tmp_path_factory.mktemp("straight")
    assert run_in_child(folder, "store").code == 0
    return folder / "store"


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


def progress_of(spec: SweepSpec, store: Path) -> list[float]:
    """Run a sweep and return its progress: the finished share at first, and after each row block."""
    seen: list[float] = []
    run_sweep(spec, store, execution=Execution(on_progress=seen.append))
    return seen


def run_until(spec: SweepSpec, store: Path, share: float) -> None:
    """Run a sweep that is cancelled at the given progress."""
    cancel = threading.Event()
    with pytest.raises(CancelledError):
        run_sweep(
            spec,
            store,
            execution=Execution(cancel=cancel, on_progress=lambda progress: cancel.set() if progress >= share else None),
        )


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

    def test_attributes_hold_the_provenance(self, finished: Path) -> None:
        attributes = run_sweep(SPEC, finished).attrs
        for name, value in SPEC.map_spec(0.5).provenance().items():
            if name != "energy":
                assert attributes[name] == (list(value) if isinstance(value, tuple) else value)
        assert "energy" not in attributes

    def test_arrays_are_read_on_access(self, tmp_path: Path) -> None:
        dataset = run_sweep(SPEC, tmp_path / "store")
        shutil.rmtree(tmp_path / "store" / "fate" / "c")
        assert (dataset["fate"] == Fate.NOT_COMPUTED).all()

    def test_unfinished_store_opens_with_its_finished_blocks(self, tmp_path: Path, finished: Path) -> None:
        """Without a warning, which would be an error."""
        run_until(IN_BLOCKS, tmp_path / "store", 1 / 9)
        with xr.open_zarr(tmp_path / "store") as found, xr.open_zarr(finished) as whole:
            assert not found["done"].any()
            assert whole["done"].all()
            rows = [0, 1, 8, 9]
            np.testing.assert_array_equal(found["fate"][0, rows], whole["fate"][0, rows])
            assert (found["fate"].drop_isel(px=rows) == Fate.NOT_COMPUTED).all()
            assert (found["fate"][1:] == Fate.NOT_COMPUTED).all()
            assert found["escape_time"][1:].isnull().all()

    def test_chunks_have_the_height_of_row_blocks(self, tmp_path: Path, finished: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        limit_block_size(monkeypatch, 48)
        assert bytes_of(run_sweep(SPEC, tmp_path / "blocks")) == bytes_of(xr.open_zarr(finished))
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
    def test_store_of_another_request_is_refused(self, finished: Path, change: dict[str, Any], name: str) -> None:
        before = files_of(finished)
        with pytest.raises(ValueError, match=name):
            run_sweep(replace(SPEC, **change), finished)
        assert files_of(finished) == before

    def test_folder_with_other_files_is_refused(self, tmp_path: Path) -> None:
        (tmp_path / "thesis.tex").touch()
        with pytest.raises(ValueError, match="holds other files"):
            run_sweep(SPEC, tmp_path)

    def test_empty_folder_is_accepted(self, tmp_path: Path, finished: Path) -> None:
        run_sweep(SPEC, tmp_path)
        assert files_of(tmp_path) == files_of(finished)


class TestResuming:
    def test_only_missing_energies_are_computed(self, tmp_path: Path, finished: Path) -> None:
        run_until(SPEC, tmp_path / "store", 0.4)
        assert len(marks(tmp_path / "store")) == 1
        resumed = progress_of(SPEC, tmp_path / "store")
        assert resumed[0] == 1 / 3
        assert resumed == sorted(resumed)
        assert files_of(tmp_path / "store") == files_of(finished)
        assert progress_of(SPEC, tmp_path / "store") == [1.0]

    def test_only_missing_blocks_are_computed(self, tmp_path: Path) -> None:
        straight = progress_of(IN_BLOCKS, tmp_path / "straight")
        assert straight == pytest.approx([0, 1 / 9, 2 / 9, 3 / 9, 3 / 9, 4 / 9, 5 / 9, 6 / 9, 6 / 9, 7 / 9, 8 / 9, 1, 1])
        run_until(IN_BLOCKS, tmp_path / "store", 0.5)
        assert progress_of(IN_BLOCKS, tmp_path / "store") == [straight[4], *straight[7:]]
        assert files_of(tmp_path / "store") == files_of(tmp_path / "straight")

    @pytest.mark.parametrize("number", [1, 3])
    def test_run_interrupted_while_writing_resumes_byte_identically(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
    ) -> None:
        """Interrupted in the second block at the first energy, at the n-th file."""

        def interrupt() -> None:
            (tmp_path / "store" / "crossings" / "c" / "0" / "0" / "0.123.partial").touch()
            raise KeyboardInterrupt

        def on_progress(share: float) -> None:
            if share > 0.0:
                interrupt_writing(number, interrupt)

        straight = progress_of(IN_BLOCKS, tmp_path / "straight")
        with monkeypatch.context() as patch:
            patch.setattr(os, "fsync", os.fsync)
            with pytest.raises(KeyboardInterrupt):
                run_sweep(IN_BLOCKS, tmp_path / "store", execution=Execution(on_progress=on_progress))
        assert progress_of(IN_BLOCKS, tmp_path / "store") == [straight[0], *straight[2:]]
        assert files_of(tmp_path / "store") == files_of(tmp_path / "straight")

    @pytest.mark.parametrize("kept", [0, 7])
    def test_damaged_unmarked_chunk_is_computed_again(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kept: int) -> None:
        """Its rows belong to two blocks, which have other rows in other chunks."""
        limit_block_size(monkeypatch, 48)
        store = tmp_path / "store"
        run_sweep(SPEC, store)
        whole = files_of(store)
        marks(store)[1].unlink()
        chunk = store / "escape_time" / "c" / "1" / "0" / "0"
        chunk.write_bytes(chunk.read_bytes()[:kept])
        run_sweep(SPEC, store)
        assert files_of(store) == whole

    def test_killed_run_resumes_byte_identically(self, tmp_path: Path, straight: Path) -> None:
        killed = run_in_child(tmp_path, "store", 0.7)
        assert (killed.code, killed.out.split()) == (
            -signal.SIGKILL,
            ["0.0", "0.125", "0.25", "0.375", "0.5", "0.5", "0.625", "0.75"],
        )
        store = tmp_path / "store"
        kept = {path: path.stat().st_mtime_ns for path in marks(store)}
        resumed = run_in_child(tmp_path, "store")
        assert (resumed.code, resumed.out.split()) == (0, ["0.5", "0.875", "1.0", "1.0"])
        assert {path: path.stat().st_mtime_ns for path in kept} == kept
        assert files_of(store) == files_of(straight)


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

    @pytest.mark.parametrize("piece", [1, 25, 119])
    def test_block_size_has_no_effect_without_certificates(self, tmp_path: Path, finished: Path, piece: int) -> None:
        assert bytes_of(run_sweep(replace(SPEC, piece=piece), tmp_path / "store")) == bytes_of(xr.open_zarr(finished))

    def test_memory_is_bounded_by_a_block(self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
        limit_block_size(monkeypatch, 2000)
        spec = SweepSpec(CASES["III"], Plane.X_PX, (0.4,), (250, 250), t_max=0.5)
        run_sweep(replace(spec, resolution=(30, 30)), tmp_path / "first")
        tracemalloc.start()
        whole = run_sweep(spec, tmp_path / "store")
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < sum(whole[name].nbytes for name in ARRAYS)


class TestStoreThatCannotBeWritten:
    """A disk that becomes full is in `tests/faults`."""

    def test_folder_that_cannot_be_created_fails_before_computing(self, tmp_path: Path) -> None:
        seen: list[float] = []
        (tmp_path / "file").touch()
        with pytest.raises(OSError, match="file"):
            run_sweep(SPEC, tmp_path / "file" / "store", execution=Execution(on_progress=seen.append))
        assert not seen

    def test_read_only_store_fails_before_computing(
        self, tmp_path: Path, finished: Path, monkeypatch: pytest.MonkeyPatch
    ) -> None:
        def refused(*_arguments: object, **_named: object) -> None:
            raise PermissionError("read-only")

        seen: list[float] = []
        shutil.copytree(finished, tmp_path / "store")
        marks(tmp_path / "store")[0].unlink()
        monkeypatch.setattr("tempfile.TemporaryFile", refused)
        with pytest.raises(PermissionError):
            run_sweep(SPEC, tmp_path / "store", execution=Execution(on_progress=seen.append))
        assert not seen


class TestCluster:
    # Threads as workers, with messages as between processes; processes are in the long verification.
    @pytest.mark.parametrize("processes", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["threads", "processes"])
    def test_dask_cluster_is_byte_identical(self, tmp_path: Path, request: pytest.FixtureRequest, processes: bool) -> None:
        distributed = pytest.importorskip("distributed")
        options = {"protocol": "tcp", "host": "127.0.0.1", "dashboard_address": "127.0.0.1:0"}
        cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=processes, **options)
        with cluster, distributed.Client(cluster) as client:
            assert count_workers(client.get_executor()) == 2
            spread = run_sweep(LONG_SPEC, tmp_path / "cluster", execution=Execution(client.get_executor()))
        assert np.unique(spread["certificate"]).size >= 3
        if processes:
            straight = request.getfixturevalue("straight")
        else:
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
        monkeypatch.setattr("engine.sweeps.run._measure_seconds", lambda spec, _execution: 0.5 + 1e-4 * np.prod(spec.resolution))
        one = plan_sweep(replace(SPEC, resolution=(1000, 1000)), cores=1)
        many = plan_sweep(replace(SPEC, resolution=(1000, 1000)), cores=10)
        assert one.seconds == pytest.approx(3 * 100.5)
        assert many.seconds == pytest.approx(one.seconds / 10)

    def test_plan_uses_the_midpoints_of_twelve_intervals(self, monkeypatch: pytest.MonkeyPatch) -> None:
        seen: set[float] = set()

        def measured(spec: MapSpec, _execution: object) -> float:
            seen.add(float(spec.energy))  # type: ignore[arg-type]
            return 1.0

        monkeypatch.setattr("engine.sweeps.run._measure_seconds", measured)
        plan_sweep(replace(SPEC, energies=tuple(np.linspace(0.0, 0.24, 241))))
        assert sorted(seen) == pytest.approx(np.arange(0.01, 0.24, 0.02), abs=0.001)

    def test_planning_can_be_cancelled(self) -> None:
        cancel = threading.Event()
        cancel.set()
        with pytest.raises(CancelledError):
            plan_sweep(SPEC, execution=Execution(cancel=cancel))

    def test_cores_must_be_positive(self) -> None:
        with pytest.raises(ValueError, match="cores=0"):
            plan_sweep(SPEC, cores=0)

    def test_description(self) -> None:
        text = SweepPlan(10**9, 7200.0, 23 * 10**9, 16).describe()
        assert text == "1e+09 orbits: about 2 hours on 16 cores (32 core hours), at most 23 GB"
