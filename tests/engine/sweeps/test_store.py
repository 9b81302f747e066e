"""Sweeps in a store have the right contents, are resumed, survive errors of the disk, and can be computed by clusters."""

from __future__ import annotations

import itertools
import os
import shutil
import signal
import sys
import threading
from collections.abc import Callable
from concurrent.futures import CancelledError
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
import zarr

from engine import CASES, Fate, Plane, SweepSpec, Window, compute_sweep
from engine.foundations.execution import Execution, count_workers
from engine.sweeps.store import check_same_sweep
from tests.forked import Finished, run

SPEC = SweepSpec(CASES["III"], Plane.X_PX, (0.4, 0.3, 0.5), (12, 10), t_max=300.0, measures=("maps", "shares"))
# Long enough for all kinds of evidence.
LONG_SPEC = SweepSpec(CASES["III"], Plane.X_PX, (0.36, 0.38, 0.4, 0.42), (9, 9), t_max=2e4)


def run_in_child(folder: Path, name: str, killed_after: float = 1.0) -> Finished:
    """Run `LONG_SPEC` in a child process. The process is killed while it writes the first value after some progress, if any.

    A bitwise comparison needs the same machine code in both runs: kernels that this process has compiled itself may differ in
    rounding from those that a child loads from the cache.
    """
    return run(folder, run_and_die, folder / name, killed_after)


def run_and_die(store: Path, killed_after: float) -> None:
    def on_progress(share: float) -> None:
        if killed_after <= share < 1.0:
            interrupt_writing(4, lambda: os.kill(os.getpid(), signal.SIGKILL))

    compute_sweep(LONG_SPEC, store, execution=Execution(on_progress=on_progress))
    sys.stdout.write("finished")


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
    """Return the store of `SPEC`, which tests must not change."""
    store = tmp_path_factory.mktemp("finished") / "store"
    compute_sweep(SPEC, store)
    return store


def files_of(store: Path) -> dict[str, bytes]:
    return {str(path.relative_to(store)): path.read_bytes() for path in store.rglob("*") if path.is_file()}


def measured_by(spec: SweepSpec, store: Path) -> list[float]:
    """Run a sweep and return the values that it computes."""
    seen: list[float] = []
    before = xr.open_zarr(store, consolidated=False)["h"].values.tolist() if store.exists() else []
    compute_sweep(spec, store, on_frame=lambda sweep: seen.extend(set(sweep.values.tolist()) - {*before, *seen}))
    return seen


def run_until(spec: SweepSpec, store: Path, share: float) -> None:
    """Run a sweep that is cancelled at the given progress."""
    cancel = threading.Event()
    with pytest.raises(CancelledError):
        compute_sweep(
            spec,
            store,
            execution=Execution(cancel=cancel, on_progress=lambda progress: cancel.set() if progress >= share else None),
        )


# Contents.


def test_a_store_contains_the_same_sweep_as_memory(finished: Path) -> None:
    """The store opens without a warning: warnings are errors in tests."""
    with xr.open_zarr(finished) as found:
        xr.testing.assert_equal(found, compute_sweep(SPEC).dataset)
        assert found["fate"].dtype == np.int8


def test_a_refined_store_is_read_in_ascending_order(tmp_path: Path) -> None:
    spec = replace(SPEC, values=(0.3, 0.5), refine=1)
    assert compute_sweep(spec, tmp_path / "store").values.tolist() == [0.3, 0.4, 0.5]
    assert measured_by(spec, tmp_path / "store") == []


def test_arrays_are_read_on_access_and_missing_data_are_not_computed(tmp_path: Path) -> None:
    dataset = compute_sweep(SPEC, tmp_path / "store").dataset
    shutil.rmtree(tmp_path / "store" / "fate" / "c")
    assert (dataset["fate"] == Fate.NOT_COMPUTED).all()


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"t_max": 301.0}, "t_max"),
        ({"potential": CASES["I"]}, "potential"),
        ({"plane": Plane.X_Y}, "plane"),
        ({"resolution": (12, 11)}, "resolution"),
        ({"window": Window(-1.0, 1.0, -1.0, 1.0)}, "window"),
        ({"use_evidence": False}, "use_evidence"),
        ({"measures": ("maps",)}, "measures"),
        ({"values": (0.3, 0.41, 0.5)}, "requested"),
    ],
)
def test_store_of_another_request_is_refused(finished: Path, change: dict[str, Any], name: str) -> None:
    before = files_of(finished)
    with pytest.raises(ValueError, match=f"holds another request, with {name}"):
        compute_sweep(replace(SPEC, **change), finished)
    assert files_of(finished) == before


def test_folder_with_other_files_is_refused(tmp_path: Path) -> None:
    (tmp_path / "thesis.tex").touch()
    with pytest.raises(ValueError, match="holds other files"):
        compute_sweep(SPEC, tmp_path)


def test_energy_without_exits_is_refused_before_writing(tmp_path: Path) -> None:
    spec = replace(SPEC, window=Window(-1.0, 1.0, -1.0, 1.0), values=(0.3, 100.0))
    with pytest.raises(ValueError, match="no Lyapunov orbit"):
        compute_sweep(spec, tmp_path / "store")
    assert not any(tmp_path.iterdir())


# Resuming.


def test_only_missing_values_are_computed(tmp_path: Path, finished: Path) -> None:
    run_until(SPEC, tmp_path / "store", 0.4)
    assert measured_by(SPEC, tmp_path / "store") == [0.4, 0.5]
    assert files_of(tmp_path / "store") == files_of(finished)
    assert measured_by(SPEC, tmp_path / "store") == []


@pytest.mark.parametrize("share", [0.0, 1 / 3])
@pytest.mark.parametrize("number", [1, 12])
def test_run_interrupted_while_writing_resumes_byte_identically(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, finished: Path, number: int, share: float
) -> None:
    """The run is interrupted at the n-th file of the first or of the second value."""

    def interrupt() -> None:
        (tmp_path / "store" / "fate" / "0.123.partial").touch()
        raise KeyboardInterrupt

    def on_progress(progress: float) -> None:
        if progress == share:
            interrupt_writing(number, interrupt)

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", os.fsync)
        with pytest.raises(KeyboardInterrupt):
            compute_sweep(SPEC, tmp_path / "store", execution=Execution(on_progress=on_progress))
    compute_sweep(SPEC, tmp_path / "store")
    assert files_of(tmp_path / "store") == files_of(finished)


def test_killed_run_resumes_byte_identically(tmp_path: Path) -> None:
    killed = run_in_child(tmp_path, "store", 0.5)
    assert (killed.code, killed.out) == (-signal.SIGKILL, "")
    with xr.open_zarr(tmp_path / "store", consolidated=False, drop_variables="energy_error") as found:
        assert found.attrs["finished"] == 2
    assert run_in_child(tmp_path, "store").out == run_in_child(tmp_path, "straight").out == "finished"
    assert files_of(tmp_path / "store") == files_of(tmp_path / "straight")


def leave_an_incomplete_file(store: Path) -> None:
    store.mkdir()
    (store / "zarr.0123.partial").touch()


@pytest.mark.parametrize("begin", [leave_an_incomplete_file, zarr.create_group])
def test_a_run_that_was_killed_before_it_wrote_its_request_is_begun_again(
    tmp_path: Path, finished: Path, begin: Callable[[Path], object]
) -> None:
    begin(tmp_path / "store")
    compute_sweep(SPEC, tmp_path / "store")
    assert files_of(tmp_path / "store") == files_of(finished)


def test_a_run_that_is_killed_while_it_removes_an_incomplete_first_value_is_begun_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, finished: Path
) -> None:
    store = tmp_path / "store"

    def interrupt() -> None:
        raise KeyboardInterrupt

    def remove_in_part(folder: Path, *_arguments: object, **_named: object) -> None:
        (Path(folder) / "zarr.json").unlink()
        interrupt()

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", os.fsync)
        interrupt_writing(2, interrupt)
        with pytest.raises(KeyboardInterrupt):
            compute_sweep(SPEC, store)
    with monkeypatch.context() as patch:
        patch.setattr(shutil, "rmtree", remove_in_part)
        with pytest.raises(KeyboardInterrupt):
            compute_sweep(SPEC, store)
    compute_sweep(SPEC, store)
    assert files_of(store) == files_of(finished)


def remove(path: Path) -> None:
    path.unlink()


def truncate(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:-3])


def fill_with_zeros(path: Path) -> None:
    path.write_bytes(bytes(path.stat().st_size))


def flip_one_bit(path: Path) -> None:
    """Change a number that is stored uncompressed. Chunks end with four bytes of their checksum."""
    content = bytearray(path.read_bytes())
    content[-6] ^= 1
    path.write_bytes(content)


@pytest.mark.parametrize("damage", [remove, truncate, fill_with_zeros, flip_one_bit])
@pytest.mark.parametrize(("chunk", "kept"), [("fate/c/1/0/0", 1), ("share/c/2/0", 2), ("h/c/0", 0), ("x/c/0", 0)])
def test_values_from_a_damaged_one_on_are_computed_again(
    tmp_path: Path, finished: Path, caplog: pytest.LogCaptureFixture, chunk: str, kept: int, damage: Callable[[Path], None]
) -> None:
    store = tmp_path / "store"
    shutil.copytree(finished, store)
    damage(store / chunk)
    sizes: list[int] = []
    compute_sweep(SPEC, store, on_frame=lambda sweep: sizes.append(sweep.values.size))
    assert min(sizes) == kept + 1
    assert files_of(store) == files_of(finished)
    assert "are damaged; computing from there" in caplog.text


@pytest.mark.parametrize("lost", ["fate", "h/zarr.json"])
@pytest.mark.parametrize("is_killed", [False, True])
def test_a_sweep_that_has_lost_an_array_is_computed_again(tmp_path: Path, finished: Path, lost: str, is_killed: bool) -> None:
    store = tmp_path / "store"
    shutil.copytree(finished, store)
    shutil.rmtree(store / lost) if (store / lost).is_dir() else remove(store / lost)
    if is_killed:
        # While a value is written, the collected metadata are missing.
        zarr.open_group(store, use_consolidated=False).attrs["finished"] = 2
    compute_sweep(SPEC, store)
    assert files_of(store) == files_of(finished)


@pytest.mark.parametrize("file", ["zarr.json", "fate/zarr.json"])
def test_damaged_metadata_are_named(tmp_path: Path, finished: Path, file: str) -> None:
    store = tmp_path / "store"
    shutil.copytree(finished, store)
    truncate(store / file)
    with pytest.raises(ValueError, match=rf"store=.*its file {file} cannot be read.*delete the folder"):
        compute_sweep(SPEC, store)


def test_a_store_without_its_metadata_is_refused(tmp_path: Path, finished: Path) -> None:
    store = tmp_path / "store"
    shutil.copytree(finished, store)
    remove(store / "zarr.json")
    with pytest.raises(ValueError, match=r"holds other files but no zarr\.json"):
        compute_sweep(SPEC, store)


# Stores that cannot be written; a disk that becomes full is in `tests/faults`.


def test_folder_that_cannot_be_created_fails_before_computing(tmp_path: Path) -> None:
    seen: list[float] = []
    (tmp_path / "file").touch()
    with pytest.raises(OSError, match="file"):
        compute_sweep(SPEC, tmp_path / "file" / "store", execution=Execution(on_progress=seen.append))
    assert not seen


def test_read_only_store_fails_before_computing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_arguments: object, **_named: object) -> None:
        raise PermissionError("read-only")

    run_until(SPEC, tmp_path / "store", 0.4)
    seen: list[float] = []
    monkeypatch.setattr("tempfile.TemporaryFile", refused)
    with pytest.raises(PermissionError):
        compute_sweep(SPEC, tmp_path / "store", execution=Execution(on_progress=seen.append))
    assert not seen


# Threads as workers, with messages as between processes; processes are in the long verification.
@pytest.mark.parametrize("processes", [False, pytest.param(True, marks=pytest.mark.slow)], ids=["threads", "processes"])
def test_dask_cluster_is_byte_identical(tmp_path: Path, processes: bool) -> None:
    distributed = pytest.importorskip("distributed")
    options = {"protocol": "tcp", "host": "127.0.0.1", "dashboard_address": "127.0.0.1:0"}
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=processes, **options)
    with cluster, distributed.Client(cluster) as client:
        assert count_workers(client.get_executor()) == 2
        spread = compute_sweep(LONG_SPEC, tmp_path / "cluster", execution=Execution(client.get_executor()))
    assert np.unique(spread["evidence"]).size >= 3
    if processes:
        run_in_child(tmp_path, "straight")
    else:
        # The machine code of this process may differ from that in the cache.
        compute_sweep(LONG_SPEC, tmp_path / "straight")
    assert files_of(tmp_path / "cluster") == files_of(tmp_path / "straight")


def test_a_sweep_with_less_provenance_is_another_sweep() -> None:
    wanted = {"energy": 0.2, "t_max": 100.0}
    check_same_sweep("store", wanted, wanted)
    with pytest.raises(ValueError, match=r"store: holds another request, with t_max=None; must have t_max=100.0"):
        check_same_sweep("store", {"energy": 0.2}, wanted)


def test_a_sweep_whose_exits_had_other_names_is_the_same() -> None:
    wanted = {"energy": 0.2, "outcomes": '[["exit", "exit 1"]]'}
    check_same_sweep("store", {"energy": 0.2, "outcomes": '[["exit", "channel 1"]]'}, wanted)
