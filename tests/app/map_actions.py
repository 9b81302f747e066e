"""Make the view of maps without a page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

from app.job_clients.shown_results import ShownResults
from app.state.view_state import ViewState
from app.views.components.view_store import ViewStore
from app.views.maps.map_plots import MapActions, MapsView
from app.views.maps.well import WellView
from app.views.panels.engine_component import BrowserEngine
from engine import Window
from engine.jobs.manager import Jobs

_NOTHING = MapActions(
    tap=lambda x, ordinate: None,
    zoom_to_point=lambda x, ordinate: None,
    count_in=lambda box: None,
)


def make_browser_engine(
    state: ViewState | None = None,
    on_zoom: Callable[[Window | None], None] = lambda window: None,
    on_rest: Callable[[], None] = lambda: None,
    on_pixels: Callable[[int], None] = lambda pixels: None,
) -> BrowserEngine:
    """Return the engine in the browser, with the store of energy and window, without a page."""
    at_once = lambda function: function  # noqa: E731
    return BrowserEngine(state or ViewState(), ShownResults(), Jobs(), at_once, on_zoom, on_rest, on_pixels)


def make_maps(state: ViewState | None = None, store: ViewStore | None = None, **actions: Any) -> MapsView:
    """Return the view of maps that follows a view state and calls these actions."""
    return MapsView(state or ViewState(), replace(_NOTHING, **actions), store or make_browser_engine())


def make_well(state: ViewState | None = None) -> WellView:
    """Return the picture of the well, without texts around it."""
    return WellView(state or ViewState(), lambda name, texts: None)
