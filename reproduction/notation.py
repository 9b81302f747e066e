"""Names of slices and axes as in the paper, in Matplotlib's math notation."""

from __future__ import annotations

from engine import Slice

_SYMBOLS = {"x": "x", "y": "y", "px": r"\dot{x}", "py": r"\dot{y}", "h": "h"}


def axis_label(name: str) -> str:
    """Label of an axis, by its name."""
    return f"${_SYMBOLS[name]}$"


def plane_label(plane: Slice) -> str:
    """Name of a slice by its axes."""
    return f"$({', '.join(_SYMBOLS[name] for name in plane.axis_names)})$"
