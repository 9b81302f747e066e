"""Full disks: existing files stay, incomplete files are not left behind, and the error is one sentence."""

from __future__ import annotations

import errno
import os
import resource
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
import xarray as xr

from cli.main import FAILED, main
from engine import CASES
from engine.maps.warmup import prepare_for_evidence, prepare_for_maps
from tests.forked import Finished, run


def limited_command(limit: int, folder: Path, arguments: tuple[str, ...]) -> None:
    # Compile the kernels before the limit, because kernels that cannot be stored give a warning.
    prepare_for_maps(CASES["I"])
    prepare_for_evidence(CASES["I"])
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    # Bytecode cut off at the limit would break every later import.
    sys.dont_write_bytecode = True
    os.chdir(folder)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    sys.exit(main(arguments))


@pytest.fixture
def run_limited(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Finished]:
    """Return a function that runs a command in a folder, in a child process that cannot write files above a limit of bytes."""
    output = tmp_path_factory.mktemp("output")
    return lambda limit, folder, *arguments: run(output, limited_command, limit, folder, arguments)


def is_one_sentence(text: str) -> bool:
    return text.startswith("escape-explorer: ") and text.count("\n") == 1


def test_failed_write_keeps_the_existing_file(tmp_path: Path, run_limited: Callable[..., Finished]) -> None:
    (tmp_path / "exits.csv").write_text("previous")
    completed = run_limited(2000, tmp_path, "lyapunov", "I", "--energy", "0.19", "--output", "exits.csv")
    assert completed.code == FAILED
    assert is_one_sentence(completed.err), completed.err
    assert os.strerror(errno.EFBIG) in completed.err
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"exits.csv": "previous"}


@pytest.mark.parametrize("share", [0.2, 0.9])
def test_a_map_that_does_not_fit_on_the_disk_ends_with_a_sentence(
    tmp_path: Path, run_limited: Callable[..., Finished], share: float
) -> None:
    command = ("map", "I", "--energy", "0.2", "--resolution", "60x50", "--t-max", "50", "--output", "map.nc")
    assert run_limited(10**9, tmp_path, *command).code == 0
    written = (tmp_path / "map.nc").read_bytes()
    completed = run_limited(int(share * len(written)), tmp_path, *command)
    assert completed.code == FAILED
    assert is_one_sentence(completed.err), completed.err
    assert f"map.nc: {os.strerror(errno.EFBIG)}" in completed.err
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == {"map.nc": written}


SWEEP = ("sweep", "I", "--energy", "0.19", "--energy", "0.2", "--resolution", "80", "--t-max", "5", "--store", "store.zarr")


def _arrays(store: Path) -> dict[str, bytes]:
    with xr.open_zarr(store) as dataset:
        return {str(name): dataset[name].to_numpy().tobytes() for name in dataset.data_vars}


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """Yield a file system of 64 kB. Skip the test where mounting is not permitted."""
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", str(disk)], capture_output=True, check=False).returncode:
        pytest.skip("mounting a file system is not permitted")
    yield disk
    subprocess.run(["umount", str(disk)], check=False)


@pytest.mark.slow
def test_sweep_resumes_after_space_is_made_on_a_full_disk(
    small_disk: Path, tmp_path: Path, run_limited: Callable[..., Finished]
) -> None:
    full = run_limited(10**9, small_disk, *SWEEP)
    assert full.code == FAILED
    assert is_one_sentence(full.err), full.err
    assert f"{os.strerror(errno.ENOSPC)}; free some space" in full.err
    subprocess.run(["mount", "-o", "remount,size=10m", str(small_disk)], check=True)
    assert run_limited(10**9, small_disk, *SWEEP).code == 0
    (tmp_path / "elsewhere").mkdir()
    assert run_limited(10**9, tmp_path / "elsewhere", *SWEEP).code == 0
    assert _arrays(small_disk / "store.zarr") == _arrays(tmp_path / "elsewhere" / "store.zarr")
