"""Files appear whole, or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cli.written_files import add_ending, write_files


def test_files_hold_what_was_given(tmp_path: Path) -> None:
    written = write_files({tmp_path / "a": "R²\n", tmp_path / "b": b"\x00\n"})
    assert written == [str(tmp_path / "a"), str(tmp_path / "b")]
    assert ((tmp_path / "a").read_bytes(), (tmp_path / "b").read_bytes()) == ("R²\n".encode(), b"\x00\n")


def test_an_ending_does_not_eat_a_dot_of_the_name() -> None:
    assert add_ending(Path("maps/h0.19"), "nc") == Path("maps/h0.19.nc")


def test_a_file_that_exists_stays_as_it_was_when_writing_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a").write_text("before")

    def fail(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(OSError, match="No space"):
        write_files({tmp_path / "a": "after"})
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_text() == "before"


@pytest.mark.skipif(os.name != "posix", reason="other systems have no file modes")
def test_files_have_the_mode_that_others_have(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    write_files({tmp_path / "a": ""})
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "plain").stat().st_mode
