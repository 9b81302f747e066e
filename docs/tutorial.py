"""The tutorial notebook as Markdown, with the outputs of its cells computed now."""

from __future__ import annotations

import ast
import base64
import json
from contextlib import redirect_stdout
from io import BytesIO, StringIO
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib import pyplot


def to_markdown(notebook: Path, *, run: bool) -> str:
    """Text and code of a notebook; with `run` also what each cell shows."""
    names: dict[str, Any] = {}
    parts: list[str] = []
    if run:
        matplotlib.use("Agg")
    for cell in json.loads(notebook.read_text(encoding="utf-8"))["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source)
            continue
        parts.append(f"```python\n{source}\n```")
        if run:
            parts += _run(source, names)
    return "\n\n".join(parts) + "\n"


def _run(source: str, names: dict[str, Any]) -> list[str]:
    """What a cell shows: its printed text, the value of its last line, and its figures."""
    *statements, last = ast.parse(source).body
    printed, shown = StringIO(), []
    with redirect_stdout(printed):
        exec(compile(ast.Module(statements, []), "tutorial", "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), "tutorial", "eval"), names)
            shown = [] if value is None or source.endswith(";") else [_html(value)]
        else:
            exec(compile(ast.Module([last], []), "tutorial", "exec"), names)
    text = [f"```\n{printed.getvalue()}```"] if printed.getvalue() else []
    return [*text, *shown, *_figures()]


def _html(value: Any) -> str:
    represent = getattr(value, "_repr_html_", None)
    return "".join(line.strip() for line in represent().splitlines()) if represent else f"```\n{value}\n```"


def _figures() -> list[str]:
    """The open figures as images; closes them."""
    images = []
    for number in pyplot.get_fignums():
        file = BytesIO()
        pyplot.figure(number).savefig(file, format="png", dpi=72)
        images.append(f'<img alt="figure" src="data:image/png;base64,{base64.b64encode(file.getvalue()).decode()}">')
    pyplot.close("all")
    return images
