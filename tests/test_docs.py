"""The documents have docstrings for all public names, valid links, and existing files and names."""

from __future__ import annotations

import doctest
import html
import inspect
import json
import pkgutil
import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

import engine
from app.state.glossary import GLOSSARY
from docs.pictures.live import LIVE
from engine import results

ROOT = Path(__file__).parents[1]
PAGES = [*sorted(ROOT.glob("*.md")), ROOT / "benchmarks" / "README.md", *sorted((ROOT / "docs").glob("**/*.md"))]

MOST_FOR_DRAWINGS = 420_000
"""Largest size of all drawings, in bytes."""

DOCUMENTED = re.compile(r"^\.\. auto\w+:: (?:escape_explorer\.results\.)?(\w+)$", re.MULTILINE)

EXAMPLE_FILES = ["examples/case_three.py", "examples/tutorial.ipynb"]
EXAMPLES = [name for name in engine.__all__ if ">>>" in (getattr(engine, name).__doc__ or "")]


def page_name(path: Path) -> str:
    return path.relative_to(ROOT).with_suffix("").as_posix()


def test_every_public_name_has_a_docstring() -> None:
    assert [name for name in engine.__all__ if callable(one := getattr(engine, name)) and not one.__doc__] == []


def test_every_public_function_has_an_example() -> None:
    assert [name for name in engine.__all__ if inspect.isfunction(getattr(engine, name)) and name not in EXAMPLES] == []


def test_every_name_is_in_the_reference() -> None:
    texts = [page.read_text(encoding="utf-8") for page in (ROOT / "docs").glob("api/*.md")]
    documented = [name for text in texts for name in DOCUMENTED.findall(text)]
    assert sorted(documented) == sorted([*engine.__all__, *results.__all__])


@pytest.mark.parametrize("page", PAGES, ids=page_name)
def test_links_pictures_formulas_and_names_of_a_page_are_sound(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    targets = [target.split("#")[0] for target in re.findall(r"\]\(([^)\s]+)\)", text) if not re.match(r"[a-z]+:", target)]
    files = re.findall(r"`((?:app|benchmarks|cli|docs|engine|examples|tests)/[\w./-]*)`", text)
    programs = re.findall(r"python -m ([a-z_.]+)|`(benchmarks\.\w+)", text)
    # GitHub takes a backslash before a sign, such as that of a thin space, for Markdown.
    prose = re.sub(r"```.*?```|`[^`]*`", "", text, flags=re.DOTALL)
    found = {
        "missing targets": [target for target in targets if target and not (page.parent / target).exists()],
        "missing files": [name for name in files if not (ROOT / name).exists()],
        "missing programs": [name for name in map("".join, programs) if not _is_program(name.replace(".", "/"))],
        "short alternative texts": [words for words in re.findall(r"!\[([^\]]*)\]\(", text) if len(words.split()) < 3],
        "formulas with escapes": re.findall(r"\$[^$\n]*\\[^a-zA-Z\n][^$\n]*\$", prose),
    }
    if page.stem != "CHANGELOG":
        modules = re.findall(r"`((?:app|cli|engine|reproduction)(?:\.\w+)+)", text)
        found["missing names"] = [name for name in modules if not _is_defined(name)]
    assert found == {kind: [] for kind in found}


def test_live_figures_stand_below_drawings() -> None:
    drawings = {path.stem for path in (ROOT / "docs" / "drawings").iterdir()}
    assert set(LIVE) <= drawings


def test_drawings_are_shown_and_small() -> None:
    shown = {name for page in PAGES for name in re.findall(r"\(drawings/([\w-]+\.webp)\)", page.read_text(encoding="utf-8"))}
    drawings = list((ROOT / "docs" / "drawings").iterdir())
    assert {drawing.name for drawing in drawings} == shown
    assert sum(drawing.stat().st_size for drawing in drawings) < MOST_FOR_DRAWINGS


def test_pictures_of_the_documents_use_names_that_exist() -> None:
    # No picture has the name "none", so the modules are only imported.
    subprocess.run([sys.executable, "-W", "error", "-m", "docs.pictures", "none"], cwd=ROOT, check=True)


@pytest.fixture(scope="module")
def small_site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a site of the page with the terms and the page on chaos, without the pages to which these link."""
    folder = tmp_path_factory.mktemp("site")
    pages = "include_patterns=docs/page.md,docs/chaos.md"
    subprocess.run(
        [sys.executable, "-m", "sphinx", "-Q", "-c", "docs", "-D", pages, "-D", "root_doc=docs/page", ".", str(folder)],
        cwd=ROOT,
        check=True,
    )
    return folder / "docs"


def test_all_terms_are_on_the_page_of_terms(small_site: Path) -> None:
    text = html.unescape((small_site / "page.html").read_text(encoding="utf-8")).replace("’", "'")
    assert [term for term, meaning in GLOSSARY.items() if f">{term}<a" not in text or meaning not in text] == []


def test_formulas_are_mathml(small_site: Path) -> None:
    text = (small_site / "chaos.html").read_text(encoding="utf-8")
    assert re.search(r'<math [^>]*display="block">\s*<mi>SALI</mi>', text)
    assert not re.search(r'src="http|"[^"]*mathjax[^"]*\.js', text)


@pytest.mark.parametrize("name", EXAMPLES)
def test_example_of_a_docstring_prints_what_it_says(name: str) -> None:
    (test,) = doctest.DocTestFinder(recurse=False).find(inspect.unwrap(getattr(engine, name)), name)
    assert doctest.DocTestRunner().run(test).failed == 0


@pytest.mark.parametrize("page", [page for page in PAGES if ">>>" in page.read_text(encoding="utf-8")], ids=page_name)
def test_examples_of_a_page_print_what_it_says(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert doctest.testfile(str(page), module_relative=False).failed == 0


def test_every_code_cell_of_the_tutorial_has_text_before_it() -> None:
    cells = json.loads((ROOT / "examples" / "tutorial.ipynb").read_text(encoding="utf-8"))["cells"]
    kinds = [cell["cell_type"] for cell in cells]
    assert kinds[0] == "markdown"
    assert ("code", "code") not in pairwise(kinds)
    assert not any(cell.get("outputs") for cell in cells)


@pytest.mark.parametrize(
    "name",
    ["README.md", "docs/api.md", "docs/slices.md", "docs/start.md", "docs/sweeps.md", "docs/thresholds.md", *EXAMPLE_FILES],
)
def test_document_for_users_recommends_public_names_only(name: str) -> None:
    assert not re.search(r"from engine\b", (ROOT / name).read_text(encoding="utf-8"))


def _is_program(path: str) -> bool:
    return (ROOT / f"{path}.py").exists() or (ROOT / path / "__main__.py").exists()


def _is_defined(name: str) -> bool:
    try:
        pkgutil.resolve_name(name)
    except (ImportError, AttributeError):
        return False
    return True
