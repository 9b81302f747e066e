"""The ending of the name of an output file is its format, and each file is written as a whole."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from cli.main import INVALID_REQUEST
from cli.output_files import name_files, write_files
from tests.cli.conftest import Run

COMMANDS = {
    "map": ("map", "I", "--energy", 0.13, "--resolution", 9, "--t-max", 100, "--picture", "basins"),
    "orbit": ("orbit", "I", "--state", 0.1, 0.0, 0.05, 0.6, "--t-max", 20),
    "curves": (
        "curves", "I", "--low", 0.2, "--high", 0.3, "--count", 2, "--resolution", 12, "--t-max", 100, "--no-exponent",
    ),
}  # fmt: skip
STYLE = ("--width", 8.5, "--no-titles", "--font-size", 7)


def test_text_and_bytes_are_written(tmp_path: Path) -> None:
    written = write_files({tmp_path / "a": "R²\n", tmp_path / "b": b"\x00\n"})
    assert written == [str(tmp_path / "a"), str(tmp_path / "b")]
    assert ((tmp_path / "a").read_bytes(), (tmp_path / "b").read_bytes()) == ("R²\n".encode(), b"\x00\n")


def test_a_number_at_the_end_of_a_name_is_not_taken_for_an_ending() -> None:
    assert name_files(Path("maps/h0.19"), ["nc", "png"], ["nc"]) == {"nc": Path("maps/h0.19.nc")}


@pytest.mark.skipif(os.name != "posix", reason="file modes are POSIX")
def test_written_files_have_the_default_mode(tmp_path: Path) -> None:
    (tmp_path / "plain").write_text("")
    write_files({tmp_path / "a": ""})
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.parametrize(
    ("command", "ending", "begins"),
    [
        ("map", "svg", b"<?xml"),
        ("map", "nc", b"\x89HDF"),
        ("orbit", "csv", b"# escape-explorer"),
        ("orbit", "png", b"\x89PNG"),
        ("curves", "csv", b"# escape-explorer"),
        ("curves", "pdf", b"%PDF"),
    ],
)
def test_the_ending_of_the_file_name_is_its_format(command: str, ending: str, begins: bytes, run: Run, tmp_path: Path) -> None:
    path = tmp_path / f"h0.13.{ending}"
    assert run(*COMMANDS[command], *STYLE, "--output", path)[0] == 0
    assert list(tmp_path.iterdir()) == [path]
    assert path.read_bytes().startswith(begins)


@pytest.mark.parametrize("command", COMMANDS)
def test_unknown_ending_is_refused_with_the_legal_ones(command: str, run: Run, tmp_path: Path) -> None:
    code, out, err = run(*COMMANDS[command], "--output", tmp_path / "h0.13.tiff")
    assert (code, out, list(tmp_path.iterdir())) == (INVALID_REQUEST, "", [])
    assert "h0.13.tiff': the ending must be one of " in err
    assert "png, svg, pdf" in err
