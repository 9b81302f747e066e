"""The image has every package that the server imports."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGES = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["importlinter"]["root_packages"]


@pytest.mark.parametrize("name", [*PACKAGES, "hatch_build.py", "pyproject.toml", "README.md", "LICENSE"])
def test_a_package_or_file_of_the_build_is_copied_and_not_ignored(name: str) -> None:
    copied = re.findall(r"^COPY (?!--from)(.*) \S+$", (ROOT / "Dockerfile").read_text(), re.MULTILINE)
    assert name in " ".join(copied).split()
    assert f"!{name}" in (ROOT / ".dockerignore").read_text().splitlines()
