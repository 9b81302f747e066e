"""A missing package is named with the command that installs it."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine import CASES
from engine.foundations.extras import load_pictures, require_package


def test_a_missing_package_has_one_sentence() -> None:
    with pytest.raises(ModuleNotFoundError, match=r"^no_such_package is not installed: pip install 'escape-explorer\[files\]'$"):
        require_package("no_such_package", "files")


def test_the_installed_package_draws_results() -> None:
    assert "<img" in CASES["I"]._repr_html_()


def test_any_package_can_draw_results(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "mine-1.0.dist-info"
    package.mkdir()
    (package / "METADATA").write_text("Name: mine\nVersion: 1.0\n")
    (package / "entry_points.txt").write_text("[mine.pictures]\nmine = types:SimpleNamespace.__name__\n")
    monkeypatch.syspath_prepend(tmp_path)
    assert load_pictures("mine.pictures") == "SimpleNamespace"


def test_without_a_package_that_draws_the_error_says_what_to_install() -> None:
    with pytest.raises(RuntimeError, match="install escape-explorer"):
        load_pictures("of no package")
