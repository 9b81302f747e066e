"""The server refuses several processes before it starts."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from app.server.lifecycle.start_checks import SEVERAL_PROCESSES, asks_for_several_processes
from tests.waiting import SECONDS

ROOT = Path(__file__).parents[4]
COMMAND = [sys.executable, "-m", "panel", "serve", "app", "--port", "0"]


@pytest.mark.parametrize("option", [["--num-procs", "2"], ["--num-procs=2"], ["--num-procs", "0"], ["--num-pr", "3"]])
def test_several_processes_are_recognized(option: list[str]) -> None:
    assert asks_for_several_processes([*COMMAND, *option])


@pytest.mark.parametrize("option", [[], ["--num-procs", "1"], ["--num-procs", "many"], ["--args", "--num-procs", "2"]])
def test_other_arguments_are_accepted(option: list[str]) -> None:
    assert not asks_for_several_processes([*COMMAND, *option])


def test_several_processes_are_refused_with_a_sentence_and_no_process_remains() -> None:
    refused = subprocess.run(
        [*COMMAND, "--num-procs", "2"], cwd=ROOT, capture_output=True, text=True, timeout=SECONDS, check=False
    )
    assert (refused.returncode, refused.stderr) == (2, f"{SEVERAL_PROCESSES}\n")
