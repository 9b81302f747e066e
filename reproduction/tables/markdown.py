"""Markdown tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence


def write_rows(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table with headings; bars inside cells are escaped."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)
