"""The maps share one toolbar, one legend and one picker."""

from __future__ import annotations

import pytest
from bokeh.models import BoxSelectTool, BoxZoomTool, PanTool, WheelZoomTool

from app.views.maps.map_plots import MAPS, SHORT_TITLES, MapsView
from app.views.maps.map_toolbar import Drag
from engine import CASES, MapSpec, Plane, Window
from plots.map_images import ON_DEMAND

ALWAYS = [name for name in MAPS if name not in ON_DEMAND]


@pytest.fixture
def maps() -> MapsView:
    view = MapsView(lambda x, y: None, lambda window: None, lambda: None, lambda box: None)
    view.show_pictures(frozenset())
    return view


def tools(maps: MapsView, kind: type) -> list[object]:
    return [tool for tool in maps.figures["basins"].toolbar.tools if isinstance(tool, kind)]


def test_all_figures_share_one_toolbar(maps: MapsView) -> None:
    maps.show_pictures(frozenset(ON_DEMAND))
    assert set(maps.figures) == set(MAPS)
    assert len({id(plot.toolbar) for plot in maps.figures.values()}) == 1


def test_a_box_tool_is_made_when_it_is_first_chosen(maps: MapsView) -> None:
    assert not tools(maps, BoxZoomTool)
    assert not tools(maps, BoxSelectTool)
    for _ in range(2):
        maps.set_drag(Drag.ZOOM)
        maps.set_drag(Drag.COUNT)
    assert len(tools(maps, BoxZoomTool)) == len(tools(maps, BoxSelectTool)) == 1


@pytest.mark.parametrize(
    ("drag", "kind"), [(Drag.PAN, PanTool), (Drag.ZOOM, BoxZoomTool), (Drag.COUNT, BoxSelectTool), (Drag.SCROLL, type(None))]
)
def test_the_mode_chooses_the_active_tool(maps: MapsView, drag: Drag, kind: type) -> None:
    maps.set_drag(drag)
    assert isinstance(maps.figures["basins"].toolbar.active_drag, kind)


def test_every_picture_has_a_short_title() -> None:
    assert set(SHORT_TITLES) == {"well", *MAPS}


def test_pictures_on_demand_are_on_the_page_while_they_are_shown(maps: MapsView) -> None:
    grid, _ = maps.layout()
    counts = []
    for on_demand in (frozenset({"origins"}), frozenset(ON_DEMAND), frozenset()):
        maps.show_pictures(on_demand)
        counts.append(len(grid.objects))
    assert counts == [len(ALWAYS) + 2, len(MAPS) + 1, len(ALWAYS) + 1]


def test_on_touch_screens_the_tool_of_the_wheel_leaves_two_fingers_alone(maps: MapsView) -> None:
    assert tools(maps, WheelZoomTool)
    maps.begin_touch()
    assert not tools(maps, WheelZoomTool)


def test_the_picker_of_a_touch_device_marks_one_picture(maps: MapsView) -> None:
    maps.begin_touch()
    maps.show_pictures(frozenset({"origins"}))
    grid, _ = maps.layout()
    picker, *panes = grid.objects
    assert list(picker.options.values()) == ["well", *ALWAYS, "origins"]
    picker.value = "origins"
    assert len(panes) == len(ALWAYS) + 2
    assert [name for name, plot in maps.figures.items() if "picked" in plot.css_classes] == ["origins"]
    maps.show_pictures(frozenset())
    assert picker.value == "basins"


def test_reversed_ranges_are_no_window() -> None:
    zooms: list[Window | None] = []
    view = MapsView(lambda x, y: None, zooms.append, lambda: None, lambda box: None)
    view._spec = MapSpec(CASES["I"], Plane.X_PX, 0.19)
    for start, end in ((0.2, 0.1), (0.1, 0.2)):
        view._ranges[0].update(start=start, end=end)
        view._rested()
    assert [(zoom.x_low, zoom.x_high) for zoom in zooms if zoom] == [(0.1, 0.2)]
