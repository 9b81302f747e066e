"""The tools of the maps: a button that shows the whole plane, and the choice of what a drag does."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from functools import partial
from typing import Any

import panel as pn
from bokeh.models import BoxSelectTool, BoxZoomTool, CrosshairTool, HoverTool, PanTool, Toolbar, WheelZoomTool

from app.state.view_state import ViewState
from app.views.components.plots import moving_line
from app.views.components.widgets import SegmentedControl, button, flex_row, keep_place


class Drag(StrEnum):
    """What a drag over a map does."""

    PAN = "Move"
    ZOOM = "Zoom"
    COUNT = "Count"
    SCROLL = "Scroll"


# Tools that draw a box. With renderers, Bokeh would change the look of the image outside the box.
_BOX_TOOLS = {Drag.ZOOM: partial(BoxZoomTool, match_aspect=True), Drag.COUNT: partial(BoxSelectTool, renderers=[])}


class MapTools:
    """The tools of all pictures, in the attribute `toolbar`. The tools follow touch input.

    Parameters
    ----------
    state
        View state.
    *hovers
        Tools with texts of the pixels.
    """

    def __init__(self, state: ViewState, *hovers: HoverTool) -> None:
        pan, wheel = PanTool(), WheelZoomTool()
        spans = [moving_line(dimension, line_alpha=0.35) for dimension in ("width", "height")]
        tools = [pan, wheel, CrosshairTool(overlay=spans), *hovers]
        self.toolbar = Toolbar(tools=tools, active_drag=pan, active_scroll=wheel)
        self._drag_tools: dict[Drag, Any] = {Drag.PAN: pan}
        state.param.watch(lambda event: self._begin_touch(), "touch")

    def set_drag(self, drag: Drag) -> None:
        """Choose the effect of dragging over a picture."""
        if drag in _BOX_TOOLS and drag not in self._drag_tools:
            self._drag_tools[drag] = _BOX_TOOLS[drag]()
            self.toolbar.tools = [*self.toolbar.tools, self._drag_tools[drag]]
        self.toolbar.active_drag = self._drag_tools.get(drag)

    def _begin_touch(self) -> None:
        """Adapt to touch input: two fingers zoom."""
        # The wheel tool would also respond to two fingers.
        tools = [tool for tool in self.toolbar.tools if not isinstance(tool, WheelZoomTool)]
        self.toolbar.update(tools=tools, active_scroll=None)


class MapToolbar:
    """A button that shows the whole plane, and a choice of `Drag`. The browser's buttons go back to earlier windows.

    Parameters
    ----------
    state
        View state, whose window the button removes.
    set_drag
        Sets the chosen effect of a drag.
    """

    def __init__(self, state: ViewState, set_drag: Callable[[Drag], None]) -> None:
        show_all = lambda: state.param.update(window=None)  # noqa: E731
        self.home = button("Whole plane", show_all, kind="light", margin=0, styles=keep_place(shown=False))
        self.drag = SegmentedControl(
            label="Drag over a map to",
            options=[Drag.PAN, Drag.ZOOM, Drag.COUNT],
            value=Drag.PAN,
            margin=0,
            css_classes=["segmented", "narrow"],
        )
        self.drag.param.watch(lambda event: set_drag(event.new), "value")
        state.param.watch(lambda event: self._begin_touch(), "touch")
        # Without a window, the button would have no effect.
        state.follow(lambda window: self.home.param.update(styles=keep_place(shown=window is not None)), "window")

    def layout(self, *before: pn.viewable.Viewable) -> pn.viewable.Viewable:
        """Return a row of the parts `before`, the choice, and the button."""
        row = flex_row(*before, self.drag, self.home, align="center")
        row.css_classes = ["status-line"]
        return row

    def _begin_touch(self) -> None:
        """Adapt to touch input: a drag scrolls the page until another effect is chosen."""
        self.drag.param.update(options=[Drag.SCROLL, Drag.PAN, Drag.ZOOM, Drag.COUNT], value=Drag.SCROLL)
