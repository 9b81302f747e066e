"""A page is built for a visitor, and nothing holds on to it when they have gone."""

from __future__ import annotations

import gc
import time
import weakref
from collections.abc import Callable
from typing import Any

from bokeh.core.validation import check_integrity
from bokeh.document import Document
from panel.io.state import set_curdoc

from app.session.explorer import Explorer
from app.session.page import explorer_page


class Sessionless(Document):
    """A document that nobody looks at: its callbacks need no lock."""

    def locked_callback(self, callback: Callable[..., None], *, policy: str = "every") -> Any:
        return callback


def build() -> weakref.ref[Explorer]:
    with set_curdoc(Sessionless()):
        explorer = Explorer()
        page = explorer_page(explorer)
        assert page.title == "Escape Explorer"
        explorer.close()
    return weakref.ref(explorer)


def held(built: list[weakref.ref[Explorer]]) -> list[Explorer]:
    gc.collect()
    return [explorer for reference in built if (explorer := reference()) is not None]


def test_a_closed_page_is_let_go_of() -> None:
    built = [build() for _ in range(2)]
    deadline = time.monotonic() + 20.0  # a computation that was stopped reads it within moments, not at once
    while held(built) and time.monotonic() < deadline:
        time.sleep(0.1)
    assert held(built) == []


def test_a_page_is_sound() -> None:
    """The server does not look at each visitor's anew."""
    document = Sessionless()
    with set_curdoc(document):
        explorer = Explorer()
        explorer_page(explorer).server_doc(document)
        issues = check_integrity(document.models)
        explorer.close()
    assert issues.error == []
    # Sections that nobody has opened.
    assert {warning.name for warning in issues.warning} == {"EMPTY_LAYOUT"}
