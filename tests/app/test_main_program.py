"""Program ``python -m app``: what it passes to Panel."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

import pytest

import app
from app import __main__ as program


@pytest.fixture
def arguments(monkeypatch: pytest.MonkeyPatch) -> Callable[..., list[str]]:
    """Function that returns the arguments with which Panel would run."""
    given: list[str] = []
    monkeypatch.setattr(sys, "argv", [])
    monkeypatch.setattr("panel.command.main", lambda: given.extend(sys.argv))

    def serve(*options: str) -> list[str]:
        program.serve(options)
        return given

    return serve


def test_panel_serves_the_folder_of_the_page(
    arguments: Callable[..., list[str]], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert arguments()[1:3] == ["serve", str(Path(app.__path__[0]))]


def test_times_and_options_are_passed_on(arguments: Callable[..., list[str]]) -> None:
    assert arguments("--port", "1")[3:] == ["--unused-session-lifetime=60000", "--keep-alive=20000", "--port", "1"]


def test_invalid_setting_is_reported_before_panel_starts(
    arguments: Callable[..., list[str]], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ESCAPE_EXPLORER_THREADS", "0")
    with pytest.raises(SystemExit, match="2"):
        arguments()
    assert capsys.readouterr().err == "ESCAPE_EXPLORER_THREADS='0': must be a whole number from 1 to 1024\n"
