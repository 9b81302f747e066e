"""Command ``live`` writes the live figure of its map."""

from __future__ import annotations

import json
import re
import signal
from functools import partial
from pathlib import Path

from cli.main import INTERRUPTED
from tests.cli.conftest import Run


def test_the_file_has_the_view_of_the_request(run: Run, tmp_path: Path) -> None:
    code, out, _ = run(
        "live", "III", "--energy", 0.45, "--resolution", "20x20", "--t-max", 50, "--start", "0.1,0", "--start", "-0.2,-0.1",
        "--shown-energies", 0.3, 0.6, "--caption", "Four exits.", "--json", "--output", tmp_path / "figure.html",
    )  # fmt: skip
    page = (tmp_path / "figure.html").read_text()
    [text] = re.findall(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)
    data = json.loads(text)
    assert code == 0
    assert (data["energy"], data["low"], data["high"], data["starts"]) == (0.45, 0.3, 0.6, [[0.1, 0.0], [-0.2, -0.1]])
    assert "Four exits." in page
    assert json.loads(out)["bytes"] == len(page.encode())


def test_a_slice_along_a_parameter_is_refused(run: Run) -> None:
    code, _, error = run("live", "I", "--energy", 0.2, "--plane", "x,epsilon=0.5:2")
    assert code == 2
    assert "along ε each orbit belongs to another system" in error


def test_ctrl_c_ends_the_command_without_a_file(run_in_terminal: Run, tmp_path: Path) -> None:
    # The map takes minutes.
    request = ("III", "--energy", 0.26, "--resolution", 300, "--t-max", 1e7)
    interrupt = partial(signal.raise_signal, signal.SIGINT)
    code, out, line = run_in_terminal("map", interrupt, "live", *request, "--output", tmp_path / "figure")
    assert (code, out) == (INTERRUPTED, "")
    assert "escape-explorer: interrupted" in line
    assert not any(tmp_path.iterdir())
