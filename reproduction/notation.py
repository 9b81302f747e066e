"""Write names of slices and axes as in the paper, for Matplotlib's math mode, and tables in Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from engine import Slice

# Symbols of the axes in the paper.
_SYMBOLS = {"x": "x", "y": "y", "px": r"\dot{x}", "py": r"\dot{y}", "h": "h"}


def axis_label(name: str) -> str:
    """Return the label of the axis with a name."""
    return f"${_SYMBOLS[name]}$"


def plane_label(plane: Slice) -> str:
    """Return the name of a slice: its axes in brackets."""
    return f"$({', '.join(_SYMBOLS[name] for name in plane.axis_names)})$"


def write_rows(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table with headings. Bars inside cells are escaped."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)
