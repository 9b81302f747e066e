"""Back, forward and home: for those without a wheel, and for those who got lost."""

from __future__ import annotations

from collections.abc import Callable

import panel as pn
import panel_material_ui as pmui

from app.palette import QUIET_TEXT
from app.zoom_history import ZoomHistory
from engine import Window

_HINT = "Zoom into any map with the wheel or a box: the region is computed anew."


class ZoomButtons:
    """Buttons that walk a history; `on_window` is told where to."""

    def __init__(self, history: ZoomHistory, on_window: Callable[[Window | None], None]) -> None:
        self._history = history
        self.back = _button("← Back", lambda: on_window(history.back()))
        self.forward = _button("Forward →", lambda: on_window(history.forward()))
        self.home = _button("Whole plane", lambda: self._go_home(on_window))

    def layout(self) -> pn.viewable.Viewable:
        """The buttons in a row that wraps, with a hint."""
        hint = pn.pane.HTML(_HINT, styles={"font-size": "13px", "color": QUIET_TEXT}, margin=(8, 10))
        return pn.FlexBox(self.back, self.forward, self.home, hint, gap="2px")

    def follow(self, window: Window | None) -> None:
        """Enable what leads somewhere from this window."""
        self.back.disabled = not self._history.can_go_back
        self.forward.disabled = not self._history.can_go_forward
        self.home.disabled = window is None

    def _go_home(self, on_window: Callable[[Window | None], None]) -> None:
        self._history.visit(None)
        on_window(None)


def _button(label: str, press: Callable[[], None]) -> pmui.Button:
    button = pmui.Button(label=label, variant="text", size="small", disabled=True)
    button.on_click(lambda event: press())
    return button
