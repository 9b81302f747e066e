"""The tools of the maps: the whole plane, and what a drag does."""

from __future__ import annotations

import panel as pn
import pytest

from app.views.maps.map_toolbar import Drag, MapToolbar


@pytest.fixture
def chosen() -> list[Drag]:
    return []


@pytest.fixture
def toolbar(chosen: list[Drag]) -> MapToolbar:
    return MapToolbar(lambda: None, chosen.append)


def test_the_whole_plane_can_be_shown_while_a_part_of_it_is(toolbar: MapToolbar) -> None:
    shown = [toolbar.home.styles["visibility"]]
    for zoomed in (True, False):
        toolbar.follow(zoomed=zoomed)
        shown.append(toolbar.home.styles["visibility"])
    assert shown == ["hidden", "visible", "hidden"]


def test_all_parts_have_fixed_places(toolbar: MapToolbar) -> None:
    text = pn.pane.HTML("text")
    row = toolbar.layout(text)
    toolbar.follow(zoomed=True)
    assert row.objects == [text, toolbar.home, toolbar.drag]


def test_a_mode_is_passed_on(toolbar: MapToolbar, chosen: list[Drag]) -> None:
    toolbar.drag.value = Drag.ZOOM
    assert chosen == [Drag.ZOOM]


def test_on_a_touch_device_dragging_scrolls_at_first(toolbar: MapToolbar, chosen: list[Drag]) -> None:
    toolbar.begin_touch()
    assert list(toolbar.drag.options) == [Drag.SCROLL, Drag.PAN, Drag.ZOOM, Drag.COUNT]
    assert chosen == [Drag.SCROLL]
