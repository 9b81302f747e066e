"""The tools of the maps: the button for the whole plane, and the effect of a drag."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum

import panel as pn

from app.state.view_state import ViewState
from app.views.components.widgets import SegmentedControl, button, flex_row, keep_place


class Drag(StrEnum):
    """The effect of dragging over a map."""

    PAN = "Move"
    ZOOM = "Zoom"
    COUNT = "Count"
    SCROLL = "Scroll"


class MapToolbar:
    """A button that shows the whole plane, and the choice of `Drag`. The browser's own buttons go back and forward.

    Parameters
    ----------
    state
        The view state; the button removes its window.
    set_drag
        Called with the mode that is chosen.
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
        # The button is visible only while it has an effect.
        state.follow(lambda window: self.home.param.update(styles=keep_place(shown=window is not None)), "window")

    def layout(self, *before: pn.viewable.Viewable) -> pn.viewable.Viewable:
        """A row of the parts `before`, the choice, and the button."""
        row = flex_row(*before, self.drag, self.home, align="center")
        row.css_classes = ["status-line"]
        return row

    def begin_touch(self) -> None:
        """The page is used by touch: one finger scrolls the page until another mode is chosen."""
        self.drag.param.update(options=[Drag.SCROLL, Drag.PAN, Drag.ZOOM, Drag.COUNT], value=Drag.SCROLL)
