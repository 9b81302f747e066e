"""The program as a whole: help, versions, and what becomes of errors."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

import pytest

from cli import map_work
from cli.main import STOPPED, WENT_WRONG, WRONG_REQUEST
from engine import CASES, EscapeMap, compute_map

Run = Callable[..., tuple[int, str, str]]

COMMANDS = ("map", "orbit", "lyapunov", "measures", "curves", "sweep", "potential", "reproduce", "serve")
MAP = ("map", "I", "--energy", 0.19, "--resolution", 9, "--t-max", 100)
WRONG = {
    "no command": (),
    "an unknown command": ("paint",),
    "no case": ("map", "--energy", 0.2),
    "an unknown case": ("map", "V", "--energy", 0.2),
    "no energy": ("map", "I"),
    "an energy for all of them": ("map", "I", "--plane", "x_h", "--energy", 0.2),
    "a range for one energy": ("map", "I", "--energies", 0.2, 0.3),
    "no number": ("map", "I", "--energy", "high"),
    "no finite number": ("map", "I", "--energy", "nan"),
    "a resolution in words": ("map", "I", "--energy", 0.2, "--resolution", "fine"),
    "no pixels": ("map", "I", "--energy", 0.2, "--resolution", 0),
    "an empty window": ("map", "I", "--energy", 0.2, "--window", 0, 0, 0, 1),
    "no time": ("map", "I", "--energy", 0.2, "--t-max", 0),
    "no threads": ("map", "I", "--energy", 0.2, "--threads", 0),
    "an unknown picture": ("map", "I", "--energy", 0.2, "--picture", "sunset"),
    "unknown colours": ("map", "I", "--energy", 0.2, "--palette", "loud"),
    "a picture too small": ("map", "I", "--energy", 0.2, "--side", 10),
    "manifolds on another plane": ("map", "I", "--energy", 0.2, "--plane", "x_y", "--manifolds", 1),
    "too many images": ("map", "I", "--energy", 0.2, "--manifolds", 7),
    "the past of the past": ("map", "I", "--energy", 0.2, "--backward", "--origins"),
    "no folder": ("map", "I", "--energy", 0.2, "--output", "/no/such/folder/name"),
    "a folder for a name": ("lyapunov", "I", "--energy", 0.2, "--output", "/"),
    "no start": ("orbit", "I", "--energy", 0.2),
    "a start at no energy": ("orbit", "I", "--start", 0, 0),
    "a forbidden start": ("orbit", "I", "--energy", 0.2, "--start", 0, 2),
    "two starts": ("orbit", "I", "--energy", 0.2, "--start", 0, 0, "--state", 0, 0, 0, 0.1),
    "a state and its energy": ("orbit", "I", "--energy", 0.2, "--state", 0, 0, 0, 0.1),
    "an energy twice": ("orbit", "I", "--plane", "x_h", "--energy", 0.2, "--start", 0, 0.2),
    "an exit that is none": ("lyapunov", "I", "--energy", 9),
    "energies the wrong way": ("curves", "I", "--low", 0.3, "--high", 0.2, "--count", 3),
    "curves on (x, h)": ("curves", "I", "--plane", "x_h", "--low", 0.1, "--high", 0.2, "--count", 3),
    "a picture too small to measure": ("measures", "I", "--energy", 0.2, "--resolution", 3, "--t-max", 10),
}


@pytest.mark.parametrize("wrong", WRONG)
def test_what_cannot_be_asked_is_refused_in_one_sentence(
    wrong: str, run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*WRONG[wrong])
    assert (code, out, list(tmp_path.iterdir())) == (WRONG_REQUEST, "", [])
    assert err.startswith("escape-explorer: ")
    assert err.count("\n") == 1


@pytest.mark.parametrize("command", COMMANDS)
def test_help_holds_an_example(command: str, run: Run) -> None:
    code, out, _ = run(command, "--help")
    assert code == 0
    assert f"escape-explorer {command} " in out.partition("Examples:")[2]


def test_the_program_names_its_commands(run: Run) -> None:
    _, out, _ = run("--help")
    assert all(f" {command} " in out for command in COMMANDS)


def test_the_program_says_its_version(run: Run) -> None:
    assert run("--version") == (0, f"escape-explorer {metadata.version('escape-explorer')}\n", "")


def test_an_unwritable_folder_is_a_failure_and_no_fault_of_the_request(run: Run, tmp_path: Path) -> None:
    (tmp_path / "taken.nc").mkdir()
    code, _, err = run(*MAP, "--output", tmp_path / "taken", "--format", "nc")
    assert code == WENT_WRONG
    assert err.count("\n") == 1
    assert [path.name for path in tmp_path.iterdir()] == ["taken.nc"]


def test_a_failure_on_the_way_writes_nothing(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*arguments: Any) -> EscapeMap:
        raise RuntimeError("the disk\nof numbers is full")

    monkeypatch.setattr(map_work, "compute_map", fail)
    assert run(*MAP, "--output", tmp_path / "map") == (
        WENT_WRONG, "", "escape-explorer: RuntimeError: the disk of numbers is full\n",
    )  # fmt: skip
    assert not any(tmp_path.iterdir())


def test_ctrl_c_stops_a_map_and_writes_nothing(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*arguments: Any) -> EscapeMap:
        signal.raise_signal(signal.SIGINT)
        return compute_map(*arguments)

    monkeypatch.setattr(map_work, "compute_map", interrupted)
    before = signal.getsignal(signal.SIGINT)
    code, out, err = run(*MAP, "--trust", "--output", tmp_path / "map")
    assert (code, out) == (STOPPED, "")
    assert err == "escape-explorer: stopped before the end; nothing was written\n"
    assert not any(tmp_path.iterdir())
    assert signal.getsignal(signal.SIGINT) is before


def test_a_second_ctrl_c_does_not_wait(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def never_stops(*arguments: Any) -> EscapeMap:
        signal.raise_signal(signal.SIGINT)
        signal.raise_signal(signal.SIGINT)
        raise AssertionError("not reached")

    monkeypatch.setattr(map_work, "compute_map", never_stops)
    assert run(*MAP, "--output", tmp_path / "map") == (STOPPED, "", "escape-explorer: stopped at once\n")
    assert not any(tmp_path.iterdir())


def test_help_does_not_wait_for_the_engine() -> None:
    script = "import sys, cli.main; sys.exit('engine' in sys.modules or 'numba' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script], cwd=Path(__file__).parents[2], check=False).returncode == 0


def test_the_module_runs_as_a_program() -> None:
    command = [sys.executable, "-m", "cli", "lyapunov", next(iter(CASES)), "--energy", "one"]
    ended = subprocess.run(command, cwd=Path(__file__).parents[2], capture_output=True, text=True, check=False)
    assert (ended.returncode, ended.stdout, ended.stderr.count("\n")) == (WRONG_REQUEST, "", 1)
