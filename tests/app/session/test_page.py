"""A page is valid, and is freed when its session ends."""

from __future__ import annotations

import gc
import time
import weakref

from bokeh.core.validation import check_integrity
from bokeh.document import Document
from panel.io.state import set_curdoc

from app.session.explorer import Explorer
from app.session.page import explorer_page
from tests.waiting import SECONDS


def build() -> weakref.ref[Explorer]:
    with set_curdoc(Document()):
        explorer = Explorer()
        explorer_page(explorer)
        explorer.close()
    return weakref.ref(explorer)


def alive(built: list[weakref.ref[Explorer]]) -> list[Explorer]:
    gc.collect()
    return [explorer for reference in built if (explorer := reference()) is not None]


def test_a_closed_page_is_freed() -> None:
    built = [build() for _ in range(2)]
    # A cancelled computation ends within moments, not at once.
    deadline = time.monotonic() + SECONDS
    while alive(built) and time.monotonic() < deadline:
        pass
    assert alive(built) == []


def test_a_page_is_valid() -> None:
    """Validate a page here, because the server does not validate the pages of sessions."""
    document = Document()
    with set_curdoc(document):
        explorer = Explorer()
        explorer_page(explorer).server_doc(document)
        assert document.title == "Escape Explorer"
        issues = check_integrity(document.models)
        explorer.close()
    assert issues.error == []
    # The empty layouts are closed sections.
    assert {warning.name for warning in issues.warning} == {"EMPTY_LAYOUT"}
