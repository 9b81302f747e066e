"""Atomic writing of output files."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cli.files import add_ending, write_files


def test_text_and_bytes_are_written(tmp_path: Path) -> None:
    written = write_files({tmp_path / "a": "R²\n", tmp_path / "b": b"\x00\n"})
    assert written == [str(tmp_path / "a"), str(tmp_path / "b")]
    assert ((tmp_path / "a").read_bytes(), (tmp_path / "b").read_bytes()) == ("R²\n".encode(), b"\x00\n")


def test_add_ending_keeps_dots_in_the_name() -> None:
    assert add_ending(Path("maps/h0.19"), "nc") == Path("maps/h0.19.nc")


def test_failed_write_keeps_the_existing_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a").write_text("before")

    def fail(descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(OSError, match="No space"):
        write_files({tmp_path / "a": "after"})
    assert [path.name for path in tmp_path.iterdir()] == ["a"]
    assert (tmp_path / "a").read_text() == "before"


@pytest.mark.skipif(os.name != "posix", reason="file modes are POSIX")
def test_written_files_have_the_default_mode(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    write_files({tmp_path / "a": ""})
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "plain").stat().st_mode
