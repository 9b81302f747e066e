"""A disk that is full: what was there stays, what is not whole is not there, and one sentence says so."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from cli.main import WENT_WRONG

ROOT = Path(__file__).parents[2]
_PROGRAM = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]), int(sys.argv[1])))
from cli.main import main
sys.exit(main(sys.argv[2:]))
"""


def run(limit: int, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """A command that can write no file longer than `limit` bytes."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", _PROGRAM, str(limit), *arguments]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=300)


def is_one_sentence(text: str) -> bool:
    return text.startswith("escape-explorer: ") and text.count("\n") == 1


def test_a_file_that_does_not_fit_is_not_there_and_the_one_before_stays(tmp_path: Path) -> None:
    (tmp_path / "exits.csv").write_text("as it was")
    ended = run(2000, tmp_path, "lyapunov", "I", "--energy", "0.19", "--output", "exits.csv")
    assert ended.returncode == WENT_WRONG
    assert is_one_sentence(ended.stderr), ended.stderr
    assert os.strerror(errno.EFBIG) in ended.stderr
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"exits.csv": "as it was"}


SWEEP = ("sweep", "I", "--energy", "0.19", "--energy", "0.2", "--resolution", "80", "--t-max", "20", "--store", "store.zarr")


def test_a_sweep_that_does_not_fit_can_be_gone_on_with(tmp_path: Path) -> None:
    full = run(6000, tmp_path, *SWEEP)
    assert full.returncode == WENT_WRONG, full.stderr
    assert is_one_sentence(full.stderr), full.stderr
    roomy = run(10**9, tmp_path, *SWEEP)
    assert roomy.returncode == 0, roomy.stderr
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    assert run(10**9, elsewhere, *SWEEP).returncode == 0
    assert _arrays(tmp_path / "store.zarr") == _arrays(elsewhere / "store.zarr")


def _arrays(store: Path) -> dict[str, bytes]:
    import xarray as xr

    with xr.open_zarr(store, consolidated=False) as dataset:
        return {str(name): dataset[name].to_numpy().tobytes() for name in dataset.data_vars}


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A file system of 64 kB, where this machine lets us have one."""
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", str(disk)], capture_output=True, check=False).returncode:
        pytest.skip("file systems cannot be mounted here")
    yield disk
    subprocess.run(["umount", str(disk)], check=False)


def test_a_disk_that_fills_up_on_the_way_is_said_in_a_sentence(small_disk: Path) -> None:
    ended = run(
        10**9, small_disk, "orbit", "I", "--energy", "0.19", "--start", "0.1", "0.1", "--t-max", "200", "--output", "orbit"
    )
    assert ended.returncode == WENT_WRONG
    assert is_one_sentence(ended.stderr), ended.stderr
    assert not [path for path in small_disk.iterdir() if path.name.endswith(".part")]
