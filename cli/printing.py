"""Print results on stdout: tables and sentences, or JSON."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import Annotated, Any

import numpy as np
import typer
from rich import box
from rich.console import Console
from rich.table import Table as RichTable

from cli.option_marks import DocumentedBy

# Width of the console, in characters. No table is wider, so nothing is cut. A terminal wraps the lines.
_WIDTH = 10_000


@dataclass(frozen=True)
class Table:
    """A table of texts, with names of columns. All columns except the first are right-aligned."""

    head: Sequence[str]
    rows: Sequence[Sequence[str]]


def print_result(as_json: bool, answer: Mapping[str, Any], *parts: Table | str, files: Sequence[str] | None = None) -> None:
    """Print the answer as a JSON object, or print the tables and sentences.

    Parameters
    ----------
    as_json
        Print JSON instead of tables and sentences; NaN and infinity are null.
    answer
        Content of the JSON object.
    parts
        Tables and sentences.
    files
        Written files; None for commands that do not write files.
    """
    console = Console(width=_WIDTH)
    if as_json:
        content = _to_json({**answer, **({} if files is None else {"files": files})})
        console.out(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False), highlight=False)
        return
    for part in (*parts, *([f"Written: {', '.join(files)}"] if files else [])):
        if isinstance(part, str):
            console.out(part, highlight=False)
        else:
            console.print(_lay_out(part), highlight=False, markup=False)


AsJson = Annotated[bool, typer.Option("--json"), DocumentedBy(print_result)]
"""Type of the option that chooses JSON."""


def list_rows(columns: Mapping[str, np.ndarray]) -> list[dict[str, Any]]:
    """Return one dictionary for each row of a table."""
    rows = zip(*(column.tolist() for column in columns.values()), strict=True)
    return [dict(zip(columns, row, strict=True)) for row in rows]


def _lay_out(table: Table) -> RichTable:
    rich_table = RichTable(box=box.SIMPLE_HEAD, show_edge=False)
    for number, name in enumerate(table.head):
        rich_table.add_column(name, justify="right" if number else "left", no_wrap=True)
    for row in table.rows:
        rich_table.add_row(*row)
    return rich_table


def _to_json(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(name): _to_json(each) for name, each in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _to_json(value.tolist())
    if isinstance(value, list | tuple):
        return [_to_json(each) for each in value]
    if isinstance(value, Enum):
        return _to_json(value.value)
    return None if isinstance(value, float) and not math.isfinite(value) else value
