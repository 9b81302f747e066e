"""The documentation: every public name has its words, and no link leads nowhere."""

from __future__ import annotations

import re
import runpy
from pathlib import Path
from typing import Any

import pytest

import engine

ROOT = Path(__file__).parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


@pytest.fixture(scope="module")
def make_api() -> dict[str, Any]:
    """What docs/make_api.py defines."""
    return runpy.run_path(str(ROOT / "docs" / "make_api.py"))


@pytest.fixture(scope="module")
def site(make_api: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The pages, made; a warning would be an error."""
    folder = tmp_path_factory.mktemp("site") / "new"
    make_api["make_site"](folder)
    return folder


def test_every_public_name_has_a_docstring(make_api: dict[str, Any]) -> None:
    module = make_api["document_engine"]()
    assert [name for name in engine.__all__ if not module.get(name).docstring.strip()] == []


def test_a_constant_has_the_docstring_of_its_own_module(make_api: dict[str, Any]) -> None:
    assert "t_max" in make_api["document_engine"]().get("LONGEST_TIME").docstring


def test_every_public_name_is_in_the_pages(site: Path) -> None:
    found = set(re.findall(r'id="([\w.]+)"', (site / "engine.html").read_text(encoding="utf-8")))
    assert set(engine.__all__) <= found
    assert "EscapeMap.to_xarray" in found


def test_private_modules_are_not_in_the_pages(site: Path) -> None:
    assert {path.name for path in site.rglob("*") if path.is_dir()} == {"deploy", "examples"}


def test_the_pages_lead_to_each_other(site: Path) -> None:
    for path in site.glob("*.html"):
        text = path.read_text(encoding="utf-8")
        targets = set(re.findall(r'(?:href|src)="([^"#:]+)(?:#[^"]*)?"', text))
        assert {target for target in targets if not (site / target).exists()} == set(), path.name
    assert 'href="certificates.html"' in (site / "index.html").read_text(encoding="utf-8")


def test_tables_are_tables(site: Path) -> None:
    assert "<table" in (site / "certificates.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)
def test_its_links_lead_to_files_that_exist(page: Path) -> None:
    targets = re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8"))
    local = [target.split("#")[0] for target in targets if not re.match(r"[a-z]+:", target)]
    assert [target for target in local if target and not (page.parent / target).exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.stem)
def test_names_of_files_in_it_exist(page: Path) -> None:
    named = re.findall(r"`((?:app|benchmarks|cli|docs|engine|examples|tests)/[\w./-]*)`", page.read_text(encoding="utf-8"))
    assert [name for name in named if not (ROOT / name).exists()] == []
