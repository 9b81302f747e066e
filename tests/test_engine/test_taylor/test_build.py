from __future__ import annotations

from pathlib import Path

import pytest

from engine import CASES
from engine.taylor import build

TERMS = ((2, 0, 0.5), (0, 2, 0.5))


@pytest.fixture
def fresh_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv(build.CACHE_VARIABLE, str(tmp_path))
    monkeypatch.setattr(build, "_load", build._load.__wrapped__)
    return tmp_path / "kernels"


def test_the_environment_chooses_the_folder(fresh_folder: Path) -> None:
    assert build.cache_folder() == fresh_folder


def test_source_is_kept_for_the_next_run(fresh_folder: Path) -> None:
    module = build.load_kernels(TERMS, 0)
    assert Path(str(module.__file__)) in fresh_folder.glob("*.py")


def test_source_already_there_is_not_written_again(fresh_folder: Path) -> None:
    file = Path(str(build.load_kernels(TERMS, 0).__file__))
    written = file.stat().st_mtime_ns
    build.load_kernels(TERMS, 0)
    assert file.stat().st_mtime_ns == written


def test_other_terms_or_channels_are_another_file(fresh_folder: Path) -> None:
    modules = [build.load_kernels(TERMS, 0), build.load_kernels(TERMS, 1), build.load_kernels(((2, 0, 0.5),), 0)]
    assert len({module.__file__ for module in modules}) == 3
    assert all(Path(str(module.__file__)).parent == fresh_folder for module in modules)


def test_a_folder_that_cannot_be_made_is_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    obstacle = tmp_path / "file"
    obstacle.write_text("")
    monkeypatch.setenv(build.CACHE_VARIABLE, str(obstacle))
    folder = build.cache_folder()
    assert folder.is_dir()
    assert obstacle not in folder.parents


def test_kernels_of_a_potential_are_loaded_once() -> None:
    first = build.load_kernels(CASES["I"].terms, 2)
    assert build.load_kernels(CASES["I"].terms, 2) is first
