"""Generate the HTML documentation from the docstrings of `engine` and from the Markdown files.

Run: python docs/make_api.py [folder]; the default folder is site/.
"""

from __future__ import annotations

import ast
import importlib
import re
import shutil
import sys
import warnings
from pathlib import Path

import pdoc.doc
import pdoc.render
import pdoc.render_helpers

sys.path.insert(0, str(Path(__file__).parents[1]))

import engine
from docs.tutorial import to_markdown

ROOT = Path(__file__).parents[1]
HERE = Path(__file__).parent
PICTURES = ("*.png", "*.webp")
# Links to files that are copied as they are.
LINKED_FILES = re.compile(r"\]\((?:\.\./)?((?:deploy|examples)/[\w.-]+|LICENSE|CITATION\.cff)\)")
LINKED_PAGES = re.compile(r"\]\((?:\.\./)?(?:docs/)?([\w-]+)\.md(#[\w-]+)?\)")
PAGE = """<!doctype html>
<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{title}</title>
<style>
body {{ max-width: 52rem; margin: 2rem auto; padding: 0 1rem; font: 1rem/1.5 system-ui, sans-serif; color-scheme: light dark }}
img {{ max-width: 100% }} pre {{ overflow-x: auto }} td, th {{ padding: 0.2rem 0.6rem; text-align: left; vertical-align: top }}
</style>
<nav><a href="index.html">Escape Explorer</a> · <a href="tutorial.html">Tutorial</a> ·
<a href="engine.html">API reference</a></nav>
{body}
<hr><nav>{pages}</nav>
</html>
"""


def main(arguments: list[str]) -> None:
    """Write the pages."""
    make_site(Path(arguments[0]) if arguments else ROOT / "site")


def make_site(folder: Path, *, run: bool = True) -> None:
    """Write index.html from README.md, one page per Markdown file, the tutorial, and engine.html with every public name.

    With `run` the tutorial is computed, which takes about 20 s, and shows its pictures.
    """
    folder.mkdir(parents=True, exist_ok=True)
    module = document_engine()
    pdoc.render.configure(docformat="numpy", show_source=False)
    with warnings.catch_warnings():
        # pdoc cannot resolve type parameters and annotations inherited by dataclasses; it prints their names.
        warnings.filterwarnings("ignore", "Error parsing type annotation")
        _write(folder / "engine.html", pdoc.render.html_module(module, {"engine": module}))
    _write(folder / "search.js", pdoc.render.search_index({"engine": module}))
    sources = _markdown_files()
    for stem, path in sources.items():
        _write(folder / f"{stem}.html", _to_html(path.read_text(encoding="utf-8"), [*list(sources)[1:], "tutorial"]))
    tutorial = to_markdown(ROOT / "examples" / "tutorial.ipynb", run=run)
    _write(folder / "tutorial.html", _to_html(tutorial, list(sources)[1:]))
    for picture in (path for pattern in PICTURES for path in HERE.glob(pattern)):
        shutil.copy(picture, folder)
    shutil.copytree(HERE / "screenshots", folder / "screenshots", dirs_exist_ok=True)
    for file in {file for path in sources.values() for file in LINKED_FILES.findall(path.read_text(encoding="utf-8"))}:
        (folder / file).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / file, folder / file)


def _markdown_files() -> dict[str, Path]:
    """Markdown files by the names of their pages."""
    files = {"index": ROOT / "README.md", "benchmarks": ROOT / "benchmarks" / "README.md"}
    others = [*sorted(HERE.glob("*.md")), *sorted(ROOT.glob("*.md"))]
    return files | {path.stem.lower(): path for path in others if path.stem != "README"}


def document_engine() -> pdoc.doc.Module:
    """Document the public names of `engine`, constants with the docstrings from their own modules."""
    module = pdoc.doc.Module(engine)
    for name in engine.__all__:
        member = module.get(name)
        if isinstance(member, pdoc.doc.Variable):
            home = pdoc.doc.Module(importlib.import_module(_find_home(name, "engine")))
            member.docstring = home.get(name).docstring
    return module


def _find_home(name: str, module: str) -> str:
    """Follow imports to the module that defines a name."""
    source = Path(str(importlib.import_module(module).__file__)).read_text(encoding="utf-8")
    for node in ast.parse(source).body:
        if isinstance(node, ast.ImportFrom) and node.module and name in {alias.asname or alias.name for alias in node.names}:
            return _find_home(name, node.module)
    return module


def _to_html(text: str, pages: list[str]) -> str:
    """Convert a Markdown page; links to Markdown files become links to their pages."""
    title = text.split("\n", 1)[0].lstrip("# ")
    text = text.replace("benchmarks/README.md)", "benchmarks.md)")
    linked = LINKED_PAGES.sub(lambda link: f"]({link[1].lower()}.html{link[2] or ''})", text)
    linked = linked.replace("](docs/", "](").replace("](../", "](")
    links = " · ".join(f'<a href="{page}.html">{page}</a>' for page in pages)
    return PAGE.format(title=title, body=pdoc.render_helpers.to_html(linked), pages=links)


def _write(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
