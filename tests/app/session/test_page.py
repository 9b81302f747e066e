"""A page is valid, and is freed when its session ends."""

from __future__ import annotations

import gc
import time
import weakref

from bokeh.core.validation import check_integrity
from bokeh.document import Document
from panel.io.state import set_curdoc
from panel.viewable import Viewable

from app.session.explorer import Explorer
from app.session.page import explorer_page
from plots.studies.section import SECTION_STUDY
from tests.waiting import SECONDS

MOST_VIEWS = 130
"""Largest number of components of Panel of a page that shows maps only."""


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


def count_views() -> int:
    """Return the number of components of Panel that are alive."""
    # A weak proxy whose object is gone raises an error when it is asked for its class by "isinstance".
    return sum(issubclass(type(each), Viewable) for each in gc.get_objects())


def test_parts_of_closed_tabs_and_drawers_are_made_when_they_are_first_opened() -> None:
    with set_curdoc(Document()):
        before = count_views()
        explorer = Explorer()
        page = explorer_page(explorer)
        opened = count_views()
        # All components cost time when the page is made, and each is searched in every collection of garbage.
        assert opened - before <= MOST_VIEWS
        explorer.state.analysis = SECTION_STUDY.name
        with_study = count_views()
        assert with_study > opened
        explorer.drawers.show("share")
        assert count_views() > with_study
        explorer.close()
    assert page is not None


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
