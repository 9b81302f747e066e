"""A button that copies a table as tab-separated text, for spreadsheets."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import panel as pn

from app.views.components.widgets import button

Rows = Iterable[Sequence[str]]
"""Texts of the cells."""


def copy_button(rows: Callable[[], Rows], on_copy: Callable[[str], None], **options: Any) -> pn.widgets.Button:
    """A button that copies the rows of the moment of the click; `on_copy` is called with the text."""
    return button("Copy table", lambda: on_copy("\n".join("\t".join(row) for row in rows())), **options)


def number_rows(title: str, numbers: Mapping[str, Any]) -> list[tuple[str, str, str]]:
    """Rows of numbers at full precision, each with a title and its name."""
    return [(title, name, repr(value) if isinstance(value, float) else str(value)) for name, value in numbers.items()]
