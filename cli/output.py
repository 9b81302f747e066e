"""Output on stdout: tables and sentences, or JSON."""

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
from engine.propagation.fates import name_fate

# Width of tables when stdout is not a terminal.
_PIPE_WIDTH = 200


def print_json(content: Mapping[str, Any]) -> None:
    """Print one JSON object; NaN and infinity become null."""
    _console().out(json.dumps(_to_json(content), indent=2, ensure_ascii=False, allow_nan=False), highlight=False)


def print_table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table; all columns but the first are right-aligned."""
    table = Table(box=box.SIMPLE_HEAD, show_edge=False)
    for number, name in enumerate(head):
        table.add_column(name, justify="right" if number else "left", no_wrap=True)
    for row in rows:
        table.add_row(*row)
    _console().print(table, highlight=False, markup=False)


def print_sentences(*sentences: str) -> None:
    """Print sentences, one per line."""
    for sentence in sentences:
        _console().out(sentence, highlight=False)


def outcome_shares(frame: EscapeMap, *, count_outside: bool) -> dict[str, float]:
    """Return the share of each outcome among the starts of a complete map, by outcome name."""
    fractions = frame.fractions(count_outside=count_outside)
    return {name_fate(code, frame.spec.outcomes): share for code, share in fractions.items() if code != Fate.NOT_COMPUTED}


def _console() -> Console:
    console = Console()
    return console if console.is_terminal else Console(width=_PIPE_WIDTH)


def _to_json(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(name): _to_json(one) for name, one in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return _to_json(value.tolist())
    if isinstance(value, list | tuple):
        return [_to_json(one) for one in value]
    if isinstance(value, Enum):
        return _to_json(value.value)
    return None if isinstance(value, float) and not math.isfinite(value) else value
