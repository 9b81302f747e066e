"""Errors of the operating system are told in a sentence with the path and what to do."""

from __future__ import annotations

from pathlib import Path

import pytest

from cli.main import FAILED
from cli.system_errors import describe_system_error
from engine.foundations.output_lock import hold_lock
from tests.cli.conftest import Run

SWEEP = ("sweep", "I", "--energy", 0.19, "--resolution", 4, "--t-max", 5, "--store")


@pytest.mark.parametrize("store", ["file", "file/store.zarr"])
def test_a_file_in_the_place_of_a_folder_is_reported_with_its_path(store: str, run: Run, tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    code, _, err = run(*SWEEP, tmp_path / store)
    assert (code, err.count("\n")) == (FAILED, 1)
    assert err.startswith(f"escape-explorer: {tmp_path / 'file'}: ")
    assert err.endswith("; choose another path\n")
    assert "Errno" not in err


COMMANDS = [
    (*SWEEP, "out"),
    ("map", "I", "--energy", 0.19, "--resolution", 4, "--t-max", 5, "--output", "out"),
    ("orbit", "I", "--energy", 0.19, "--start", 0.0, 0.0, "--t-max", 5, "--output", "out"),
    ("lyapunov", "I", "--energy", 0.19, "--output", "out"),
    ("curves", "I", "--low", 0.13, "--high", 0.2, "--count", 2, "--resolution", 4, "--t-max", 5, "--output", "out"),
    ("reproduce", "--quick", "--output", "out"),
]


def test_output_of_another_process_is_not_touched(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").mkdir()
    with hold_lock(Path("out")):
        for command in COMMANDS:
            code, out, err = run(*command)
            assert (code, out, err.count("\n")) == (FAILED, "", 1), command
            assert "out: is being written by process" in err, command
            assert not any((tmp_path / "out").iterdir()), command


def test_errors_without_a_number_are_shown_as_they_are() -> None:
    assert describe_system_error(TimeoutError("no answer from tcp://node1:8786")) == "no answer from tcp://node1:8786"
