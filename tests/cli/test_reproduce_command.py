"""``reproduce``: what is asked for is written, whole and at once."""

from __future__ import annotations

import json
import signal
from collections.abc import Callable
from pathlib import Path

import pytest

from cli.main import STOPPED, WRONG_REQUEST
from engine import Plane
from reproduction import members, quality
from reproduction.figures import FIGURES
from reproduction.map_shelf import MapShelf
from reproduction.quality import Quality

Run = Callable[..., tuple[int, str, str]]

TINY = Quality("tiny", resolution=9, t_max=100.0, curve_points=7, hunt_resolution=9, hunt_t_max=200.0)


@pytest.fixture(autouse=True)
def tiny(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(quality, "QUICK", TINY)


def test_named_figures_are_written_as_png_and_pdf(run: Run, tmp_path: Path) -> None:
    code, out, err = run("reproduce", "II-xh", "I-potential", "--quick", "--output", tmp_path / "new")
    names = ["I-potential.pdf", "I-potential.png", "II-xh.pdf", "II-xh.png"]
    assert (code, err) == (0, "")
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == names
    assert all(name in out for name in names)
    assert "tiny quality: 9 x 9 starts" in out


def test_json_tells_files_and_seconds(run: Run, tmp_path: Path) -> None:
    code, out, _ = run("reproduce", "II-xh", "--quick", "--json", "--output", tmp_path)
    answer = json.loads(out)
    (figure,) = answer["figures"]
    assert (code, answer["quality"], figure["name"]) == (0, "tiny", "II-xh")
    assert figure["files"] == [str(tmp_path / "II-xh.png"), str(tmp_path / "II-xh.pdf")]
    assert 0.0 < figure["seconds"] <= answer["seconds"]


def test_the_list_names_everything_and_makes_nothing(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, _ = run("reproduce", "--list", "--json")
    assert code == 0
    assert list(json.loads(out)["figures"]) == [*FIGURES, "tables"]
    assert not any(tmp_path.iterdir())


def test_an_unknown_name_is_refused_before_anything_is_made(run: Run, tmp_path: Path) -> None:
    code, out, err = run("reproduce", "I-xh", "IV-xh", "--output", tmp_path / "new")
    assert (code, out, err.count("\n")) == (WRONG_REQUEST, "", 1)
    assert "IV-xh" in err
    assert not any(tmp_path.iterdir())


def test_a_folder_in_no_folder_is_refused(run: Run, tmp_path: Path) -> None:
    assert run("reproduce", "I-xh", "--output", tmp_path / "no" / "such")[0] == WRONG_REQUEST


def test_what_is_made_stays_when_the_rest_is_stopped(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def make(name: str, shelf: MapShelf) -> dict[str, str | bytes]:
        if name == "I-xh":
            signal.raise_signal(signal.SIGINT)
            shelf.map("I", Plane.X_PX, 0.13)
        return {f"{name}.png": b"whole"}

    monkeypatch.setattr(members, "make_files", make)
    code, out, err = run("reproduce", "I-potential", "I-xh", "--quick", "--output", tmp_path)
    assert (code, out) == (STOPPED, "")
    assert "1 of 2" in err
    assert [path.name for path in tmp_path.iterdir()] == ["I-potential.png"]


def test_help_holds_examples(run: Run) -> None:
    code, out, _ = run("reproduce", "--help")
    assert code == 0
    assert "escape-explorer reproduce --quick" in out.partition("Examples:")[2]
