"""The program ``python -m app`` passes options to Panel."""

from __future__ import annotations

from pathlib import Path

import pytest

import app
from app import __main__ as program


def test_panel_serves_the_folder_of_the_page_with_the_times_of_a_public_server() -> None:
    folder = str(Path(app.__path__[0]).absolute())
    assert program.serve_arguments() == ["serve", folder, "--unused-session-lifetime=60000", "--keep-alive=20000"]


def test_invalid_setting_is_reported_before_panel_starts(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ESCAPE_EXPLORER_THREADS", "0")
    with pytest.raises(SystemExit, match="2"):
        program.serve(())
    assert capsys.readouterr().err == "ESCAPE_EXPLORER_THREADS='0': must be a whole number from 1 to 1024\n"
