"""The recipe of the conda package and pyproject.toml name the same version and dependencies."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import pytest
import yaml

ROOT = Path(__file__).parents[1]
PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
RECIPE: dict[str, Any] = yaml.safe_load((ROOT / "packaging" / "recipe.yaml").read_text(encoding="utf-8"))
# Names in PyPI of packages that have another name in conda.
NAMES = {"matplotlib-base": "matplotlib"}


def required(part: str) -> set[str]:
    """Return the requirements of a part of the recipe, as pyproject.toml writes them."""
    pairs = (re.split(r"\s+", line, maxsplit=1) for line in RECIPE["requirements"][part])
    return {NAMES.get(name, name) + "".join(version) for name, *version in pairs}


def test_dependencies_are_the_same() -> None:
    assert required("run") - {"python>=${{ python_min }}"} == set(PROJECT["project"]["dependencies"])


def test_packages_of_the_build_are_the_same() -> None:
    assert required("host") - {"python${{ python_min }}.*", "pip"} == set(PROJECT["build-system"]["requires"])


@pytest.mark.parametrize(
    ("found", "wanted"),
    [
        (RECIPE["context"]["version"], PROJECT["project"]["version"]),
        (f">={RECIPE['context']['python_min']}", PROJECT["project"]["requires-python"]),
        (RECIPE["package"]["name"], PROJECT["project"]["name"]),
        (RECIPE["about"]["summary"], PROJECT["project"]["description"]),
        (RECIPE["about"]["license"], PROJECT["project"]["license"]),
        ([RECIPE["about"]["license_file"]], PROJECT["project"]["license-files"]),
        (RECIPE["build"]["python"]["entry_points"], [" = ".join(pair) for pair in PROJECT["project"]["scripts"].items()]),
    ],
    ids=["version", "python", "name", "summary", "licence", "licence file", "command"],
)
def test_the_facts_of_all_recipes_are_the_same(found: Any, wanted: Any) -> None:
    assert found == wanted
