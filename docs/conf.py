"""Settings of Sphinx, which builds the documentation as a site. Run: .ci/docs

The folder of sources is the repository, so that the links between Markdown files are the same here as on GitHub.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import re
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

from docutils import nodes
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.util.docutils import SphinxDirective

from app.state.glossary import GLOSSARY
from docs.pictures.live import FOLDER, LIVE, write_live_figures
from engine import results

if TYPE_CHECKING:
    from sphinx.application import Sphinx
    from sphinx.writers.html5 import HTML5Translator

project = "Escape Explorer"
author = "The Escape Explorer developers"

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "docs/index"
include_patterns = ["*.md", "docs/*.md", "docs/api/*.md", "benchmarks/README.md", "examples/tutorial.ipynb"]
exclude_patterns = [".*", "README.md", "site"]

myst_heading_anchors = 3
# Formulas are written as on GitHub: $…$ in a line, blocks fenced as `math`.
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
nb_execution_mode = "force"
nb_execution_raise_on_error = True
# Seconds for each cell: enough on a loaded machine with an empty cache of kernels.
nb_execution_timeout = 300
# The output on stderr is progress bars, and what libraries say about this machine.
nb_output_stderr = "remove"

default_role = "py:obj"
autodoc_default_options = {"members": True, "member-order": "bysource"}
python_maximum_signature_line_length = 100
napoleon_attr_annotations = False
# Sections "Returns" contain sentences. By default, Napoleon reads a list of types.
napoleon_custom_sections = ["Returns"]

html_theme = "furo"
html_title = project
html_extra_path = ["redirect"]
html_static_path = ["static"]
html_css_files = ["formulas.css", "live.css"]
# Browsers show MathML without a program. MathJax would come from another host.
html_math_renderer = "mathml"


def setup(app: Sphinx) -> None:
    """Add formulas as MathML, the list of terms and live figures, and replace docstrings that the extensions misread or miss."""
    app.add_html_math_renderer("mathml", (_write_formula, None), (_write_formula, None))
    app.add_directive("terms", Terms)
    app.connect("autodoc-process-docstring", _set_docstring, priority=900)
    app.connect("doctree-resolved", _add_live_figures)
    app.connect("build-finished", lambda app, error: None if error else write_live_figures(Path(app.outdir)))


class Terms(SphinxDirective):
    """Writes the terms of the page with their meanings, as a glossary."""

    def run(self) -> list[nodes.Node]:
        """Return the nodes of the glossary."""
        entries = (f"{term}\n  {meaning}\n" for term, meaning in GLOSSARY.items())
        return self.parse_text_to_nodes("\n".join(["```{glossary}", ":sorted:", "", *entries, "```"]))


def _add_live_figures(app: Sphinx, doctree: nodes.document, name: str) -> None:
    """Add the live figure of each drawing that has one, closed at first, because an open one computes."""
    for image in [*doctree.findall(nodes.image)]:
        drawing = Path(image["uri"])
        if drawing.parent.name != "drawings" or drawing.stem not in LIVE:
            continue
        address = f"{'../' * name.count('/')}{FOLDER}/{drawing.stem}.html"
        frame = f'<iframe src="{address}" title="Live figure" loading="lazy" sandbox="allow-scripts"></iframe>'
        html = f'<details class="live"><summary>Change this map yourself</summary>{frame}</details>'
        image.parent.parent.insert(image.parent.parent.index(image.parent) + 1, nodes.raw("", html, format="html"))


def _write_formula(writer: HTML5Translator, node: nodes.math | nodes.math_block) -> None:
    writer.body.append(tex2mathml(node.astext(), as_block=isinstance(node, nodes.math_block)))
    raise nodes.SkipNode


def _set_docstring(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    if what == "data":
        # Constants have their docstrings where they are defined; autodoc looks for them where they are imported.
        module, constant = name.rsplit(".", 1)
        # `escape_explorer` has the names of `engine`, which it imports at their first use.
        lines[:] = [*_docstring(constant, module.replace("escape_explorer", "engine")).splitlines(), ""]
    elif what == "property":
        # Napoleon takes the words before a colon for a type.
        lines[:] = [*inspect.cleandoc(obj.__doc__ or "").splitlines(), ""]
    # Docstrings name the classes of results without their module.
    lines[:] = [re.sub(rf"(?<!`)`({'|'.join(results.__all__)})\b", r"`~escape_explorer.results.\1", line) for line in lines]


def _docstring(name: str, module: str) -> str:
    """Return the string below the definition of a constant, in the module that defines it."""
    body = ast.parse(Path(str(importlib.import_module(module).__file__)).read_text(encoding="utf-8")).body
    for node, following in pairwise(body):
        if isinstance(node, ast.ImportFrom) and name in {alias.name for alias in node.names}:
            return _docstring(name, str(node.module))
        if ast.unparse(node).startswith((f"{name} =", f"{name}:")) and isinstance(following, ast.Expr):
            return str(ast.literal_eval(following.value))
    raise ValueError(f"{module}.{name} has no docstring")
