"""Command ``serve`` becomes the server, with the right command line and environment."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import app
from cli.commands.serve import serve_arguments, server_environment
from tests.cli.conftest import Run


def test_default_address_is_local_only() -> None:
    command = serve_arguments(5006, "127.0.0.1", [], show=False)
    assert command[command.index("--address") + 1] == "127.0.0.1"
    assert not any("origin" in argument or argument == "--show" for argument in command)


@pytest.mark.skipif(os.name != "posix", reason="elsewhere the server is a child process")
def test_the_command_becomes_the_server_with_its_options(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[tuple[Any, ...]] = []

    def become(*call: Any) -> None:
        calls.append(call)
        raise SystemExit

    monkeypatch.setattr(os, "execve", become)
    origins = ("--allow-websocket-origin", "a", "--allow-websocket-origin", "b:1")
    with pytest.raises(SystemExit):
        run("serve", "--port", 8080, "--address", "0.0.0.0", *origins, "--show")
    program, command, environment = calls[0]
    assert program == command[0] == sys.executable
    assert command[1:] == [
        "-P", "-m", "app", "--port", "8080", "--address", "0.0.0.0", "--allow-websocket-origin=a", "--allow-websocket-origin=b:1",
        "--show",
    ]  # fmt: skip
    assert environment == server_environment()


def test_folder_named_app_in_the_working_directory_is_not_imported(tmp_path: Path) -> None:
    (tmp_path / "app").mkdir()
    (tmp_path / "app" / "__init__.py").write_text("")
    command = serve_arguments(5006, "127.0.0.1", [], show=False)
    python = command[: command.index("-m")]
    script = "import importlib.util as u; print(u.find_spec('app').origin)"
    process = subprocess.run(
        [*python, "-c", script], cwd=tmp_path, env=server_environment(), capture_output=True, text=True, check=True
    )
    assert process.stdout.strip() == app.__file__
