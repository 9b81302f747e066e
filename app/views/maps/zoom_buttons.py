"""Back, forward and home: for those without a wheel, and for those who got lost."""

from __future__ import annotations

from collections.abc import Callable

import panel as pn
import panel_material_ui as pmui

from app.state.zoom_history import ZoomHistory
from app.views.components.flex_row import flex_row

_HINT = "Zoom into any map with the wheel or a box: the region is computed anew. Keys: arrows, + −, h, b, f, p, Esc."


class ZoomButtons:
    """Buttons that walk a history."""

    def __init__(self, back: Callable[[], None], forward: Callable[[], None], home: Callable[[], None]) -> None:
        self.back, self.forward, self.home = _button("← Back", back), _button("Forward →", forward), _button("Whole plane", home)

    def layout(self) -> pn.viewable.Viewable:
        """The buttons in a row that wraps, with a hint."""
        hint = pn.pane.HTML(_HINT, styles={"font-size": "13px", "opacity": "0.75"}, margin=(8, 10))
        return flex_row(self.back, self.forward, self.home, hint, gap="2px")

    def follow(self, history: ZoomHistory) -> None:
        """Enable what leads somewhere from here."""
        self.back.disabled = not history.can_go_back
        self.forward.disabled = not history.can_go_forward
        self.home.disabled = history.window is None


def _button(label: str, press: Callable[[], None]) -> pmui.Button:
    button = pmui.Button(label=label, variant="text", size="small", disabled=True)
    button.on_click(lambda event: press())
    return button
