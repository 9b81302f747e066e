"""Answers on stdout: small tables and sentences for people, JSON for programs."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from enum import Enum
from typing import Any

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

from engine import EscapeMap, Fate

# Wide enough for any table of ours where nobody's window sets a width.
_PIPE_WIDTH = 200


def print_json(answer: Mapping[str, Any]) -> None:
    """One JSON object; NaN and infinity, which JSON lacks, are null."""
    _console().out(json.dumps(_plain(answer), indent=2, ensure_ascii=False, allow_nan=False), highlight=False)


def print_table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """A table; all columns but the first to the right."""
    table = Table(box=box.SIMPLE_HEAD, show_edge=False)
    for number, name in enumerate(head):
        table.add_column(name, justify="right" if number else "left", no_wrap=True)
    for row in rows:
        table.add_row(*row)
    _console().print(table, highlight=False, markup=False)


def print_sentences(*sentences: str) -> None:
    """Sentences, a line each."""
    for sentence in sentences:
        _console().out(sentence, highlight=False)


def name_outcome(code: int) -> str:
    """A fate code in a word or two."""
    return f"channel {code}" if code >= 1 else Fate(code).name.lower().replace("_", " ")


def name_shares(frame: EscapeMap, *, count_outside: bool) -> dict[str, float]:
    """Shares of a whole map's starts by the names of their outcomes."""
    fractions = frame.fractions(count_outside=count_outside)
    return {name_outcome(code): share for code, share in fractions.items() if code != Fate.NOT_COMPUTED}


def _console() -> Console:
    console = Console()
    return console if console.is_terminal else Console(width=_PIPE_WIDTH)


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(name): _plain(one) for name, one in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    if isinstance(value, Enum):
        return _plain(value.value)
    return None if isinstance(value, float) and not math.isfinite(value) else value
