"""The tools of the maps: buttons that lead somewhere, and what a drag does."""

from __future__ import annotations

import panel as pn
import pytest

from app.state.history import History
from app.views.maps.map_toolbar import Drag, MapToolbar


@pytest.fixture
def chosen() -> list[Drag]:
    return []


@pytest.fixture
def toolbar(chosen: list[Drag]) -> MapToolbar:
    return MapToolbar(lambda: None, lambda: None, lambda: None, chosen.append)


def buttons(row: pn.Column) -> list[str]:
    return [part.label for part in row.objects if isinstance(part, pn.widgets.Button)]


def test_only_buttons_that_lead_somewhere_are_shown(toolbar: MapToolbar) -> None:
    row, history = toolbar.layout(), History()
    shown = []
    for step, zoomed in ((None, False), (history.record, True), (history.record, False), (lambda: history.move_to(1), True)):
        if step is not None:
            step()
        toolbar.follow(history, zoomed=zoomed)
        shown.append(buttons(row))
    back, forward, home = "← Back", "Forward →", "Whole plane"
    assert shown == [[], [back, home], [back], [back, forward, home]]


def test_the_parts_before_the_buttons_stay(toolbar: MapToolbar) -> None:
    text = pn.pane.HTML("text")
    row = toolbar.layout(text)
    toolbar.follow(History(), zoomed=False)
    assert row.objects == [text, toolbar.drag]


def test_a_mode_is_passed_on(toolbar: MapToolbar, chosen: list[Drag]) -> None:
    toolbar.drag.value = Drag.ZOOM
    assert chosen == [Drag.ZOOM]


def test_on_a_touch_device_dragging_scrolls_at_first(toolbar: MapToolbar, chosen: list[Drag]) -> None:
    toolbar.begin_touch()
    assert list(toolbar.drag.options) == [Drag.SCROLL, Drag.PAN, Drag.ZOOM, Drag.COUNT]
    assert chosen == [Drag.SCROLL]
