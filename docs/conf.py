"""The documentation as a site. Run: .ci/docs

The folder of sources is the repository, so that the links between Markdown files are the same here as on GitHub.
"""

from __future__ import annotations

import ast
import importlib
import inspect
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sphinx.application import Sphinx

project = "Escape Explorer"
author = "The Escape Explorer developers"

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
root_doc = "docs/index"
include_patterns = ["*.md", "docs/*.md", "benchmarks/README.md", "examples/tutorial.ipynb"]
exclude_patterns = [".*", "README.md", "site"]

myst_heading_anchors = 3
nb_execution_mode = "force"
nb_execution_raise_on_error = True
# A loaded machine, with an empty cache of kernels.
nb_execution_timeout = 300
# Progress bars, and what libraries say about this machine.
nb_output_stderr = "remove"

default_role = "py:obj"
autodoc_default_options = {"members": True, "member-order": "bysource"}
python_maximum_signature_line_length = 100
napoleon_attr_annotations = False
# Sentences, not a list of types.
napoleon_custom_sections = ["Returns"]

html_theme = "furo"
html_title = project
html_extra_path = ["redirect"]


def setup(app: Sphinx) -> None:
    """Docstrings that the extensions do not find or misread are set after them."""
    app.connect("autodoc-process-docstring", _set_docstring, priority=900)


def _set_docstring(app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]) -> None:
    if what == "data":
        # Constants have their docstrings where they are defined; autodoc looks for them where they are imported.
        module, constant = name.rsplit(".", 1)
        # `escape_explorer` has the names of `engine`, which it imports at their first use.
        lines[:] = [*_docstring(constant, module.replace("escape_explorer", "engine")).splitlines(), ""]
    elif what == "property":
        # Napoleon takes the words before a colon for a type.
        lines[:] = [*inspect.cleandoc(obj.__doc__ or "").splitlines(), ""]


def _docstring(name: str, module: str) -> str:
    """The string below the definition of a constant, in the module that defines it."""
    body = ast.parse(Path(str(importlib.import_module(module).__file__)).read_text(encoding="utf-8")).body
    for node, following in pairwise(body):
        if isinstance(node, ast.ImportFrom) and name in {alias.name for alias in node.names}:
            return _docstring(name, str(node.module))
        if ast.unparse(node).startswith((f"{name} =", f"{name}:")) and isinstance(following, ast.Expr):
            return str(ast.literal_eval(following.value))
    raise ValueError(f"{module}.{name} has no docstring")
