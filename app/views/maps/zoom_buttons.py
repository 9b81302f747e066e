"""Back, forward and whole plane."""

from __future__ import annotations

from collections.abc import Callable

import panel as pn

from app.state.zoom_history import ZoomHistory
from app.views.components.flex_row import flex_row
from app.views.components.widgets import button

_HINT = "Zoom into any map with the wheel or a box. Keys: arrows, + −, h, b, f, p, Esc, ?"


class ZoomButtons:
    """Buttons that move through a zoom history."""

    def __init__(self, back: Callable[[], None], forward: Callable[[], None], home: Callable[[], None]) -> None:
        options = {"disabled": True, "margin": (5, 0)}
        self.back = button("← Back", back, kind="light", **options)
        self.forward = button("Forward →", forward, kind="light", **options)
        self.home = button("Whole plane", home, kind="light", **options)

    def layout(self) -> pn.viewable.Viewable:
        """The buttons in a row that wraps, with a hint."""
        hint = pn.pane.HTML(f"<span class='quiet'>{_HINT}</span>", margin=(5, 10))
        return flex_row(self.back, self.forward, self.home, hint, align="center", gap="0px")

    def follow(self, history: ZoomHistory) -> None:
        """Enable the buttons that lead to another window."""
        self.back.disabled = not history.can_go_back
        self.forward.disabled = not history.can_go_forward
        self.home.disabled = history.window is None
