"""Full disks: existing files stay, incomplete files are not left behind, and the error is one sentence."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from cli.main import FAILED

ROOT = Path(__file__).parents[2]
_PROGRAM = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]), int(sys.argv[1])))
from cli.main import main
sys.exit(main(sys.argv[2:]))
"""


def run(limit: int, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run a command that cannot write files longer than `limit` bytes."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", _PROGRAM, str(limit), *arguments]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False, timeout=300)


def is_one_sentence(text: str) -> bool:
    return text.startswith("escape-explorer: ") and text.count("\n") == 1


def test_failed_write_keeps_the_existing_file(tmp_path: Path) -> None:
    (tmp_path / "exits.csv").write_text("previous")
    completed = run(2000, tmp_path, "lyapunov", "I", "--energy", "0.19", "--output", "exits.csv")
    assert completed.returncode == FAILED
    assert is_one_sentence(completed.stderr), completed.stderr
    assert os.strerror(errno.EFBIG) in completed.stderr
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == {"exits.csv": "previous"}


SWEEP = ("sweep", "I", "--energy", "0.19", "--energy", "0.2", "--resolution", "80", "--t-max", "20", "--store", "store.zarr")


def test_sweep_can_be_resumed_after_a_full_disk(tmp_path: Path) -> None:
    full = run(6000, tmp_path, *SWEEP)
    assert full.returncode == FAILED, full.stderr
    assert is_one_sentence(full.stderr), full.stderr
    resumed = run(10**9, tmp_path, *SWEEP)
    assert resumed.returncode == 0, resumed.stderr
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
    """A file system of 64 kB; skips where mounting is not permitted."""
    disk = tmp_path / "disk"
    disk.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=64k", "none", str(disk)], capture_output=True, check=False).returncode:
        pytest.skip("mounting a file system is not permitted")
    yield disk
    subprocess.run(["umount", str(disk)], check=False)


def test_disk_that_fills_up_is_reported_in_one_sentence(small_disk: Path) -> None:
    completed = run(
        10**9, small_disk, "orbit", "I", "--energy", "0.19", "--start", "0.1", "0.1", "--t-max", "200", "--output", "orbit"
    )
    assert completed.returncode == FAILED
    assert is_one_sentence(completed.stderr), completed.stderr
    assert not [path for path in small_disk.iterdir() if path.name.endswith(".part")]
