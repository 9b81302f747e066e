"""The maps share one toolbar, and clicks on them reach the page."""

from __future__ import annotations

from dataclasses import replace

import pytest
from bokeh.document import Document
from bokeh.events import DoubleTap, Tap
from bokeh.models import BasicTickFormatter, BoxSelectTool, BoxZoomTool, CustomJSTickFormatter, PanTool, WheelZoomTool

from app.state.view import View
from app.state.view_state import ViewState
from app.views.maps.map_plots import MAPS, MapsView
from app.views.maps.map_toolbar import Drag
from engine import CASES, MapSpec, Plane, Window, compute_map
from plots.browser.browser_system import window_in_browser
from plots.layers.table import LAYERS
from plots.pictures.image_columns import map_columns
from plots.pictures.time_scale import TimeScale, fitted_scale
from tests.app.map_actions import make_browser_engine, make_maps


@pytest.fixture
def state() -> ViewState:
    return ViewState()


@pytest.fixture
def maps(state: ViewState) -> MapsView:
    return make_maps(state)


def tools(maps: MapsView, kind: type) -> list[object]:
    return [tool for tool in maps.figures["basins"].toolbar.tools if isinstance(tool, kind)]


def test_all_figures_share_one_toolbar(state: ViewState, maps: MapsView) -> None:
    state.layers = frozenset(LAYERS)
    state.compared = View()
    assert set(maps.figures) == set(MAPS)
    assert len({id(plot.toolbar) for plot in maps.figures.values()}) == 1


@pytest.mark.parametrize(
    ("drag", "kind"), [(Drag.PAN, PanTool), (Drag.ZOOM, BoxZoomTool), (Drag.COUNT, BoxSelectTool), (Drag.SCROLL, type(None))]
)
def test_the_mode_chooses_the_active_tool(maps: MapsView, drag: Drag, kind: type) -> None:
    for mode in (drag, Drag.PAN, drag):
        maps.tools.set_drag(mode)
    assert isinstance(maps.figures["basins"].toolbar.active_drag, kind)
    # The tool is made once, when it is first chosen.
    assert len(tools(maps, BoxZoomTool)) == (drag is Drag.ZOOM)
    assert len(tools(maps, BoxSelectTool)) == (drag is Drag.COUNT)


def test_on_touch_screens_the_wheel_tool_ignores_two_fingers(state: ViewState, maps: MapsView) -> None:
    assert tools(maps, WheelZoomTool)
    state.touch = True
    assert not tools(maps, WheelZoomTool)


def clicks(*points: tuple[float, float]) -> list[tuple[str, float, float]]:
    """Return the calls after quick clicks on points of a map, one after the other."""
    called: list[tuple[str, float, float]] = []
    view = make_maps(tap=lambda x, y: called.append(("tap", x, y)), zoom_to_point=lambda x, y: called.append(("zoom", x, y)))
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (10, 10), (0.0, 1.0, 0.0, 1.0), t_max=10.0))
    view.show(frame, map_columns(frame))
    document = Document()
    view.grid.layout().server_doc(document)
    plot = view.figures["basins"]
    for event, (x, y) in zip((Tap, DoubleTap), points, strict=True):
        document.callbacks.trigger_event(event(plot, x=x, y=y))
    return called


def test_two_clicks_on_one_pixel_are_a_dive_to_the_point() -> None:
    assert clicks((0.31, 0.52), (0.33, 0.54)) == [("tap", pytest.approx(0.35), pytest.approx(0.55)), ("zoom", 0.33, 0.54)]


def test_two_quick_clicks_on_two_pixels_are_two_taps() -> None:
    assert [name for name, _, _ in clicks((0.31, 0.52), (0.71, 0.52))] == ["tap", "tap"]


def deep(width: float) -> MapsView:
    store = make_browser_engine()
    view = make_maps(store=store)
    spec = MapSpec(CASES["I"], Plane.X_PX, 0.19, (4, 4), (0.1, 0.1 + width, 0.2, 0.2 + width), t_max=10.0)
    frame = compute_map(spec)
    store.set_home(replace(spec, window=None))
    view.show(frame, map_columns(frame))
    return view


def test_labels_of_a_deep_window_are_distances_from_a_stated_number() -> None:
    view = deep(1e-9)
    for axis in (view.figures["times"].below[0], view.figures["times"].left[0]):
        assert isinstance(axis.formatter, CustomJSTickFormatter)
        assert axis.formatter.args["unit"] == 1e-10
    assert abs(view.figures["times"].below[0].formatter.args["base"] - 0.1) < 1e-9
    # Each map with axes states what its labels mean.
    assert view.grid.strips.object.count("x = 0.1000000006 + … × 10⁻¹⁰") == 3
    assert "times enlarged" in view.grid.strips.object
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (4, 4), t_max=10.0))
    view.show(frame, map_columns(frame))
    assert isinstance(view.figures["times"].below[0].formatter, BasicTickFormatter)
    assert "…" not in view.grid.strips.object


def test_a_locked_scale_of_times_keeps_its_ends_until_it_is_unlocked(state: ViewState, maps: MapsView) -> None:
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.3, (20, 20), t_max=50.0))
    state.lock_times = TimeScale(2.5, 5000.0)
    maps.show(frame, map_columns(frame))
    assert maps.times == TimeScale(2.5, 5000.0)
    assert "≥ 5 000" in maps.grid.strips.object
    state.lock_times = None
    assert maps.times == fitted_scale(frame)
    assert "≥ 5 000" not in maps.grid.strips.object


def test_the_pictures_return_to_a_window_whose_map_was_the_last_one_shown() -> None:
    store = make_browser_engine()
    maps = make_maps(store=store)
    frame = compute_map(MapSpec(CASES["I"], Plane.X_PX, 0.19, (8, 8), t_max=10.0))
    home = frame.spec.find_window()
    for _ in range(2):
        maps.show(frame, map_columns(frame))
        assert store.window["value"] == window_in_browser(home)
        # The map of this window never arrives.
        store.go_to(Window(-0.1, 0.1, -0.2, 0.2))
