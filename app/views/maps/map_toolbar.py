"""The tools of the maps: back, forward, whole plane, and what a drag does."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum

import panel as pn

from app.state.history import History
from app.views.components.flex_row import flex_row
from app.views.components.widgets import SegmentedControl, button


class Drag(StrEnum):
    """What dragging over a map does."""

    PAN = "Move"
    ZOOM = "Zoom"
    COUNT = "Count"
    SCROLL = "Scroll"


class MapToolbar:
    """Buttons that undo, redo and show the whole plane, and the choice of `Drag`.

    Parameters
    ----------
    back, forward, home
        Called when a button is pressed.
    set_drag
        Called with the mode that is chosen.
    """

    def __init__(
        self,
        back: Callable[[], None],
        forward: Callable[[], None],
        home: Callable[[], None],
        set_drag: Callable[[Drag], None],
    ) -> None:
        self.back, self.forward, self.home = (
            button(label, action, kind="light", margin=0)
            for label, action in (("← Back", back), ("Forward →", forward), ("Whole plane", home))
        )
        modes = [Drag.PAN, Drag.ZOOM, Drag.COUNT]
        self.drag = SegmentedControl(label="Drag over a map to", options=modes, value=Drag.PAN, margin=(0, 0, 0, 8))
        self._before: tuple[pn.viewable.Viewable, ...] = ()
        self._row = flex_row(align="center")
        self._row.css_classes = ["status-line"]
        self.drag.param.watch(lambda event: set_drag(event.new), "value")

    def layout(self, *before: pn.viewable.Viewable) -> pn.viewable.Viewable:
        """A row of the parts `before`, the buttons that lead somewhere, and the choice."""
        self._before = before
        self._row.objects = [*before, *self._row.objects]
        return self._row

    def begin_touch(self) -> None:
        """The page is used by touch: one finger scrolls the page until another mode is chosen."""
        self.drag.param.update(options=[Drag.SCROLL, Drag.PAN, Drag.ZOOM, Drag.COUNT], value=Drag.SCROLL)

    def follow(self, history: History, *, zoomed: bool) -> None:
        """Show the buttons that lead somewhere."""
        needed = {
            self.back: history.can_go_back,
            self.forward: history.can_go_forward,
            self.home: zoomed,
        }
        parts = [*self._before, *(one for one, is_needed in needed.items() if is_needed), self.drag]
        if parts != self._row.objects:
            self._row.objects = parts
