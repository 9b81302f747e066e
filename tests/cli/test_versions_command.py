"""The command `versions` and `show_versions` tell what a report of an error needs."""

from __future__ import annotations

import json
import platform
from importlib import metadata
from pathlib import Path

import pytest

from engine import show_versions
from engine.foundations.cache_files import CACHE_VARIABLE
from tests.cli.conftest import Run


def test_versions_are_those_of_the_running_packages(run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    code, out, _ = run("versions", "--json")
    versions = json.loads(out)
    assert code == 0
    assert versions["Python"] == platform.python_version()
    assert {
        name: metadata.version(name) for name in ("escape-explorer", "numpy", "numba", "llvmlite", "panel")
    }.items() <= versions.items()
    assert Path(versions["cache"]).parent == tmp_path
    assert int(versions["threads"]) >= 1
    assert platform.machine() in versions["processor"]


def test_a_missing_package_is_named(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    def find(name: str) -> str:
        if name == "distributed":
            raise metadata.PackageNotFoundError(name)
        return "1.0"

    monkeypatch.setattr(metadata, "version", find)
    _, out, _ = run("versions", "--json")
    assert (json.loads(out)["distributed"], json.loads(out)["numpy"]) == ("not installed", "1.0")


def test_the_function_prints_what_the_command_prints(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    _, out, _ = run("versions", "--json")
    show_versions()
    lines = capsys.readouterr().out.splitlines()
    assert dict(line.split(maxsplit=1) for line in lines) == json.loads(out)
