"""The ending of a file's name is its format, and no other file is written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

Run = Callable[..., tuple[int, str, str]]

COMMANDS = {
    "map": ("map", "I", "--energy", 0.13, "--resolution", 9, "--t-max", 100, "--picture", "basins"),
    "orbit": ("orbit", "I", "--state", 0.1, 0.0, 0.05, 0.6, "--t-max", 20),
    "curves": (
        "curves", "I", "--low", 0.2, "--high", 0.3, "--count", 2, "--resolution", 12, "--t-max", 100, "--no-exponent",
    ),
}  # fmt: skip
STYLE = ("--width", 8.5, "--no-titles", "--font-size", 7)


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
