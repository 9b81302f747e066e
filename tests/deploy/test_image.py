"""The image has every package that the server imports, in the tested versions, and external images and actions have versions."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
PACKAGES = PROJECT["tool"]["importlinter"]["root_packages"]
REQUIREMENTS = (ROOT / "deploy" / "requirements.txt").read_text()


@pytest.mark.parametrize("name", [*PACKAGES, "hatch_build.py", "pyproject.toml", "README.md", "LICENSE"])
def test_a_package_or_file_of_the_build_is_copied_and_not_ignored(name: str) -> None:
    copied = re.findall(r"^COPY (?!--from)(.*) \S+$", (ROOT / "Dockerfile").read_text(), re.MULTILINE)
    assert name in " ".join(copied).split()
    assert f"!{name}" in (ROOT / ".dockerignore").read_text().splitlines()


def test_the_image_has_the_tested_versions() -> None:
    tested = dict(constraint.split("==") for constraint in PROJECT["tool"]["uv"]["constraint-dependencies"])
    installed = dict(re.findall(r"^([\w.-]+)==([^ ;]+)", REQUIREMENTS, re.MULTILINE))
    assert {name: version for name, version in installed.items() if tested.get(name, version) != version} == {}
    needed = [*PROJECT["project"]["dependencies"], *PROJECT["project"]["optional-dependencies"]["page"]]
    assert {re.split(r"\W*[<>=\[]", need)[0] for need in needed} - {"escape-explorer"} <= installed.keys()


def test_each_package_of_the_image_has_a_hash() -> None:
    entries = re.split(r"\n(?=\w)", REQUIREMENTS.strip())
    assert [entry for entry in entries if not re.search(r"--hash=sha256:[0-9a-f]{64}", entry)] == []
    assert "://" not in REQUIREMENTS


def test_the_base_of_the_image_has_a_version() -> None:
    assert re.search(
        r"^ARG BASE=python(:\d+\.\d+\.\d+-slim-[a-z]+|@sha256:[0-9a-f]{64})$", (ROOT / "Dockerfile").read_text(), re.MULTILINE
    )


def test_actions_have_versions() -> None:
    workflows = [path.read_text() for path in (ROOT / ".github" / "workflows").iterdir()]
    used = re.findall(r"uses: (\S+)", "\n".join(workflows))
    assert used
    assert all(re.fullmatch(r"[\w/-]+@(v\d+\.\d+\.\d+|[0-9a-f]{40})", action) for action in used), used
