"""The documentation: docstrings of all public names, valid links, and existing files and names."""

from __future__ import annotations

import pkgutil
import re
import runpy
from pathlib import Path
from typing import Any

import pytest

import engine

ROOT = Path(__file__).parents[1]
PAGES = [*sorted(ROOT.glob("*.md")), ROOT / "benchmarks" / "README.md", *sorted((ROOT / "docs").glob("*.md"))]


def page_name(path: Path) -> str:
    return path.relative_to(ROOT).with_suffix("").as_posix()


@pytest.fixture(scope="module")
def make_api() -> dict[str, Any]:
    """Names defined by docs/make_api.py."""
    return runpy.run_path(str(ROOT / "docs" / "make_api.py"))


@pytest.fixture(scope="module")
def site(make_api: dict[str, Any], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The generated pages; warnings are errors."""
    folder = tmp_path_factory.mktemp("site") / "new"
    make_api["make_site"](folder)
    return folder


def test_every_public_name_has_a_docstring(make_api: dict[str, Any]) -> None:
    module = make_api["document_engine"]()
    assert [name for name in engine.__all__ if not module.get(name).docstring.strip()] == []


def test_constant_has_the_docstring_of_its_module(make_api: dict[str, Any]) -> None:
    assert "Zotos" in make_api["document_engine"]().get("CASES").docstring


def test_every_public_name_is_in_the_pages(site: Path) -> None:
    found = set(re.findall(r'id="([\w.]+)"', (site / "engine.html").read_text(encoding="utf-8")))
    assert set(engine.__all__) <= found
    assert "EscapeMap.to_xarray" in found


def test_pages_contain_no_private_modules(site: Path) -> None:
    assert {path.name for path in site.rglob("*") if path.is_dir()} == {"deploy", "examples", "screenshots"}


def test_links_between_pages_are_valid(site: Path) -> None:
    for path in site.glob("*.html"):
        text = path.read_text(encoding="utf-8")
        targets = set(re.findall(r'(?:href|src)="([^"#:]+)(?:#[^"]*)?"', text))
        assert {target for target in targets if not (site / target).exists()} == set(), path.name
    assert 'href="certificates.html"' in (site / "index.html").read_text(encoding="utf-8")


def test_markdown_tables_become_html_tables(site: Path) -> None:
    assert "<table" in (site / "certificates.html").read_text(encoding="utf-8")


@pytest.mark.parametrize("page", PAGES, ids=page_name)
def test_links_point_to_existing_files(page: Path) -> None:
    targets = re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8"))
    local = [target.split("#")[0] for target in targets if not re.match(r"[a-z]+:", target)]
    assert [target for target in local if target and not (page.parent / target).exists()] == []


@pytest.mark.parametrize("page", PAGES, ids=page_name)
def test_files_named_in_text_exist(page: Path) -> None:
    named = re.findall(r"`((?:app|benchmarks|cli|docs|engine|examples|tests)/[\w./-]*)`", page.read_text(encoding="utf-8"))
    assert [name for name in named if not (ROOT / name).exists()] == []


@pytest.mark.parametrize("page", [page for page in PAGES if page.stem != "CHANGELOG"], ids=page_name)
def test_modules_named_in_text_exist(page: Path) -> None:
    named = re.findall(r"`((?:app|cli|engine|reproduction)(?:\.\w+)+)", page.read_text(encoding="utf-8"))
    assert [name for name in named if not _is_defined(name)] == []


def test_python_example_of_the_readme_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (code,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    monkeypatch.chdir(tmp_path)
    exec(compile(code, "README.md", "exec"), {})


def _is_defined(name: str) -> bool:
    try:
        pkgutil.resolve_name(name)
    except (ImportError, AttributeError):
        return False
    return True
