"""Command ``reproduce`` writes the selected figures, and keeps finished figures when it is interrupted."""

from __future__ import annotations

import json
import signal
from pathlib import Path

import pytest

from cli.main import INTERRUPTED
from reproduction import quality
from reproduction.figures.all_figures import FIGURES
from reproduction.quality import Quality
from tests.cli.conftest import Run

TINY = Quality(
    "tiny", resolution=9, t_max=100.0, curve_points=7, search_resolution=9,
    search_t_max=200.0, classified_resolution=10, exponent_work=1e4,
)  # fmt: skip


@pytest.fixture(autouse=True)
def tiny(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(quality, "QUICK", TINY)


def test_named_figures_are_written_as_png_and_pdf(run: Run, tmp_path: Path) -> None:
    code, out, err = run("reproduce", "II-xh", "I-potential", "--quick", "--json", "--output", tmp_path / "new")
    result = json.loads(out)
    assert (code, err, result["quality"]) == (0, "", "tiny")
    assert [figure["name"] for figure in result["figures"]] == ["I-potential", "II-xh"]
    files = [file for figure in result["figures"] for file in figure["files"]]
    assert sorted(files) == sorted(map(str, (tmp_path / "new").iterdir()))
    assert {Path(file).name for file in files} == {"I-potential.pdf", "I-potential.png", "II-xh.pdf", "II-xh.png"}
    assert 0.0 < result["figures"][0]["seconds"] <= result["seconds"]


def test_list_names_all_figures_and_writes_nothing(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, _ = run("reproduce", "--list", "--json")
    assert code == 0
    assert list(json.loads(out)["figures"]) == [*FIGURES, "tables"]
    assert not any(tmp_path.iterdir())


def test_ctrl_c_keeps_finished_figures(run_in_terminal: Run, tmp_path: Path) -> None:
    arguments = ("reproduce", "I-potential", "I-xh", "--quick", "--output", tmp_path)
    code, out, line = run_in_terminal("I-xh", lambda: signal.raise_signal(signal.SIGINT), *arguments)
    assert (code, out) == (INTERRUPTED, "")
    assert "1 of 2" in line
    assert sorted(path.name for path in tmp_path.iterdir()) == ["I-potential.pdf", "I-potential.png"]
