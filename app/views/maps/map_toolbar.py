"""The tools of the maps: whole plane, and what a drag does."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum

import panel as pn

from app.views.components.widgets import SegmentedControl, button, flex_row, keep_place


class Drag(StrEnum):
    """What dragging over a map does."""

    PAN = "Move"
    ZOOM = "Zoom"
    COUNT = "Count"
    SCROLL = "Scroll"


class MapToolbar:
    """A button that shows the whole plane, and the choice of `Drag`; the browser's own buttons go back and forward.

    Parameters
    ----------
    home
        Called when the button is pressed.
    set_drag
        Called with the mode that is chosen.
    """

    def __init__(self, home: Callable[[], None], set_drag: Callable[[Drag], None]) -> None:
        self.home = button("Whole plane", home, kind="light", margin=0, styles=keep_place(shown=False))
        self.drag = SegmentedControl(
            label="Drag over a map to",
            options=[Drag.PAN, Drag.ZOOM, Drag.COUNT],
            value=Drag.PAN,
            margin=0,
            css_classes=["segmented", "narrow"],
        )
        self.drag.param.watch(lambda event: set_drag(event.new), "value")

    def layout(self, *before: pn.viewable.Viewable) -> pn.viewable.Viewable:
        """A row of the parts `before`, the choice, and the button."""
        row = flex_row(*before, self.drag, self.home, align="center")
        row.css_classes = ["status-line"]
        return row

    def begin_touch(self) -> None:
        """The page is used by touch: one finger scrolls the page until another mode is chosen."""
        self.drag.param.update(options=[Drag.SCROLL, Drag.PAN, Drag.ZOOM, Drag.COUNT], value=Drag.SCROLL)

    def follow(self, *, zoomed: bool) -> None:
        """Show the button while it leads somewhere."""
        self.home.styles = keep_place(shown=zoomed)
