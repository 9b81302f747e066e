"""Names of slices and axes as in the paper, in Matplotlib's math notation, and tables in Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from engine import Slice

_SYMBOLS = {"x": "x", "y": "y", "px": r"\dot{x}", "py": r"\dot{y}", "h": "h"}


def axis_label(name: str) -> str:
    """Return the label of an axis, by its name."""
    return f"${_SYMBOLS[name]}$"


def plane_label(plane: Slice) -> str:
    """Name of a slice by its axes."""
    return f"$({', '.join(_SYMBOLS[name] for name in plane.axis_names)})$"


def write_rows(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table with headings; bars inside cells are escaped."""
    lines = [heads, ["---"] * len(heads), *rows]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)
